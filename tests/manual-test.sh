#!/bin/sh
# The manual: makeinfo has nothing to say against it, as Info and as web pages, whose links all lead
# somewhere; `make' has built what can be read.
# SPDX-License-Identifier: LGPL-3.0-or-later
command -v makeinfo >/dev/null || { echo "makeinfo is not installed"; exit 77; }
[ -e "$TW_BUILDDIR/doc/reference.texi" ] || { echo "the manual is not built here"; exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

# claim TEXT COMMAND...: the command must succeed
claim() {
  text=$1
  shift
  if "$@"; then
    echo "ok   $text"
  else
    echo "FAIL $text"
    failures=$((failures + 1))
  fi
}

# quiet OPTION...: makeinfo says nothing
quiet() {
  makeinfo -D 'VERSION test' -I "$TW_BUILDDIR/doc" "$@" "$TW_SRCDIR/doc/timewarp.texi" \
    >"$folder/said" 2>&1 && ! [ -s "$folder/said" ] || { cat "$folder/said"; return 1; }
}

# each "PAGE#ANCHOR" that a page leads to is there
links_lead_somewhere() {
  cd "$folder/html" || return 1
  sed -n 's/.*href="\([A-Za-z0-9_-]*\.html\)[#"].*/\1/p' ./*.html | sort -u | while read -r page; do
    [ -e "$page" ] || { echo "no page $page"; exit 1; }
  done || return 1
  for page in *.html; do
    sed 's/href="/\n&/g' "$page" | sed -n "s/^href=\"\([A-Za-z0-9_-]*\.html\)\{0,1\}#\([^\"]*\)\".*/\1 \2/p" |
      while read -r where anchor; do
        case $where in *.html) ;; *) anchor=$where where=$page ;; esac
        grep -q "id=['\"]$anchor['\"]" "$where" || { echo "$page: no $anchor in $where"; exit 1; }
      done || return 1
  done
}

claim "as Info" quiet --no-split -o "$folder/timewarp.info"
claim "as web pages" quiet --html -o "$folder/html"
claim "links lead somewhere" links_lead_somewhere
claim "the tutorial is in it" grep -q 'A controller and a sensor' "$folder/timewarp.info"
claim "a procedure is in it, with its default" grep -q '#(0 0 -9.81)' "$folder/timewarp.info"
claim "and an option" grep -q -- '--until=SECONDS' "$folder/timewarp.info"
exit $((failures > 0))
