#!/usr/bin/env bash
# Brings translations/skincal_en.ts up to date with the texts in the source that count (tr() with %n). Their English
# forms for one and for many are then written into it by hand.
#   scripts/update-translations.sh [--check]    only says whether anything is missing in it or left over
set -euo pipefail
cd "$(dirname "$0")/.."
lupdate=${LUPDATE:-/usr/lib/qt6/bin/lupdate}
texts=translations/skincal_en.ts
update() {
  "$lupdate" -silent -source-language en -target-language en -pluralonly -locations none -no-obsolete -I . ui app core -ts "$1"
}

if [ "${1:-}" != --check ]; then
  update "$texts"
  exit 0
fi
copy=$(mktemp --suffix .ts)
trap 'rm -f "$copy"' EXIT
cp "$texts" "$copy"
update "$copy"
if ! diff "$texts" "$copy" || grep 'type="unfinished"' "$copy"; then
  echo "$texts is not up to date: scripts/update-translations.sh, then write what is unfinished" >&2
  exit 1
fi
echo "plural forms: complete"
