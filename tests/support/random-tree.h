// Multibodies of all kinds of joints, drawn at random, and states of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "multibody/joint-laws.h"
#include "support/scene.h"

namespace tw::test {

using Numbers = std::vector<double>;
using Column = Eigen::VectorXd;

inline Eigen::Map<const Column> column(const Numbers& x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}
inline Numbers numbers(const Column& x) { return Numbers(x.data(), x.data() + x.size()); }

inline Mat3 random_inertia(Random& random) {
  const Vec3 squares(random.real(0.01, 0.1), random.real(0.01, 0.1), random.real(0.01, 0.1));
  const Vec3 moments = squares.sum() * Vec3::Ones() - squares;
  const Mat3 R = random_attitude(random).toRotationMatrix();
  const Mat3 inertia = R * moments.asDiagonal() * R.transpose();
  return 0.5 * (inertia + inertia.transpose());
}

inline multibody::AxisSpec random_law(Random& random) {
  multibody::AxisSpec axis;
  axis.damping = random.real(0, 1);
  axis.friction = random.real(0, 1);
  axis.stiffness = random.real(0, 20);
  axis.rest = random.real(-1, 1);
  return axis;
}

// `laws`: with damping, friction and springs at the joints.
inline multibody::LinkSpec random_link(Random& random, multibody::JointKind kind, int index,
                                       int parent, bool laws) {
  multibody::LinkSpec link;
  link.name = "link " + std::to_string(index);
  if (parent >= 0) link.parent = "link " + std::to_string(parent);
  link.mass = random.real(0.5, 2);
  link.inertia = random_inertia(random);
  link.center_of_mass = random_vector(random, 0.3);
  link.joint.kind = kind;
  link.joint.placement = {random_vector(random, 0.5), random_attitude(random)};
  link.joint.axis = random_vector(random, 1);
  link.joint.second = link.joint.axis.cross(random_vector(random, 1)).normalized();
  if (laws) {
    for (multibody::AxisSpec& axis : link.joint.axes) axis = random_law(random);
    link.joint.rest_attitude = random_attitude(random);
  }
  return link;
}

inline std::vector<multibody::LinkSpec> random_links(Random& random, int count, bool laws) {
  using multibody::JointKind;
  constexpr JointKind kinds[] = {JointKind::revolute,  JointKind::prismatic, JointKind::universal,
                                 JointKind::spherical, JointKind::weld,      JointKind::revolute};
  std::vector<multibody::LinkSpec> links;
  for (int i = 0; i < count; ++i) {
    const int parent = i == 0 ? -1 : static_cast<int>(random.below(static_cast<std::uint64_t>(i)));
    const JointKind kind =
        i == 0 && random.below(2) == 0 ? JointKind::free : kinds[random.below(6)];
    links.push_back(random_link(random, kind, i, parent, laws));
  }
  return links;
}

// Some joints of one freedom follow others.
inline std::vector<multibody::LinkSpec> with_followers(std::vector<multibody::LinkSpec> links,
                                                       Random& random) {
  std::vector<multibody::LinkSpec*> leaders;
  for (multibody::LinkSpec& link : links) {
    if (link.joint.kind != multibody::JointKind::revolute &&
        link.joint.kind != multibody::JointKind::prismatic)
      continue;
    if (leaders.empty() || random.below(3) == 0)
      leaders.push_back(&link);
    else
      link.joint.follows = {leaders[random.below(leaders.size())]->name, random.real(-2, 2),
                            random.real(-1, 1)};
  }
  return links;
}

// A tree with a state, and what surrounds it.
struct TreeState {
  multibody::Tree tree;
  Numbers q, u;
  multibody::BaseMotion around;

  TreeState(const std::vector<multibody::LinkSpec>& links, Random& random, bool moving_base)
      : tree(links),
        q(static_cast<std::size_t>(tree.nq())),
        u(static_cast<std::size_t>(tree.nv())) {
    Numbers z(u.size());
    for (double& x : z) x = random.real(-1.5, 1.5);
    for (double& x : u) x = random.real(-2, 2);
    multibody::neutral_position(tree, q);
    multibody::displace(tree, q, z, q);
    around.gravity = random_vector(random, 10);
    around.base = Frame(Pose{random_vector(random, 2), random_attitude(random)});
    if (!moving_base) return;
    around.v = random_vector(random, 2);
    around.w = random_vector(random, 2);
    around.a = random_vector(random, 5);
    around.alpha = random_vector(random, 5);
  }
  Numbers zeros() const { return Numbers(u.size(), 0.0); }
};

inline Numbers random_numbers(Random& random, std::size_t count, double most) {
  Numbers numbers(count);
  for (double& x : numbers) x = random.real(-most, most);
  return numbers;
}

// The derivative at 0 of f, whose result is added up with weights: the difference of order 8.
template <class Function>
auto difference_of_order_8(double h, Function f) {
  using Value = decltype(f(0.0));
  const auto pair = [&](double x) { return Value(f(x) - f(-x)); };
  const Value sum = (4.0 / 5) * pair(h) - (1.0 / 5) * pair(2 * h) + (4.0 / 105) * pair(3 * h) -
                    (1.0 / 280) * pair(4 * h);
  return Value(sum / h);
}

}  // namespace tw::test
