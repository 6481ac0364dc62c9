// Contact manifolds of round shapes: lying, standing, rolling, on edges and on each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <set>

#include "base/constants.h"
#include "collision/distance/separation.h"
#include "collision/manifold/manifold.h"
#include "convex-oracles.h"
#include "groups/contacts/followed-contact.h"
#include "integrate/arc/group-arc.h"
#include "integrate/standing.h"

namespace tw::test {
namespace {

using Points = std::vector<ManifoldPoint>;

Points manifold_of(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b, const Frame& frame_b,
                   double reach) {
  Points points;
  manifold(*a, frame_a, *b, frame_b, reach, points);
  return points;
}

Frame turned(const Vec3& rotation, const Vec3& position) {
  return Frame(rotation_by(rotation).toRotationMatrix(), position);
}

double gap_by_feature(const ManifoldPoint& p) {
  const Vec3 r = p.core_point - p.reference_point;
  // of ellipsoids the balls that osculate them
  const Vec3 across = r - p.direction * p.direction.dot(r);
  const double radii = p.reference_radius + p.radius;
  if (p.kind == ContactFeature::plane || p.kind == ContactFeature::tangent_plane)
    return p.normal.dot(r) - p.radius;
  if (p.kind == ContactFeature::rim || p.kind == ContactFeature::crossing) {
    Vec3 line = p.other_direction;
    if (p.kind == ContactFeature::rim) {
      EXPECT_NEAR((p.core_point - p.rim_center).norm(), p.rim, 1e-12);
      line = p.other_direction.cross(p.core_point - p.rim_center);
    }
    const Vec3 normal = p.direction.cross(line).normalized();
    return (normal.dot(p.normal) < 0 ? -normal : normal).dot(r) - radii;
  }
  return (p.kind == ContactFeature::point ? r : across).norm() - radii;
}

const ShapePtr ground = make_half_space({0, 0, 1}, 0);

TEST(RoundManifold, the_deepest_point_is_as_deep_as_the_shapes_and_follows_from_its_features) {
  Engine random(1);
  std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  zoo.push_back(make_sphere(0.4));
  zoo.push_back(make_half_space({1, 2, 3}, 0.1));
  const std::vector<ShapePtr> round = {make_cylinder(0.5, 1),
                                       make_cylinder(0.5, 0.05),
                                       make_cylinder(0.03, 1.5),
                                       make_capsule(0.2, 1),
                                       make_cone(0.5, 1),
                                       make_cone(0.05, 1),
                                       make_ellipsoid({0.5, 0.3, 0.2}),
                                       make_ellipsoid({0.6, 0.6, 0.1})};
  zoo.insert(zoo.end(), round.begin(), round.end());
  int poses = 0;
  for (int i = 0; i < 100; ++i)
    for (const ShapePtr& a : round)
      for (const ShapePtr& b : zoo) {
        const Frame frame_a = random_frame(random, 1);
        Frame frame_b = random_frame(random, 1);
        if (b->is_half_space()) frame_b.R = frame_a.R * Mat3(frame_b.R);
        frame_b.p = frame_a.p + 4 * random_direction(random);
        const double depth = (i % 3 == 0 ? -1 : 1) * std::pow(10, uniform(random, -6, -3));
        const Separation far = separation(*a, frame_a, *b, frame_b);
        frame_b.p -= (far.distance + depth) * far.normal;
        const Separation s = separation(*a, frame_a, *b, frame_b);
        for (bool swap : {false, true}) {
          const Points points = swap ? manifold_of(b, frame_b, a, frame_a, 0.01)
                                     : manifold_of(a, frame_a, b, frame_b, 0.01);
          ASSERT_FALSE(points.empty())
              << a->kind_name() << " " << b->kind_name() << " at " << s.distance;
          ASSERT_LE(points.size(), patch::most_points);
          double least = 1e300;
          std::set<std::uint64_t> names;
          for (const ManifoldPoint& p : points) {
            least = std::min(least, p.gap);
            names.insert(p.feature);
            ASSERT_NEAR(p.gap, gap_by_feature(p), 1e-10) << a->kind_name() << " " << b->kind_name();
            ASSERT_GT((p.reference_is_a != swap ? 1 : -1) * p.normal.dot(s.normal), 0.99)
                << a->kind_name() << " " << b->kind_name() << " at " << s.distance << " by "
                << static_cast<int>(p.kind);
          }
          ASSERT_EQ(names.size(), points.size());
          ASSERT_NEAR(least, s.distance, 2e-3 * std::abs(s.distance) + 5e-6)
              << a->kind_name() << " " << b->kind_name();
          ++poses;
        }
      }
  EXPECT_GT(poses, 5000);
}

TEST(CylinderManifold, lying_it_has_the_ends_of_its_axis_and_rolling_leaves_them_exact) {
  const ShapePtr log = make_cylinder(0.2, 1);
  const ShapePtr table = make_box({4, 4, 1});
  for (double roll : {0.0, 0.3, 2.0}) {
    const Frame lying(rotation_by({0, pi / 2, 0}).toRotationMatrix() *
                          rotation_by({0, 0, roll}).toRotationMatrix(),
                      {0, 0, 0.2 - 1e-4});
    const Frame below(Mat3::Identity(), {0, 0, -0.5});
    for (const Points& points : {manifold_of(ground, Frame(), log, lying, 0.01),
                                 manifold_of(table, below, log, lying, 0.01)}) {
      ASSERT_EQ(points.size(), 2u);
      for (const ManifoldPoint& p : points) {
        EXPECT_EQ(p.kind, ContactFeature::tangent_plane);
        EXPECT_NEAR(p.gap, -1e-4, 1e-15);
        EXPECT_NEAR(p.radius, 0.2, 1e-15);
        EXPECT_NEAR((p.core_point.cwiseAbs() - Vec3(0.5, 0, 0.2 - 1e-4)).norm(), 0, 1e-15);
      }
    }
  }
}

TEST(CylinderManifold, tilted_its_gaps_are_exact_and_stay_while_it_spins) {
  Engine random(2);
  const ShapePtr coin = make_cylinder(0.3, 0.1);
  for (int i = 0; i < 300; ++i) {
    const double tilt = std::pow(10, uniform(random, -3.5, 0.19));
    const Frame frame = turned({tilt, 0, 0}, {0, 0, uniform(random, 0.05, 0.3)});
    const double truth = separation(*ground, Frame(), *coin, frame).distance;
    const Points points = manifold_of(ground, Frame(), coin, frame, 1);
    double least = 1e300;
    const ManifoldPoint* lowest = nullptr;
    for (const ManifoldPoint& p : points)
      if (p.gap < least) {
        least = p.gap;
        lowest = &p;
      }
    ASSERT_NEAR(least, truth, 1e-10) << tilt;
    // the core is on the axis (far up where it stands): spinning does not move it
    const Vec3 local = frame.to_local(lowest->core_point);
    ASSERT_NEAR(local.head<2>().norm(), 0, 1e-9 * lowest->radius);
    // nodding by a little lowers the rim as the ball says, to second order
    const Frame nodded(rotation_by({1e-5, 0, 0}).toRotationMatrix() * frame.R, frame.p);
    const double ball = (nodded * local).z() - lowest->radius;
    ASSERT_NEAR(ball, separation(*ground, Frame(), *coin, nodded).distance,
                1e-10 * (1 + lowest->radius));
  }
}

TEST(CylinderManifold, standing_it_has_eight_points_fixed_in_it) {
  const ShapePtr can = make_cylinder(0.3, 0.8);
  const Points flat =
      manifold_of(ground, Frame(), can, turned({0, 0, 0.3}, {0, 0, 0.4 - 1e-4}), 0.01);
  ASSERT_EQ(flat.size(), 8u);
  for (const ManifoldPoint& p : flat) {
    EXPECT_EQ(p.radius, 0);
    EXPECT_NEAR(p.gap, -1e-4, 1e-15);
    EXPECT_NEAR(p.core_point.head<2>().norm(), 0.3, 1e-15);
  }
  // their names stay while it rocks a little
  const Points rocked =
      manifold_of(ground, Frame(), can, turned({1e-4, 1e-4, 0.3}, {0, 0, 0.4 - 1e-4}), 0.01);
  ASSERT_EQ(rocked.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(rocked[i].feature, flat[i].feature);
}

TEST(CylinderManifold, over_the_edge_of_a_table_only_what_is_over_it_carries) {
  const ShapePtr table = make_box({1, 1, 1});
  const ShapePtr log = make_cylinder(0.1, 1);
  const Frame lying = turned({0, pi / 2, 0}, {0.3, 0, 0.6 - 1e-4});
  const Points points = manifold_of(table, Frame(), log, lying, 0.01);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(std::min(points[0].core_point.x(), points[1].core_point.x()), -0.2, 1e-12);
  EXPECT_NEAR(std::max(points[0].core_point.x(), points[1].core_point.x()), 0.5, 1e-12);
  // a can on a box narrower than itself stands on the box's corners
  const ShapePtr post = make_box({0.2, 0.2, 1});
  const ShapePtr can = make_cylinder(0.3, 0.8);
  const Points corners =
      manifold_of(post, Frame(), can, turned({0, 0, 0}, {0, 0, 0.9 - 1e-4}), 0.01);
  Aabb support;
  for (const ManifoldPoint& p : corners) support.add(p.core_point);
  EXPECT_NEAR(support.size().x(), 0.2, 1e-12);
  EXPECT_NEAR(support.size().y(), 0.2, 1e-12);
}

TEST(CylinderManifold, a_log_along_an_edge_has_two_points_and_across_it_one) {
  const ShapePtr box = make_box({1, 1, 1});
  const ShapePtr log = make_cylinder(0.1, 0.6);
  // beside the edge along x through (., 0.5, 0.5)
  const Vec3 out(0, std::sqrt(0.5), std::sqrt(0.5));
  const Vec3 place = Vec3(0.4, 0.5, 0.5) + (0.1 - 1e-4) * out;
  const Points along = manifold_of(box, Frame(), log, turned({0, pi / 2, 0}, place), 0.01);
  ASSERT_EQ(along.size(), 2u);
  for (const ManifoldPoint& p : along) {
    EXPECT_EQ(p.kind, ContactFeature::line);
    EXPECT_FALSE(p.reference_is_a);
    EXPECT_EQ(p.reference_radius, 0.1);
    EXPECT_NEAR(p.gap, -1e-4, 1e-12);
  }
  EXPECT_NEAR(std::abs(along[0].core_point.x() - along[1].core_point.x()), 0.4, 1e-12);
  Frame across = turned({pi / 4, 0, 0}, Vec3(0.1, 0.5, 0.5) + (0.1 - 1e-4) * out);
  const Points one = manifold_of(box, Frame(), log, across, 0.01);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].kind, ContactFeature::crossing);
  EXPECT_NEAR((one[0].core_point - Vec3(0.1, 0.5, 0.5)).norm(), 0, 1e-6);
}

// Askew by 0.3 to 5 degrees what is short touches along much of what it shares with the edge: two
// points, exact where they are, and no shallower than the deepest by more than a weight presses; a
// needle has one.
TEST(CylinderManifold, a_log_askew_on_an_edge_has_two_points_and_a_needle_one) {
  const ShapePtr box = make_box({1, 1, 1});
  const double radius = 0.2;
  const ShapePtr log = make_cylinder(radius, 0.4), needle = make_cylinder(1e-3, 0.4);
  const Vec3 out(0, std::sqrt(0.5), std::sqrt(0.5));
  for (const double askew : {0.005, 0.01, 0.02, 0.05, 0.09}) {
    Frame frame = turned({0, pi / 2, 0}, Vec3(0, 0.5, 0.5) + (radius - 1e-4) * out);
    frame.R = rotation_by(askew * out).toRotationMatrix() * frame.R;
    const double deepest = separation(*box, Frame(), *log, frame).distance;
    const Points two = manifold_of(box, Frame(), log, frame, 0.01);
    ASSERT_EQ(two.size(), 2u) << askew;
    EXPECT_GT((two[0].core_point - two[1].core_point).norm(), 0.03) << askew;
    for (const ManifoldPoint& p : two) {
      EXPECT_EQ(p.kind, ContactFeature::line);
      EXPECT_NEAR(p.gap, gap_by_feature(p), 1e-12);
      EXPECT_GE(p.gap, deepest - 1e-12) << askew;
      EXPECT_LE(p.gap, deepest + 1.001 * patch::missed_along * radius) << askew;
      EXPECT_NEAR(p.core_point.y(), 0.5, 1e-12) << "on the edge";
    }
    frame.p = Vec3(0, 0.5, 0.5) + (1e-3 - 1e-6) * out;
    EXPECT_EQ(manifold_of(box, Frame(), needle, frame, 0.01).size(), 1u) << askew;
  }
}

TEST(CylinderManifold, logs_side_by_side_have_two_points_crossed_ones_one_stacked_cans_eight) {
  const ShapePtr log = make_cylinder(0.1, 1);
  const Points beside =
      manifold_of(log, Frame(), log, turned({0, 0, 0}, {0.2 - 1e-4, 0, 0.3}), 0.01);
  ASSERT_EQ(beside.size(), 2u);
  for (const ManifoldPoint& p : beside) {
    EXPECT_EQ(p.kind, ContactFeature::line);
    EXPECT_NEAR(p.gap, -1e-4, 1e-14);
    EXPECT_EQ(p.radius, 0.1);
    EXPECT_EQ(p.reference_radius, 0.1);
  }
  const Points crossed =
      manifold_of(log, Frame(), log, turned({1, 0, 0}, {0.2 - 1e-4, 0, 0}), 0.01);
  ASSERT_EQ(crossed.size(), 1u);
  EXPECT_EQ(crossed[0].kind, ContactFeature::crossing);
  EXPECT_NEAR(crossed[0].gap, -1e-4, 1e-12);
  EXPECT_NEAR((crossed[0].core_point - Vec3(0.2 - 1e-4, 0, 0)).norm(), 0, 1e-6);
  const Points stacked =
      manifold_of(log, Frame(), log, turned({0, 0, 0.2}, {0, 0, 1 - 1e-4}), 0.01);
  ASSERT_EQ(stacked.size(), 8u);
  for (const ManifoldPoint& p : stacked) EXPECT_NEAR(p.gap, -1e-4, 1e-14);
}

// The one contact of a body that stands and one that flies past it, as its group sees it: how far
// its gap is from the distance of the two, m, at most; `while_same`: as long as these features
// meet.
double worst_gap(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b, const Frame& frame_b,
                 const Vec3& v, const Vec3& w, ContactFeature kind, bool while_same = false) {
  const Points points = manifold_of(a, frame_a, b, frame_b, 1e-3);
  EXPECT_EQ(points.size(), 1u);
  const ManifoldPoint& p = points.at(0);
  EXPECT_EQ(p.kind, kind);
  EXPECT_TRUE(p.reference_is_a);
  GroupStart start;
  start.end = 0.02;
  start.outside = {make_standing({frame_a.p, Quat(frame_a.R)})};
  GroupMember member;
  member.x = frame_b.p;
  member.q = Quat(frame_b.R);
  member.v = v;
  member.L = w;
  start.members = {member};
  GroupContact c = followed_contact(p, frame_a, a->parts()[0], frame_b, b->parts()[0]);
  c.a = -1;
  start.contacts = {c};
  GroupArc arc(start);
  arc.extend(start.end);
  double worst = 0;
  for (int i = 0; i <= 20; ++i) {
    const double time = start.end * i / 20;
    const GroupSample s = arc.evaluate(0, time);
    const Frame there(s.q.toRotationMatrix(), s.x);
    if (while_same) {
      const Points now = manifold_of(a, frame_a, b, there, 0.1);
      if (now.size() != 1 || now[0].feature != p.feature) break;
    }
    const Separation apart = separation(*a, frame_a, *b, there);
    worst = std::max(worst, std::abs(arc.contact_force(0, time).gap - apart.distance));
  }
  return worst;
}

// By a point that is fixed in either, the gap of crossed rods was s^2 sin^2/2r wrong after they had
// slid by s: here 3e-4 m.
TEST(CylinderManifold, where_sides_edges_and_rims_cross_the_gap_stays_that_of_the_bodies) {
  const ShapePtr rod = make_cylinder(0.01, 2), coin = make_cylinder(0.5, 0.01);
  const ShapePtr box = make_box({1, 1, 1});
  const Vec3 v(0.1, 0.3, 0.2), w(0.5, -0.3, 0.4);
  // the other one to the right of what stands along z, where it touches
  const auto beside = [](const ShapePtr& a, const ShapePtr& b, const Quat& attitude) {
    Frame frame(attitude.toRotationMatrix(), Vec3(2, 0, 0));
    const Separation s = separation(*a, Frame(), *b, frame);
    frame.p -= (s.distance - 1e-4) * s.normal;
    return frame;
  };
  const auto worst = [&](const ShapePtr& a, const ShapePtr& b, const Quat& attitude,
                         const Vec3& turning, ContactFeature kind) {
    return worst_gap(a, Frame(), b, beside(a, b, attitude), v, turning, kind);
  };
  const Quat slant = rotation_by(Vec3(1, 0, 0));
  EXPECT_LT(worst(rod, rod, slant, w, ContactFeature::crossing), 1e-9);
  const Quat on_edge = slant * rotation_by(Vec3(0, 0, pi / 4));
  EXPECT_LT(worst(rod, box, on_edge, w, ContactFeature::crossing), 1e-9);
  // a coin that spins about its axis
  const Quat tilt = rotation_by(Vec3(0, 1, 0.3));
  const Vec3 spin = 20 * (tilt * Vec3::UnitZ());
  EXPECT_LT(worst(rod, coin, tilt, w, ContactFeature::rim), 1e-9);
  EXPECT_LT(worst(rod, coin, tilt, spin, ContactFeature::rim), 1e-9);
}

// A ball in the place of the ellipsoid would miss half the difference of its two radii of curvature
// times the square of the angle it rolls by: 4e-4 m.
TEST(RoundManifold, an_ellipsoid_that_rolls_on_a_plane_keeps_its_gap) {
  Engine random(5);
  const ShapePtr table = make_box({4, 4, 1}), disc = make_cylinder(2, 0.1);
  for (const ShapePtr& egg : {make_ellipsoid({0.5, 0.3, 0.2}), make_ellipsoid({0.1, 0.1, 0.5}),
                              place_shape(make_ellipsoid({0.3, 0.4, 0.1}),
                                          Pose{{0.1, 0.2, 0.3}, rotation_by({1, 2, 3})})})
    for (int i = 0; i < 20; ++i)
      for (const ShapePtr& under : {ground, table, disc}) {
        Frame frame = random_frame(random, 0.1);
        frame.p.z() += 3;
        const Separation s = separation(*under, Frame(), *egg, frame);
        frame.p.z() -= s.distance - 1e-4;
        const Vec3 spin = 5 * random_direction(random);
        EXPECT_LT(worst_gap(under, Frame(), egg, frame, {0.1, 0.2, 0.3}, spin,
                            ContactFeature::tangent_plane),
                  1e-9);
      }
}

// By balls in their places gaps were up to 1e-3 m wrong.
TEST(RoundManifold, ellipsoids_on_what_is_curved_keep_their_gaps) {
  Engine random(6);
  const std::vector<ShapePtr> below = {make_ellipsoid({2, 1, 0.5}), make_sphere(1),
                                       make_cylinder(0.7, 8), make_capsule(0.3, 8),
                                       make_box({4, 6, 8})};
  const std::vector<ShapePtr> above = {make_ellipsoid({0.5, 0.3, 0.2}),
                                       make_ellipsoid({0.1, 0.1, 0.3}), make_sphere(0.3)};
  int curved = 0;
  for (const ShapePtr& b : above)
    for (const ShapePtr& a : below)
      for (int i = 0; i < 40; ++i) {
        if (a->parts()[0].kind != PartKind::ellipsoid && b->parts()[0].kind != PartKind::ellipsoid)
          continue;
        const Frame under = random_frame(random, 0.1);
        Frame frame = random_frame(random, 0.1);
        // at the sides and edges that are far from their ends
        Vec3 from = random_direction(random);
        if (a->parts()[0].kind == PartKind::frustum || a->parts()[0].kind == PartKind::polyhedron)
          from -= 0.95 * under.R.col(2).dot(from) * under.R.col(2);
        frame.p += 6 * from.normalized();
        const Separation s = separation(*a, under, *b, frame);
        frame.p -= (s.distance - 1e-4) * s.normal;
        const Points points = manifold_of(a, under, b, frame, 1e-3);
        ASSERT_EQ(points.size(), 1u);
        if (points[0].kind != ContactFeature::curved) continue;
        ++curved;
        EXPECT_LT(worst_gap(a, under, b, frame, {0.1, 0.2, 0.3}, 2 * random_direction(random),
                            ContactFeature::curved, true),
                  1e-9)
            << "of " << &a - below.data() << " and " << &b - above.data();
      }
  EXPECT_GT(curved, 250);
}

// Balls about a point of the axis missed the gap by r delta^2/(2 sin tilt): 1e-4 m.
TEST(CylinderManifold, rims_on_planes_keep_their_gaps) {
  Engine random(7);
  int tangent = 0;
  for (const ShapePtr& disc : {make_cylinder(0.3, 0.1), make_cylinder(0.2, 1), make_cone(0.3, 0.5)})
    for (int i = 0; i < 40; ++i) {
      Frame frame = random_frame(random, 0.1);
      frame.p.z() += 3;
      const Separation s = separation(*ground, Frame(), *disc, frame);
      frame.p.z() -= s.distance - 1e-4;
      const Points points = manifold_of(ground, Frame(), disc, frame, 1e-3);
      if (points.size() != 1 || points[0].kind != ContactFeature::tangent_plane) continue;
      ++tangent;
      EXPECT_LT(worst_gap(ground, Frame(), disc, frame, {0.1, 0.2, 0.3},
                          3 * random_direction(random), points[0].kind),
                1e-9);
    }
  EXPECT_GT(tangent, 80);
}

TEST(CylinderManifold, a_ball_meets_side_cap_and_rim) {
  const ShapePtr can = make_cylinder(0.3, 0.8);
  const ShapePtr ball = make_sphere(0.1);
  const auto meets = [&](const Vec3& center) {
    const Points points = manifold_of(can, Frame(), ball, Frame(Mat3::Identity(), center), 0.1);
    EXPECT_EQ(points.size(), 1u);
    return points.at(0);
  };
  ManifoldPoint p = meets({0.39, 0, 0.1});
  EXPECT_EQ(p.kind, ContactFeature::line);
  EXPECT_NEAR(p.gap, -0.01, 1e-15);
  EXPECT_NEAR(gap_by_feature(p), -0.01, 1e-15);
  p = meets({0.1, 0, 0.49});
  EXPECT_EQ(p.kind, ContactFeature::plane);
  EXPECT_NEAR(gap_by_feature(p), -0.01, 1e-15);
  p = meets({0.36, 0, 0.48});
  EXPECT_EQ(p.kind, ContactFeature::point);
  EXPECT_NEAR(gap_by_feature(p), 0, 1e-15);
  // the rim rolls on the ball: spinning about the axis changes nothing
  EXPECT_NEAR(p.reference_point.head<2>().norm(), 0, 1e-15);
  // a capsule's end is the ball that it is
  const Points end = manifold_of(make_capsule(0.2, 0.6), Frame(), ball,
                                 Frame(Mat3::Identity(), {0.15, 0, 0.55}), 0.1);
  ASSERT_EQ(end.size(), 1u);
  EXPECT_NEAR(end[0].reference_radius, 0.2, 1e-15);
  EXPECT_NEAR((end[0].reference_point - Vec3(0, 0, 0.3)).norm(), 0, 1e-15);
  EXPECT_NEAR(end[0].gap, std::hypot(0.15, 0.25) - 0.3, 1e-15);
}

}  // namespace
}  // namespace tw::test
