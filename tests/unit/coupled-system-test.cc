// Groups with multibodies: stages against the derivative by differences, on random trees that
// springs, holds and a contact tie to each other and to bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "integrate/implicit/group-system.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

Bond random_bond(Random& random, bool holds) {
  Bond bond;
  bond.arm_a = random_vector(random, 0.4);
  bond.arm_b = random_vector(random, 0.4);
  bond.spring = {40, 3, holds ? 0 : 0.5};
  bond.holds = holds;
  if (holds) bond.turn = {6, 0.5, random_attitude(random)};
  return bond;
}

// A tree of `links` becomes the next one of the arc, its links the next members.
void add_tree(GroupStart& start, Random& random, int links) {
  const TreeState drawn(random_links(random, links, true), random, false);
  auto multibody = std::make_shared<Multibody>(
      Multibody{0, "tree", {}, drawn.tree, Frame(), {}, {}, false, nullptr, {}});
  auto state = std::make_shared<MultibodyState>();
  state->q = drawn.q;
  state->u = drawn.u;
  GroupTree tree{multibody, nullptr, {0, 0, -9.81}, {}, {}};
  for (int i = 0; i < links; ++i) {
    multibody->principal.push_back({drawn.tree.link(i).center_of_mass, random_attitude(random)});
    tree.members.push_back(static_cast<int>(start.members.size()));
    tree.forces.push_back(random_vector(random, 2));
    GroupMember member;
    member.tree = static_cast<int>(start.trees.size());
    member.link = i;
    start.members.push_back(member);
  }
  tree.state = state;
  start.trees.push_back(tree);
}

// Two trees and a body; each is tied to the next, two links of the first tree to each other, and
// the body lies deep in a plane of a link.
GroupStart random_group(Random& random) {
  GroupStart start;
  start.end = 1;
  add_tree(start, random, 5);
  add_tree(start, random, 3);
  GroupMember body;
  body.moments = {0.1, 0.2, 0.25};
  body.q = random_attitude(random);
  body.x = random_vector(random, 1);
  body.v = random_vector(random, 1);
  body.L = random_vector(random, 0.3);
  start.members.push_back(body);
  const int ties[][2] = {{1, 4}, {2, 6}, {8, 5}, {3, 8}};
  for (const auto& [a, b] : ties)
    start.bonds.push_back({a, b, std::make_shared<Bond>(random_bond(random, a % 2))});
  GroupContact contact;
  contact.a = 4;
  contact.b = 8;
  contact.normal = random_vector(random, 1).normalized();
  contact.radius_b = 20;
  contact.law.k = 50;
  contact.law.hardening = 100;
  contact.law.b = 0.1;
  contact.law.size = 0.5;
  contact.law.kt = 40;
  contact.law.ct = 5;
  contact.law.mu = 1000;
  start.contacts.push_back(contact);
  return start;
}

struct Bench {
  explicit Bench(const GroupStart& start) : system(start) {
    const std::size_t slots = static_cast<std::size_t>(system.contact_packs().slots);
    scratch.members.resize(static_cast<std::size_t>(system.members()));
    scratch.bodies.resize(slots);
    scratch.changes.resize(slots);
    scratch.wrenches.resize(slots);
    scratch.linear.resize(static_cast<std::size_t>(system.packs()));
    scratch.sides.resize(static_cast<std::size_t>(system.packs()));
    scratch.right_side.resize(system.unknowns());
    y = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system.size()));
    const GroupMember& body = start.members.back();
    const Eigen::Index at = 12 * static_cast<Eigen::Index>(start.members.size() - 1);
    y.segment<3>(at) = body.x;
    y.segment<3>(at + 6) = body.v;
    y.segment<3>(at + 9) = body.L;
    counts.assign(system.size(), true);
    std::fill_n(counts.begin(), at, false);
    for (std::size_t t = 0; t < start.trees.size(); ++t) {
      const Numbers& u = start.trees[t].state->u;
      system.trees()[t]->set_positions(start.trees[t].state->q);
      std::copy(u.begin(), u.end(), y.data() + system.tree_row(t) + u.size());
    }
  }
  Eigen::VectorXd slope(const Eigen::VectorXd& state) {
    Eigen::VectorXd f(state.size());
    system.evaluate(0, state.data(), scratch, f.data());
    return f;
  }
  GroupSystem system;
  GroupScratch scratch;
  Eigen::VectorXd y;
  std::vector<bool> counts;  // which of them mean something
};

Eigen::MatrixXd differences(Bench& bench) {
  const Eigen::Index size = bench.y.size();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    if (!bench.counts[static_cast<std::size_t>(j)]) continue;
    const double d = 1e-4;
    Eigen::VectorXd y = bench.y;
    const auto at = [&](double by) {
      y[j] = bench.y[j] + by * d;
      return bench.slope(y);
    };
    J.col(j) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * d);
  }
  return J;
}

TEST(CoupledSystem, stage_solution_satisfies_the_differenced_jacobian) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const GroupStart start = random_group(random);
    Bench bench(start);
    Eigen::VectorXd f(bench.y.size());
    bench.system.linearise(0, bench.y.data(), bench.scratch, f.data());
    const Eigen::MatrixXd J = differences(bench);
    for (const double sigma : {30.0, 3000.0}) {
      ASSERT_TRUE(bench.system.factor(sigma, bench.scratch));
      Eigen::VectorXd r = Eigen::VectorXd::Zero(bench.y.size());
      for (Eigen::Index j = 0; j < r.size(); ++j)
        if (bench.counts[static_cast<std::size_t>(j)]) r[j] = random.real(-1, 1);
      // of the pack's four lanes one has a contact
      const Eigen::Index pack = 12 * static_cast<Eigen::Index>(start.members.size());
      for (Eigen::Index j = 0; j < 12; ++j)
        if (j % lane_count != 0) r[pack + j] = 0;
      Eigen::VectorXd k = r;
      ASSERT_TRUE(bench.system.solve(bench.scratch, k.data()));
      k.head(pack - 12).setZero();
      Eigen::VectorXd residual = sigma * k - J * k - r;
      residual.head(pack - 12).setZero();
      const double scale = (J.cwiseAbs() * k.cwiseAbs()).maxCoeff() + r.cwiseAbs().maxCoeff();
      EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-7 * scale) << "case " << i << ", " << sigma;
    }
  }
}

}  // namespace
}  // namespace tw::test
