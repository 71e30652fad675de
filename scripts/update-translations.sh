#!/usr/bin/env bash
# Brings translations/skincal_en.ts up to date with the texts in the source that count (tr() with %n). Their English
# forms for one and for many are then written into it by hand.
#   scripts/update-translations.sh [--check]    only says whether anything is missing in it or left over
set -euo pipefail
cd "$(dirname "$0")/.."
lupdate=${LUPDATE:-/usr/lib/qt6/bin/lupdate}
texts=translations/skincal_en.ts
# Core marks its sentences by Sentence::saying() (core/geometry/sentence.h), whose class needs no Q_OBJECT: ui/texts looks
# them up.
extract() {
  "$lupdate" -silent -tr-function-alias tr+=saying -source-language en -target-language en -locations none -no-obsolete \
    -I . ui app core -ts "$@" 2> >(grep -v "'skincal::Sentence' lacks Q_OBJECT\|undeclared qualified class" >&2)
}
update() { extract "$1" -pluralonly; }

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
# What lupdate takes for a comment would be looked up with it, and not be found.
all=$(mktemp --suffix .ts)
trap 'rm -f "$copy" "$all"' EXIT
rm "$all"
extract "$all"
if awk '/<context>/ { ours = 0 } /<name>skincal::Sentence</ { ours = 1 } ours' "$all" | grep -B2 "<comment>"; then
  echo "text goes into Sentence::saying() as a variable, not as a literal" >&2
  exit 1
fi
if grep "<name>Sentence<" "$all"; then
  echo "a file says Sentence::saying() and does not include core/geometry/sentence.h" >&2
  exit 1
fi
if grep -A3 "<name>skincal<" "$all"; then
  echo "these are looked up elsewhere than lupdate puts them: tr() of a class of their own is needed" >&2
  exit 1
fi
echo "plural forms: complete"
