// A scene as dump-bodies.scm writes it, and what may be measured on its bodies whatever moves them.
//
// The measure of depth is ours (collision/distance/separation.h), the same for all engines: the
// deepest overlap of any two bodies of which one moves.
//
// Frames and units: world frame, SI.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "collision/broad/spatial-hash.h"
#include "geometry/polyhedron.h"
#include "geometry/shape.h"

namespace tw::bench {

inline constexpr long frames_per_second = 30;

struct OtherBody {
  bool fixed = false;
  double mass = 0;              // kg; 0 for fixed ones
  Mat3 inertia = Mat3::Zero();  // about the centre of mass, body axes
  Pose pose;
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  ShapePtr shape;  // one hull; the frame's origin is the centre of mass
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

// Throws std::runtime_error where the file cannot be read.
OtherScene read_scene(const std::string& file);

// Overlaps, energy and losses of the scene; the scene must outlive it.
class SceneMeter {
 public:
  explicit SceneMeter(const OtherScene& scene);
  // Looks at these states, one a body; those of fixed bodies are not looked at.
  void look(const std::vector<OtherState>& states);
  double depth() const { return depth_; }  // deepest overlap, m
  // Of whom, a moving body first; 0, 0 where nothing overlaps.
  std::pair<std::size_t, std::size_t> deepest() const { return deepest_; }
  double energy() const { return energy_; }  // kinetic and potential, J
  // Moving bodies whose centre is inside a fixed one or below all of them.
  int lost() const { return lost_; }

 private:
  void place(std::size_t index, const Pose& pose);
  void measure(std::size_t index, const OtherState& state);

  const OtherScene& scene_;
  std::vector<Frame> frames_;
  SpatialHash hash_;
  double floor_ = 0;  // below it nothing is fixed
  double depth_ = 0, energy_ = 0;
  std::pair<std::size_t, std::size_t> deepest_;
  int lost_ = 0;
};

// The states of the bodies at the start.
std::vector<OtherState> first_states(const OtherScene& scene);

}  // namespace tw::bench
