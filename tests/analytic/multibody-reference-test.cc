// A tree of every joint against accelerations by Simbody, kept here; where Simbody is installed it
// is asked again, and about random trees.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "multibody/forward-dynamics.h"
#include "support/dynamics-engine.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

using namespace multibody;

const Vec3 gravity(0.5, -1, -9.81);

LinkSpec part(const char* name, const char* parent, JointKind kind, const Vec3& at) {
  LinkSpec link;
  link.name = name;
  link.parent = parent;
  link.joint.kind = kind;
  link.joint.placement = {at, Quat(0.8, 0, 0.6, 0)};
  link.joint.axis = {0, 0.6, 0.8};
  link.joint.second = Vec3::UnitX();
  link.mass = 1.5;
  link.center_of_mass = {0.1, -0.2, 0.3};
  link.inertia << 0.05, 0.005, 0, 0.005, 0.06, -0.01, 0, -0.01, 0.07;
  return link;
}

// A free hull with two branches; every joint once, the weld between two that move.
Links reference_links() {
  return {part("hull", "", JointKind::free, Vec3::Zero()),
          part("boom", "hull", JointKind::revolute, {0.5, 0, 0.1}),
          part("crown", "boom", JointKind::weld, {0.2, 0.1, 0}),
          part("ball", "crown", JointKind::spherical, {0, 0, 0.4}),
          part("fork", "hull", JointKind::universal, {-0.5, 0.2, 0}),
          part("slide", "fork", JointKind::prismatic, {0, 0.3, -0.2})};
}

struct ReferenceState {
  Numbers q{1, 2, 3, 0.5, 0.5, -0.5, 0.5, 0.7, 0.6, 0, -0.8, 0, -0.4, 0.9, 0.25};
  Numbers u{0.3, -0.2, 0.1, 0.5, -1, 0.7, 1.5, 0.4, -0.6, 0.8, -1.2, 0.9, 0.35};
  Numbers tau{1, 2, -3, 0.4, 0.5, -0.6, 0.7, 0.2, -0.1, 0.3, 0.25, -0.35, 2};
};

Numbers our_accelerations(const Links& links, const Numbers& q, const Numbers& u,
                          const Numbers& tau) {
  const Tree tree(links);
  Kinematics k(tree);
  Articulation a(tree);
  BaseMotion around;
  around.gravity = gravity;
  place(tree, q, u, around, k);
  Numbers rate(u.size());
  EXPECT_TRUE(forward_dynamics(tree, k, tau, a, rate));
  return rate;
}

void expect_near(const Numbers& ours, const Numbers& theirs, double tolerance) {
  ASSERT_EQ(ours.size(), theirs.size());
  double largest = 0;
  for (double x : theirs) largest = std::max(largest, std::abs(x));
  for (std::size_t i = 0; i < ours.size(); ++i)
    EXPECT_NEAR(ours[i], theirs[i], tolerance * largest) << "dof " << i;
}

// By Simbody 3.7.
const Numbers kept{-0.091139613057316771, 0.33753908597179316,  -10.175165675830495,
                   -0.7312120728110072,   -0.56192307972067379, 0.61594994637567879,
                   -3.1334451553370046,   -8.0922968476129427,  -6.4859904390856418,
                   5.5798761367420493,    -2.6399235888763117,  -4.0340526706934954,
                   2.1476287336315503};

TEST(MultibodyReference, every_joint_is_accelerated_as_by_simbody) {
  const ReferenceState s;
  expect_near(our_accelerations(reference_links(), s.q, s.u, s.tau), kept, 1e-13);
}

#ifdef TW_SIMBODY
Numbers their_accelerations(const Links& links, const Numbers& q, const Numbers& u,
                            const Numbers& tau) {
  Numbers rate(u.size());
  make_simbody(links, gravity)->accelerations(q.data(), u.data(), tau.data(), rate.data());
  return rate;
}

TEST(MultibodyReference, simbody_still_says_what_is_kept_here) {
  const ReferenceState s;
  expect_near(their_accelerations(reference_links(), s.q, s.u, s.tau), kept, 1e-13);
}

TEST(MultibodyReference, random_trees_are_accelerated_as_by_simbody) {
  Random random(41);
  for (int round = 0; round < 40; ++round) {
    const int count = 1 + static_cast<int>(random.below(9));
    const Links links = random_links(random, count, false);
    const TreeState s(links, random, false);
    if (s.u.empty()) continue;
    const Numbers tau = random_numbers(random, s.u.size(), 10);
    expect_near(our_accelerations(links, s.q, s.u, tau), their_accelerations(links, s.q, s.u, tau),
                1e-10);
  }
}
#endif

}  // namespace
}  // namespace tw::test
