// A scene as data: what a random scene is made of, before there is a world.
//
// One description is simulated, judged and written down as Scheme.  The judge reads shapes from
// here and not from the world, so that a shape which the world understands differently shows.
//
// Frames and units: as in a scene, SI; a solid is placed in its body's frame.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "integrate/given/keyframes.h"
#include "kernel/world/world.h"
#include "multibody/tree.h"

namespace tw::fuzz {

enum class SolidKind { ball, box, cylinder, hull, half_space, capsule, cone, ellipsoid };

struct Solid {
  SolidKind kind = SolidKind::ball;
  // m: ball (radius), cylinder, capsule and cone (about z; the length of a capsule without its
  // ends, the height of a cone)
  double radius = 0, length = 0;
  Vec3 edges = Vec3::Zero();    // m: box; ellipsoid: twice its semi-axes
  std::vector<Vec3> points;     // m: hull
  Vec3 normal = Vec3::UnitZ();  // half-space: solid where normal.x <= offset
  double offset = 0;
  Pose placement;  // not of half-spaces

  bool placed() const {
    return placement.p != Vec3::Zero() || placement.q.coeffs() != Quat::Identity().coeffs();
  }
};

// A height field of cells of `spacing` metres, or a mesh of the same triangles.
struct Hills {
  std::vector<double> heights;  // m, row by row
  std::size_t columns = 0;
  double spacing = 1;
  bool as_mesh = false;

  Vec3 corner(std::size_t row, std::size_t column) const;
  std::size_t rows() const { return heights.size() / columns; }
  // Of all cells, with numbers of corners.
  std::vector<MeshTriangle> triangles() const;
};

// How a body hangs on a multibody, whose links follow one another in the scene, parents first.
// They are named MULTIBODY/LINK.
struct Hanging {
  std::string multibody;
  std::string parent;    // a link's whole name; empty: the base, at the first link's pose, or none
                         // where the first link is free
  std::string part, on;  // first links: of what is welded to it, and of what that hangs on
  multibody::JointSpec joint;
  bool free = false;
  std::vector<double> velocity;  // of the joint
};

// To and fro by a procedure of time about where the body begins.
struct Swing {
  Vec3 along = Vec3::Zero();  // m
  Vec3 turn = Vec3::Zero();   // rad, a rotation vector
  double period = 1;          // s

  Pose pose(const Pose& middle, double time) const;
  // Of any point within `radius` of the origin, m/s.
  double max_speed(double radius) const;
};

struct DescribedBody {
  std::string name;
  std::vector<Solid> solids;   // several: a union
  bool mesh = false;           // its polyhedra are read from a mesh file
  std::optional<Hills> hills;  // instead of solids
  Pose pose;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  double density = 1000;
  double bare_mass = 0, bare_moment = 0;  // kg, kg m^2: of a link without a shape
  bool fixed = false;
  std::vector<Keyframe> keyframes;  // kinematic where there are any
  bool smooth = false;
  std::optional<Swing> swing;  // kinematic where there is one
  std::optional<Hanging> hanging;

