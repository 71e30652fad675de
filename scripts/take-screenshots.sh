#!/usr/bin/env bash
# Takes the pictures of the window that README.md shows, in both themes, from a run of the whole demo: docs/window.
#   scripts/take-screenshots.sh [FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install-dependencies.sh
[ -f build/release/build.ninja ] || cmake --preset release
cmake --build --preset release --target ui_window
SKINCAL_SCREENSHOTS=${1:-$PWD/docs/window} build/release/bin/ui_window --gtest_filter='Demo.*:LiveDemo.FeelsTheMouseWhereItIsAndForgetsItAfterwards'
