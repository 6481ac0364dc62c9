#!/bin/sh
# Runs a program that prints a Markdown table and, where TW_BENCH_RESULTS names a folder, keeps the
# table there as NAME.csv, as bench-table.h does for the programs in C++.
#
#   keep-table.sh NAME PROGRAM ARGUMENT...
#
# SPDX-License-Identifier: LGPL-3.0-or-later
name=$1
shift
[ -n "${TW_BENCH_RESULTS:-}" ] || exec "$@"
mkdir -p "$TW_BENCH_RESULTS" || exit 1
failed=$(mktemp)
trap 'rm -f "$failed"' EXIT
{ "$@" || echo $? >"$failed"; } |
  awk -v file="$TW_BENCH_RESULTS/$name.csv" -v from="${TW_BENCH_COMMAND:-$*}" '
    function quoted(cell) {
      if (cell !~ /[,"]/) return cell
      gsub(/"/, "\"\"", cell)
      return "\"" cell "\""
    }
    BEGIN {
      run = ENVIRON["TW_BENCH_RUN"]
      printf "%s# command: %s\n", (run == "" ? "" : run "\n"), from >file
    }
    { print; fflush() }
    /^\| .* \|$/ && !/^\| --- / {
      n = split(substr($0, 3, length($0) - 4), cells, / \| /)
      line = quoted(cells[1])
      for (i = 2; i <= n; ++i) line = line "," quoted(cells[i])
      print line >file
    }'
read -r status <"$failed" || status=0
exit "$status"
