// Inverse inertias and impulses of multibodies against J M^-1 J^T.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "multibody/accounts.h"
#include "multibody/impulses.h"
#include "multibody/inverse-dynamics.h"
#include "multibody/jacobian.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

using namespace multibody;
using Matrix = Eigen::MatrixXd;

// A random tree, placed and factored, with its dense twin; in every other one joints follow others.
struct Case {
  std::vector<LinkSpec> links;
  TreeState state;
  const Tree& tree = state.tree;
  Kinematics k{tree};
  Articulation a{tree};
  Factored factored{tree, k, a};
  Matrix M{tree.nv(), tree.nv()};
  Matrix T = Matrix::Identity(tree.nv(), tree.nv());  // u = T v

  Case(Random& random, int count)
      : links(random.below(2) == 0 ? random_links(random, count, false)
                                   : with_followers(random_links(random, count, false), random)),
        state(links, random, true) {
    follow_positions(tree, state.q);
    follow(tree, state.u);
    for (const Coupling& c : tree.couplings()) T(c.follower, c.leader) = c.ratio;
    for (const Coupling& c : tree.couplings()) T(c.follower, c.follower) = 0;
    place(tree, state.q, state.u, state.around, k);
    EXPECT_TRUE(factor(tree, k, a));
    InverseDynamics work(tree);
    mass_matrix(tree, k, work, Out(M.data(), static_cast<std::size_t>(M.size())));
  }
  // Of velocity and turn at a point of the link.
  Matrix jacobian(int link, const Vec3& point) const {
    Matrix J(6, tree.nv());
    link_jacobian(tree, k, link, Out(J.data(), static_cast<std::size_t>(J.size())));
    const Vec3 arm = point - link_frame(tree, k, link).p;
    J.topRows<3>() -= cross_matrix(arm) * J.bottomRows<3>();
    return J;
  }
  // Of M, or of T^T M T where some follow.
  Matrix solve(const Matrix& b) const {
    Matrix folded = T.transpose() * M * T;
    for (const Coupling& c : tree.couplings()) folded(c.follower, c.follower) = 1;
    return T * folded.llt().solve(T.transpose() * b);
  }
};

int random_of(Random& random, int count) {
  return static_cast<int>(random.below(static_cast<std::uint64_t>(count)));
}

TEST(MultibodyImpulses, inverse_inertia_is_that_of_the_mass_matrix) {
  Random random(21);
  for (int round = 0; round < 200; ++round) {
    const Case c(random, 9);
    const int a = random_of(random, 9), b = random_of(random, 9);
    const Vec3 at_a = random_vector(random, 2), at_b = random_vector(random, 2);
    const Matrix Ja = c.jacobian(a, at_a), Jb = c.jacobian(b, at_b);
    const Matrix aa = Ja * c.solve(Ja.transpose()), ab = Ja * c.solve(Jb.transpose());
    const Matrix bb = Jb * c.solve(Jb.transpose());
    const double scale = 1e-12 * (aa.norm() + bb.norm() + 1);
    EXPECT_LT((spatial_inverse_inertia(c.factored, a, at_a) - aa).norm(), scale);
    EXPECT_LT((inverse_inertia(c.factored, a, at_a) - aa.topLeftCorner<3, 3>()).norm(), scale);
    const InverseInertias K = inverse_inertias(c.factored, a, at_a, b, at_b);
    EXPECT_LT((K.aa - aa.topLeftCorner<3, 3>()).norm(), scale);
    EXPECT_LT((K.ab - ab.topLeftCorner<3, 3>()).norm(), scale);
    EXPECT_LT((K.bb - bb.topLeftCorner<3, 3>()).norm(), scale);
    const int n = c.tree.nv();
    if (n == 0) continue;
    const int dof = random_of(random, n);
    const double inverse = c.solve(Matrix::Identity(n, n))(dof, dof);
    EXPECT_NEAR(inverse_inertia_of_dof(c.factored, dof), inverse, 1e-12 * (1 + inverse));
  }
}

TEST(MultibodyImpulses, velocities_change_as_by_the_mass_matrix) {
  Random random(22);
  for (int round = 0; round < 200; ++round) {
    const Case c(random, 9);
    std::vector<LinkImpulse> impulses(2);
    Numbers given = random_numbers(random, c.state.u.size(), 1);
    Column sum = column(given);
    for (LinkImpulse& p : impulses) {
      p.link = random_of(random, 9);
      p.point = random_vector(random, 2);
      p.linear = random_vector(random, 2);
      p.angular = random_vector(random, 2);
      sum += c.jacobian(p.link, p.point).transpose() * (Vec6() << p.linear, p.angular).finished();
    }
    ImpulseWork work(c.tree);
    velocity_change(c.factored, impulses, given, work, given);
    const Column expected = c.solve(sum);
    EXPECT_LT((column(given) - expected).norm(), 1e-12 * (1 + expected.norm()));
  }
}

