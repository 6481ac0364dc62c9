// What edits and callbacks may do to the joints of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/joint-changes.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/index.h"
#include "base/limits.h"
#include "groups/joints/joints.h"
#include "multibody/impulses.h"
#include "multibody/limits.h"

namespace tw {

using namespace multibody;

namespace {

std::string joint_of(const Multibody& multibody, const Link& link) {
  return "joint " + link.joint_name + " of " + multibody.name;
}

void require_finite(const Multibody& multibody, const MultibodyState& state) {
  const auto require = [&](const Link& link, const std::vector<double>& values, int begin,
                           int count, const char* what) {
    for (int i = begin; i < begin + count; ++i)
      TW_REQUIRE(std::isfinite(values[index(i)]),
                 std::string(what) + " of " + joint_of(multibody, link) + " is " +
                     show(values[index(i)]) + "; expected finite numbers");
  };
  for (const Link& link : multibody.tree.links()) {
    require(link, state.q, link.q, link.coordinates, "the position");
    require(link, state.u, link.u, link.dofs, "the velocity");
  }
}

// Joints that follow others go where these are put; to put them elsewhere is an error.
void follow_leaders(const Multibody& multibody, const MultibodyState& before,
                    MultibodyState& after) {
  const auto set = [&](const Coupling& c, const std::vector<double>& old, std::vector<double>& row,
                       int leader, int follower, double offset, const char* what) {
    double& own = row[index(follower)];
    const bool was_put = own != old[index(follower)];
    if (!was_put && row[index(leader)] == old[index(leader)]) return;
    const double follows = c.ratio * row[index(leader)] + offset;
    const auto name = [&](int dof) {
      for (const Link& link : multibody.tree.links())
        if (link.u == dof && link.dofs == 1) return link.joint_name;
      return std::string();
    };
    TW_REQUIRE(!was_put || std::abs(own - follows) <= 1e-9 * (1 + std::abs(follows)),
               std::string(what) + " of joint " + name(c.follower) + " of " + multibody.name +
                   " is " + show(own) + "; expected " + show(follows) + ", as it follows " +
                   name(c.leader) + ": set that one");
    own = follows;
  };
  for (const Coupling& c : multibody.tree.couplings()) {
    set(c, before.q, after.q, c.leader_q, c.follower_q, c.offset, "the position");
    set(c, before.u, after.u, c.leader, c.follower, 0, "the velocity");
  }
}

void require_quaternions(const Multibody& multibody, const MultibodyState& state) {
  for (const Link& link : multibody.tree.links()) {
    if (link.joint != JointKind::spherical && link.joint != JointKind::free) continue;
    const int begin = link.joint == JointKind::free ? link.q + 3 : link.q;
    const double norm = quaternion_at(&state.q[index(begin)]).norm();
    TW_REQUIRE(norm > 1e-100 && std::isfinite(norm),
               "the position of " + joint_of(multibody, link) +
                   " has a quaternion that is zero or not finite; expected #(w x y z)");
  }
}

void check_positions(const Multibody& multibody, const MultibodyState& before, bool may_place,
                     MultibodyState& after) {
  if (after.q == before.q) return;
  const Tree& tree = multibody.tree;
  require_quaternions(multibody, after);
  normalize(tree, after.q);
  for (const Link& link : tree.links()) {
    const auto begin = after.q.begin() + link.q;
    const bool changed = !std::equal(begin, begin + link.coordinates, before.q.begin() + link.q);
    TW_REQUIRE(!changed || may_place,
               "the position of " + joint_of(multibody, link) +
                   " was set inside a callback; expected only velocities, torques and servos to be "
                   "set there");
  }
  for (int i = 0; i < tree.axis_count(); ++i) {
    const Axis& axis = tree.axes()[index(i)];
    const auto first = after.q.begin() + axis.q;
    if (std::equal(first, first + (axis.ball ? 4 : 1), before.q.begin() + axis.q)) continue;
    const double q = multibody::limited(axis, after.q);
    const std::string what = axis.ball ? "the angle of " : "the position of ";
    TW_REQUIRE(q >= axis.law.lower && q <= axis.law.upper,
               what + joint_of(multibody, tree.link(axis.link)) + " is " + show(q) +
                   "; expected one within its limits, " + show(axis.ball ? 0 : axis.law.lower) +
                   " to " + show(axis.law.upper));
    if (!after.stops.empty()) after.stops[index(i)] = Stop::none;
  }
}

void check_speeds(const Multibody& multibody, const PlacedJoints& placed) {
  for (int i = 0; i < multibody.tree.link_count(); ++i) {
    const PoseTwist point = placed.link(i);
    TW_REQUIRE(point.v.norm() <= speed_limit && point.w.norm() <= greatest_angular_speed &&
                   point.x.norm() <= farthest,
               "the link " + multibody.name + "/" + multibody.tree.link(i).name + " would be at " +
                   show(point.x.norm()) + " m, with " + show(point.v.norm()) + " m/s and " +
                   show(point.w.norm()) + " rad/s; expected at most " + show(farthest) + " m and " +
                   show(speed_limit) + " m/s and rad/s");
  }
}

// What the torques alone do to the rates of the joints.
void check_torques(const Multibody& multibody, const PlacedJoints& placed,
                   const MultibodyState& after) {
  const Tree& tree = multibody.tree;
  Articulation factors(tree);
  factor(tree, placed.kinematics(), factors);
  ImpulseWork work(tree);
  std::vector<double> rate(after.torques.size());
  velocity_change({tree, placed.kinematics(), factors}, {}, after.torques, work, rate);
  for (const Link& link : tree.links())
    for (int k = link.u; k < link.u + link.dofs; ++k)
      TW_REQUIRE(std::abs(rate[index(k)]) <= greatest_angular_acceleration,
                 "the torques at the joints of " + multibody.name + " accelerate joint " +
                     link.joint_name + " by " + show(rate[index(k)]) + "; expected at most " +
                     show(greatest_angular_acceleration) +
                     " rad/s^2 or m/s^2 (the torque there is " + show(after.torques[index(k)]) +
                     ")");
}

void check_gains(const Multibody& multibody, const MultibodyState& after) {
  for (std::size_t i = 0; i < after.servos.size(); ++i) {
    const ServoGains& gains = after.servos[i];
    TW_REQUIRE(gains.stiffness <= greatest_stiffness && gains.damping <= greatest_damping,
               "the servo of " +
                   joint_of(multibody, multibody.tree.link(multibody.tree.axes()[i].link)) +
                   " has the stiffness " + show(gains.stiffness) + " and the damping " +
                   show(gains.damping) + "; expected at most " + show(greatest_stiffness));
  }
}

}  // namespace

void check_joints(const Multibody& multibody, const MultibodyState& before, double time,
                  bool may_place, MultibodyState& after) {
  require_finite(multibody, after);
  follow_leaders(multibody, before, after);
  check_positions(multibody, before, may_place, after);
  require_inputs(multibody.tree, after.inputs());
  check_gains(multibody, after);
  const bool torques = !after.torques.empty() && after.torques != before.torques;
  if (after.q == before.q && after.u == before.u && !torques) return;
  const PlacedJoints placed(multibody, after, time);
  check_speeds(multibody, placed);
  if (torques) check_torques(multibody, placed, after);
}

}  // namespace tw
