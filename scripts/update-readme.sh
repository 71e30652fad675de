#!/usr/bin/env bash
# Writes the table of the paper's experiments into README.md, as the program prints it.
set -euo pipefail
cd "$(dirname "$0")/.."
table=$(mktemp)
trap 'rm -f "$table"' EXIT
./run.sh reproduce-paper --trials "${1:-50}" >"$table"
awk -v file="$table" '
  /<!-- reproduce-paper -->/ { print; print ""; while ((getline line < file) > 0) print line; print ""; skip = 1; next }
  /<!-- end -->/ { skip = 0 }
  !skip { print }
' README.md >"$table.md"
mv "$table.md" README.md
