#!/usr/bin/env bash
# Fuzzes the skin protocol: frames through both decoders, a cell among liars, the computer with a skin that lies.
#   scripts/fuzz-protocol.sh [INPUTS]    100,000,000 in full: a night on two cores
# Six of ten inputs are frames, by two processes, the rest is shared by two; all four run beside each other. Each stops
# at the first input that crashes, takes 5 s or 1 GB, or makes one side say what it must not; the input is then in
# build/fuzz/found. Inputs of worth are kept in build/fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")/.."
inputs=${1:-100000000}
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz
cmake --build --preset fuzz --target fuzz_frames fuzz_cell fuzz_client
mkdir -p build/fuzz/found
# What is freed is kept back for a while, to see it used; the default, 256 MB, is most of the time that inputs take.
export ASAN_OPTIONS=quarantine_size_mb=8
running=()
trap 'kill $(jobs -p) 2> /dev/null || true' EXIT
for share in frames:3 frames:3 cell:2 client:2; do
  target=${share%:*}
  log=build/fuzz/$target-${#running[@]}.log
  mkdir -p "build/fuzz/corpus/$target"
  "build/fuzz/bin/fuzz_$target" -runs=$((inputs * ${share#*:} / 10)) -max_len=400 -entropic=0 -reload=0 -timeout=5 \
    -rss_limit_mb=1000 -print_final_stats=1 -verbosity=0 -artifact_prefix=build/fuzz/found/ \
    "build/fuzz/corpus/$target" "tests/fuzz/corpus_protocol/$target" > "$log" 2>&1 &
  running+=("$target:$!:$log")
done
found=0
for one in "${running[@]}"; do
  IFS=: read -r target process log <<< "$one"
  if wait "$process"; then
    echo "$target: nothing found in $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs"
  else
    tail -n 40 "$log"
    echo "$target: FOUND something, see build/fuzz/found and $log"
    found=1
  fi
done
exit $found
