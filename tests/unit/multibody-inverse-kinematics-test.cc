// Inverse kinematics: what is in reach is reached, what is not is told.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/inverse-kinematics.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

using namespace multibody;

// Eight joints of +-2 rad whose axes take turns, 2 m long.
std::vector<LinkSpec> arm() {
  std::vector<LinkSpec> links;
  for (int i = 0; i < 8; ++i) {
    LinkSpec link;
    link.name = std::to_string(i);
    if (i > 0) link.parent = std::to_string(i - 1);
    if (i > 0) link.joint.placement.p = {0, 0, 0.25};
    link.joint.axis = Vec3::Unit(i % 3);
    link.joint.axes[0].lower = -2;
    link.joint.axes[0].upper = 2;
    link.mass = 1;
    link.inertia = 0.01 * Mat3::Identity();
    links.push_back(link);
  }
  return links;
}

struct Arm {
  Tree tree{arm()};
  Kinematics k{tree};
  Numbers u = Numbers(8), start = Numbers(8, 0.1);
  Target target;

  Arm() { target.link = 7, target.point = {0, 0, 0.25}; }
  Frame end(const Numbers& q) {
    place(tree, q, u, {}, k);
    const Frame X = link_frame(tree, k, 7);
    return {X.R, X * target.point};
  }
  // The target where the joints at q bring it.
  void aim(const Numbers& q, bool with_attitude) {
    const Frame X = end(q);
    target.position = X.p;
    target.attitude.reset();
    if (with_attitude) target.attitude = Quat(X.R);
  }
  Reached search(int starts) {
    SearchOptions options;
    options.starts = starts;
    return inverse_kinematics(tree, {}, target, start, options);
  }
  // Whether the answer is one, within limits.
  bool solves(const Reached& reached) {
    if (!reached.q) return false;
    for (double x : *reached.q)
      if (std::abs(x) > 2) ADD_FAILURE() << x << " is beyond the limits";
    const Frame X = end(*reached.q);
    EXPECT_LT((X.p - target.position).norm(), 3e-9);
    if (target.attitude) {
      EXPECT_LT((X.R - target.attitude->toRotationMatrix()).norm(), 3e-8);
    }
    return true;
  }
};

// Of 400 places that joints within their limits bring the end to.
int solved(bool with_attitude, int starts, double near) {
  Random random(51);
  Arm a;
  int count = 0;
  for (int i = 0; i < 400; ++i) {
    const Numbers q = random_numbers(random, 8, 2);
    a.aim(q, with_attitude);
    if (near > 0)
      for (std::size_t j = 0; j < 8; ++j)
        a.start[j] = std::clamp(q[j] + random.real(-near, near), -2.0, 2.0);
    count += a.solves(a.search(starts));
  }
  return count;
}

TEST(InverseKinematics, places_in_reach_are_found_from_one_start) {
  EXPECT_GE(solved(false, 1, 0), 397);
}

TEST(InverseKinematics, places_and_attitudes_are_found_from_several_starts) {
  const int once = solved(true, 1, 0), often = solved(true, 6, 0);
  EXPECT_GE(once, 325);
  EXPECT_GE(often, 389);
  EXPECT_GT(often, once);
}

TEST(InverseKinematics, what_is_near_is_found_at_once) { EXPECT_GE(solved(true, 1, 0.3), 398); }

TEST(InverseKinematics, what_is_out_of_reach_is_told_with_how_far) {
  Arm a;
  a.target.position = {0, 0, 2.5};
  const Reached reached = a.search(1);
  EXPECT_FALSE(reached.q);
  EXPECT_NEAR(reached.residual, 0.5, 1e-2);
  EXPECT_LT(reached.iterations, 60);
  EXPECT_EQ(a.search(6).iterations, a.search(6).iterations) << "always the same starts";
}

TEST(InverseKinematics, all_joints_take_part_and_free_links_stay) {
  Random random(52);
  int count = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<LinkSpec> links;
    links.push_back(random_link(random, JointKind::free, 0, -1, false));
    links.push_back(random_link(random, JointKind::spherical, 1, 0, false));
    links.push_back(random_link(random, JointKind::prismatic, 2, 1, false));
    links.push_back(random_link(random, JointKind::universal, 3, 2, false));
    const TreeState s(links, random, false);
    Kinematics k(s.tree);
    place(s.tree, s.q, s.u, s.around, k);
    Target target;
    target.link = 3;
    target.position = link_frame(s.tree, k, 3).p;
    target.attitude = Quat(link_frame(s.tree, k, 3).R);
    Numbers start(s.q.size());
    neutral_position(s.tree, start);
    std::copy_n(s.q.begin(), 7, start.begin());
    const Reached reached = inverse_kinematics(s.tree, s.around, target, start);
    if (!reached.q) continue;
    ++count;
    for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR((*reached.q)[i], s.q[i], 1e-15);
  }
  EXPECT_GE(count, 95);
}

TEST(InverseKinematics, wrong_questions_are_refused) {
  Arm a;
  a.target.position.x() = NAN;
  EXPECT_THROW(a.search(1), UserError);
  a.target.position.x() = 0;
  EXPECT_THROW(a.search(0), UserError);
  a.target.link = 8;
  EXPECT_THROW(a.search(1), UserError);
}

}  // namespace
}  // namespace tw::test
