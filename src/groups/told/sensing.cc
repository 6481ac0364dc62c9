// What acts on one body at one instant.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/told/sensing.h"

#include "dynamics/placed-body.h"
#include "groups/group.h"
#include "integrate/given/moving-base.h"
#include "multibody/forward-dynamics.h"
#include "multibody/joint-forces.h"

namespace tw {
namespace {

// What contacts and bonds of its group do to a member, about its centre of mass, and the forces
// that act on it alone; without weight and constant force.
Wrench wrench_on(const Group& group, std::uint32_t member, double when) {
  const GroupArc& arc = *group.arc;
  const GroupStart& start = arc.start();
  const auto number = static_cast<int>(member);
  const PoseTwist point = arc.trajectory(number).at(when);
  Wrench sum;
  for (const std::uint32_t pair : group.pairs_of(member))
    each_contact(group.pairs[pair], [&](std::uint32_t c) {
      const Wrench load = arc.contact_force(static_cast<int>(c), when)
                              .wrench_on(start.contacts[c].b == number, point.x);
      sum.force += load.force;
      sum.torque += load.torque;
    });
  for (const GroupBond& bond : start.bonds) {
    if (bond.a != number && bond.b != number) continue;
    const Bond::Wrenches pull =
        bond.bond->wrenches(arc.trajectory(bond.a).at(when), arc.trajectory(bond.b).at(when));
    const Wrench& mine = bond.a == number ? pull.a : pull.b;
    sum.force += mine.force;
    sum.torque += mine.torque;
  }
  const GroupMember& given = start.members[member];
  if (given.forces) {
    const Wrench more = given.forces->wrench(when, point);
    sum.force += more.force;
    sum.torque += more.torque;
  }
  sum.torque += given.torque;
  return sum;
}

// Newton and Euler, of a body that moves by itself.
Twist acceleration_by(const Body& body, const PoseTwist& point, const Vec3& constant,
                      const Wrench& wrench) {
  const Mat3 R = point.q.toRotationMatrix();
  const Vec3 L = body.moments.cwiseProduct(R.transpose() * point.w);
  const Vec3 torque = R.transpose() * (wrench.torque - point.w.cross(R * L));
  return {constant + wrench.force / body.mass, R * torque.cwiseQuotient(body.moments)};
}

// A multibody at an instant: its links as placed, what acts on each from outside, about the origin
// of `k`, and how its nodes are accelerated by the joints.
struct TreeMotion {
  const multibody::Tree& tree;
  multibody::Kinematics k;
  std::vector<multibody::Force> wrenches;
  multibody::Articulation work;

