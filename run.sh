#!/usr/bin/env bash
# Installs what is missing, builds, and runs skincal.
#   ./run.sh          simulates a skin and calibrates it from end to end; results in out/
#   ./run.sh ARGS     skincal ARGS
set -euo pipefail
top=$(cd "$(dirname "$0")" && pwd)

{
  "$top/scripts/install-dependencies.sh"
  cd "$top"
  [ -f build/release/build.ninja ] || cmake --preset release
  cmake --build --preset release --target skincal
  cd "$OLDPWD"
} >&2

if [ $# -eq 0 ]; then
  exec "$top/build/release/bin/skincal" demo --output "$top/out"
fi
exec "$top/build/release/bin/skincal" "$@"
