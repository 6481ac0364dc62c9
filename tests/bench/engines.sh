#!/bin/sh
# Run time against error on the cases: engines.csv, tables as engines.md and, by
# gnuplot where it is installed, engines.png, in the current folder.
#
#   engines.sh PROGRAM...     each prints lines of CSV (engine-cases.h)
#
# doc/engines.md holds such tables between its markers (engine-tables.sh engines.csv PAGE writes them
# there), doc/pictures/engines.png such a picture.
# SPDX-License-Identifier: LGPL-3.0-or-later
echo "engine,version,case,setting,cold_cpu_s,cpu_s,error,unit,note,made_cpu_s" > engines.csv
for engine in timewarp ode bullet mujoco simbody dart; do
  program=
  for each; do
    [ "${each##*/engine-}" != $engine ] || program=$each
  done
  if [ -z "$program" ]; then
    echo "engines: $engine is not installed: skipped"
    continue
  fi
  "$program" >> engines.csv || exit 1
done
"${0%/*}/engine-tables.sh" engines.csv > engines.md
cat engines.md
if ! command -v gnuplot > /dev/null; then
  echo "engines: gnuplot is not installed: no picture"
  exit 0
fi
engines=$(tail -n +2 engines.csv | cut -d, -f1 | awk '!seen[$0]++')
{
  # four panels a row, the key in one of its own
  rows=$(tail -n +2 engines.csv | cut -d, -f3 | awk '!seen[$0]++ { ++n } END { print int((n + 4) / 4) }')
  echo "set terminal png size 1600,$((300 * rows)) font 'sans,10'; set output 'engines.png'"
  echo 'set linetype 5 lc rgb "#a0522d"; set linetype 6 lc rgb "black"'
  echo 'set datafile separator ","; set logscale xy; set format "10^{%T}"; set grid'
  echo "set multiplot layout $rows,4"
  echo 'set xlabel "CPU, s"; set ylabel "error"; unset key; set yrange [1e-17:20]'
  # an error of 0 is drawn at the bottom
  tail -n +2 engines.csv | cut -d, -f3 | awk '!seen[$0]++' | while read -r name; do
    printf 'set title "%s"\nplot ' "$name"
    type=0
    for engine in $engines; do
      type=$((type + 1))
      awk -F, -v engine="$engine" -v name="$name" \
        '$1 == engine && $3 == name && $7 != "" { found = 1 } END { exit !found }' engines.csv || continue
      printf '"< awk -F, '"'"'$1==\"%s\" && $3==\"%s\" && $7!=\"\" {print $6 \",\" ($7>1e-16 ? $7 : 1e-16)}'"'"' engines.csv" using 1:2 with linespoints pt 7 lt %s, ' \
        "$engine" "$name" "$type"
    done
    echo
  done
  # the key in a panel of its own
  echo 'set title ""; unset border; unset tics; unset grid; unset xlabel; unset ylabel; set key center'
  printf 'plot [1:10] '
  type=0
  for engine in $engines; do
    type=$((type + 1))
    printf 'NaN with linespoints pt 7 lt %s title "%s", ' "$type" "$engine"
  done
  echo
} | sed 's/, $//' | gnuplot
