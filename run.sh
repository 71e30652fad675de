#!/usr/bin/env bash
# Installs what is missing, builds, and runs skincal.
#   ./run.sh          opens the window on a simulated arm; where there is no screen, simulates a skin and calibrates it
#                     from end to end with results in out/
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

skincal="$top/build/release/bin/skincal"
if [ $# -gt 0 ]; then
  exec "$skincal" "$@"
fi
if [ -n "${DISPLAY:-}" ]; then
  exec "$skincal" --demo
fi
exec "$skincal" demo --output "$top/out"
