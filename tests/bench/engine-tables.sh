#!/bin/sh
# The tables of doc/engines.md from engines.csv: what it costs to come within an error, CPU of the
# best run of the cheapest setting that does.
#
#   engine-tables.sh CSV         prints them
#   engine-tables.sh CSV PAGE    writes them into the page, between its markers
#
# SPDX-License-Identifier: LGPL-3.0-or-later
set -e

# $1: "summary", a case with an exact result a row, within 1e-4; "simbenchmark", the same of its tests,
# within 1e-3; "heaps", moving heaps, at 1/240 s and as deep as ours; or "cases", a table a case
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
    function kind(name) {
      if (name ~ /^(drum|shaken)$/) return "heaps"
      return name ~ /^(rolling|rolling-diagonal|bouncing|elastic-666|666|kapla|kapla after 1 s)$/ ? "simbenchmark" : "summary"
    }
    # CPU a frame of the run, of 5 s, and depth
    function frame(name, engine, i) {
      return sprintf("%.3g ms, %.2g mm", 1e3 * cpu[name, engine, i] / 150, 1e3 * errors[name, engine, i])
    }
    # the first setting that is no deeper than ours; none: the shallowest
    function like_ours(name, engine,   i, best, depth) {
      depth = errors[name, engine_names[1], 1]
      for (i = 1; i <= runs[name, engine]; ++i) {
        if (best == "" || errors[name, engine, i] < errors[name, engine, best]) best = i
        if (errors[name, engine, i] <= depth) { best = i; break }
      }
      return best == "" ? "" : setting[name, engine, best] ": " frame(name, engine, best)
    }
    function header(first,   i, line, rule) {
      line = "| " first " |"; rule = "| --- |"
      for (i = 1; i <= engines; ++i) { line = line " " engine_names[i] " |"; rule = rule " --- |" }
      return line "\n" rule
    }
    NR == 1 { next }
    !($1 in engine_seen) { engine_seen[$1]; engine_names[++engines] = $1 }
    !($3 in case_seen) { case_seen[$3]; case_names[++cases] = $3; units[$3] = $8 }
    $7 != "" { i = ++runs[$3, $1]; cpu[$3, $1, i] = $6; setting[$3, $1, i] = $4; errors[$3, $1, i] = $7 + 0 }
    $6 != "" && $6 > longest[$3, $1] { longest[$3, $1] = $6 }
    $6 == "" && $4 != "" { failure[$3, $1] = $9 }
    $6 == "" && $4 == "" { unable[$3, $1] = $9 }
    END {
      if (what == "heaps") {
        print "| heap | engine | at 1/240 s | as deep as ours, or nearest |\n| --- | --- | --- | --- |"
        for (c = 1; c <= cases; ++c)
          for (e = 1; e <= engines; ++e) {
            name = case_names[c]; engine = engine_names[e]
            if (kind(name) != what) continue
            first = cannot(name, engine)
            if (first == "" && !runs[name, engine]) first = failure[name, engine]
            if (first == "") first = e == 1 ? "accuracy 1e-4: " frame(name, engine, 1) : frame(name, engine, 1)
            print "| " name " | " engine " | " first " | " (e == 1 ? "" : like_ours(name, engine)) " |"
          }
        exit
      }
      if (what != "cases") {
        print header("case")
        for (c = 1; c <= cases; ++c) {
          name = case_names[c]
          if (kind(name) != what) continue
          line = "| " name " |"
          for (e = 1; e <= engines; ++e) {
            engine = engine_names[e]; cell = cost(name, engine, what == "summary" ? 1e-4 : 1e-3)
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
parts="summary simbenchmark heaps cases"
if [ -z "$2" ]; then
  for part in $parts; do
    tables $part
    echo
  done
  exit
fi
page=$(mktemp)
trap 'rm -f "$page" "$page".*' EXIT
for part in $parts; do
  tables $part > "$page.$part"
done
awk -v folder="$page" '
  /^<!-- end/ { inside = 0 }
  !inside
  /^<!-- (summary|simbenchmark|heaps|cases):/ {
    inside = 1; file = folder "." substr($2, 1, length($2) - 1)
    print ""
    while ((getline line < file) > 0) print line
    print ""
  }' "$2" > "$page"
cat "$page" > "$2"
