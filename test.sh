#!/usr/bin/env bash
# Installs what is missing, builds everything, and runs the whole test suite.
set -euo pipefail
cd "$(dirname "$0")"
scripts/install-dependencies.sh
[ -f build/release/build.ninja ] || cmake --preset release
cmake --build --preset release
ctest --preset release --parallel 2
