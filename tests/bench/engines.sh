#!/bin/sh
# Run time against error on the cases with exact results: engines.csv, tables as engines.md and, by
# gnuplot where it is installed, engines.png, in the current folder.
#
#   engines.sh PROGRAM...     each prints lines of CSV (engine-cases.h)
#
# doc/engines.md holds such tables between its markers (engine-tables.sh engines.csv PAGE writes them
# there), doc/pictures/engines.png such a picture.
# SPDX-License-Identifier: LGPL-3.0-or-later
echo "engine,version,case,setting,cold_cpu_s,cpu_s,error,unit,note" > engines.csv
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
{
  echo 'set terminal png size 1600,1200 font "sans,10"; set output "engines.png"'
  echo 'set datafile separator ","; set logscale xy; set format "10^{%T}"; set grid'
  echo 'set multiplot layout 3,4; set xlabel "CPU, s"; set ylabel "error"; set key bottom left; set yrange [1e-17:20]'
  # an error of 0 is drawn at the bottom
  tail -n +2 engines.csv | cut -d, -f3 | awk '!seen[$0]++' | while read -r name; do
    printf 'set title "%s"\nplot ' "$name"
    cut -d, -f1 engines.csv | tail -n +2 | awk '!seen[$0]++' | while read -r engine; do
      printf '"< awk -F, '"'"'$1==\\"%s\\" && $3==\\"%s\\" && $7!=\\"\\" {print $6 \\",\\" ($7>1e-16 ? $7 : 1e-16)}'"'"' engines.csv" using 1:2 with linespoints pt 7 title "%s", ' \
        "$engine" "$name" "$engine"
    done
    echo
  done
} | sed 's/, $//' | gnuplot
