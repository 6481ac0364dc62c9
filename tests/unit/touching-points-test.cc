// Contact manifolds: how many points, where, and which normal.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "collision/distance/separation.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

std::vector<ContactPoint> touching(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b,
                                   const Frame& frame_b, double tolerance = 1e-6) {
  std::vector<ContactPoint> points;
  touching_points(*a, frame_a, *b, frame_b, tolerance, points);
  return points;
}

Frame at(double x, double y, double z) { return Frame(Mat3::Identity(), Vec3(x, y, z)); }

Frame turned(const Vec3& rotation, const Vec3& position) {
  return Frame(rotation_by(rotation).toRotationMatrix(), position);
}

const ShapePtr& cube() {
  static const ShapePtr shape = make_box({1, 1, 1});
  return shape;
}

TEST(TouchingPoints, aligned_cubes_touch_at_four_corners) {
  for (double gap : {0.0, 1e-12, 1e-7, -1e-12, -1e-4}) {
    const auto points = touching(cube(), Frame(), cube(), at(0, 0, 1 + gap));
    ASSERT_EQ(points.size(), 4u) << gap;
    for (const ContactPoint& p : points) {
      EXPECT_EQ(p.normal, Vec3::UnitZ());
      EXPECT_NEAR(p.gap, gap, 1e-15);
      EXPECT_NEAR(std::abs(p.point.x()), 0.5, 1e-15);
      EXPECT_NEAR(std::abs(p.point.y()), 0.5, 1e-15);
      EXPECT_NEAR(p.point.z(), 0.5 + 0.5 * gap, 1e-15);
    }
  }
}

TEST(TouchingPoints, a_shifted_cube_touches_on_the_overlap_of_the_faces) {
  const auto points = touching(cube(), Frame(), cube(), at(0.25, 0.5, 1));
  ASSERT_EQ(points.size(), 4u);
  Aabb box;
  for (const ContactPoint& p : points) box.add(p.point);
  EXPECT_NEAR((box.lo - Vec3(-0.25, 0, 0.5)).norm(), 0, 1e-15);
  EXPECT_NEAR((box.hi - Vec3(0.5, 0.5, 0.5)).norm(), 0, 1e-15);
}

TEST(TouchingPoints, a_cube_turned_by_an_eighth_touches_at_eight_points) {
  const auto points = touching(cube(), Frame(), cube(), turned({0, 0, pi / 4}, {0, 0, 1}));
  ASSERT_EQ(points.size(), 8u);
  for (const ContactPoint& p : points) {
    EXPECT_NEAR((p.normal - Vec3::UnitZ()).norm(), 0, 1e-15);
    EXPECT_NEAR(std::max(std::abs(p.point.x()), std::abs(p.point.y())), 0.5, 1e-15);
  }
}

TEST(TouchingPoints, a_corner_touches_at_one_point_and_an_edge_at_two) {
  Frame corner;
  corner.R = Quat::FromTwoVectors(Vec3(-1, -1, -1), Vec3(0.1, 0.2, -1)).toRotationMatrix();
  corner.p = Vec3(0.1, 0.1, 0.5 - cube()->bounds(corner).lo.z());
  auto points = touching(cube(), Frame(), cube(), corner);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR((points[0].normal - Vec3::UnitZ()).norm(), 0, 1e-15);
  EXPECT_NEAR((points[0].point - corner * Vec3(-0.5, -0.5, -0.5)).norm(), 0, 1e-15);

  Frame edge = turned({pi / 4, 0, 0}, {0, 0, 0});
  edge.p.z() = 0.5 - cube()->bounds(edge).lo.z();
  points = touching(cube(), Frame(), cube(), edge);
  ASSERT_EQ(points.size(), 2u);
  for (const ContactPoint& p : points) {
    EXPECT_NEAR((p.normal - Vec3::UnitZ()).norm(), 0, 1e-15);
    EXPECT_NEAR((p.point.cwiseAbs() - Vec3(0.5, 0, 0.5)).norm(), 0, 1e-15);
  }
}

