// What is asked of a pair of arcs, without a world: exact impacts, certificates, clearances.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "detect/approach.h"
#include "detect/clearance.h"
#include "detect/exact-impact.h"
#include "integrate/standing.h"
#include "timeline/successor.h"
#include "timeline/swept-bounds.h"

namespace tw {
namespace {

// One of a pair, and its state: it flies from time 0 on.
struct Flyer {
  Body body;
  State state;

  Flyer(BodyId id, ShapePtr shape, const Vec3& x, const Vec3& v, const Vec3& L = Vec3::Zero()) {
    body.info.id = id;
    body.mass = 1;
    body.moments = Vec3(0.1, 0.15, 0.2);
    body.turn_excess = 1;
    body.shape_P = shape;
    body.radius = shape->radius_about_origin();
    body.least_width = shape->least_width();
    const ConvexPart& part = shape->parts().front();
    if (part.kind == PartKind::sphere) body.sphere_radius = part.radius;
    state.x = x;
    state.v = v;
    state.L = L;
    state.acceleration = Vec3(0, 0, -9.81);
    let_fly(body, state);
  }
  Flyer& carried() {
    state.follows = make_resting({state.x, state.q});
    return *this;
  }
};

Piece between(const Flyer& a, const Flyer& b) {
  Piece piece;
  piece.a = &a.state;
  piece.b = &b.state;
  piece.body_a = &a.body;
  piece.body_b = &b.body;
  piece.end = last_key;
  return piece;
}

TEST(Pieces, spheres_that_fall_alike_meet_when_the_quadratic_says) {
  const Flyer a(0, make_sphere(0.5), {0, 0, 0}, {1, 0, 0});
  const Flyer b(1, make_sphere(0.25), {3, 0, 0}, {-1, 0, 0});
  const Piece piece = between(a, b);
  ASSERT_TRUE(predicted_exactly(piece));
  EXPECT_NEAR(exact_impact(piece), (3 - 0.75) / 2, 1e-15);
  EXPECT_TRUE(approaching_at(piece, 1));
  EXPECT_NEAR(separation_at(piece, 1).distance, 3 - 0.75 - 2, 1e-15);
}

TEST(Pieces, what_is_carried_is_followed_on_the_grid_and_pressed_by_what_falls) {
  Flyer a(0, make_sphere(0.5), {0, 0, 0}, {0, 0, 0});
  const Flyer b(1, make_sphere(0.5), {0, 0, 1.5}, {0, 0, 0});
  EXPECT_TRUE(predicted_exactly(between(a, b)));
  EXPECT_FALSE(pressed_at(between(a, b), Vec3::UnitZ())) << "both fall alike";
  a.carried();
  EXPECT_FALSE(predicted_exactly(between(a, b)));
  EXPECT_TRUE(pressed_at(between(a, b), Vec3::UnitZ()));
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

TEST(Pieces, a_clearance_once_measured_answers_again_until_something_changes) {
  const Flyer a(0, make_box(Vec3(1, 1, 1)), {0, 0, 0}, {0, 0, 0});
  const Flyer b(1, make_box(Vec3(1, 1, 1)), {1.5, 0, 0}, {-0.1, 0, 0});
  const Piece piece = between(a, b);
  Clearance known;
  SimplexCaches caches;
  const unsigned long long before = distance_queries;
  EXPECT_TRUE(apart_throughout(piece, known, caches, 0, 0.1));
  EXPECT_EQ(known.until, 0.1);
  const unsigned long long asked = distance_queries;
  EXPECT_GT(asked, before);
  EXPECT_TRUE(apart_throughout(piece, known, caches, 0.1, 0.2));
  EXPECT_EQ(distance_queries, asked) << "remembered";
  known.forget_from(0.15);
  EXPECT_TRUE(apart_throughout(piece, known, caches, 0.2, 0.3));
  EXPECT_GT(distance_queries, asked) << "what was remembered no longer holds";
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

}  // namespace
}  // namespace tw
