// What is asked of a pair of arcs, without a world: exact impacts, certificates, clearances.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/random.h"
#include "base/work-count.h"
#include "detect/approach.h"
#include "detect/clearance.h"
#include "detect/dip.h"
#include "detect/exact-impact.h"
#include "support/flyer.h"
#include "timeline/swept-bounds.h"

namespace tw {
namespace {

using test::between;
using test::Flyer;

TEST(Pieces, spheres_that_fall_alike_meet_when_the_quadratic_says) {
  const Flyer a(0, make_sphere(0.5), {0, 0, 0}, {1, 0, 0});
  const Flyer b(1, make_sphere(0.25), {3, 0, 0}, {-1, 0, 0});
  const Piece piece = between(a, b);
  ASSERT_TRUE(predicted_exactly(piece));
  EXPECT_NEAR(exact_impact(piece), (3 - 0.75) / 2, 1e-15);
  EXPECT_NEAR(closing_at(piece, 1, separation_at(piece, 1)), 2, 1e-12);
  EXPECT_NEAR(separation_at(piece, 1).distance, 3 - 0.75 - 2, 1e-15);
}

TEST(Pieces, what_is_carried_is_followed_on_the_grid_and_pressed_by_what_falls) {
  Flyer a(0, make_sphere(0.5), {0, 0, 0}, {0, 0, 0});
  const Flyer b(1, make_sphere(0.5), {0, 0, 1.5}, {0, 0, 0});
  EXPECT_TRUE(predicted_exactly(between(a, b)));
  EXPECT_FALSE(pressed_at(between(a, b), 0, Vec3::UnitZ())) << "both fall alike";
  a.carried();
  EXPECT_FALSE(predicted_exactly(between(a, b)));
  EXPECT_TRUE(pressed_at(between(a, b), 0, Vec3::UnitZ()));
}

// Never after the first overlap, and on the way it comes near to it.
TEST(Pieces, certificates_lead_to_the_impact_and_never_past_it) {
  const Flyer a(0, make_box(Vec3(1, 0.6, 0.4)), {0, 0, 0}, {0.5, 0, 0}, {0.3, -0.2, 0.4});
  const Flyer b(1, make_box(Vec3(0.5, 0.5, 0.5)), {2, 0.1, 0}, {-1, 0, 0.1}, {-0.1, 0.2, 0.1});
  const Piece piece = between(a, b);
  double impact = 0;
  while (separation_at(piece, impact).distance > 0) impact += 1e-4;
  SimplexCaches caches;
  double when = 0;
  for (int i = 0; i < 200; ++i) {
    const double clear = certificate(piece, caches, when, 0);
    ASSERT_LE(clear, impact);
    if (clear - when < 1e-6) break;
    when = clear;
  }
  EXPECT_GT(when, impact - 2e-3);
  EXPECT_EQ(certificate(piece, caches, impact + 0.01, 0), -never);
}

// A warm query may find what the cold one finds at touch apart by the last digit.
TEST(Pieces, what_rounding_parts_is_not_surely_apart) {
  const double edge = 0.011776484121165992;
  for (const double gap : {1e-18, 1e-17, -1e-18}) {
    const Flyer a(0, make_box(Vec3::Constant(edge)), {0, 0, edge / 2}, {0, 0, 0});
    const Flyer b(1, make_box(Vec3::Constant(edge)), {edge + gap, 0, edge / 2}, {1, 0, 0});
    const Piece piece = between(a, b);
    SimplexCaches caches;
    EXPECT_EQ(certificate(piece, caches, 0, 0), -never) << gap;
    Clearance known;
    EXPECT_FALSE(apart_throughout(piece, known, caches, 0, 0.1)) << gap;
    EXPECT_EQ(certificate(piece, caches, 0, answer::depth_slack * edge), never) << gap;
  }
}

// Where their impact is found is known to a few times the rounding of distances: a piece that ends
// within that must not tell another story than one that goes on.
TEST(Pieces, what_is_apart_by_a_few_roundings_is_not_surely_apart_until_soon) {
  const double edge = 0.011776484121165992;
  for (const double roundings : {2.0, 3.0, 8.0, 100.0}) {
    const Flyer a(0, make_box(Vec3::Constant(edge)), {0, 0, edge / 2}, {0, 0, 0});
    Flyer b(1, make_box(Vec3::Constant(edge)), {edge, 0, edge / 2}, {-1e-4, 0, 0});
    b.state.x.x() += roundings * distance_rounding(a.body, a.state.x, b.body, b.state.x);
    let_fly(b.body, b.state);
    SimplexCaches caches;
    Clearance known;
    const bool surely = apart_throughout(between(a, b), known, caches, 0, 1e-15);
    EXPECT_EQ(surely, roundings > 2 * answer::apart_in_roundings) << roundings;
  }
}

TEST(Pieces, a_clearance_once_measured_answers_again_until_something_changes) {
  const Flyer a(0, make_box(Vec3(1, 1, 1)), {0, 0, 0}, {0, 0, 0});
  const Flyer b(1, make_box(Vec3(1, 1, 1)), {1.5, 0, 0}, {-0.1, 0, 0});
  const Piece piece = between(a, b);
  Clearance known;
  SimplexCaches caches;
  const unsigned long long before = work_count.distance_queries;
  EXPECT_TRUE(apart_throughout(piece, known, caches, 0, 0.1));
  EXPECT_EQ(known.until, 0.1);
  const unsigned long long asked = work_count.distance_queries;
  EXPECT_GT(asked, before);
  EXPECT_TRUE(apart_throughout(piece, known, caches, 0.1, 0.2));
  EXPECT_EQ(work_count.distance_queries, asked) << "remembered";
  known.forget_from(0.15);
  EXPECT_TRUE(apart_throughout(piece, known, caches, 0.2, 0.3));
  EXPECT_GT(work_count.distance_queries, asked) << "what was remembered no longer holds";
  EXPECT_FALSE(apart_throughout(piece, known, caches, 0.3, 8));
}

TEST(Pieces, the_swept_box_holds_the_shape_on_its_way) {
  const Flyer a(0, make_box(Vec3(1, 0.6, 0.4)), {0, 0, 0}, {0.5, 0, 3}, {0.3, -0.2, 0.4});
  Flyer still(1, make_box(Vec3(1, 0.6, 0.4)), {1, 2, 3}, {0, 0, 0});
  still.carried();
  for (const Flyer* flyer : {&a, &std::as_const(still)}) {
    Aabb box = swept_bounds(flyer->body, flyer->state.trajectory(), 0.1, 0.9);
    box.grow(1e-14);
    for (int i = 0; i <= 100; ++i) {
      const double time = 0.1 + 0.008 * i;
      const Aabb there = flyer->body.shape_P->bounds(flyer->state.trajectory().frame(time));
      EXPECT_TRUE(box.contains(there.lo) && box.contains(there.hi)) << time;
    }
  }
}

// Two that touch along a line: rounding leaves no plane between them, but nothing moves.
TEST(Certificates, an_overlap_is_told_with_the_bits_of_a_cold_query) {
  for (const double x : {0.9, 0.99, 1.1, 2.0}) {
    const Flyer a(0, make_box(Vec3(1, 1, 1)), {0, 0, 0}, {0, 0, 0});
    const Flyer b(1, make_box(Vec3(1, 1, 1)), {x, 0.1, 0.05}, {-0.1, 0, 0}, {0.1, 0.2, 0.3});
    const Piece piece = between(a, b);
    SimplexCaches caches;
    Certificates certificates(piece, caches, 0.01);
    EXPECT_FALSE(certificates.overlap()) << "nobody has asked";
    const bool apart = certificates.until(0) > -never;
    EXPECT_EQ(apart, x > 1);
    const double distance = separation_at(piece, 0.01).distance;
    EXPECT_EQ(distance_at(piece, 0.01), distance);
    EXPECT_EQ(certificates.overlap(), apart ? std::optional<double>() : distance);
  }
}

TEST(Certificates, what_touches_and_moves_alike_is_apart_for_ever) {
  const ShapePtr drum = make_cylinder(0.25, 0.5);
  const double allowance = 1e-12 * 0.5;
  for (const double speed : {0.0, 3.0}) {
    const Flyer a(0, drum, {0, 0, 0.25}, {speed, 0, speed});
    const Flyer b(1, drum, {0.5, 0, 0.25}, {speed, 0, speed});
    SimplexCaches caches;
    EXPECT_EQ(certificate(between(a, b), caches, 0, allowance), never);
  }
  const Flyer a(0, drum, {0, 0, 0.25}, {0, 0, 0}), b(1, drum, {0.5, 0, 0.25}, {-1e-3, 0, 0});
  SimplexCaches caches;
  EXPECT_LT(certificate(between(a, b), caches, 0, allowance), 1e-9);
}

// Faces, sides and rims that lie almost flat on each other and turn: never past the impact.
TEST(Certificates, planes_that_turn_with_what_is_round_are_never_crossed_before_they_say) {
  Random random(5);
  const auto uniform = [&](double low, double high) { return random.real(low, high); };
  const ShapePtr plate = make_box({2, 1.5, 0.01}), rod = make_box({2, 0.02, 0.02});
  const ShapePtr coin = make_cylinder(1, 0.01), needle = make_cylinder(0.01, 2);
  const ShapePtr cone = make_cone(0.6, 0.3), pill = make_capsule(0.05, 1), ball = make_sphere(0.3);
  const ShapePtr egg = make_ellipsoid({0.8, 0.5, 0.05});
  const std::pair<ShapePtr, ShapePtr> pairs[] = {
      {plate, coin}, {plate, needle}, {plate, cone}, {plate, pill},  {plate, ball},    {plate, egg},
      {rod, coin},   {rod, needle},   {coin, coin},  {coin, needle}, {needle, needle}, {coin, cone},
      {coin, pill},  {coin, ball},    {coin, egg},   {needle, pill}, {cone, cone}};
  int longer = 0;
  for (const auto& [shape_a, shape_b] : pairs)
    for (int i = 0; i < 60; ++i) {
      const auto turn = [&] { return Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); };
      const double tilt = std::pow(10, uniform(-5, -0.3));
      Flyer a(0, shape_a, Vec3::Zero(), 0.1 * turn(), 0.5 * turn());
      Flyer b(1, shape_b, {uniform(-1, 1), uniform(-1, 1), 3}, 0.1 * turn(), 0.5 * turn());
      a.state.q = rotation_by(tilt * turn());
      b.state.q = rotation_by(tilt * turn());
      let_fly(a.body, a.state);
      let_fly(b.body, b.state);
      // let down on the other one but for a hair
      const double gap = std::pow(10, uniform(-9, -3));
      for (int round = 0; round < 60; ++round) {
        const double distance = separation_at(between(a, b), 0).distance;
        if (distance < 2 * gap) break;
        b.state.x.z() -= 0.9 * (distance - gap);
        let_fly(b.body, b.state);
      }
      const Piece piece = between(a, b);
      SimplexCaches caches;
      double when = 0;
      for (int round = 0; round < 4; ++round) {
        const double clear = certificate(piece, caches, when, 0);
        if (!(clear > when)) break;
        const double to = std::min(clear, when + 1);
        for (int k = 1; k <= 16; ++k)
          ASSERT_GT(separation_at(piece, when + (to - when) * k / 16.0001).distance, -1e-12)
              << i << " of " << static_cast<int>(shape_a->part(0).kind) << " and "
              << static_cast<int>(shape_b->part(0).kind);
        longer += to - when > 1e-5;
        when = to;
      }
    }
  EXPECT_GT(longer, 500) << "something is certified";
}

// A coin that lies on a plate but for a micrometre, while both turn about an edge: a plane at rest
// would be crossed by the far end within half a microsecond.
TEST(Certificates, what_lies_on_what_turns_is_apart_for_long) {
  const double gap = 1e-6, spin = 2;
  Flyer plate(0, make_box({2, 2, 0.02}), {0, 0, 0}, Vec3::Zero(), {0, spin * 0.15, 0});
  for (const ShapePtr& shape : {make_cylinder(0.9, 0.02), make_box({1.5, 1.5, 0.02})}) {
    Flyer other(1, shape, {0, 0, 0.02 + gap}, {spin * 0.02, 0, 0}, {0, spin * 0.15, 0});
    SimplexCaches caches;
    EXPECT_GT(certificate(between(plate, other), caches, 0, 0), 1e-4);
  }
}

// Cylinders of 620 m that lean along the plane between them and are near at their ends: of points
// 0.1 um apart the direction is known to 1e-6 only, and far ends reach through the plane square to
// it.
TEST(Certificates, what_stands_side_by_side_is_apart_although_its_normal_is_hardly_known) {
  const double gap = 1e-13, radius = 310.6197153363118;
  const ShapePtr drum = make_cylinder(radius, 2 * radius);
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const auto lean = [&] { return random.real(1e-5, 4e-5) * Vec3::UnitY(); };
    Flyer a(0, drum, {6 * radius, 0, radius + 0.0115}, Vec3::Zero());
    Flyer b(1, drum, {6 * radius + 0.015, 2 * radius + gap, 3 * radius - 0.002}, {0.05, 0, 0});
    a.state.q = rotation_by(lean());
    b.state.q = rotation_by(-lean());
    let_fly(a.body, a.state);
    let_fly(b.body, b.state);
    SimplexCaches caches;
    EXPECT_GT(certificate(between(a, b), caches, 0, 0), 1e-3) << i;
  }
}

