// What a multibody may be made of, and what is said of what it may not.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "multibody/forward-dynamics.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

using namespace multibody;

LinkSpec arm(const std::string& name, const std::string& parent = "") {
  LinkSpec link;
  link.name = name;
  link.parent = parent;
  link.mass = 1;
  link.center_of_mass = {0.5, 0, 0};
  link.inertia = Mat3::Identity();
  link.joint.placement.p = {1, 0, 0};
  return link;
}

// What the tree of these links, or the inputs to it, are refused with.
template <class Make>
std::string refusal(Make make) {
  try {
    make();
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}
std::string refused(const std::vector<LinkSpec>& links) {
  return refusal([&] { Tree tree(links); });
}
template <class Change>
std::string refused_arm(Change change) {
  LinkSpec link = arm("elbow");
  change(link);
  return refused({link});
}

TEST(MultibodyTree, names_and_parents_that_are_wrong_are_told) {
  EXPECT_EQ(refused({arm("")}), "a link has no name; expected one");
  EXPECT_EQ(refused({arm("a"), arm("a")}),
            "two links are named a; expected a name to each link of a multibody");
  EXPECT_EQ(refused({arm("a", "b")}),
            "parent of a is b; expected the name of one of the multibody's links");
  EXPECT_EQ(refused({arm("a", "b"), arm("b")}),
            "parent of a is b, which comes later; expected parents before their children");
  EXPECT_EQ(refused({arm("a", "b"), arm("b", "c"), arm("c", "a")}),
            "parent of a is b, which hangs on it; expected a tree, no cycle");
  EXPECT_EQ(refused({arm("a", "a")}),
            "parent of a is a, which hangs on it; expected a tree, no cycle");
  LinkSpec floating = arm("b", "a");
  floating.joint.kind = JointKind::free;
  EXPECT_EQ(refused({arm("a"), floating}),
            "the joint of b below a is free; expected that of a link on the base alone");
}

TEST(MultibodyTree, numbers_that_are_wrong_are_told_with_link_and_value) {
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.mass = -2; }).rfind("mass of elbow is -2;", 0), 0u);
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.mass = NAN; }).rfind("mass of elbow is ", 0), 0u);
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.inertia(0, 0) = -1; }),
            "inertia of elbow has principal moments (-1 1 1); expected none that is negative or "
            "exceeds the sum of the other two");
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.inertia(0, 0) = 3; }),
            "inertia of elbow has principal moments (1 1 3); expected none that is negative or "
            "exceeds the sum of the other two");
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.inertia(0, 1) = 0.5; }),
            "inertia of elbow differs from its transpose by 0.5; expected it symmetric");
  EXPECT_EQ(refused_arm([](LinkSpec& l) {
              l.inertia(0, 1) = INFINITY;
            }).rfind("inertia of elbow has an element ", 0),
            0u);
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.mass = 0; }),
            "inertia of elbow has an element 1; expected 0, as its mass is 0");
  EXPECT_EQ(refused_arm([](LinkSpec& l) {
              l.center_of_mass.x() = NAN;
            }).rfind("centre of mass of elbow is ", 0),
            0u);
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.joint.axis.setZero(); }),
            "axis of the joint of elbow is (0 0 0); expected a vector that is not zero");
  EXPECT_EQ(refused_arm([](LinkSpec& l) {
              l.joint.kind = JointKind::universal;
              l.joint.second = Vec3::UnitZ();
            }),
            "axes of the joint of elbow are (0 0 1) and (0 0 1); expected two that are square to "
            "each other");
  EXPECT_EQ(refused_arm([](LinkSpec& l) {
              l.joint.axes[0].lower = 1;
              l.joint.axes[0].upper = -1;
            }),
            "limits of the joint of elbow are 1 and -1; expected the lower one first");
  EXPECT_EQ(
      refused_arm([](LinkSpec& l) {
        l.joint.kind = JointKind::spherical;
        l.joint.axes[0].lower = -1;
        l.joint.axes[0].upper = 1;
      }),
      "the lower limit of the joint of elbow is -1; expected none, as the joint is spherical");
  for (const double angle : {-1.0, 0.0, 3.1})
    EXPECT_EQ(refused_arm([&](LinkSpec& l) {
                l.joint.kind = JointKind::spherical;
                l.joint.axes[0].upper = angle;
              }).substr(0, 31),
              "the limit of the joint of elbow");
  for (double AxisSpec::*field : {&AxisSpec::damping, &AxisSpec::friction, &AxisSpec::stiffness})
    for (double value : {-1.0, double(NAN), double(INFINITY)})
      EXPECT_NE(refused_arm([&](LinkSpec& l) {
                  l.joint.axes[0].*field = value;
                }).find(" of the joint of elbow is " + show(value) + "; expected a number from 0"),
                std::string::npos);
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.joint.axes[0].restitution = 1.5; }),
            "restitution of the joint of elbow is 1.5; expected a number from 0 to 1");
  EXPECT_EQ(refused_arm([](LinkSpec& l) { l.joint.placement.q = Quat(0, 0, 0, 0); }),
            "orientation of the joint of elbow is (0 0 0 0); expected a unit quaternion");
}

