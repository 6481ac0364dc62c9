#!/bin/sh
# What a second thread gives: wall seconds beyond loading on one thread and on two, in turn, the
# least of some runs.  A table on standard output.
#
#   threads.sh SOURCE RUNS TIMEWARP...
#
# A run to time 0 is timed likewise and taken off.  *helper*: CPU seconds of the helper at work, of
# the last run; *in vain*: checks and impacts decided ahead that did not hold, of all.
# Means little where anything else is running.
#
# SPDX-License-Identifier: LGPL-3.0-or-later
source=$1 runs=$2
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# one THREADS SCENE UNTIL FILE: a run; adds its wall time, s, to the file
one() {
  begin=$(date +%s.%N)
  $command --quiet --stats --threads="$1" "$source/$2" --until="$3" >"$folder/stats-$1" || exit 1
  end=$(date +%s.%N)
  echo "$begin $end" | awk '{ printf "%.3f\n", $2 - $1 }' >>"$folder/$4"
}

least() { sort -n "$folder/$1" | head -n 1; }
statistic() { awk -v name="$2" '$1 == name { print $2 }' "$folder/stats-$1"; }

command=$*
echo "| scene | until, s | 1 thread, s | 2 threads, s | ratio | helper, s | checks in vain | impacts in vain |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
while read -r scene until; do
  rm -f "$folder"/1 "$folder"/2 "$folder"/load
  run=0
  while [ $run -lt "$runs" ]; do
    one 1 "$scene" 0 load
    one 1 "$scene" "$until" 1
    one 2 "$scene" "$until" 2
    run=$((run + 1))
  done
  echo "$(least load) $(least 1) $(least 2) $(statistic 2 helper_cpu_seconds)" \
    "$(statistic 2 checks_decided_in_vain) $(statistic 2 checks_decided_ahead)" \
    "$(statistic 2 impacts_decided_in_vain) $(statistic 2 impacts_decided_ahead)" |
    awk -v scene="$scene" -v until="$until" '{
      one = $2 - $1; two = $3 - $1
      printf "| `%s` | %s | %.2f | %.2f | %.2f | %.2f | %d of %d | %d of %d |\n",
        scene, until, one, two, one / two, $4, $5, $6, $7, $8
    }'
done <<END
scenes/avalanche.scm 1.3
scenes/avalanche.scm 4
scenes/gallery/hopper.scm 1
tests/bench/drum.scm 1
scenes/cars.scm 4
scenes/robots.scm 3
scenes/atoms.scm 60
END
