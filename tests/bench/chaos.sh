#!/bin/sh
# Until when the three policies agree, and that it is chaos which parts them: atoms under each of them
# against timewarp, and against timewarp with each atom put aside by a hair.  A table on standard output.
#
#   chaos.sh SOURCE TIMEWARP... [-- N...]     N: atoms; 200 400 by default
#
# All fly by Cash and Karp's method, so that each policy has its own rounding and errors of its own.
# SPDX-License-Identifier: LGPL-3.0-or-later
. "${0%/*}/arguments.sh"
source=$(cd "$source" && pwd)
sizes=${*:-200 400}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
atoms=$source/scenes/atoms.scm

# run NAME SCENE OPTION...: poses and impacts of 2 s go to $folder/NAME.*
run() {
  name=$1
  shift
  $command --quiet --threads=1 --integrator=rk45 --until=2 --fps=10 --poses="$folder/$name.poses" \
    --events="$folder/$name.events" "$@" </dev/null || exit 1
}

# compare NAME LABEL: with timewarp; how far the middle one of the atoms is from where it is there, and the rate at
# which that grows from 1 s to 2 s.
compare() {
  awk -F, -v label="$2" -v fps=10 '
    function pair() { return $3 < $4 ? $3 " " $4 : $4 " " $3 }
    FNR == 1 { ++file; next }
    file == 1 && $2 == "collision" { mine[++mines] = pair(); when[mines] = $1 }
    file == 2 && $2 == "collision" { others[++theirs] = pair() }
    file == 3 { x[$1, $2] = $3; y[$1, $2] = $4; z[$1, $2] = $5 }
    file == 4 {
      n = ++count[$1]
      d[$1, n] = sqrt((x[$1, $2] - $3) ^ 2 + (y[$1, $2] - $4) ^ 2 + (z[$1, $2] - $5) ^ 2)
      if (n == 1) times[++frames] = $1
    }
    # the middle one at a frame, by insertion
    function median(t,   n, i, j, v, sorted) {
      n = count[t]
      for (i = 1; i <= n; ++i) {
        v = d[t, i]
        for (j = i - 1; j >= 1 && sorted[j] > v; --j) sorted[j + 1] = sorted[j]
        sorted[j + 1] = v
      }
      return sorted[int((n + 1) / 2)]
    }
    END {
      for (k = 1; k <= mines && mine[k] == others[k]; ++k);
      first = k <= mines || k <= theirs ? k " at " sprintf("%.3f s", when[k < mines ? k : mines]) : "none"
      for (i = 1; i <= frames; ++i) m[i] = median(times[i])
      rate = sprintf("%.1f", log(m[2 * fps + 1] / m[fps + 1]))
      printf "%s | %d | %s", label, theirs, first
      for (t = 0.5; t <= 2; t += 0.5) printf " | %.1e", m[int(t * fps + 1.5)]
      printf " | %s |\n", rate
    }' "$folder/timewarp.events" "$folder/$1.events" "$folder/timewarp.poses" "$folder/$1.poses"
}

echo "| atoms | accuracy | against timewarp | impacts | first pair that differs | apart at 0.5 s, m | 1 s | 1.5 s | 2 s | growth, 1/s |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
for n in $sizes; do
  molecules=$((n / 3))
  for accuracy in 1e-6 1e-10; do
    set -- --accuracy=$accuracy -D spheres=$((n - molecules)) -D molecules=$molecules -D room=1
    run timewarp "$atoms" "$@"
    for policy in retroactive:0.0333333 conservative; do
      run other "$atoms" --policy=$policy "$@"
      echo "| $n | $accuracy | $(compare other $policy)"
    done
    run other "$source/tests/bench/nudged.scm" -D scene-file="$atoms" -D nudge=1e-12 "$@"
    echo "| $n | $accuracy | $(compare other 'timewarp, all put aside by 1e-12 m')"
  done
done
