// The verdict on one scene: what is wrong, with numbers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "fuzz/described-scene.h"
#include "fuzz/findings.h"

namespace tw::fuzz {

enum class Fault { crash, error, not_finite, lost, deep, energy, slow, hash };
constexpr int fault_count = 8;

// What may be at most, and is a fault beyond, beside depth_bound: a share of the energy at play;
// seconds of CPU per time unit and body.  Real time over 50 for a hundred bodies of a metre, whose
// time unit is 0.32 s, is a pace of 0.16.
constexpr double energy_bound = 1e-3, pace_bound = 0.16;

const char* name_of(Fault fault);

struct Judges {
  bool depth = true, energy = true, progress = true, hash = true;
  double pace = pace_bound;
  double work = std::numeric_limits<double>::infinity();  // of the dearest tenth
  // hashes are compared under so many of the schedules as there are, from this one on
  std::size_t first_schedule = 0, most_schedules = std::numeric_limits<std::size_t>::max();
};

struct Verdict {
  DescribedScene scene;
  Findings findings;
  std::vector<Fault> faults;        // the worst first
  std::string schedules;            // under which the hash is another
  std::string dear;                 // schedules that took too long to tell
  double value(Fault fault) const;  // the number that says how bad, NaN: there is none
  bool has(Fault fault) const;
  std::string line() const;
};

// `budget`: seconds of CPU for the plain run.
Verdict judge(const DescribedScene& scene, const Judges& judges, double budget);

}  // namespace tw::fuzz
