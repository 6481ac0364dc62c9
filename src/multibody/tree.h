// A multibody: rigid links that hang on one another by joints, in a tree.  What never changes.
//
// The user's links are kept as they were given: each has a placement in a *node*, a rigid body that
// moves by itself.  Links that are welded share a node, a universal joint makes two (the first
// massless).  Algorithms go over nodes and *dofs*; a joint of several dofs is a run of them, and
// each dof knows the one before it on the way to the base.
//
// Coordinates q and velocities u, link after link, joint by joint:
//   revolute   angle, rad                         its rate
//   prismatic  distance, m                        its rate
//   universal  two angles                         their rates
//   spherical  unit quaternion (w x y z), of the  angular velocity in the link's frame
//              link in the joint's frame
//   free       position of the link's origin,     velocity of the link's origin, angular velocity;
//              unit quaternion; in the world      both in the world
// A weld has none.
//
// Frames: a link's frame is that of its joint, as in URDF: at q = 0 it coincides with the joint's
// frame, which is fixed in the parent link.  Nodes have the frame of their first link, turned so
// that a single axis is z.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "multibody/spatial.h"

namespace tw::multibody {

enum class JointKind { weld, revolute, prismatic, universal, spherical, free };

// What acts at one coordinate of a joint (of a spherical joint: at its three together).  Units: per
// rad and N m, or per m and N.
struct AxisSpec {
  double damping = 0;    // torque against the velocity, >= 0
  double friction = 0;   // Coulomb torque against the motion, >= 0
  double stiffness = 0;  // of a spring, >= 0
  double rest = 0;       // where the spring is relaxed
  // limits; of spherical joints the upper one, of an angle (limits.h)
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double restitution = 0;                // of the stops at the limits, 0 to 1
  std::optional<double> stop_stiffness;  // default: the subtree's weight bends it by stop_depth
  // what drives it has: the most that a servo gives unless it says more, and the fastest that it is
  // meant to go, which nothing enforces; N m and rad/s, or N and m/s
  double effort = std::numeric_limits<double>::infinity();
  double speed = std::numeric_limits<double>::infinity();
};

// A joint of one coordinate follows another: its position is ratio times that one's, plus offset.
struct FollowSpec {
  std::string joint;  // its name, or its link's
  double ratio = 1, offset = 0;
};

struct JointSpec {
  std::string name;  // empty: that of the link that it moves
  JointKind kind = JointKind::revolute;
  Pose placement;                // joint frame in the parent link's frame (of roots: in the base's)
  Vec3 axis = Vec3::UnitZ();     // in the joint frame; need not be a unit vector
  Vec3 second = Vec3::UnitY();   // universal: fixed in the link, square to the first at 0
  std::array<AxisSpec, 2> axes;  // the second: universal joints alone
  // of a spherical joint
  Quat rest_attitude = Quat::Identity();  // where its spring is relaxed
  std::optional<FollowSpec> follows;
  std::optional<Vec3> swinging;  // whose swing is limited, in the joint frame; none: all turning
};

struct LinkSpec {
  std::string name;
  std::string parent;  // name of an earlier link; empty: the base
  JointSpec joint;
  double mass = 0;                     // kg, >= 0
  Vec3 center_of_mass = Vec3::Zero();  // m, in the link's frame
  Mat3 inertia = Mat3::Zero();         // kg m^2, about the centre of mass, axes of the link
};

// Nodes 0 and 1 are the world and the base; those of links follow, parents first.
enum class NodeKind { world, base, hinge, slider, ball, floating };
inline constexpr int world_node = 0, base_node = 1, first_node = 2;

struct Node {
  NodeKind kind = NodeKind::world;
  int parent = world_node;
  int link = -1;     // the first of the links that move with it
  int q = 0, u = 0;  // where its coordinates and dofs begin
  int dofs = 0;
  Frame X_PF;                  // joint frame in the parent node, z along the axis
  double mass = 0;             // kg
  Vec3 center = Vec3::Zero();  // of mass, in the node's frame
  Sym3 moments;                // about it, axes of the node's frame
};

struct Link {
  std::string name;
  std::string joint_name;
  int parent = -1;  // link; -1: the base
  JointKind joint = JointKind::weld;
  int node = base_node;
  Frame X_NL;                                   // of the link in its node
  Frame placement;                              // joint frame in the parent link
  int q = 0, coordinates = 0, u = 0, dofs = 0;  // its joint's
  int first_axis = 0, axes = 0;                 // its joint's
  double mass = 0;
  Vec3 center_of_mass = Vec3::Zero();  // in the link's frame
  Mat3 inertia = Mat3::Zero();
};

// One coordinate with what acts at it, or the three of a spherical joint.
struct Axis {
  bool ball = false;
  int link = 0;
  int q = 0, u = 0;
  AxisSpec law;
  Quat rest_attitude = Quat::Identity();
  Vec3 swinging = Vec3::Zero();  // unit vector; 0: none
  double unit = 1;               // rad, or the reach of what it moves, m
  double slow = 1;               // that over sqrt(reach/g): the scale of what is slow, rad/s or m/s
  double stop_stiffness = 0;     // N m/rad or N/m
  bool passive = false;          // damping, friction or a spring
};

// q_f = ratio q_l + offset (couplings.h): dofs, and where their coordinates are.
struct Coupling {
  int leader = 0, follower = 0, leader_q = 0, follower_q = 0;
  double ratio = 1, offset = 0;
};

class Tree {
 public:
  // Errors (TW_REQUIRE), with the link's name: no or a repeated name, a parent that is unknown,
  // comes later or leads back to the link, a free joint below another link, axes that are zero or
  // not square, limits that are reversed or, of a spherical joint, out of range, numbers that are
  // not finite, negative mass, damping, friction or stiffness, restitution outside 0 to 1, inertia
  // that is not symmetric or that no body has, massless parts that leave the acceleration of a
  // joint undetermined, joints that follow one that is not there, has not one coordinate, or
  // follows itself.
  explicit Tree(const std::vector<LinkSpec>& links);
  // m/s^2, > 0: sets what is slow at the joints and how stiff stops are (Axis), the standard one at
  // first.
  void set_gravity(double magnitude);

