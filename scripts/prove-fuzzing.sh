#!/usr/bin/env bash
# Whether the fuzzers of the skin protocol find faults: plants each of tests/fuzz/faults in a copy of the sources and says
# what it took. Fails where one is not found, or something is found where none was planted.
#   scripts/prove-fuzzing.sh [INPUTS]    for each fault, at most; 500,000
# A fault's file begins with a line of what it does; its name with the fuzzer that has to find it.
set -euo pipefail
cd "$(dirname "$0")/.."
inputs=${1:-500000}
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$copy"
cd "$copy"
cmake --preset fuzz > configure.log
export ASAN_OPTIONS=quarantine_size_mb=8

# Builds and runs a fuzzer until it finds something. What it reads is what is committed: nothing is known of the faults.
search() {
  cmake --build --preset fuzz --target "fuzz_$1" > build.log || { cat build.log; exit 1; }
  rm -rf kept
  mkdir kept
  began=$SECONDS
  build/fuzz/bin/"fuzz_$1" -runs="$inputs" -max_len=400 -entropic=0 -reload=0 -timeout=5 -rss_limit_mb=1000 \
    -seed=1 -print_final_stats=1 kept tests/fuzz/corpus_protocol/"$1" > found.log 2>&1
}
tried() { sed -n 's/^stat::number_of_executed_units: *//p' found.log; }
reason() { grep -m1 -oE 'what\(\):.*|runtime error: .*|Assertion .*|AddressSanitizer: [a-zA-Z-]+|libFuzzer: [a-z-]+' found.log; }

for target in frames cell client; do
  search $target || { echo "$target: found where nothing was planted: $(reason)"; exit 1; }
  echo "$target: nothing planted, nothing found in $(tried) inputs"
done
missed=0
for fault in tests/fuzz/faults/*.patch; do
  name=$(basename "$fault" .patch)
  patch -s -p1 < "$fault"
  if search "${name%%-*}"; then
    echo "MISSED $name in $(tried) inputs: $(head -1 "$fault")"
    missed=1
  else
    echo "found  $name after $((SECONDS - began)) s and $(tried) inputs: $(reason)"
  fi
  patch -s -R -p1 < "$fault"
done
exit $missed
