// What an arc keeps of joints: its bounds hold, whatever stretch is asked for.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/arc/joint-record.h"

#include <gtest/gtest.h>

#include "integrate/given/keyframes.h"
#include "multibody/coordinates.h"
#include "support/motions.h"
#include "support/random-tree.h"
#include "support/scene.h"

namespace tw::test {
namespace {

using namespace multibody;

// A multibody of random links, each with its principal frame at its centre of mass.
Multibody random_multibody(Random& random, int links) {
  const Tree tree(random_links(random, links, false));
  Multibody multibody{0, "tree", {}, tree, {}, {}, {}, true, nullptr, {}};
  for (int i = 0; i < links; ++i) {
    multibody.links.push_back(static_cast<BodyId>(i));
    multibody.principal.push_back({tree.link(i).center_of_mass, random_attitude(random)});
  }
  return multibody;
}

// Steps whose displacements and velocities are random polynomials, the latter those that belong to
// the former where joints are scalars.
JointRecord random_record(Random& random, const Multibody& multibody, Numbers& nodes) {
  constexpr int degree = 5, steps = 3;
  const Tree& tree = multibody.tree;
  const auto n = static_cast<std::size_t>(tree.nv());
  Numbers q(static_cast<std::size_t>(tree.nq()));
  neutral_position(tree, q);
  JointRecord record(multibody, 0, never, q, Numbers(n), degree);
  double time = 0;
  for (int step = 0; step < steps; ++step) {
    const double length = random.real(0.05, 0.2);
    Numbers coefficients(2 * n * (degree + 1)), end(n);
    for (std::size_t e = 0; e < n; ++e)
      for (std::size_t k = 1; k <= degree; ++k) {
        const double c = random.real(-0.3, 0.3) / static_cast<double>(k * k);
        coefficients[2 * n * k + e] = c;
        coefficients[2 * n * (k - 1) + n + e] = static_cast<double>(k) * c / length;
        end[e] += c;
      }
    displace(tree, q, end, q);
    normalize(tree, q);
    time += length;
    record.append(time, coefficients, q);
    nodes.push_back(time);
  }
  return record;
}

void expect_bounds(Random& random, const TrajectoryPtr& base) {
  for (int trial = 0; trial < 60; ++trial) {
    Multibody multibody = random_multibody(random, 5);
    multibody.base_motion = base;
    multibody.base_in_motion = {random_vector(random, 0.5), random_attitude(random)};
    Numbers nodes;
    const JointRecord record = random_record(random, multibody, nodes);
    for (int i = 0; i < 12; ++i) {
      const int link = static_cast<int>(random.below(5));
      const double a = random.real(0, record.reached()), b = random.real(0, record.reached());
      const double from = std::min(a, b);
      // some are short against a step
      const double to = i % 3 == 0 ? from + 0.02 * (record.reached() - from) : std::max(a, b);
      const MotionBounds bounds = record.bounds(link, from, to);
      constexpr int samples = 40;
      for (int k = 1; k < samples; ++k) {
        const double when = from + (to - from) * k / samples, apart = 1e-7 * (to - from);
        // velocities of these steps differ where they meet
        if (std::any_of(nodes.begin(), nodes.end(),
                        [&](double node) { return std::abs(node - when) <= apart; }))
          continue;
        const Twist here = record.rates(link, when);
        const Twist left = record.rates(link, when - apart),
                    right = record.rates(link, when + apart);
        const Vec3 acceleration = (right.v - left.v) / (2 * apart);
        const double turn_change = (right.w - left.w).norm() / (2 * apart);
        const Vec3 x = record.pose(link, when).p;
        ASSERT_TRUE(((x - bounds.path.lo).array() >= -1e-12).all() &&
                    ((bounds.path.hi - x).array() >= -1e-12).all())
            << trial;
        ASSERT_LE(here.v.norm(), bounds.speed * (1 + 1e-9) + 1e-12);
        ASSERT_LE(here.w.norm(), bounds.turn * (1 + 1e-9) + 1e-12);
        const double slack = 1e-4 * (1 + acceleration.norm());
        ASSERT_LE(turn_change, bounds.turn_change * (1 + 1e-4) + 1e-4);
        ASSERT_TRUE(((acceleration - bounds.acceleration.lo).array() >= -slack).all() &&
                    ((bounds.acceleration.hi - acceleration).array() >= -slack).all())
            << trial << " " << acceleration.transpose();
      }
    }
  }
}

TEST(JointRecord, bounds_hold) {
  Random random(7);
  expect_bounds(random, nullptr);
}

TEST(JointRecord, bounds_hold_on_bases_that_move) {
  Random random(8);
  std::vector<Keyframe> frames;
  for (int i = 0; i < 4; ++i)
    frames.push_back({0.3 * i - 0.1, random_vector(random, 0.3), random_attitude(random)});
  expect_bounds(random, make_keyframes(frames, true));
  const Sampled circling([](double t) {
    return Pose{{std::cos(3 * t), std::sin(3 * t), 0}, rotation_by(Vec3(0, std::sin(4 * t), t))};
  });
  expect_bounds(random, circling.motion);
}

}  // namespace
}  // namespace tw::test
