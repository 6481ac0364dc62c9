// Runs a scene in another engine: reads the bodies that dump-bodies.scm wrote, steps, measures.
//
// Depths are measured at the frames and are not part of an engine's CPU time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "other-scene.h"

namespace tw::bench {

// An engine, filled with a scene.
class OtherEngine {
 public:
  virtual ~OtherEngine() = default;
  virtual void step(double dt) = 0;
  // Of the moving body `index` (its number in the scene).
  virtual OtherState state(std::size_t index) const = 0;
};

// What the command line says.
struct OtherOptions {
  std::string file;
  double until = 45;   // s
  long rate = 240;     // steps per second, a multiple of 30
  bool sleep = false;  // the engine may put bodies to sleep
  int iterations = 0;  // of the solver; 0: the engine's default
  std::string poses;   // a CSV file like that of `timewarp --poses`, or none
  bool brief = false;  // one row a rate (frame-row.h), no others
  // m: the rate is doubled until nothing overlaps deeper
  double depth = std::numeric_limits<double>::infinity();
};

// How to make an engine: its name with its precision, and a new one with the scene in it.
struct EngineKind {
  std::string name;
  std::function<std::unique_ptr<OtherEngine>(const OtherScene&, const OtherOptions&)> make;
};

// The program: steps to the end, frame by frame at 30 Hz, and prints a Markdown table with a row
// every 5 s.  Returns the exit status; prints how to use it where the command line makes no sense.
int run_other_engine(const EngineKind& kind, int argc, char** argv);

}  // namespace tw::bench
