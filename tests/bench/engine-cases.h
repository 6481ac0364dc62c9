// Cases with exact results in any engine: run time against error, as lines of CSV.
//
// The columns are engine, version, case, setting, CPU of the first run in a process and of the best
// of several, s, error, its unit, note.  Only stepping is timed, by the CPU clock of the thread.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/case-file.h"

namespace tw::bench {

// An engine, filled with a case.
class CaseEngine {
 public:
  virtual ~CaseEngine() = default;
  // By a whole number of steps, if the engine has steps.
  virtual void advance(double duration) = 0;
  // Of the body's centre of mass and principal axes.
  virtual Pose pose(std::size_t body) const = 0;
};

// How an engine is run: a time step, s, or an accuracy.
struct Setting {
  std::string text;
  double value = 0;
};

struct CaseRunner {
  std::string engine, version;
  std::function<std::unique_ptr<CaseEngine>(const std::string& name, const test::Case&,
                                            const Setting&)>
      make;
  std::vector<Setting> settings;  // the cheapest first
};

// The radius of a sphere and the half extents of a box; of other shapes none.
std::optional<double> sphere_radius(const BodyDef& def);
std::optional<Vec3> box_half(const BodyDef& def);

// Steps from a 60th of a second down, each a quarter of the one before.
std::vector<Setting> time_steps();

// Runs all cases, each setting in a process of its own, until one takes seconds.  Returns the exit
// status.
int run_cases(const CaseRunner& runner);

}  // namespace tw::bench