TEST(MultibodyTree, massless_parts_that_determine_no_motion_are_named) {
  const std::string end =
      " and of what hangs on it leave the motion of its joint undetermined; expected mass that "
      "moves with each joint by itself";
  const auto massless = [](LinkSpec link) {
    link.mass = 0;
    link.inertia.setZero();
    return link;
  };
  EXPECT_EQ(refused({arm("a"), massless(arm("b", "a"))}), "mass and inertia of b" + end);
  // two hinges about one line, nothing between
  LinkSpec same = arm("b", "a");
  same.joint.placement.p.setZero();
  EXPECT_EQ(refused({massless(arm("a")), same}), "mass and inertia of a" + end);
  // a point on its own axis
  LinkSpec point = arm("a");
  point.inertia.setZero();
  point.center_of_mass.setZero();
  EXPECT_EQ(refused({point}), "mass and inertia of a" + end);
  // a point on a ball joint does not say how it turns about its own line
  point = arm("a");
  point.inertia.setZero();
  point.joint.kind = JointKind::spherical;
  EXPECT_EQ(refused({point}), "mass and inertia of a" + end);
  // a massless link that mass follows is fine, and so is a point that swings
  point.joint.kind = JointKind::revolute;
  EXPECT_EQ(refused({massless(arm("a")), arm("b", "a"), point}),
            "two links are named a; expected "
            "a name to each link of a multibody");
  LinkSpec swings = point;
  swings.name = "c";
  EXPECT_EQ(refused({massless(arm("a")), arm("b", "a"), swings}), "accepted");
}

TEST(MultibodyTree, inputs_that_are_wrong_are_told) {
  const Tree tree({arm("a"), arm("b", "a")});
  const auto refused_inputs = [&](const Inputs& in) {
    return refusal([&] { require_inputs(tree, in); });
  };
  const Numbers bad{0, NAN}, good{0, 0}, short_one{0};
  Inputs in;
  EXPECT_EQ(refused_inputs(in), "accepted");
  in.torques = bad;
  EXPECT_EQ(refused_inputs(in).rfind("torque of the joint of b is ", 0), 0u);
  in.torques = short_one;
  EXPECT_EQ(refused_inputs(in), "1 torques for a multibody; expected 2");
  in.torques = good;
  std::vector<ServoGains> servos(2);
  servos[1].stiffness = -5;
  in.servos = servos;
  EXPECT_EQ(refused_inputs(in), "0 targets of servos for a multibody; expected 2");
  in.targets = good;
  EXPECT_EQ(refused_inputs(in),
            "stiffness of the servo of b is -5; expected a number that is not negative");
  servos[1] = {1, 1, NAN};
  EXPECT_EQ(refused_inputs(in).rfind("greatest torque of the servo of b is ", 0), 0u);
  servos[1] = {1, 1, INFINITY};
  EXPECT_EQ(refused_inputs(in), "accepted");
}

