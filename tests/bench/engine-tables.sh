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
# within 1e-3; "heaps", moving heaps and 666, at 1/240 s and as deep as ours at either accuracy; "cold", the
# settings of these tables, also in a fresh process; or "cases", a table a case
tables() {
  awk -F, -v what="$1" '
    function duration(s) {
      if (s < 1e-3) return sprintf("%.3g us", 1e6 * s)
      if (s < 1) return sprintf("%.3g ms", 1e3 * s)
      return sprintf((s < 10 ? "%.1f s" : "%.0f s"), s)
    }
    # the cheapest setting within the error; none: 0
    function cheapest(name, engine, error,   i, best) {
      best = 0
      for (i = 1; i <= runs[name, engine]; ++i)
        if (errors[name, engine, i] <= error && (!best || cpu[name, engine, i] < cpu[name, engine, best]))
          best = i
      return best
    }
    function cost(name, engine, error,   i) {
      i = cheapest(name, engine, error)
      return i ? duration(cpu[name, engine, i]) : ""
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
    function by_depth(name) { return kind(name) == "heaps" || name == "666" }
    # CPU a frame of the run, and depth
    function frame(name, engine, i) {
      return sprintf("%.3g ms, %.2g mm", 1e3 * cpu[name, engine, i] / (name == "666" ? 300 : 150), 1e3 * errors[name, engine, i])
    }
    # of a setting; not among them: 0
    function number_of(name, engine, text,   i) {
      for (i = 1; i <= runs[name, engine]; ++i) if (setting[name, engine, i] == text) return i
      return 0
    }
    # the first setting that is no deeper than ours at an accuracy; none: 0
    function like_ours(name, engine, accuracy,   i, ours) {
      ours = number_of(name, engine_names[1], "accuracy " accuracy)
      if (engine == engine_names[1] || !ours) return ours
      for (i = 1; i <= runs[name, engine]; ++i)
        if (errors[name, engine, i] <= errors[name, engine_names[1], ours]) return i
      return 0
    }
    function shallowest(name, engine,   i, best) {
      best = 0
      for (i = 1; i <= runs[name, engine]; ++i)
        if (!best || errors[name, engine, i] < errors[name, engine, best]) best = i
      return best
    }
    function deep_cell(name, engine, accuracy,   i, near) {
      i = like_ours(name, engine, accuracy)
      if (engine == engine_names[1]) return i ? frame(name, engine, i) : ""
      if (i) return setting[name, engine, i] ": " frame(name, engine, i)
      near = shallowest(name, engine)
      return near ? "no; nearest " setting[name, engine, near] ": " frame(name, engine, near) : ""
    }
    # CPU of the best run, of the first in a process, and of making the world before it
    function cold_cell(name, engine, i) {
      if (!i) return ""
      return duration(cpu[name, engine, i]) ", " duration(cold[name, engine, i]) (made[name, engine, i] == "" ? "" : ", " duration(made[name, engine, i]))
    }
    function header(first,   i, line, rule) {
      line = "| " first " |"; rule = "| --- |"
      for (i = 1; i <= engines; ++i) { line = line " " engine_names[i] " |"; rule = rule " --- |" }
      return line "\n" rule
    }
    NR == 1 { next }
    !($1 in engine_seen) { engine_seen[$1]; engine_names[++engines] = $1 }
    !($3 in case_seen) { case_seen[$3]; case_names[++cases] = $3; units[$3] = $8 }
    $7 != "" { i = ++runs[$3, $1]; cpu[$3, $1, i] = $6; cold[$3, $1, i] = $5; made[$3, $1, i] = $10; setting[$3, $1, i] = $4; errors[$3, $1, i] = $7 + 0 }
    $6 != "" && $6 > longest[$3, $1] { longest[$3, $1] = $6 }
    $6 == "" && $4 != "" { failure[$3, $1] = $9 }
    $6 == "" && $4 == "" { unable[$3, $1] = $9 }
    END {
      if (what == "heaps") {
        print "| heap | engine | at 1/240 s | as deep as timewarp at 1e-3 | at 1e-4 |\n| --- | --- | --- | --- | --- |"
        for (c = 1; c <= cases; ++c)
          for (e = 1; e <= engines; ++e) {
            name = case_names[c]; engine = engine_names[e]
            if (!by_depth(name)) continue
            first = cannot(name, engine)
            if (first == "" && !runs[name, engine]) first = failure[name, engine]
            i = number_of(name, engine, "1/240 s")
            if (first == "" && i) first = frame(name, engine, i)
            print "| " name " | " engine " | " first " | " deep_cell(name, engine, "1e-3") " | " deep_cell(name, engine, "1e-4") " |"
          }
        exit
      }
      if (what == "cold") {
        print header("case")
        for (c = 1; c <= cases; ++c) {
          name = case_names[c]
          line = "| " name " |"
          for (e = 1; e <= engines; ++e) {
            engine = engine_names[e]
            i = by_depth(name) ? like_ours(name, engine, "1e-3") : cheapest(name, engine, kind(name) == "summary" ? 1e-4 : 1e-3)
            line = line " " cold_cell(name, engine, i) " |"
          }
          print line
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
parts="summary simbenchmark heaps cold cases"
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
  /^<!-- (summary|simbenchmark|heaps|cold|cases):/ {
    inside = 1; file = folder "." substr($2, 1, length($2) - 1)
    print ""
    while ((getline line < file) > 0) print line
    print ""
  }' "$2" > "$page"
cat "$page" > "$2"
