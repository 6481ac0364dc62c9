#!/bin/sh
# What loading costs: CPU seconds of the whole program until the scene stands, and its peak memory.
# A table on standard output.
#
#   loading.sh SOURCE TIMEWARP...
#
# SPDX-License-Identifier: LGPL-3.0-or-later
source=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# lines COUNT TEXT: the text COUNT times, its @ the number of the line
lines() {
  awk -v count="$1" -v text="$2" 'BEGIN {
    for (i = 1; i <= count; ++i) { line = text; gsub(/@/, i, line); print line }
  }'
}

command=$*
# row NAME UNTIL SCENE; times are those of the subshell and what it ran
row() {
  spent=$($command --quiet --stats --until="$2" "$3" >"$folder/stats" || exit 1; times) || exit 1
  echo "$spent" | tail -n 1 | tr ms '  ' | cat - "$folder/stats" | awk -v name="$1" '
    NR == 1 { cpu = 60 * $1 + $2 + 60 * $3 + $4 }
    $1 == "peak_rss_bytes" { printf "| %s | %.2g | %.0f |\n", name, cpu, $2 / 1e6 }'
}

many='(let ((shape (sphere 0.1)))
  (do ((k 0 (1+ k))) ((= k COUNT))
    (add-body! #:shape shape #:position (vector (modulo k 1000) (quotient k 1000) 0))))'
echo "(use-modules (timewarp))" >"$folder/start"
{ cat "$folder/start"; lines 4 '(add-body! #:shape (sphere 0.1) #:position (vector @ 0 0))'; } >"$folder/five.scm"
lines 2000 '(define x@ 1)' >"$folder/define.scm"
lines 100000 '(define x@ 1)' >"$folder/define-more.scm"
{ cat "$folder/start"; lines 100000 '(add-body! #:shape (sphere 0.1) #:position (vector @ 0 0))'; } >"$folder/forms.scm"
lines 5000 '(define (f@ x) (+ x @)) (f@ 1)' >"$folder/procedures.scm"
for count in 100000 1000000; do
  { cat "$folder/start"; echo "$many" | sed "s/COUNT/$count/"; } >"$folder/loop-$count.scm"
done

echo "| scene | CPU, s | peak resident, MB |"
echo "| --- | --- | --- |"
row "five forms" 0 "$folder/five.scm"
row '`gallery/dominoes.scm`' 0 "$source/scenes/gallery/dominoes.scm"
row '2000 definitions `(define x1 1)`' 0 "$folder/define.scm"
row "1e5 definitions" 0 "$folder/define-more.scm"
row '1e5 forms `(add-body! #:shape (sphere 0.1) ...)`' 0 "$folder/forms.scm"
row "5000 procedures, each called once" 0 "$folder/procedures.scm"
row "1e5 bodies of one shape in a loop" 0 "$folder/loop-100000.scm"
row "1e6 bodies of one shape in a loop" 0 "$folder/loop-1000000.scm"
row "the same, and run for 0.01 s" 0.01 "$folder/loop-1000000.scm"