TEST(TouchingPoints, crossing_edges_touch_at_their_crossing) {
  const Frame lower = turned({pi / 4, 0, 0}, {0, 0, 0});
  Frame upper = turned({0, 0, 1.2}, {0, 0, 0});
  upper.R = upper.R * lower.R;
  for (double gap : {0.0, 1e-12, -1e-12, 1e-8, -1e-5}) {
    upper.p = Vec3(0.2, 0.05, std::sqrt(2.0) + gap);
    const auto points = touching(cube(), lower, cube(), upper);
    ASSERT_EQ(points.size(), 1u);
    EXPECT_NEAR((points[0].normal - Vec3::UnitZ()).norm(), 0, 1e-14);
    EXPECT_NEAR(points[0].gap, gap, 1e-15);
    // the lower edge is the x axis at height 1/sqrt 2; the upper passes (0.2, 0.05) at 1.2 rad
    EXPECT_NEAR(points[0].point.y(), 0, 1e-15);
    EXPECT_NEAR(points[0].point.x(), 0.2 - 0.05 / std::tan(1.2), 1e-15);
  }
}

TEST(TouchingPoints, corner_against_corner_gives_one_point_with_an_axis_as_normal) {
  for (double gap : {-1e-9, 0.0, 1e-12, 1e-8}) {
    const double offset = 1 + gap;
    const auto points = touching(cube(), Frame(), cube(), at(offset, offset, offset));
    ASSERT_EQ(points.size(), 1u);
    EXPECT_NEAR((points[0].point - Vec3::Constant(0.5)).norm(), 0, 2e-8);
    EXPECT_EQ(points[0].normal, Vec3::UnitX());
  }
}

TEST(TouchingPoints, two_tetrahedra_tip_to_tip_touch_at_the_tip) {
  const ShapePtr tip = make_hull({{0, 0, 0}, {1, 0.2, 1}, {-0.7, 0.6, 1}, {-0.3, -0.8, 1}});
  const Frame down = turned({pi, 0, 0}, {0, 0, 0});
  for (double gap : {0.0, 1e-12, 1e-8}) {
    const auto points = touching(tip, down, tip, at(0, 0, gap));
    ASSERT_EQ(points.size(), 1u) << gap;
    EXPECT_NEAR(points[0].point.norm(), 0, 1e-8);
    EXPECT_NEAR(points[0].normal.norm(), 1, 1e-15);
    EXPECT_GT(points[0].normal.z(), 0);
  }
}

TEST(TouchingPoints, a_sphere_touches_at_one_point) {
  const ShapePtr ball = make_sphere(0.5);
  const ShapePtr ground = make_half_space({0, 0, 1}, 0);
  auto points = touching(ground, Frame(), ball, at(3, 4, 0.5));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].normal, Vec3::UnitZ());
  EXPECT_EQ(points[0].point, Vec3(3, 4, 0));
  points = touching(ball, at(3, 4, 0.5), ground, Frame());
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].normal, -Vec3::UnitZ());
  points = touching(cube(), Frame(), ball, at(1, 0.1, 0.2));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR((points[0].point - Vec3(0.5, 0.1, 0.2)).norm(), 0, 1e-15);
  points = touching(ball, Frame(), ball, at(0.6, 0.8, 0));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR((points[0].point - Vec3(0.3, 0.4, 0)).norm(), 0, 1e-15);
}

TEST(TouchingPoints, a_polyhedron_touches_a_half_space_at_its_low_vertices) {
  const ShapePtr ground = make_half_space({0, 0, 1}, 0);
  EXPECT_EQ(touching(ground, Frame(), cube(), at(1, 2, 0.5)).size(), 4u);
  EXPECT_EQ(touching(cube(), at(1, 2, 0.5 + 1e-3), ground, Frame()).size(), 0u);
  const Frame on_edge = turned({pi / 4, 0, 0}, {0, 0, std::sqrt(0.5) - 1e-5});
  const auto points = touching(cube(), on_edge, ground, Frame());
  ASSERT_EQ(points.size(), 2u);
  for (const ContactPoint& p : points) {
    EXPECT_EQ(p.normal, -Vec3::UnitZ());
    EXPECT_NEAR(p.gap, -1e-5, 1e-15);
    EXPECT_NEAR(p.point.z(), -0.5e-5, 1e-15);
  }
}