  const std::vector<Link>& links() const { return links_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Axis>& axes() const { return axes_; }
  const std::vector<Coupling>& couplings() const { return couplings_; }
  const Link& link(int i) const { return links_[static_cast<std::size_t>(i)]; }
  const Node& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  int link_count() const { return static_cast<int>(links_.size()); }
  int node_count() const { return static_cast<int>(nodes_.size()); }
  int axis_count() const { return static_cast<int>(axes_.size()); }
  int nq() const { return nq_; }
  int nv() const { return nv_; }
  // Of all links that are not welded to the base, kg.
  double mass() const { return mass_; }

  // The dof before dof k on the way to the base, -1: none.  The last dof that moves a node, -1:
  // none.
  int dof_parent(int k) const { return dof_parent_[static_cast<std::size_t>(k)]; }
  int last_dof(int node) const { return last_dof_[static_cast<std::size_t>(node)]; }
  int dof_node(int k) const { return dof_node_[static_cast<std::size_t>(k)]; }
  // A link by its name, -1: none.
  int find(const std::string& name) const;
  // The link that a joint moves, by the joint's name, or else by its own; -1: none.
  int find_joint(const std::string& name) const;

 private:
  void add_link(const LinkSpec& spec);
  int add_node(NodeKind kind, int parent, const Frame& X_PF);
  void add_axis(const AxisSpec& law);
  void add_mass(Node& node, const LinkSpec& spec, const Frame& X_NL);
  void add_coupling(const LinkSpec& spec);
  void require_regular() const;

  std::vector<Link> links_;
  std::vector<Node> nodes_;
  std::vector<Axis> axes_;
  std::vector<Coupling> couplings_;
  std::vector<int> dof_parent_, last_dof_, dof_node_;
  int nq_ = 0, nv_ = 0;
  double mass_ = 0;
};

}  // namespace tw::multibody