// As a tree whose joints follow none, pulled at by what holds them.
TEST(MultibodyImpulses, joints_that_follow_are_accelerated_as_one) {
  Random random(23);
  int followers = 0;
  for (int round = 0; round < 200; ++round) {
    Case c(random, 9);
    followers += static_cast<int>(c.tree.couplings().size());
    std::vector<LinkSpec> alone = c.links;
    for (LinkSpec& link : alone) link.joint.follows.reset();
    const Tree free(alone);
    Kinematics k(free);
    Articulation a(free);
    place(free, c.state.q, c.state.u, c.state.around, k);
    const Numbers tau = random_numbers(random, c.state.u.size(), 5);
    Numbers rate = c.state.zeros(), together = rate;
    ASSERT_TRUE(forward_dynamics(free, k, tau, a, rate));
    ASSERT_TRUE(forward_dynamics(c.tree, c.k, tau, c.a, together));
    const Column expected = c.solve(c.M * column(rate));
    EXPECT_LT((column(together) - expected).norm(), 1e-11 * (1 + expected.norm()));
    for (const Coupling& coupling : c.tree.couplings())
      EXPECT_EQ(together[static_cast<std::size_t>(coupling.follower)],
                coupling.ratio * together[static_cast<std::size_t>(coupling.leader)]);
  }
  EXPECT_GT(followers, 100);
}

TEST(MultibodyImpulses, a_free_body_has_the_inverse_inertia_of_a_body) {
  LinkSpec body;
  body.name = "body";
  body.joint.kind = JointKind::free;
  body.mass = 2;
  body.center_of_mass = {0.3, -0.1, 0.2};
  body.inertia = Vec3(0.2, 0.3, 0.4).asDiagonal();
  const Tree tree({body});
  Kinematics k(tree);
  Articulation a(tree);
  const Numbers q{1, 2, 3, 1, 0, 0, 0}, u(6);
  place(tree, q, u, {}, k);
  ASSERT_TRUE(factor(tree, k, a));
  const Vec3 point(1.5, 2, 3.5), r = point - Vec3(1.3, 1.9, 3.2);
  const Mat3 arm = cross_matrix(r), inverse = body.inertia.inverse();
  const Mat3 K = Mat3::Identity() / 2 - arm * inverse * arm;
  EXPECT_LT((inverse_inertia({tree, k, a}, 0, point) - K).norm(), 1e-14);
}

// Chains of parallel hinges: what a point can do lies in a plane.
TEST(MultibodyImpulses, inverse_inertia_of_planar_chains_is_exactly_singular_across) {
  for (int count : {1, 2, 4}) {
    std::vector<LinkSpec> links;
    for (int i = 0; i < count; ++i) {
      LinkSpec link;
      link.name = std::to_string(i);
      if (i > 0) link.parent = std::to_string(i - 1);
      link.joint.placement.p = {i > 0 ? 1.0 : 0.0, 0, 0};
      link.mass = 1;
      link.center_of_mass = {0.5, 0, 0};
      link.inertia = Vec3(0.001, 0.08, 0.08).asDiagonal();
      links.push_back(link);
    }
    const Tree tree(links);
    Kinematics k(tree);
    Articulation a(tree);
    const Numbers q(links.size(), 0.4), u(links.size());
    place(tree, q, u, {}, k);
    ASSERT_TRUE(factor(tree, k, a));
    const Frame end = link_frame(tree, k, count - 1);
    const Mat3 K = inverse_inertia({tree, k, a}, count - 1, end * Vec3(1, 0, 0.2));
    EXPECT_LT(K.col(2).norm() + K.row(2).norm(), 1e-13 * K.trace());
    const Vec3 values = Eigen::SelfAdjointEigenSolver<Mat3>(K).eigenvalues();
    EXPECT_GT(values[0], -1e-13 * values[2]);
    EXPECT_EQ((values.array() > 1e-10 * values[2]).count(), std::min(count, 2));
  }
}

TEST(MultibodyImpulses, equal_and_opposite_impulses_keep_the_momentum_of_what_floats) {
  Random random(23);
  for (int round = 0; round < 50; ++round) {
    std::vector<LinkSpec> links = random_links(random, 8, false);
    links[0].joint.kind = JointKind::free;
    TreeState s(links, random, false);
    Kinematics k(s.tree);
    Articulation a(s.tree);
    place(s.tree, s.q, s.u, s.around, k);
    ASSERT_TRUE(factor(s.tree, k, a));
    const Vec3 before = momentum(s.tree, k), spin = angular_momentum(s.tree, k, Vec3::Zero());
    const Vec3 point = random_vector(random, 2), p = random_vector(random, 3);
    std::vector<LinkImpulse> impulses(2);
    impulses[0] = {random_of(random, 8), point, p, Vec3::Zero()};
    impulses[1] = {random_of(random, 8), point, -p, Vec3::Zero()};
    ImpulseWork work(s.tree);
    Numbers du = s.zeros();
    velocity_change({s.tree, k, a}, impulses, {}, work, du);
    for (std::size_t i = 0; i < du.size(); ++i) s.u[i] += du[i];
    place(s.tree, s.q, s.u, s.around, k);
    EXPECT_LT((momentum(s.tree, k) - before).norm(), 1e-12 * (10 + before.norm()));
    EXPECT_LT((angular_momentum(s.tree, k, Vec3::Zero()) - spin).norm(),
              1e-12 * (10 + spin.norm()));
  }
}

}  // namespace
}  // namespace tw::test