  explicit TreeMotion(const multibody::Tree& t)
      : tree(t), k(t), wrenches(static_cast<std::size_t>(t.link_count())), work(t) {}
};

// Its joints accelerate as what acts on all links makes them; at rest, not at all.
TreeMotion tree_motion(const Group& group, std::uint32_t member, const State& state, double when) {
  using namespace multibody;
  const GroupStart& start = group.arc->start();
  const GroupMember& mine = start.members[member];
  const GroupTree& given = start.trees[static_cast<std::size_t>(mine.tree)];
  const Tree& tree = given.multibody->tree;
  TreeMotion motion(tree);
  Kinematics& k = motion.k;
  std::vector<double> q = state.joints->q, u(state.joints->u.size());
  if (!group.at_rest) group.arc->joints(mine.tree, when, q, u);
  BaseMotion around;
  MovingBase(*given.multibody, start.end).set(when, around);
  around.gravity = given.gravity;
  place(tree, q, u, around, k);
  for (int link = 0; link < tree.link_count(); ++link) {
    const auto at = static_cast<std::size_t>(link);
    const auto number = static_cast<std::uint32_t>(given.members[at]);
    const Wrench wrench = wrench_on(group, number, group.contact_time(when));
    const Vec3 center = link_center_of_mass(tree, k, link), force = wrench.force + given.forces[at];
    add_force(tree, k, link, center, force);
    add_torque(tree, k, link, wrench.torque);
    motion.wrenches[at] = {(center - k.origin).cross(force) + wrench.torque, force};
  }
  if (group.at_rest) return motion;
  std::vector<double> tau(u.size()), rate(u.size());
  joint_torques(tree, q, u, given.state->inputs(), tau);
  forward_dynamics(tree, k, tau, motion.work, rate);
  return motion;
}

Twist link_acceleration(const Group& group, std::uint32_t member, const State& state, double when,
                        const Vec3& gravity) {
  using namespace multibody;
  const TreeMotion motion = tree_motion(group, member, state, when);
  const Kinematics& k = motion.k;
  // at the link's own centre of mass: what moves with it there accelerates by A.v + w' x r + w x v
  const int link = group.arc->start().members[member].link;
  const auto number = static_cast<std::size_t>(motion.tree.link(link).node);
  const NodeMotion& node = k.nodes[number];
  const Motion A = node.A + motion.work.acceleration[number];
  const Vec3 arm = link_center_of_mass(motion.tree, k, link) - k.origin;
  const Vec3& w = node.V.w;
  return {A.v + A.w.cross(arm) + w.cross(node.V.v + w.cross(arm)) + gravity, A.w};
}

Twist acceleration_of(const Scene& scene, const Body& body, const State& state,
                      const PoseTwist& point, double when) {
  if (body.fixed()) return {};
  if (body.kinematic()) return body.motion->twist_rates(when);
  if (!state.group)
    return acceleration_by(body, point, state.acceleration,
                           state.forces ? state.forces->wrench(when, point) : Wrench{});
  const Group& group = *state.group;
  if (group.at_rest) return {};
  const std::uint32_t member = state.member;
  if (body.multibody) return link_acceleration(group, member, state, when, scene.options.gravity);
  return acceleration_by(body, point, group.arc->start().members[member].force / body.mass,
                         wrench_on(group, member, when));
}

bool is_of(PullKind kind, const Bond& bond, BodyId a, BodyId b) {
  return bond.holds == (kind == PullKind::holds) && bond.joins(a, b);
}

// Of a wrench of a bond on the body, about its centre: the torque about the bond's point of body b,
// where the force acts.
Wrench at_point(const Bond& bond, const Wrench& wrench, const PoseTwist& body,
                const PoseTwist& on_b) {
  const Vec3 arm = on_b.x + on_b.q * bond.arm_b - body.x;
  return {wrench.force, bond.holds ? Vec3(wrench.torque - arm.cross(wrench.force)) : Vec3::Zero()};
}

}  // namespace

Vec3 SensedMotion::proper_acceleration(const Vec3& at) const {
  const Vec3 arm = body.position + body.orientation * at - point.x;
  return acceleration + angular_acceleration.cross(arm) + point.w.cross(point.w.cross(arm)) -
         gravity;
}

SensedMotion sense_motion(const Scene& scene, const Body& body, const State& state, double when) {
  SensedMotion sensed;
  sensed.point = state.trajectory().at(when);
  sensed.body = body_state(body, sensed.point);
  const Twist rates = acceleration_of(scene, body, state, sensed.point, when);
  sensed.acceleration = rates.v;
  sensed.angular_acceleration = rates.w;
  sensed.gravity = scene.options.gravity;
  return sensed;
}

std::vector<ContactReading> contacts_of(const Body& body, const State& state, double when) {
  std::vector<ContactReading> contacts;
  if (!body.dynamic() || !state.group || state.error) return contacts;
  const Group& group = *state.group;
  for (const std::uint32_t pair : group.pairs_of(state.member))
    each_contact(group.pairs[pair], [&](std::uint32_t c) {
      contacts.push_back(reading_of(group.tags[c], group.contact_at(c, when)));
    });
  return contacts;
}

Wrench sense_joint(const Body& body, const State& state, int link, double when) {
  using namespace multibody;
  const Multibody& multibody = *body.multibody;
  const Tree& tree = multibody.tree;
  TW_REQUIRE(tree.link(link).joint != JointKind::free,
             "link " + tree.link(link).name + " of " + multibody.name +
                 " is free; expected one that a joint carries");
  if (!state.group || state.error) return {};
  const TreeMotion motion = tree_motion(*state.group, state.member, state, when);
  const std::vector<Force> through =
      joint_forces(tree, motion.k, motion.work.acceleration, motion.wrenches);
  const Force& f = through[static_cast<std::size_t>(link)];
  const Vec3 at = link_frame(tree, motion.k, link).p - motion.k.origin;
  return {f.f, f.n - at.cross(f.f)};
}

Wrench sense_pull(const Body& body, const State& state, BodyId other, PullKind kind, double when) {
  Wrench sum;
  const auto add = [&sum](const Wrench& wrench) {
    sum.force += wrench.force;
    sum.torque += wrench.torque;
  };
  if (!body.dynamic() || state.error) return sum;
  // to what is not dynamic: a law of its own, in which it is b
  const PoseTwist point = state.trajectory().at(when);
  if (state.forces)
    for (const ForceLawPtr& law : state.forces->laws()) {
      const Bond* bond = law->bond();
      if (!bond || !is_of(kind, *bond, body.id(), other)) continue;
      Wrench wrench;
      law->add(when, point, wrench);
      add(at_point(*bond, wrench, point, point));
    }
  if (!state.group) return sum;
  // to another member of its group
  const GroupArc& arc = *state.group->arc;
  const double time = state.group->contact_time(when);
  for (const GroupBond& bond : arc.start().bonds) {
    if (!is_of(kind, *bond.bond, body.id(), other)) continue;
    const PoseTwist a = arc.trajectory(bond.a).at(time), b = arc.trajectory(bond.b).at(time);
    const Bond::Wrenches pull = bond.bond->wrenches(a, b);
    const bool first = bond.bond->a == body.id();
    add(at_point(*bond.bond, first ? pull.a : pull.b, first ? a : b, b));
  }
  return sum;
}

}  // namespace tw
