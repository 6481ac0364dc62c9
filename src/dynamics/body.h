// A rigid body: its constants, and what it does at one instant.
//
// Frames: B the user's body frame, P the principal frame at the centre of mass.  The kernel
// computes in P (X_WP is the state's x and q); fixed and kinematic bodies have P = B.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/never.h"
#include "dynamics/contact-parameters.h"
#include "dynamics/ids.h"
#include "dynamics/rigid-body.h"
#include "geometry/shape.h"
#include "geometry/visual.h"

namespace tw {

class Trajectory;
struct Multibody;

// What a body does at one instant.  Position and orientation are the *body frame's*, velocity the
// centre of mass's; all in the world frame, SI.
struct BodyState {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
};

enum class BodyKind : unsigned char { dynamic, fixed, kinematic };

// What one may ask about a body; stays valid while the world lives.
struct BodyInfo {
  BodyId id = 0;
  std::string name, material;
  BodyKind kind = BodyKind::dynamic;
  ShapePtr shape;  // in the body frame; may be null
  double mass = 0;
  std::optional<Vec3> color;
  bool visible = true;
  Place place;
  VisualPtr visual;      // what is drawn of it; null: its shape
  bool removed = false;  // World::remove_body; its number stays taken
};

struct Body {
  BodyInfo info;
  ProcessId process{};                   // that its motion belongs to
  const Multibody* multibody = nullptr;  // it is a link of; null: of none
  std::uint32_t link = 0;                // which one
  bool welded_down = false;              // it is a link that is welded to a base that stands
  std::vector<BodyId> neighbours;        // across a joint: it touches them where told to; ascending
  ContactBody contact;
  double mass = 0;              // kg; 0 for fixed and kinematic
  Vec3 moments = Vec3::Zero();  // kg m^2
  Pose X_BP, X_PB;
  ShapePtr shape_P;           // the shape in P; null: touches nothing
  double radius = 0;          // of the ball about the origin of P that holds the shape, m
  int slender_axis = -1;      // of P, about which it is slender (base/constants.h); -1: about none
  double girth = 0;           // how far it reaches from that axis, m
  double least_width = 0;     // m: what lengths of a pair are measured by
  double thickness = 0;       // least width of any part: how deep contacts may be follows, m
  double sphere_radius = -1;  // >= 0: a single sphere centred on P
  std::shared_ptr<const Trajectory> motion;  // given: of fixed and kinematic bodies
  bool unbounded = false;
  Vec3 plane_normal = Vec3::Zero();  // a fixed half-space, world
  double plane_offset = 0;
  bool is_fixed_plane = false;

  // Of the callbacks that are handed its states again and again the least, s; never: none is.
  double callback_period = never;

  // Radius of gyration about its longest axis of them, m; of dynamic bodies.
  double gyration() const { return std::sqrt(moments.maxCoeff() / mass); }
  // How far it reaches about its centre, m; without a shape as far as its mass does.
  double extent() const { return shape_P ? radius : gyration(); }
  bool dynamic() const { return info.kind == BodyKind::dynamic; }
  bool fixed() const { return info.kind == BodyKind::fixed; }
  bool kinematic() const { return info.kind == BodyKind::kinematic; }
  bool never_moves() const { return fixed() || welded_down; }
  BodyId id() const { return info.id; }
};

}  // namespace tw
