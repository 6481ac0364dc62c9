#!/bin/sh
# While rocks move: the first 10 s of scenes by all engines, a row each (frame-row.h).
#
#   moving-rocks.sh AVALANCHE-BENCH "ENGINE..." FILE...     FILE is written by dump-bodies.scm
#
# Ours at two accuracies, by one thread and by all; others at 1/240 s and at steps halved until
# nothing overlaps deeper than in ours at 1e-4 (or until 1/3840 s).
# SPDX-License-Identifier: LGPL-3.0-or-later
ours=$1 others=$2
shift 2
echo "| scene | engine | CPU, ms a frame | helpers | wall | deepest, mm | lost | energy rise |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
for file; do
  for accuracy in 1e-3 1e-4; do
    for threads in 1 0; do
      row=$("$ours" --brief --until=10 --accuracy=$accuracy --threads=$threads "$file") || exit 1
      echo "$row"
    done
  done
  depth=$(echo "$row" | cut -d '|' -f 7)
  for engine in $others; do
    "$engine" --brief --until=10 --rate=240 --depth="$depth" "$file" || exit 1
  done
done
