#!/bin/sh
# Where the four scenes spend their time: perf samples the stack, and each sample counts for the
# innermost function that is named below.  A table, percent of the CPU, on standard output.
#
#   profile.sh SOURCE TIMEWARP...
#
# Needs linux-perf and leave to use it (kernel.perf_event_paranoid at most 2).
# SPDX-License-Identifier: LGPL-3.0-or-later
source=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# what|functions, the first that fits (stacks end in the allocator: perf finds no way out); what fits none is loading or Scheme
cat >"$folder/parts" <<'END'
distances: GJK, least axes, nearest features|::?(core_distance|part_distance|part_separation|distance_of|signed_distance|separation|nearest_features|least_axis|climb_to_axis)
contact points: manifolds, seams|manifold|polyhedra_at_seam
the allocator|_int_malloc|_int_free|malloc_consolidate|unlink_chunk|sysmalloc|cfree|operator (new|delete)|[ \t](malloc|calloc|realloc|free)$
closed-form flight|::(FreeRotation|Flight|JacobiTheta)::
pairs followed: certificates, crossings|::(PairChecks|Certificates|Travels)::|time_apart|part_reach|apart_throughout|::certificate|first_dip
integration of groups|::(Rodas|Tree|Spring)Steps::|::GroupSystem::(evaluate|factor|solve|linearise)
groups and their arcs made|make_groups|start_arc|::(GroupArc|GroupStepper|GroupSystem)::(GroupArc|GroupStepper|GroupSystem)
impulses and whom they reach|::(ImpactEvents|JointImpulses)::|pass_on_impulses|who_notices|give_impulse
checks of groups|::GroupEvents::|find_contacts|::regroup|go_round
when arcs end|test_end|::Claims::test_
claims: boxes, neighbours|::Claims::|::SpatialHash::|swept_bounds
queue, states, commit|::(EventQueue|StateGraph|Commit|Discontinuities)::
callbacks|::CallbackEvents::|::Callbacks?::
rest of the kernel|::Kernel::advance
END

# profile NAME FREQUENCY OPTION...
profile() {
  name=$1 frequency=$2
  shift 2
  perf record -q -F "$frequency" --call-graph dwarf,16384 -o "$folder/$name.data" \
    $command --quiet --threads=1 "$@" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
  perf script -i "$folder/$name.data" --no-inline -F ip,sym 2>/dev/null |
    awk -F '|' -v file="$folder/$name" '
      FNR == NR {
        at = index($0, "|")
        part[++parts] = substr($0, 1, at - 1)
        functions[parts] = substr($0, at + 1)
        next
      }
      NF == 0 { if (seen) { ++all; ++count[found ? found : 0] } seen = found = 0; next }
      { seen = 1; for (i = 1; !found && i <= parts; ++i) if ($0 ~ functions[i]) found = i }
      END {
        for (i = 1; i <= parts; ++i) printf "%s|%.0f\n", part[i], 100 * count[i] / all > file
        printf "loading, Scheme, the rest|%.0f\n", 100 * count[0] / all > file
      }' "$folder/parts" -
}

command=$*
profile atoms 2000 --until=120 "$source/scenes/atoms.scm"
profile cars 300 --until=20 "$source/scenes/cars.scm"
profile robots 400 --until=20 "$source/scenes/robots.scm"
profile avalanche 40 --until=10 --seed=1 "$source/scenes/avalanche.scm"
echo "| % | atoms, 120 s | cars, 20 s | robots, 20 s | avalanche, 10 s |"
echo "| --- | --- | --- | --- | --- |"
paste -d '|' "$folder/atoms" "$folder/cars" "$folder/robots" "$folder/avalanche" |
  awk -F '|' '{ printf "| %s | %s | %s | %s | %s |\n", $1, $2, $4, $6, $8 }'
