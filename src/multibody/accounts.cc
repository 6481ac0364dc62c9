// Energy, momentum and centre of mass of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/accounts.h"

namespace tw::multibody {
namespace {

Vec3 center_velocity(const NodeMotion& node) { return node.V.v + node.V.w.cross(node.center); }

}  // namespace

double kinetic_energy(const Tree& tree, const Kinematics& k) {
  double sum = 0;
  for (int i = first_node; i < tree.node_count(); ++i) {
    const NodeMotion& node = k.node(i);
    sum += 0.5 * (tree.node(i).mass * center_velocity(node).squaredNorm() +
                  node.V.w.dot(node.moments * node.V.w));
  }
  return sum;
}

double gravity_energy(const Tree& tree, const Kinematics& k, const Vec3& gravity) {
  double sum = 0;
  for (int i = first_node; i < tree.node_count(); ++i)
    sum -= tree.node(i).mass * gravity.dot(k.origin + k.node(i).center);
  return sum;
}

Vec3 momentum(const Tree& tree, const Kinematics& k) {
  Vec3 sum = Vec3::Zero();
  for (int i = first_node; i < tree.node_count(); ++i)
    sum += tree.node(i).mass * center_velocity(k.node(i));
  return sum;
}

Vec3 angular_momentum(const Tree& tree, const Kinematics& k, const Vec3& point) {
  Vec3 sum = Vec3::Zero();
  for (int i = first_node; i < tree.node_count(); ++i) {
    const NodeMotion& node = k.node(i);
    const Vec3 arm = k.origin + node.center - point;
    sum += node.moments * node.V.w + arm.cross(tree.node(i).mass * center_velocity(node));
  }
  return sum;
}

Vec3 center_of_mass(const Tree& tree, const Kinematics& k) {
  Vec3 sum = Vec3::Zero();
  for (int i = first_node; i < tree.node_count(); ++i) sum += tree.node(i).mass * k.node(i).center;
  return k.origin + sum / tree.mass();
}

}  // namespace tw::multibody
