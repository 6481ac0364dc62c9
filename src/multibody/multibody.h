// A multibody in a scene: its tree, the bodies that are its links, and its state.
//
// Every link is a body, with a shape, contacts and a process; the processes of one multibody get
// new arcs together, whatever happens to one of them, so that their states are one ring.  Where the
// joints stand is kept once: the links' states share it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/body.h"
#include "dynamics/pose-twist.h"
#include "multibody/joint-laws.h"

namespace tw {

// How the joints stand where an arc starts, and what users set there.
struct MultibodyState {
  std::vector<double> q, u;  // multibody/tree.h
  // joint-laws.h; rows may be empty
  std::vector<double> torques, targets, target_velocities;
  std::vector<multibody::ServoGains> servos;
  std::vector<multibody::Stop> stops;
  Twist base;  // what u is against: the velocity of the base's origin; 0 where it stands

  bool operator==(const MultibodyState&) const = default;
  multibody::Inputs inputs() const { return {torques, servos, targets, target_velocities, stops}; }
};
using MultibodyStatePtr = std::shared_ptr<const MultibodyState>;

struct Multibody {
  std::uint32_t number = 0;  // among those of the scene
  std::string name;
  Place place;
  multibody::Tree tree;
  Frame base;                   // where it stands, or was put first, in the world
  std::vector<BodyId> links;    // ascending, one a link of the tree
  std::vector<Pose> principal;  // of each: the principal frame in the link's
  bool touches = false;         // a link has a shape
  // Of the body that carries the base, null where that stands; and the base in what this moves.
  std::shared_ptr<const Trajectory> base_motion;
  Pose base_in_motion;
};

// How far a link reaches, m: its shape, what lies between its joint and its parent's, or, where
// there is neither, its radius of gyration.
inline double extent_of_link(const Body& body) {
  const Vec3& offset = body.multibody->tree.link(static_cast<int>(body.link)).placement.p;
  return std::max({body.radius, offset.norm(), body.gyration()});
}

}  // namespace tw