  // Links on both sides of a joint, with what is welded to them, don't touch.
  bool joined_to(const DescribedBody& other) const {
    if (!hanging || !other.hanging) return false;
    const Hanging &a = *hanging, &b = *other.hanging;
    return a.part == b.part || a.part == b.on || a.on == b.part;
  }
  bool kinematic() const { return !keyframes.empty() || swing; }
  bool dynamic() const { return !fixed && !kinematic(); }
  bool bare() const { return solids.empty() && !hills; }
};

// A spring between two points, or a hold; of bodies by name.
struct DescribedBond {
  std::string a, b;
  SpringDef spring;  // its bodies say nothing
  bool holds = false;
};

// What slows a body, and a force by a procedure: a pull to a place, a push to and fro, and what
// resists its turning.
struct DescribedForce {
  std::string body;
  double linear = 0, quadratic = 0;                // drag: N s/m, N s^2/m^2
  bool procedure = false;                          // it has what follows
  Vec3 place = Vec3::Zero(), push = Vec3::Zero();  // m, N
  double stiffness = 0, resistance = 0;            // N/m, N m s
  double period = 1;                               // s, of the push
};

// At the joint of a link, of one axis.
struct DescribedServo {
  std::string link;
  double target = 0, rate = 0;  // rad or m; a second
  double stiffness = 0, damping = 0, max_torque = 0;
};

// What a callback does, with a counter of its calls in the slot of its first target:
//   turn    every other time, by chance, turns a velocity: (x y z) becomes (y z x)
//   feel    where the first target has contacts, every other time its spin turns round
//   grip    holds the two targets together, or lets go, at times drawn at random
//   reach   turns the first joint's torque round, where that of the last link is beyond a limit
//   lean    pushes the first target against what springs and the hold to the second do to it, or
//           against what its accelerometer reads, or not, in turn
//   scan    looks from the first target at the others, in turn by a ray along its velocity, which
//           turns away from what is near there, and by a rangefinder: its spin turns round
//   mind    turns the first target's velocity away from the second where their closest points are
//           near; turns its spin round where a ball about it overlaps an even number of the others
//           or its bounding box reaches down low
//   steady  turns the first target against its spin as a gyroscope reads it, pushes it against what
//           contacts with the second do to it, turns it against torques of contacts and of the
//           hold to the second, in turn
//   strain  turns the last joint's torque against the force or the moment that passes through it,
//           and its servo's target round, in turn
enum class Deed { turn, feel, grip, reach, lean, scan, mind, steady, strain };

struct DescribedCallback {
  Deed deed = Deed::turn;
  std::vector<std::string> targets;  // of bodies, by name
  double start = 0, period = 0;      // s
  double torque = 0;                 // N m or N: reach, strain; N, at most: lean, steady
  double reach = 0;                  // m: scan, mind; times the torque, N m: steady
};

// Where centres of dynamic bodies stay, in the frame of a body.
struct Room {
  std::optional<std::size_t> body;  // absent: the world
  Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();
  double rim = never;  // m: whose centre was above this may go over the walls
};

struct DescribedScene {
  std::string kind;
  std::uint64_t seed = 0;
  double size = 1;       // m, of a typical body
  double time_unit = 1;  // s, in which something happens: sqrt(size/g), or size over speed
  double duration = 1;   // s
  Vec3 gravity = Vec3::Zero();
  double friction = 0.5, restitution = 0.3, accuracy = 1e-6;
  double rolling = 0, spinning = 0;  // m
  std::vector<DescribedBody> bodies;
  std::vector<DescribedBond> bonds;
  std::vector<DescribedForce> forces;
  std::vector<DescribedServo> servos;
  std::vector<DescribedCallback> callbacks;  // and each collision counts, where there are any
  Room room;

  std::string name() const { return kind + ":" + std::to_string(seed); }
  std::size_t moving() const;
  bool has(const std::string& body) const;
  // Callbacks, servos or forces by procedures give energy.
  bool driven() const;
};

Solid ball(double radius);
Solid box(const Vec3& edges);
Solid cylinder(double radius, double length);
Solid capsule(double radius, double length);
Solid cone(double radius, double height);
Solid ellipsoid(const Vec3& widths);
Solid hull(std::vector<Vec3> points);
Solid half_space(const Vec3& normal, double offset);
Solid placed(Solid solid, const Vec3& position, const Quat& orientation = Quat::Identity());

// The polyhedra of a body as an OBJ file, an object each.
std::string obj_text(const DescribedBody& body);
ShapePtr shape_of(const DescribedBody& body);
// Adds everything to an empty world.
void fill(World& world, const DescribedScene& scene);
// The same as a scene for the command: `timewarp FILE`.
std::string scheme_text(const DescribedScene& scene);

}  // namespace tw::fuzz
