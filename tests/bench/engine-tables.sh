#!/bin/sh
# The tables of doc/engines.md from engines.csv: what it costs to come within an error, CPU of the
# best run of the cheapest setting that does.
#
#   engine-tables.sh CSV         prints them
#   engine-tables.sh CSV PAGE    writes them into the page, between its markers
#
# SPDX-License-Identifier: LGPL-3.0-or-later
set -e

# $1: "summary", a case a row within 1e-4, or "cases", a table a case
tables() {
  awk -F, -v what="$1" '
    function duration(s) {
      if (s < 1e-3) return sprintf("%.3g us", 1e6 * s)
      if (s < 1) return sprintf("%.3g ms", 1e3 * s)
      return sprintf((s < 10 ? "%.1f s" : "%.0f s"), s)
    }
    # the cheapest run within the error; none: -
    function cost(name, engine, error,   i, best) {
      best = -1
      for (i = 1; i <= runs[name, engine]; ++i)
        if (errors[name, engine, i] <= error && (best < 0 || cpu[name, engine, i] < best))
          best = cpu[name, engine, i]
      return best < 0 ? "" : duration(best)
    }
    function nearest(name, engine,   i, best) {
      best = ""
      for (i = 1; i <= runs[name, engine]; ++i)
        if (best == "" || errors[name, engine, i] < best + 0) best = errors[name, engine, i]
      return best == "" ? "" : sprintf("%.1e", best)
    }
    # why the engine cannot do the case; what is judged later in it fails with it
    function cannot(name, engine) {
      sub(/ after .*/, "", name)
      return (name, engine) in unable ? unable[name, engine] : ""
    }
    function header(first,   i, line, rule) {
      line = "| " first " |"; rule = "| --- |"
      for (i = 1; i <= engines; ++i) { line = line " " engine_names[i] " |"; rule = rule " --- |" }
      return line "\n" rule
    }
    NR == 1 { next }
    !($1 in engine_seen) { engine_seen[$1]; engine_names[++engines] = $1 }
    !($3 in case_seen) { case_seen[$3]; case_names[++cases] = $3; units[$3] = $8 }
    $7 != "" { i = ++runs[$3, $1]; cpu[$3, $1, i] = $6; errors[$3, $1, i] = $7 + 0 }
    $6 != "" && $6 > longest[$3, $1] { longest[$3, $1] = $6 }
    $6 == "" && $4 == "" { unable[$3, $1] = $9 }
    END {
      if (what == "summary") {
        print header("case")
        for (c = 1; c <= cases; ++c) {
          name = case_names[c]; line = "| " name " |"
          for (e = 1; e <= engines; ++e) {
            engine = engine_names[e]; cell = cost(name, engine, 1e-4)
            if (cannot(name, engine) != "") cell = "can not"
            else if (cell == "" && (name, engine) in longest) cell = "not in " duration(longest[name, engine])
            line = line " " cell " |"
          }
          print line
        }
        exit
      }
      for (c = 1; c <= cases; ++c) {
        name = case_names[c]
        printf "%s### %s\n\n%s\n", (c > 1 ? "\n" : ""), name, header("within, " units[name])
        # of rows with the same costs the strictest
        last = ""
        for (k = 1; k <= 13; ++k) {
          line = ""; any = 0
          for (e = 1; e <= engines; ++e) {
            cell = cost(name, engine_names[e], 10 ^ -k)
            if (cell != "") any = 1
            line = line " " cell " |"
          }
          if (last != "" && (line != last || k == 13)) printf "| 1e-%d |%s\n", k - 1, last
          last = any ? line : ""
        }
        line = "| nearest |"
        for (e = 1; e <= engines; ++e) {
          engine = engine_names[e]; cell = nearest(name, engine)
          if (cannot(name, engine) != "") cell = cannot(name, engine)
          line = line " " cell " |"
        }
        print line
      }
    }' "$csv"
}

csv=$1
if [ -z "$2" ]; then
  tables summary
  echo
  tables cases
  exit
fi
page=$(mktemp)
trap 'rm -f "$page" "$page.summary" "$page.cases"' EXIT
tables summary > "$page.summary"
tables cases > "$page.cases"
awk -v folder="$page" '
  /^<!-- end/ { inside = 0 }
  !inside
  /^<!-- (summary|cases):/ {
    inside = 1; file = folder "." ($2 == "summary:" ? "summary" : "cases")
    print ""
    while ((getline line < file) > 0) print line
    print ""
  }' "$2" > "$page"
cat "$page" > "$2"