// A plate 20 um thick on end, 5 mm above the ground, that turns at 1e5 rad/s: its corners are below
// for some microseconds of every turn of 63, the deepest for a time that is given.
TEST(Dips, what_comes_and_goes_between_two_grid_points_is_seen) {
  Flyer ground(0, make_half_space(Vec3::UnitZ(), 0), Vec3::Zero(), Vec3::Zero());
  ground.body.unbounded = true;
  ground.body.least_width = never;
  ground.carried();
  const double half = 5e-3, turn = 1e5;
  Flyer plate(1, make_box({2 * half, 2 * half, 2e-5}), Vec3(0, 0, 0), Vec3::Zero());
  for (const double lasts : {1e-7, 1e-8}) {
    // a corner of the square face goes round in the plane x-z at this radius
    const double corner = std::sqrt(2.0) * half;
    const double deepest = corner * (1 - std::cos(0.5 * turn * lasts));
    plate.state.x = {0, 0, corner - deepest};
    plate.state.q = Quat(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()));
    // about the plate's own normal, which lies along y
    plate.body.moments = Vec3(1, 1, 1);
    plate.state.L = Vec3(0, turn, 0);
    plate.state.acceleration = Vec3::Zero();
    let_fly(plate.body, plate.state);
    SimplexCaches caches;
    std::uint64_t looks = 0;
    // the corners stand at 45 degrees at the start: an eighth of a turn later one is lowest
    const double lowest = 0.25 * pi / turn;
    const double dip = first_dip(between(ground, plate), caches, 0, 2 * lowest, looks);
    if (deepest > answer::dip_share * 2e-5) {
      EXPECT_NEAR(dip, lowest, 0.5 * lasts) << lasts;
      EXPECT_LT(separation_at(between(ground, plate), dip).distance, 0);
    } else {
      EXPECT_EQ(dip, never) << deepest;
    }
    EXPECT_LT(looks, 300u);
  }
}

}  // namespace
}  // namespace tw
