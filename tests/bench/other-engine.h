// Runs the avalanche in another engine: reads the bodies that dump-bodies.scm wrote, steps,
// measures.
//
// Depths are measured at the frames and are not part of an engine's CPU time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

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
};

// Prints how to use the program and exits with 2 where the command line makes no sense.
OtherOptions parse_options(int argc, char** argv);
// Steps to the end, frame by frame at 30 Hz, and prints a Markdown table with a row every 5 s.
void run_other_engine(OtherEngine& engine, const OtherScene& scene, const OtherOptions& options);

}  // namespace tw::bench
