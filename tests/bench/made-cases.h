// Cases that are made, not read from tables: SimBenchmark's tests, heaps that are kept moving, and
// a large gas.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "support/case-table.h"

namespace tw::bench {

// The rigid-body tests of SimBenchmark (github.com/leggedrobotics/SimBenchmark), by its numbers:
//
// - rolling: a box of 10 kg, 20 x 20 x 1 m, with 5 x 5 balls of 1 kg on it, is pushed by 150 N;
//   rolling-diagonal: askew to the axes
// - bouncing: 49 elastic balls of 10 kg dropped from 5 m
// - 666: 6 x 6 x 6 balls of 10 kg without restitution or friction, nearly touching
// - elastic-666: the same from 1.1 m, elastic
// - kapla: a tower of 6 rings of 8 planks on edge, of which each stands on the ends of two; its
//   planks and their places are ours
test::CaseTable simbenchmark_case(const std::string& name);

// - drum: boxes and balls in a drum that turns about its level axis
// - shaken: the same in a box that is shaken sideways, a little more than gravity pulls
test::CaseTable heap_case(const std::string& name);

// gas-N: the spheres of make_gas (event-driven-md.h) within six planes, for 2 s.
test::CaseTable gas_case(int count);
// Number, position and velocity of each at its end, by the event-driven program: in double, which
// is within 1e-11 m of another one in it (gas-bench).
std::vector<std::vector<double>> gas_result(int count);

bool is_simbenchmark(const std::string& name);
bool is_heap(const std::string& name);
// Heaps, and 666: engines are compared at like depths.
bool is_judged_by_depth(const std::string& name);

// Made here, or read from a table; so is the exact result.
test::CaseTable case_named(const std::string& name);
std::vector<std::vector<double>> exact_result(const std::string& name);

// Of what moves and has a shape of its own.
test::CaseBody solid_ball(double radius, double mass, const test::Numbers3& position);
test::CaseBody solid_box(const test::Numbers3& half_edges, double mass,
                         const test::Numbers3& position);

}  // namespace tw::bench
