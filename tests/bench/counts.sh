#!/bin/sh
# What short runs cost, in instructions: make bench-counts, and a quick part of it within make check.
#
#   counts.sh           all rows of tests/data/counts.csv, beside what stands there
#   counts.sh --quick   the quick ones
#   counts.sh --print   the table as this build has it, to be put in its place; COUNTS=--print of make
#
# Counted by valgrind's callgrind within World::advance, or the function that a row names, on one thread
# and in one slice: the same to 1e-4 from run to run.  More than 3 % beside the table fails: whoever
# makes something dearer, or cheaper, changes its row, and says why in the commit.
# SPDX-License-Identifier: LGPL-3.0-or-later
set -u
table=$TW_SRCDIR/tests/data/counts.csv
arch=${TW_BUILT_FOR##*-march=}
arch=${arch%% *}
which=${1:-all}
failures=0
passed=0

case "$arch $TW_BUILT_AS" in
  x86-64-v3*-O2*usual) ;;
  *) echo "counts are known for -march=x86-64-v3, -O2, units joined, no sanitizers" && exit 77 ;;
esac
command -v valgrind >/dev/null || { echo "counting needs valgrind" && exit 77; }

# count FUNCTION FILE PARAMETERS SECONDS
count() {
  # shellcheck disable=SC2086  # parameters are words
  valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect="$1" \
    "$TIMEWARP" -q --quiet --threads=1 $3 -l "$TW_SRCDIR/$2" \
    -c "((@ (timewarp primitives) %advance!) (current-world) $4 1e9)" 2>&1 </dev/null |
    sed -n 's/.*Collected *: *\([0-9]*\).*/\1/p'
}

[ "$which" = --print ] || printf '%-38s %8s %14s %14s %8s\n' scene seconds table now change
while IFS=, read -r file parameters seconds function speed expected; do
  if [ "$file" = file ]; then
    [ "$which" = --print ] && echo "$file,$parameters,$seconds,$function,$speed,$expected"
    continue
  fi
  [ "$which" = --quick ] && [ "$speed" != quick ] && continue
  found=$(count "$function" "$file" "$parameters" "$seconds")
  if [ "$which" = --print ]; then
    echo "$file,$parameters,$seconds,$function,$speed,$found"
    continue
  fi
  if awk -v a="${found:-0}" -v b="$expected" 'BEGIN { exit !(a > 0.97 * b && a < 1.03 * b) }'; then
    passed=$((passed + 1))
  else
    failures=$((failures + 1))
  fi
  awk -v f="$file $parameters" -v s="$seconds" -v a="${found:-0}" -v b="$expected" 'BEGIN {
    sub(/.*\//, "", f); printf "%-38s %8s %14d %14d %+7.2f%%\n", f, s, b, a, 100 * (a / b - 1) }'
done <"$table"
[ "$which" = --print ] && exit 0
echo "$passed passed, $failures failed"
if [ $failures -gt 0 ]; then
  echo "costs have changed by more than 3 %: if that is meant, put in $table what --print gives, and say why"
  exit 1
fi
