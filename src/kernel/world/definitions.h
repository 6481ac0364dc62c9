// How bodies and callbacks come into a world: what a scene says of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/shape.h"
#include "geometry/visual.h"
#include "integrate/trajectory.h"
#include "kernel/world/callback.h"
#include "multibody/tree.h"

namespace tw {

// How a body comes into the world.  Absent mass properties come from shape and density.
struct BodyDef {
  std::string name;                     // empty: body-N with N the body's id
  ShapePtr shape;                       // null: touches nothing; then mass and inertia are needed
  std::optional<double> density;        // kg/m^3, default 1000
  std::optional<double> mass;           // kg; scales the shape's inertia
  std::optional<Mat3> inertia;          // kg m^2 about the centre of mass, body axes
  std::optional<Vec3> center_of_mass;   // body frame, m
  Vec3 position = Vec3::Zero();         // of the body frame's origin
  Quat orientation = Quat::Identity();  // normalised here; zero is an error
  Vec3 velocity = Vec3::Zero();         // of the centre of mass
  Vec3 angular_velocity = Vec3::Zero();
  bool fixed = false;
  TrajectoryPtr motion;  // makes the body kinematic; excludes `fixed`
  std::string material;
  SlotsPtr slots;             // null: no slots
  std::optional<Vec3> color;  // sRGB 0..1
  bool visible = true;
  VisualPtr visual;  // null: that of the shape
  Place place;       // of the form that made it
};

// A link of a multibody: its body, whose name, pose, velocities and motion say nothing, and how it
// hangs on its parent.
struct LinkDef {
  std::string name;
  std::string parent;  // name of an earlier link; empty: the base
  multibody::JointSpec joint;
  BodyDef body;
};

// How a multibody comes into the world.
struct MultibodyDef {
  std::string name;                     // empty: multibody-N with N its number
  bool free = false;                    // else its base stands where it is put
  BodyId base = no_body;                // a fixed body that it stands on; excludes `free`
  Vec3 position = Vec3::Zero();         // of the base, or of the free first link's frame; in the
                                        // world, or the base's body frame
  Quat orientation = Quat::Identity();  // normalised here
  std::vector<LinkDef> links;           // parents first; bodies are named MULTIBODY/LINK
  Place place;
};

// Two points of bodies, in their body frames, and what holds between them.
struct SpringDef {
  BodyId a = no_body, b = no_body;  // one of them dynamic
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();
  double stiffness = 0;        // N/m
  double damping = 0;          // N s/m
  std::optional<double> rest;  // m; absent: as long as it is now
};

// How two bodies are held as they are against each other.
struct HoldDef {
  std::optional<Vec3> at;  // where, in the body frame of the first; absent: at the centre of
                           // mass of the second, or of the first where that is not dynamic
  std::optional<double> stiffness;  // N/m; absent: it gives way by answer::hold_sag
  std::optional<double> damping;    // N s/m; absent: answer::hold_damping
};

// Of a procedure of the user: force and torque, N and N m, world frame, on the body as it is seen;
// pure.  Errors: UserError.
class ForceProcedure {
 public:
  virtual ~ForceProcedure() = default;
  virtual Wrench force(double time, const BodyState& body) = 0;
  // Tells it from others, the same in every run.
  virtual std::uint64_t number() const = 0;
};

// What add_spring, add_drag and add_force of a world return: tells a force from all others, and on
// whom it acts.  What acts is known by its address, which states share.
struct ForceHandle {
  BodyId a = no_body, b = no_body;  // b: a again, where it acts on one alone
  std::shared_ptr<const void> law;
};

struct CallbackDef {
  std::vector<BodyId> targets;
  std::shared_ptr<Callback> callback;
  double start = 0;
  std::optional<double> period;  // absent: the callback returns its next time
  std::string name;              // for messages
  Place place;
};

struct CollisionCallbackDef {
  // It is called for what is between the first and the second of one of these pairs.
  using Sides = std::pair<ContactSide, ContactSide>;
  std::vector<Sides> sides = std::vector<Sides>(1);  // of all, unless given
  std::shared_ptr<CollisionCallback> callback;
  std::string name;
  Place place;
};

}  // namespace tw
