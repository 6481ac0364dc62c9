#!/bin/sh
# What becomes of the robots and meshes below folders: make check-files DIR=...
#
# Each is loaded by a process of its own with bounds of memory and time, robots fall on the ground for
# 2 s.  Prints a line each, OUTCOME FILE WHY, and at the end a table by folder.
# SPDX-License-Identifier: LGPL-3.0-or-later
set -eu
dirs=${*:-${DIR:?expected a folder: make check-files DIR=...}}
memory=${MEMORY:-4000000} # kB
seconds=${SECONDS_EACH:-120}
jobs=${JOBS:-$(nproc)}
TIMEWARP=${TIMEWARP:-timewarp}
export TIMEWARP memory seconds TW_SRCDIR

one='
  status=0
  line=$(ulimit -v "$memory"; timeout "$seconds" "$TIMEWARP" -q --quiet -l "$TW_SRCDIR/tests/check-files.scm" \
    -c "(check-file \"$1\")" 2>&1) || status=$?
  case $status in
    0) printf "%s\n" "$line" | grep -a "	" | head -1 | awk -F"	" -v file="$1" "{print \$1 \"\t\" file \"\t\" \$2}" ;;
    124) printf "slow\t%s\tmore than %s s\n" "$1" "$seconds" ;;
    *) printf "killed\t%s\tstatus %s: %s\n" "$1" "$status" "$(printf "%s" "$line" | tail -1 | cut -c1-200)" ;;
  esac'

results=$(mktemp)
trap 'rm -f "$results"' EXIT
# shellcheck disable=SC2086
find $dirs -type f \( -iname '*.urdf' -o -iname '*.obj' -o -iname '*.stl' -o -iname '*.dae' -o -iname '*.ply' \
  -o -iname '*.off' \) | sort | xargs -d '\n' -P "$jobs" -n 1 sh -c "$one" sh | tee "$results"
echo
awk -F'\t' -v dirs="$dirs" '
  BEGIN { count = split(dirs, dir, " ") }
  { name = $2
    for (i = 1; i <= count; ++i) if (index(name, dir[i]) == 1) name = substr(name, length(dir[i]) + 1)
    sub("^/+", "", name); sub("/.*", "", name)
    kind = tolower($2) ~ /\.urdf$/ ? "robots" : "meshes"
    key = name " " kind; rows[key]; n[key, $1]++; outcomes[$1] }
  END { for (row in rows) { printf "%-40s", row
          for (o in outcomes) if (n[row, o]) printf "  %s %d", o, n[row, o]
          printf "\n" } }' "$results" | sort
