// Running a described scene under the eyes of the judge.
//
// - depth: the overlap of all parts of all pairs with a dynamic body, by overlap.h
// - lost: a dynamic body's centre outside the room
// - energy: kinetic, weight and springs, less the work of kinematic bodies, above the least so far;
//   as a share of the scale: the most energy that was at play
// - pace: CPU time per time unit and moving body; work, dearest: the same in counts, to the last
// digit
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "fuzz/described-scene.h"
#include "fuzz/findings.h"
#include "support/schedule.h"

namespace tw::fuzz {

constexpr int samples = 60;
// Of the smaller body's least width; deeper than that is a fault.
constexpr double depth_bound = 0.02;

// Looks at the scene `samples` times, or stops after `looks` of them, or when the loop has used
// `budget` seconds of CPU.
void run_judged(const DescribedScene& scene, double budget, Findings& findings,
                int looks = samples);

// Runs it under a schedule, for its hash alone; with edits in between that leave nothing behind, if
// asked for.
void run_for_hash(const DescribedScene& scene, const test::Schedule& schedule, bool vain_edits,
                  Findings& findings);

}  // namespace tw::fuzz
