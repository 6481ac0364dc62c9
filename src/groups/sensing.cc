// What acts on one body at one instant.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/sensing.h"

#include "dynamics/placed-body.h"
#include "groups/group.h"
#include "integrate/moving-base.h"
#include "multibody/forward-dynamics.h"

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
      const ContactForce contact = arc.contact_force(static_cast<int>(c), when);
      const double sign = start.contacts[c].b == number ? 1 : -1;
      const Vec3 force = sign * (contact.normal_force * contact.normal + contact.friction);
      sum.force += force;
      sum.torque += (contact.point - point.x).cross(force) + sign * contact.torque;
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

// Of a link: its multibody's joints accelerate as what acts on all links makes them.
Twist link_acceleration(const Group& group, std::uint32_t member, double when,
                        const Vec3& gravity) {
  using namespace multibody;
  const GroupStart& start = group.arc->start();
  const GroupMember& mine = start.members[member];
  const GroupTree& given = start.trees[static_cast<std::size_t>(mine.tree)];
  const Tree& tree = given.multibody->tree;
  std::vector<double> q, u;
  group.arc->joints(mine.tree, when, q, u);
  Surroundings around;
  MovingBase(*given.multibody, start.end).set(when, around);
  around.gravity = given.gravity;
  Kinematics k(tree);
  place(tree, q, u, around, k);
  for (int link = 0; link < tree.link_count(); ++link) {
    const int at = given.members[static_cast<std::size_t>(link)];
    const Wrench wrench = wrench_on(group, static_cast<std::uint32_t>(at), when);
    add_force(tree, k, link, link_center_of_mass(tree, k, link),
              wrench.force + given.forces[static_cast<std::size_t>(link)]);
    add_torque(tree, k, link, wrench.torque);
  }
  std::vector<double> tau(u.size()), rate(u.size());
  joint_torques(tree, q, u, given.state->inputs(), tau);
  Articulation work(tree);
  forward_dynamics(tree, k, tau, work, rate);
  // at the link's own centre of mass: what moves with it there accelerates by A.v + w' x r + w x v
  const int number = tree.link(mine.link).node;
  const NodeMotion& node = k.node(number);
  const Motion A = node.A + work.acceleration_of(number);
  const Vec3 arm = link_center_of_mass(tree, k, mine.link) - k.origin;
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
  if (body.multibody) return link_acceleration(group, member, when, scene.options.gravity);
  return acceleration_by(body, point, group.arc->start().members[member].force / body.mass,
                         wrench_on(group, member, when));
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

}  // namespace tw
