#!/bin/sh
# The paper's comparisons: figure 2, the cost of a tumbling brick by integration step; figure 6, the
# main loops on 2 s of atoms.  Tables on standard output; where gnuplot is installed, the plots
# policies-brick.png, policies-step.png, policies-total.png and policies-cost.png in the current folder.
#
#   policies.sh SOURCE TIMEWARP... [-- N...]     N: atoms; 25 50 100 200 400 by default
#
# The paper's box holds some 400 atoms. For more it grows at the density of 400, edges by the cube
# root, so that each meets as many others as there.
#
# All fly by Cash and Karp's method, on one thread: in closed form nothing would be integrated (the
# brick does so, too).
# SPDX-License-Identifier: LGPL-3.0-or-later
. "${0%/*}/arguments.sh"
sizes=${*:-25 50 100 200 400}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# run OPTION...: the statistics go to $folder/stats
run() {
  $command --quiet --stats --threads=1 "$@" </dev/null >"$folder/stats" || exit 1
}
statistic() { awk -v name="$1" '$1 == name { print $2 }' "$folder/stats"; }

# A hair less than 10 s: a loop whose step ends there would begin the next one.
echo "## A brick in flight, 10 s"
echo
echo "| integration step, s | flight | CPU, ms | steps |"
echo "| --- | --- | --- | --- |"
brick() {
  name=$1
  shift
  for step in 0.0001 0.0003 0.001 0.003 0.01 0.03 0.1 0.3 1 3 10; do
    run --until=9.9999 --policy=retroactive:$step "$@" "$source/tests/bench/brick.scm"
    cpu=$(statistic cpu_seconds | awk '{ printf "%.3f", 1000 * $1 }')
    echo "| $step | $name | $cpu | $(statistic integrations) |"
    echo "$step $cpu" >>"$folder/brick $name"
  done
}
brick "accuracy 1e-4" --integrator=rk45 --accuracy=1e-4
brick "accuracy 1e-8" --integrator=rk45 --accuracy=1e-8
brick "closed form"

echo
echo "## Atoms, 2 s, the divider at rest"
echo
echo "| atoms | policy | CPU, ms a frame | average integration step, ms | integrated a body, s | impacts |"
echo "| --- | --- | --- | --- | --- | --- |"
for atoms in $sizes; do
  molecules=$((atoms / 3))
  room=$(awk -v n="$atoms" 'BEGIN { print (n > 400 ? (n / 400) ^ (1 / 3) : 1) }')
  for policy in timewarp retroactive:0.0333333 retroactive:0.01 retroactive:0.001 conservative; do
    run --until=2 --integrator=rk45 --policy=$policy "$source/scenes/atoms.scm" \
      -D spheres=$((atoms - molecules)) -D molecules=$molecules -D room=$room
    cpu=$(statistic cpu_seconds_per_frame | awk '{ printf "%.3f", 1000 * $1 }')
    step=$(statistic avg_integration_step | awk '{ printf "%.3f", 1000 * $1 }')
    total=$(statistic integration_per_moving_body | awk '{ printf "%.2f", $1 }')
    echo "| $atoms | $policy | $cpu | $step | $total | $(statistic collisions) |"
    echo "$atoms $step $total $cpu" >>"$folder/$policy"
  done
done

command -v gnuplot >/dev/null || exit 0
here=$(pwd)
cd "$folder" || exit 1
gnuplot <<END
set terminal pngcairo size 720,480
set linetype 1 lc rgb "#c0392b" lw 2
set linetype 2 lc rgb "#7f8c8d" lw 2
set linetype 3 lc rgb "#2980b9" lw 2
set linetype 4 lc rgb "#27ae60" lw 2
set linetype 5 lc rgb "#000000" lw 2
set key left top
set logscale xy
set grid
set output "$here/policies-brick.png"
set xlabel "integration step, s"
set ylabel "CPU, ms, for 10 s of a tumbling brick"
set key right top
bricks = "'accuracy 1e-4' 'accuracy 1e-8' 'closed form'"
plot for [i=1:3] "brick ".word(bricks, i) using 1:2 with linespoints title word(bricks, i)
set xlabel "atoms"
set key left top
all = "conservative retroactive:0.001 retroactive:0.01 retroactive:0.0333333 timewarp"
names = "CA RD-0.001 RD-0.01 RD-1/30 TW"
set output "$here/policies-step.png"
set ylabel "average integration step, ms"
set key left bottom
plot for [i=1:5] word(all, i) using 1:2 with linespoints title word(names, i)
set key left top
set output "$here/policies-total.png"
set ylabel "total integration a body, s"
plot for [i=1:5] word(all, i) using 1:3 with linespoints title word(names, i)
set output "$here/policies-cost.png"
set ylabel "CPU, ms a frame"
plot for [i=1:5] word(all, i) using 1:4 with linespoints title word(names, i)
END
