#!/usr/bin/env bash
# Writes the tables of README.md as the program gives them: the recordings under tests/data by both methods, and the
# experiments of the paper.
#   scripts/update-readme.sh [TRIALS]
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
./run.sh --version >/dev/null
skincal=build/release/bin/skincal

# "placed of all: position rms in mm, rotation rms in degrees" of RECORDING by METHOD; 1 is the exit code of a body
# with modules missing.
outcome() {
  "$skincal" calibrate --force "$1" --method "$2" -o "$work/body.json" >/dev/null || [ $? -eq 1 ]
  "$skincal" compare --json "$work/body.json" "$1/truth.json" | awk -F '[:,] *' '
    { gsub(/"| /, "", $1); value[$1] = $2 }
    END { printf "%s of %s: %.2f mm, %.1f°", value["placed"], value["modules"],
          1e3 * value["position_rms"], 57.2958 * value["rotation_rms"] }'
}

{
  echo "| recording | \`--method paper\` | \`--method sturdy\` | default |"
  echo "| --- | --- | --- | --- |"
  for recording in tests/data/recordings/*.skinrec; do
    name=$(basename "$recording" .skinrec)
    echo "| ${name//-/ } | $(outcome "$recording" paper) | $(outcome "$recording" sturdy) | $(outcome "$recording" joint) |"
  done
} >"$work/recordings"
"$skincal" reproduce-paper --trials "${1:-50}" >"$work/reproduce-paper"

for table in recordings reproduce-paper; do
  awk -v file="$work/$table" -v start="<!-- $table -->" '
    $0 == start { print; print ""; while ((getline line < file) > 0) print line; print ""; skip = 1; next }
    /<!-- end -->/ { skip = 0 }
    !skip { print }
  ' README.md >"$work/README.md"
  cp "$work/README.md" README.md
done
