// A rigid body as the kernel keeps it: constants, and where its process stands.
//
// Frames: B the user's body frame, P the principal frame at the centre of mass.  The kernel
// computes in P (X_WP is the state's x and q); fixed and kinematic bodies have P = B.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "dynamics/contact-parameters.h"
#include "dynamics/motion.h"
#include "dynamics/rigid-body.h"
#include "geometry/shape.h"
#include "kernel/event-queue.h"
#include "kernel/world.h"

namespace tw {

struct Body {
  // ---- constants ----
  BodyInfo info;
  ContactBody contact;
  double mass = 0;              // kg; 0 for fixed and kinematic
  Vec3 moments = Vec3::Zero();  // kg m^2
  Pose X_BP, X_PB;
  ShapePtr shape_P;           // the shape in P; null: touches nothing
  double radius = 0;          // of the ball about the origin of P that holds the shape, m
  double least_width = 0;     // the `size` of contact parameters, m
  double sphere_radius = -1;  // >= 0: a single sphere centred on P
  double turn_excess = 0;     // max |Ii - Ij| / Ik: bounds the angular acceleration
  MotionPtr motion;           // fixed and kinematic
  bool unbounded = false;
  Vec3 plane_normal = Vec3::Zero();  // a fixed half-space, world
  double plane_offset = 0;
  bool is_fixed_plane = false;

  // ---- the process ----
  int lonely_claims = 0;             // windows in a row in which nobody was near
  Key claim;                         // every key below it has been looked at with its box in place
  std::vector<std::uint32_t> pairs;  // active pair records
  std::vector<std::uint32_t> callbacks;  // that receive its states
  EventQueue::Handle advance = EventQueue::none;
  EventQueue::Handle group_check = EventQueue::none;  // of the group that this body is in
  double head_start = 0;                              // adversary scheduler
  bool placed = false;  // has claimed: has a box in the hash unless it is unbounded

  bool dynamic() const { return info.kind == BodyKind::dynamic; }
  bool fixed() const { return info.kind == BodyKind::fixed; }
  BodyId id() const { return info.id; }
};

}  // namespace tw