TEST(MultibodyTree, welded_links_move_as_one_body_and_answer_each_for_itself) {
  Random random(31);
  for (int round = 0; round < 30; ++round) {
    LinkSpec base = random_link(random, JointKind::spherical, 0, -1, false);
    LinkSpec welded = random_link(random, JointKind::weld, 1, 0, false);
    LinkSpec tip = random_link(random, JointKind::revolute, 2, 1, false);
    const TreeState s({base, welded, tip}, random, false);
    EXPECT_EQ(s.tree.nv(), 4);
    EXPECT_EQ(s.tree.link_count(), 3);
    // the same with the mass of both in the first link, and the tip's joint in it
    const Frame X(welded.joint.placement);
    LinkSpec both = base;
    both.mass = base.mass + welded.mass;
    const Vec3 c = X * welded.center_of_mass;
    both.center_of_mass = (base.mass * base.center_of_mass + welded.mass * c) / both.mass;
    const auto about = [&](double m, const Mat3& I, const Vec3& at) -> Mat3 {
      const Mat3 d = cross_matrix(at - both.center_of_mass);
      return I - m * d * d;
    };
    const Mat3 sum = about(base.mass, base.inertia, base.center_of_mass) +
                     about(welded.mass, X.R * welded.inertia * X.R.transpose(), c);
    both.inertia = 0.5 * (sum + sum.transpose());
    LinkSpec same_tip = tip;
    same_tip.parent = base.name;
    same_tip.joint.placement = welded.joint.placement * tip.joint.placement;
    same_tip.joint.placement.q.normalize();
    const Tree merged({both, same_tip});
    Kinematics k(s.tree), km(merged);
    Articulation a(s.tree), am(merged);
    Numbers rate = s.zeros(), same = s.zeros();
    place(s.tree, s.q, s.u, s.around, k);
    place(merged, s.q, s.u, s.around, km);
    ASSERT_TRUE(forward_dynamics(s.tree, k, s.zeros(), a, rate));
    ASSERT_TRUE(forward_dynamics(merged, km, s.zeros(), am, same));
    for (std::size_t i = 0; i < rate.size(); ++i)
      EXPECT_NEAR(rate[i], same[i], 1e-11 * (1 + std::abs(same[i])));
    const Frame placed = link_frame(s.tree, k, 0) * X, asked = link_frame(s.tree, k, 1);
    EXPECT_LT((placed.p - asked.p).norm() + (placed.R - asked.R).norm(), 1e-14);
  }
}

TEST(MultibodyTree, a_link_on_the_base_stands_where_the_base_puts_it) {
  LinkSpec foot = arm("foot");
  foot.joint.kind = JointKind::weld;
  const Tree tree({foot, arm("a", "foot")});
  EXPECT_EQ(tree.nv(), 1);
  EXPECT_EQ(tree.mass(), 1) << "the foot is part of the base";
  Kinematics k(tree);
  BaseMotion around;
  around.base.p = {0, 0, 5};
  around.v = {1, 0, 0};
  place(tree, Numbers{0}, Numbers{0}, around, k);
  EXPECT_EQ(link_frame(tree, k, 0).p, Vec3(1, 0, 5));
  EXPECT_EQ(link_twist(tree, k, 0).v, Vec3(1, 0, 0));
  EXPECT_EQ(link_frame(tree, k, 1).p, Vec3(2, 0, 5));
}

TEST(MultibodyTree, a_stop_yields_by_its_depth_under_the_weight_beyond_it) {
  LinkSpec link = arm("a");
  link.inertia.setZero();
  EXPECT_NEAR(Tree({link}).axes()[0].stop_stiffness, 9.81 * 0.5 / 1e-4, 1e-6);
  link.joint.axes[0].stop_stiffness = 7;
  EXPECT_EQ(Tree({link}).axes()[0].stop_stiffness, 7);
}

}  // namespace
}  // namespace tw::test
