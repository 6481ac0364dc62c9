#!/bin/sh
# doc/notation.md: each row names files that exist, and each name in `code` of its first column
# stands in one of them.
# SPDX-License-Identifier: LGPL-3.0-or-later
cd "${TW_SRCDIR:-.}" || exit 99
notation=${1:-doc/notation.md}
rows=0
failures=0

complain() {
  echo "$1"
  failures=$((failures + 1))
}

# what stands between backquotes, one a line
quoted() { printf '%s\n' "$1" | grep -o '`[^`]*`' | tr -d '`'; }

while IFS='|' read -r _ term meaning files rest; do
  case $term in ' term ' | ' symbol ' | ' --- ' | '') continue ;; esac
  rows=$((rows + 1))
  [ -n "$meaning" ] && [ -z "$rest" ] || complain "$term: a row has three columns"
  paths=''
  for file in $(quoted "$files"); do
    [ -f "src/$file" ] || complain "$term: there is no src/$file"
    paths="$paths src/$file"
  done
  [ -n "$paths" ] || complain "$term: names no file"
  for name in $(quoted "$term"); do
    # shellcheck disable=SC2086
    grep -qw -- "$name" $paths 2>/dev/null || complain "$term: no $name in$paths"
  done
done <<END
$(grep '^|' "$notation")
END

echo "$rows rows checked, $failures wrong"
[ "$rows" -gt 50 ] && [ "$failures" = 0 ]
