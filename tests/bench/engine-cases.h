// Cases in any engine: run time against error, as lines of CSV.
//
// The columns are engine, version, case, setting, CPU of the first run in a process and of the best
// of several, s, error, its unit, note, CPU of making the engine's world before that first run, s.
// By the CPU clock of the thread; making the world is in none of the other times.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "support/case-table.h"

namespace tw::bench {

using test::CaseBody;
using test::CaseTable;

struct EngineState {
  test::Numbers3 position{};
  std::array<double, 4> orientation{};  // w x y z
  // of a link of a tree they may be left out
  test::Numbers3 velocity{}, angular_velocity{};
};

// An engine, filled with a case.
class CaseEngine {
 public:
  virtual ~CaseEngine() = default;
  // By a whole number of steps, if the engine has steps.
  virtual void advance(double duration) = 0;
  // Of the body's centre of mass and principal axes, in the world.
  virtual EngineState state(std::size_t body) const = 0;
};

// How an engine is run: a time step, s, or an accuracy.
struct Setting {
  std::string text;
  double value = 0;
};

struct CaseRunner {
  std::string engine, version;
  std::function<std::unique_ptr<CaseEngine>(const CaseTable&, const Setting&)> make;
  bool by_steps = true;        // a setting is a time step
  bool every_setting = false;  // else none after one that takes seconds
  // The cheapest first, for a case.
  std::function<std::vector<Setting>(const std::string& name)> settings;
  // Why the engine can't do a case, without commas; empty where it can.
  std::function<std::string(const CaseTable&)> unable = [](const CaseTable&) { return ""; };
};

// Steps from a 60th of a second down, each a quarter of the one before; where depths are to be
// alike each half of it, of moving heaps from a 240th down.
std::vector<Setting> time_steps(const std::string& name);

// Of a program whose engine is made from a case and a setting's value, by default a time step.
template <class Engine>
CaseRunner runner_of(const std::string& name, const std::string& version) {
  CaseRunner runner;
  runner.engine = name;
  runner.version = version;
  runner.make = [](const CaseTable& c, const Setting& setting) {
    return std::make_unique<Engine>(c, setting.value);
  };
  runner.settings = time_steps;
  return runner;
}

// Runs all cases, or those that the command line names, each setting in processes of its own, until
// one takes seconds; says on standard error which.  Returns the exit status.
int run_cases(const CaseRunner& runner, int argc, char** argv);

}  // namespace tw::bench