TEST(TouchingPoints, manifolds_have_at_most_sixteen_points_spread_over_the_face) {
  const ShapePtr drum = prism(40, 0.5, 0.2);
  for (const auto& points : {touching(make_half_space({0, 0, 1}, 0), Frame(), drum, at(0, 0, 0.2)),
                             touching(drum, Frame(), drum, turned({0, 0, 0.03}, {0.05, 0, 0.4}))}) {
    ASSERT_EQ(points.size(), 16u);
    Aabb box;
    for (const ContactPoint& p : points) box.add(p.point);
    EXPECT_GT(box.size().x(), 0.85);
    EXPECT_GT(box.size().y(), 0.85);
  }
}

TEST(TouchingPoints, none_beyond_the_tolerance) {
  EXPECT_TRUE(touching(cube(), Frame(), cube(), at(0, 0, 1.001), 1e-4).empty());
  EXPECT_EQ(touching(cube(), Frame(), cube(), at(0, 0, 1.001), 1e-2).size(), 4u);
  EXPECT_TRUE(touching(cube(), Frame(), cube(), at(5, 0, 0), 1e-4).empty());
}

TEST(TouchingPoints, of_unions_carry_the_pair_of_parts) {
  // a table of two legs on the ground and on a box
  const ShapePtr legs = make_union({place_shape(cube(), {{-2, 0, 0}, Quat::Identity()}),
                                    place_shape(cube(), {{2, 0, 0}, Quat::Identity()})});
  const ShapePtr floor = make_box({10, 10, 1});
  const auto points = touching(floor, Frame(), legs, at(0, 0, 1));
  ASSERT_EQ(points.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(points[i].pair, i < 4 ? 0 : 1);
    EXPECT_EQ(points[i].point.x() < 0, i < 4);
  }
}

TEST(TouchingPoints, gaps_and_midpoints_belong_to_both_surfaces_in_random_contacts) {
  Engine random(1);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  for (int round = 0; round < 10; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const Frame frame_a = random_frame(random, 1);
        Frame frame_b = random_frame(random, 1);
        frame_b.p = frame_a.p + 4 * random_direction(random);
        const double gap = uniform(random, -1e-7, 1e-7);
        const Separation s = separation(*a, frame_a, *b, frame_b);
        frame_b.p -= (s.distance - gap) * s.normal;
        const auto points = touching(a, frame_a, b, frame_b, 2e-7);
        ASSERT_GE(points.size(), 1u);
        ASSERT_LE(points.size(), 8u);
        double least = 1e300;
        for (const ContactPoint& p : points) {
          ASSERT_NEAR(p.normal.norm(), 1, 1e-14);
          ASSERT_EQ(p.normal, points[0].normal);
          ASSERT_LE(p.gap, 2e-7);
          least = std::min(least, p.gap);
          // within half the gap of both surfaces; needles' faces meet at small angles
          int face = 0;
          ASSERT_LT(std::abs(a->parts()[0].core->face_separation(frame_a.to_local(p.point), face)),
                    3e-7);
          ASSERT_LT(std::abs(b->parts()[0].core->face_separation(frame_b.to_local(p.point), face)),
                    3e-7);
        }
        // just apart, the nearest corner may stand beside the reference face
        if (gap < 0) {
          ASSERT_NEAR(least, separation(*a, frame_a, *b, frame_b).distance, 1e-14);
        }
      }
}

TEST(TouchingPoints, swapping_the_bodies_negates_the_normal) {
  Engine random(2);
  const ShapePtr rock = random_rock(random, 20, {0.5, 0.4, 0.3});
  for (int i = 0; i < 200; ++i) {
    const Frame frame_a = random_frame(random, 1);
    Frame frame_b = random_frame(random, 1);
    frame_b.p = frame_a.p + 3 * random_direction(random);
    const Separation s = separation(*rock, frame_a, *rock, frame_b);
    frame_b.p -= (s.distance + 1e-9) * s.normal;
    const auto ab = touching(rock, frame_a, rock, frame_b);
    const auto ba = touching(rock, frame_b, rock, frame_a);
    ASSERT_EQ(ab.size(), ba.size());
    ASSERT_NEAR((ab[0].normal + ba[0].normal).norm(), 0, 1e-14);
    ASSERT_NEAR(ab[0].gap, ba[0].gap, 1e-14);
  }
}

TEST(TouchingPoints, appends_to_what_is_there) {
  std::vector<ContactPoint> points(3);
  touching_points(*cube(), Frame(), *cube(), at(0, 0, 1), 1e-6, points);
  EXPECT_EQ(points.size(), 7u);
}

}  // namespace
}  // namespace tw::test
