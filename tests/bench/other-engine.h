// Runs the avalanche in another engine: reads the bodies that dump-bodies.scm wrote, steps, measures.
//
// The measure of depth is ours (collision/separation.h), the same for all engines and not part of
// their CPU time: the deepest overlap of any two bodies of which one moves, at the frames.
//
// Frames and units: world frame, SI.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/polyhedron.h"
#include "geometry/shape.h"

namespace tw::bench {

struct OtherBody {
  bool fixed = false;
  double mass = 0;                // kg; 0 for fixed ones
  Mat3 inertia = Mat3::Zero();    // about the centre of mass, body axes
  Pose pose;
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  ShapePtr shape;                 // one hull; the frame's origin is the centre of mass
  const Polyhedron& hull() const { return *shape->parts()[0].core; }
};

struct OtherScene {
  Vec3 gravity = Vec3::Zero();
  double restitution = 0, friction = 0;
  std::vector<OtherBody> bodies;
};

struct OtherState {
  Pose pose;
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

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
  double until = 45;              // s
  long rate = 240;                // steps per second, a multiple of 30
  bool sleep = false;             // the engine may put bodies to sleep
  int iterations = 0;             // of the solver; 0: the engine's default
  std::string poses;              // a CSV file like that of `timewarp --poses`, or none
};

// Prints how to use the program and exits with 2 where the command line makes no sense.
OtherOptions parse_options(int argc, char** argv);
// Throws std::runtime_error where the file cannot be read.
OtherScene read_scene(const std::string& file);
// Steps to the end, frame by frame at 30 Hz, and prints a Markdown table with a row every 5 s.
void run_other_engine(OtherEngine& engine, const OtherScene& scene, const OtherOptions& options);

}  // namespace tw::bench
