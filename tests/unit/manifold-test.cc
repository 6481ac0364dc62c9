// Contact manifolds: features, depths, names, and what their points leave out.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/manifold/manifold.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "base/constants.h"
#include "collision/distance/overlap-along.h"
#include "collision/distance/separation.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

using Points = std::vector<ManifoldPoint>;

Points manifold_of(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b, const Frame& frame_b,
                   double reach, ReferenceChoice choice = ReferenceChoice::larger) {
  Points points;
  manifold(*a, frame_a, *b, frame_b, reach, points, choice);
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

double least_gap(const Points& points) {
  double least = 1e300;
  for (const ManifoldPoint& p : points) least = std::min(least, p.gap);
  return least;
}

// Frames of a and b that penetrate by about `depth` along the line of nearest points.
struct ShallowPose {
  Frame frame_a, frame_b;

  ShallowPose(Engine& random, const ShapePtr& a, const ShapePtr& b, double depth) {
    frame_a = random_frame(random, 1);
    frame_b = random_frame(random, 1);
    frame_b.p = frame_a.p + 4 * random_direction(random);
    const Separation apart = separation(*a, frame_a, *b, frame_b);
    frame_b.p -= (apart.distance + depth) * apart.normal;
  }
};

// The gap of a point from its features, by the formulas of integrate/arc/group-arc.h.
double gap_by_feature(const ManifoldPoint& p) {
  const Vec3 r = p.core_point - p.reference_point;
  switch (p.kind) {
    case ContactFeature::plane: return p.normal.dot(r) - p.radius;
    case ContactFeature::line:
      return (r - p.direction * p.direction.dot(r)).norm() - p.reference_radius - p.radius;
    case ContactFeature::point: break;
    case ContactFeature::crossing: {
      const Vec3 across = p.direction.cross(p.other_direction).normalized();
      return (across.dot(p.normal) < 0 ? -1 : 1) * across.dot(r);
    }
    case ContactFeature::rim:
    case ContactFeature::tangent_plane:
    case ContactFeature::curved: ADD_FAILURE() << "of round shapes alone"; break;
  }
  return r.norm() - p.reference_radius - p.radius;
}

TEST(Manifold, gaps_follow_from_the_features) {
  Engine random(1);
  std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  zoo.push_back(make_sphere(0.4));
  zoo.push_back(make_half_space({1, 2, 3}, 0.1));
  int points = 0;
  for (int round = 0; round < 10; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        if (a->is_half_space() && b->is_half_space()) continue;
        const double depth = (random() % 2 == 0 ? 1 : -1) * std::pow(10, uniform(random, -6, -2));
        const ShallowPose pose(random, a, b, depth);
        for (const ManifoldPoint& p : manifold_of(a, pose.frame_a, b, pose.frame_b, 0.05)) {
          ASSERT_NEAR(p.gap, gap_by_feature(p), 1e-13);
          ASSERT_NEAR(p.normal.norm(), 1, 1e-14);
          ASSERT_NEAR(p.direction.norm(), 1, 1e-14);
          ASSERT_LE(p.gap, 0.05);
          ++points;
        }
      }
  EXPECT_GT(points, 2000);
}

TEST(Manifold, stacked_cubes_lie_on_four_corners) {
  for (double gap : {0.0, 1e-12, 1e-4, -1e-12, -1e-4}) {
    const Points points = manifold_of(cube(), Frame(), cube(), at(0, 0, 1 + gap), 0.01);
    ASSERT_EQ(points.size(), 4u) << gap;
    for (const ManifoldPoint& p : points) {
      EXPECT_TRUE(p.reference_is_a);
      EXPECT_EQ(p.normal, Vec3::UnitZ());
      EXPECT_NEAR(p.gap, gap, 1e-15);
      EXPECT_NEAR((p.core_point.cwiseAbs() - Vec3(0.5, 0.5, 0.5 + gap)).norm(), 0, 1e-15);
    }
  }
}

// How much all points count that lie on each other, those beyond the reach as well.
double lying(const Points& points) {
  double sum = 0;
  for (const ManifoldPoint& p : points) sum += p.flatness + p.beyond;
  return sum;
}

// A cube that is tilted about one of its lower edges has all four points, as flat as the two others
// lie, until it is no longer parallel to what it lies on: on a plane, a larger box and a cap.
TEST(Manifold, what_tilts_loses_its_points_little_by_little) {
  const ShapePtr plane = make_half_space(Vec3::UnitZ(), 0);
  const ShapePtr plate = make_box({3, 3, 1}), disc = make_cylinder(2, 1);
  for (const double share : {0.0, 1e-3, 0.25, 0.5, 0.99, 1.5}) {
    const double angle = std::asin(share * patch::aligned_sine);
    const Frame tilted(Pose{Vec3(0.5 - 0.5 * std::cos(angle) + 0.5 * std::sin(angle), 0,
                                 0.5 * std::cos(angle) + 0.5 * std::sin(angle) - 1e-6),
                            rotation_by(Vec3(0, -angle, 0))});
    const double expected = 2 + 2 * std::max(0.0, 1 - share);
    EXPECT_NEAR(lying(manifold_of(plane, Frame(), cube(), tilted, 1e-4)), expected, 1e-4) << share;
    EXPECT_NEAR(lying(manifold_of(plate, at(0, 0, -0.5), cube(), tilted, 1e-4)), expected, 1e-4)
        << share;
    EXPECT_NEAR(lying(manifold_of(disc, at(0, 0, -0.5), cube(), tilted, 1e-4)), expected, 0.05)
        << share;
  }
}

// The two ends of a cylinder's lowest line, and the points of a rim.
TEST(Manifold, round_bodies_that_tilt_lose_their_points_little_by_little) {
  const ShapePtr plane = make_half_space(Vec3::UnitZ(), 0), cylinder = make_cylinder(0.5, 1);
  const double angle = std::asin(0.5 * patch::aligned_sine);
  const auto height = [&](double turn) {
    return 0.5 * std::abs(std::cos(turn)) + 0.5 * std::abs(std::sin(turn)) - 1e-6;
  };
  const double lies = pi / 2 + angle, stands = angle;
  const auto placed = [&](double turn) {
    return Frame(Pose{Vec3(0, 0, height(turn)), rotation_by(Vec3(0, turn, 0))});
  };
  EXPECT_NEAR(lying(manifold_of(plane, Frame(), cylinder, placed(lies), 1e-4)), 1.5, 1e-3);
  const double of_rim = lying(manifold_of(plane, Frame(), cylinder, placed(stands), 1e-4));
  EXPECT_GT(of_rim, 4);
  EXPECT_LT(of_rim, 6);
}

// A prism whose lower side is folded by `fold` along its middle.
ShapePtr folded(double fold) {
  const double low = 0.5 * std::tan(fold);
  std::vector<Vec3> points;
  for (const double y : {-1.0, 1.0})
    for (const Vec3& p :
         {Vec3(-0.5, y, low), Vec3(0, y, 0), Vec3(0.5, y, low), Vec3(-0.5, y, 1), Vec3(0.5, y, 1)})
      points.push_back(p);
  return make_hull(points);
}

// On facets that hardly differ a body rocks from one to the other: both lie there, also where the
// plate is shorter than these.
TEST(Manifold, facets_that_hardly_differ_lie_there_together) {
  const double fold = 0.5 * patch::aligned_sine;
  const ShapePtr prism = folded(fold), plate = make_box({3, 1.6, 1});
  for (const double angle : {-0.9 * fold, 0.0, 0.9 * fold}) {
    const Frame tilted(Pose{Vec3(0, 0, -1e-6), rotation_by(Vec3(0, angle, 0))});
    const Points points = manifold_of(plate, at(0, 0, -0.5), prism, tilted, 0.02);
    EXPECT_EQ(points.size(), 6u) << angle;
    for (const double end : {-1.0, 1.0})
      EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](const auto& p) {
        return std::abs(p.core_point.x()) < 1e-6 && std::abs(p.core_point.y() - 0.8 * end) < 1e-9;
      })) << angle;
  }
}

// An edge over a strip no wider than it: the strip's borders cut it twice, however the faces beside
// it lean, and whatever other face there is at its ends.
TEST(Manifold, an_edge_over_a_strip_has_two_points) {
  const ShapePtr strip = make_box({0.2, 2, 0.2});
  // beside the edge the faces lean by 45 and 60 degrees, at its ends there are flatter ones
  std::vector<Vec3> points = {{0, 0, 1.5}};
  for (const double side : {-1.0, 1.0}) {
    points.push_back({0.5 * side, 0, 0});
    points.push_back({0.8 * side, 0, 0.03});
    points.push_back({2 * side, -0.3, 0.3});
    points.push_back({2 * side, 0.3, 0.3 * std::sqrt(3.0)});
  }
  const ShapePtr keel = make_hull(points);
  const Points found = manifold_of(strip, at(0, 0, -0.1), keel, at(0, 0, -1e-5), 1e-3);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(std::abs(found[0].core_point.x() - found[1].core_point.x()), 0.2, 1e-9);
}

TEST(Manifold, the_deepest_point_is_as_deep_as_the_separating_axis_test_says) {
  Engine random(2);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  for (int round = 0; round < 200; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const ShallowPose pose(random, a, b, std::pow(10, uniform(random, -6, -3)));
        const Separation s = separation(*a, pose.frame_a, *b, pose.frame_b);
        const Points points = manifold_of(a, pose.frame_a, b, pose.frame_b, 0.01);
        ASSERT_FALSE(points.empty());
        ASSERT_LE(points.size(), patch::most_points);
        // 1 - cos 2 degrees, and what one millionth of the size is
        ASSERT_NEAR(least_gap(points), s.distance, 2e-3 * std::abs(s.distance) + 3e-6);
      }
}

TEST(Manifold, every_pair_within_reach_has_a_point_and_none_beyond) {
  Engine random(3);
  std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  zoo.push_back(make_sphere(0.4));
  int near = 0;
  for (int round = 0; round < 60; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const ShallowPose pose(random, a, b, -uniform(random, 0, 0.1));
        const double distance = separation(*a, pose.frame_a, *b, pose.frame_b).distance;
        if (std::abs(distance - 0.05) < 1e-9) continue;
        const Points points = manifold_of(a, pose.frame_a, b, pose.frame_b, 0.05);
        ASSERT_EQ(points.empty(), distance > 0.05) << distance;
        near += points.empty() ? 0 : 1;
      }
  EXPECT_GT(near, 2000);
}

TEST(Manifold, swapping_the_bodies_mirrors_the_points) {
  Engine random(4);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  int pairs = 0;
  for (int round = 0; round < 20; ++round)
    for (std::size_t i = 0; i < zoo.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const ShallowPose pose(random, zoo[i], zoo[j], 1e-4);
        Points points = manifold_of(zoo[i], pose.frame_a, zoo[j], pose.frame_b, 0.01);
        Points mirror = manifold_of(zoo[j], pose.frame_b, zoo[i], pose.frame_a, 0.01);
        ASSERT_EQ(points.size(), mirror.size());
        ASSERT_NEAR(least_gap(points), least_gap(mirror), 1e-12);
        for (const ManifoldPoint& p : points) {
          // the edge pair's one point always has a as reference
          const bool same = std::any_of(mirror.begin(), mirror.end(), [&p](const auto& q) {
            const bool turned_round = p.reference_is_a == q.reference_is_a;
            return (turned_round ? (p.normal + q.normal).norm() : (p.normal - q.normal).norm()) <
                       1e-9 &&
                   ((turned_round ? q.reference_point : q.core_point) - p.core_point).norm() < 1e-3;
          });
          ASSERT_TRUE(same);
        }
        ++pairs;
      }
  EXPECT_GT(pairs, 500);
}

TEST(Manifold, a_rigid_motion_of_both_moves_the_points_along) {
  Engine random(5);
  std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  zoo.push_back(make_sphere(0.4));
  for (int round = 0; round < 10; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const ShallowPose pose(random, a, b, 1e-4);
        const Frame motion = random_frame(random, 10);
        const Points before = manifold_of(a, pose.frame_a, b, pose.frame_b, 0.01);
        const Points after = manifold_of(a, motion * pose.frame_a, b, motion * pose.frame_b, 0.01);
        ASSERT_EQ(before.size(), after.size());
        for (std::size_t i = 0; i < before.size(); ++i) {
          ASSERT_EQ(before[i].feature, after[i].feature);
          ASSERT_EQ(before[i].kind, after[i].kind);
          ASSERT_NEAR(before[i].gap, after[i].gap, 1e-12);
          ASSERT_NEAR((motion * before[i].core_point - after[i].core_point).norm(), 0, 1e-10);
          ASSERT_NEAR((motion.R * before[i].normal - after[i].normal).norm(), 0, 1e-10);
        }
      }
}

TEST(Manifold, names_of_points_outlive_small_motions) {
  Engine random(6);
  int kept = 0;
  int all = 0;
  for (int i = 0; i < 2000; ++i) {
    // a box of random edges resting on a larger one
    const ShapePtr box = make_box({uniform(random, 0.2, 0.6), uniform(random, 0.2, 0.6), 0.2});
    const Vec3 place(uniform(random, -0.6, 0.6), uniform(random, -0.6, 0.6), 0.6 - 1e-4);
    const Vec3 turn(0, 0, uniform(random, 0, 6));
    const Points before = manifold_of(cube(), Frame(), box, turned(turn, place), 0.01);
    const Vec3 rattle = 1e-5 * random_direction(random);
    const Points after = manifold_of(
        cube(), Frame(), box, turned(turn + 1e-5 * random_direction(random), place + rattle), 0.01);
    std::set<std::uint64_t> names;
    for (const ManifoldPoint& p : after) names.insert(p.feature);
    ASSERT_EQ(names.size(), after.size());
    for (const ManifoldPoint& p : before) kept += names.count(p.feature) != 0 ? 1 : 0;
    all += static_cast<int>(before.size());
  }
  EXPECT_GT(all, 6000);
  EXPECT_GT(kept, 0.999 * all);
}

// The greatest depth of a vertex of b under the face of a that the points refer to, over it.
double deepest_under_top(const ShapePtr& b, const Frame& frame_b, double half, double top) {
  double deepest = 0;
  for (const Vec3& v : b->parts()[0].core->vertices()) {
    const Vec3 x = frame_b * v;
    if (std::max(std::abs(x.x()), std::abs(x.y())) > half) continue;
    deepest = std::max(deepest, top - x.z());
  }
  return deepest;
}

TEST(Manifold, what_rolls_within_the_reach_is_represented) {
  Engine random(7);
  const ShapePtr table = make_box({2, 2, 1});
  int rolled = 0;
  for (int i = 0; i < 3000; ++i) {
    const ShapePtr rock = random_rock(random, 12, {0.3, 0.3, 0.25});
    Frame before = random_frame(random, 0.3);
    before.p.z() = 0.5;
    before.p.z() -= rock->bounds(before).lo.z() - 0.5 + 1e-4;
    const double reach = 0.03;
    const Points points = manifold_of(table, Frame(), rock, before, reach);
    if (points.size() >= patch::most_points) continue;
    // roll about the lowest point, each surface point by less than the reach
    const Vec3 pivot(before.p.x(), before.p.y(), 0.5);
    const Vec3 turn = uniform(random, 0, 1) * reach / 0.6 * random_direction(random);
    const Frame roll(rotation_by(turn).toRotationMatrix(), Vec3::Zero());
    const Frame after(roll.R * before.R, pivot + roll.R * (before.p - pivot));
    double predicted = 0;
    for (const ManifoldPoint& p : points) {
      const Vec3 now = after * before.to_local(p.core_point);
      predicted = std::max(predicted, 0.5 - now.z());
    }
    ASSERT_LE(deepest_under_top(rock, after, 1, 0.5), predicted + 1e-12);
    rolled += predicted > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(rolled, 500);
}

TEST(Manifold, a_box_over_an_edge_is_not_carried_beyond_it) {
  // coplanar faces, slightly deep: the points end at the edge of the lower cube
  const ShapePtr box = make_box({1, 1, 0.2});
  for (double overhang : {0.3, 0.49, 0.499, 0.7}) {
    const Points points = manifold_of(cube(), Frame(), box, at(overhang, 0, 0.6 - 1e-4), 0.05);
    ASSERT_EQ(points.size(), 4u);
    for (const ManifoldPoint& p : points) EXPECT_LE(p.core_point.x(), 0.5 + 1e-12) << overhang;
  }
}

// Two cards lean on each other: their upper edges share a stretch, and touch at both its ends.
TEST(Manifold, edges_along_each_other_touch_at_both_ends) {
  const ShapePtr card = make_box({0.1, 1, 2});
  const double lean = 0.3, aside = std::sin(lean) + 0.05 * std::cos(lean);
  for (const double gap : {1e-3, -1e-3})
    for (const double shift : {0.0, 0.25}) {
      const Frame left = turned({0, lean, 0}, {-aside - 0.5 * gap, 0, 1});
      const Frame right = turned({0, -lean, 0}, {aside + 0.5 * gap, shift, 1});
      const Points points = manifold_of(card, left, card, right, 0.01);
      ASSERT_EQ(points.size(), 2u) << gap << ' ' << shift;
      double from = 1, to = -1;
      for (const ManifoldPoint& p : points) {
        from = std::min(from, p.core_point.y());
        to = std::max(to, p.core_point.y());
        // what overlaps is pushed out along a face
        EXPECT_NEAR(p.gap, gap > 0 ? gap : std::cos(lean) * gap, 1e-12);
      }
      EXPECT_NEAR(from, shift - 0.5, 1e-12);
      EXPECT_NEAR(to, 0.5, 1e-12);
    }
  // where they cross there is one point
  const Frame left = turned({0, lean, 0}, {-aside, 0, 1});
  const Frame skew = turned({0, -lean, 0}, {aside - 1e-3, 0, 1});
  const Frame crossing(rotation_by({0.3, 0, 0}).toRotationMatrix() * skew.R, skew.p);
  EXPECT_EQ(manifold_of(card, left, card, crossing, 0).size(), 1u);
}

TEST(Manifold, a_ball_meets_faces_edges_and_vertices_as_planes_lines_and_points) {
  const ShapePtr ball = make_sphere(0.2);
  const auto meets = [&ball](const Vec3& center) {
    const Points points = manifold_of(cube(), Frame(), ball, Frame(Mat3::Identity(), center), 0.1);
    EXPECT_EQ(points.size(), 1u);
    return points.at(0);
  };
  ManifoldPoint p = meets({0.1, 0.2, 0.69});
  EXPECT_EQ(p.kind, ContactFeature::plane);
  EXPECT_EQ(p.normal, Vec3::UnitZ());
  EXPECT_EQ(p.radius, 0.2);
  EXPECT_NEAR(p.gap, -0.01, 1e-15);
  EXPECT_EQ(p.core_point, Vec3(0.1, 0.2, 0.69));
  // sunk until the centre is inside
  p = meets({0.1, 0.2, 0.45});
  EXPECT_EQ(p.kind, ContactFeature::plane);
  EXPECT_NEAR(p.gap, -0.25, 1e-15);
  // beside an edge along x
  p = meets({0.1, 0.5 + 0.12, 0.5 + 0.16});
  EXPECT_EQ(p.kind, ContactFeature::line);
  EXPECT_NEAR(std::abs(p.direction.x()), 1, 1e-15);
  EXPECT_NEAR((p.normal - Vec3(0, 0.6, 0.8)).norm(), 0, 1e-14);
  EXPECT_NEAR(p.gap, 0, 1e-15);
  EXPECT_EQ(p.reference_radius, 0);
  // beside a corner
  p = meets({0.6, 0.6, 0.6});
  EXPECT_EQ(p.kind, ContactFeature::point);
  EXPECT_EQ(p.reference_point, Vec3(0.5, 0.5, 0.5));
  EXPECT_NEAR(p.gap, 0.1 * std::sqrt(3.0) - 0.2, 1e-15);
}

TEST(Manifold, the_fixed_face_is_the_reference_where_asked) {
  const ShapePtr large = make_box({2, 2, 0.2});
  const Frame over = turned({1e-3, 0, 0}, {0, 0, 0.6});
  for (const ManifoldPoint& p : manifold_of(cube(), Frame(), large, over, 0.01))
    EXPECT_FALSE(p.reference_is_a);
  const Points of_a = manifold_of(cube(), Frame(), large, over, 0.01, ReferenceChoice::of_a);
  ASSERT_EQ(of_a.size(), 4u);
  for (const ManifoldPoint& p : of_a) {
    EXPECT_TRUE(p.reference_is_a);
    EXPECT_EQ(p.normal, Vec3::UnitZ());
  }
}

// A face over a ridge of the ground, a little tilted along it: as the body slides on along the
// ridge, its lowest point goes with it, so the normal stands on the ridge, and on the face's
// border.
TEST(Manifold, a_face_that_slides_along_a_ridge_does_not_part_from_it) {
  const ShapePtr ridge =
      make_hull({{-5, 0, 0}, {5, 0, 0}, {-5, 2, -2}, {5, 2, -2}, {-5, -2, -2}, {5, -2, -2}});
  const ShapePtr box = make_box({1, 1, 1});
  const double tilt = 0.02;
  const Frame level(Mat3::Identity(), Vec3::Zero());
  const Frame over = Frame(rotation_by({0, tilt, 0}).toRotationMatrix(), Vec3(0, 0, 0.51));
  for (const bool ground_first : {true, false}) {
    std::vector<ManifoldPoint> points;
    if (ground_first)
      manifold(*ridge, level, *box, over, 0.05, points, ReferenceChoice::of_a);
    else
      manifold(*box, over, *ridge, level, 0.05, points, ReferenceChoice::of_b);
    ASSERT_EQ(points.size(), 2u);
    double least = 1;
    for (const ManifoldPoint& p : points) {
      // the face's plane, in which its border is fixed
      EXPECT_NE(p.reference_is_a, ground_first);
      EXPECT_NEAR(p.normal.x(), 0, 1e-12);
      EXPECT_NEAR(p.normal.z(), -1, 1e-3);
      EXPECT_NEAR(p.normal.dot(over.R * Vec3::UnitY()), 0, 1e-12);
      EXPECT_NEAR(p.core_point.y(), 0, 1e-12);
      EXPECT_NEAR(p.gap, p.normal.dot(p.core_point - p.reference_point), 1e-12);
      // on the box: the lower edge of its face at x = 0.5
      EXPECT_NEAR(std::abs((over.R.transpose() * (p.reference_point - over.p)).x()), 0.5, 1e-3);
      least = std::min(least, p.gap);
    }
    EXPECT_NEAR(least, 0.51 - 0.5 * std::cos(tilt) - 0.5 * std::sin(tilt), 1e-5);
  }
}

// The corner of one cube's lower face sticks out over the border of another's upper face: its edge
// crosses that border, at an angle small enough to count as a contact of faces.  Whatever way the
// two slide, the deepest point nears as fast as the distance says.
TEST(Manifold, the_crossing_of_an_edge_and_a_border_nears_as_fast_as_the_bodies) {
  const double depth = 1e-3, step = 1e-6;
  for (const double tilt : {0.005, 0.015, 0.03}) {
    Frame over = turned({tilt, -0.5 * tilt, 0}, {0, 0, 0});
    over = Frame(rotation_by({0, 0, 0.7}).toRotationMatrix() * over.R, Vec3(0.95, 0.1, 2));
    over.p.z() -= separation(*cube(), Frame(), *cube(), over).distance;
    const Separation first = separation(*cube(), Frame(), *cube(), over);
    over.p -= (first.distance + depth) * first.normal;
    const Separation now = separation(*cube(), Frame(), *cube(), over);
    ASSERT_NEAR(now.distance, -depth, 1e-5);

    const Points points = manifold_of(cube(), Frame(), cube(), over, 0.01);
    const auto deepest = std::min_element(
        points.begin(), points.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
    ASSERT_NE(deepest, points.end());
    EXPECT_NEAR(deepest->gap, now.distance, 1e-6);
    for (const Vec3& slide : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, -2, 0.1)}) {
      Frame later = over;
      later.p += step * slide;
      const double rate =
          (separation(*cube(), Frame(), *cube(), later).distance - now.distance) / step;
      const double predicted = slide.dot(deepest->normal) * (deepest->reference_is_a ? 1 : -1);
      EXPECT_NEAR(predicted, rate, 1e-4) << "tilt " << tilt;
    }
  }
}

// Two plates across each other, tilted a little: corners of one lie over the face of the other, of
// both, and edges cross.  Whatever way they slide, every point nears as fast as its normal says.
TEST(Manifold, points_of_tilted_faces_near_as_fast_as_the_bodies) {
  const ShapePtr plate = make_box({2, 1, 0.1}), other = make_box({1.6, 1.2, 0.1});
  const double step = 1e-5;
  int corners = 0;
  for (const double tilt : {0.005, 0.02, 0.035}) {
    Frame over = turned({0.6 * tilt, tilt, 0}, {0, 0, 0});
    over = Frame(rotation_by({0, 0, 0.1}).toRotationMatrix() * over.R, Vec3(0.7, 0.3, 0.12));
    const Points points = manifold_of(plate, Frame(), other, over, 0.2);
    ASSERT_GE(points.size(), 4u);
    for (const Vec3& slide : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, -2, 0.1)}) {
      Frame later = over;
      later.p += step * slide;
      for (const ManifoldPoint& now : manifold_of(plate, Frame(), other, later, 0.2))
        for (const ManifoldPoint& p : points) {
          if (p.feature != now.feature) continue;
          const double predicted = slide.dot(p.normal) * (p.reference_is_a ? 1 : -1);
          EXPECT_NEAR((now.gap - p.gap) / step, predicted, 1e-6) << "tilt " << tilt;
          corners += p.reference_is_a ? 0 : 1;
        }
    }
  }
  EXPECT_GE(corners, 9);
}

// Along any normal two hulls overlap at least as far as they are deep, along that of their nearest
// points just so far.
TEST(Manifold, overlap_along_a_normal_bounds_the_depth) {
  Engine random(31);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  for (const ShapePtr& a : zoo)
    for (const ShapePtr& b : zoo) {
      const double depth = std::pow(10, uniform(random, -6, -3));
      const ShallowPose pose(random, a, b, depth);
      const Separation apart = separation(*a, pose.frame_a, *b, pose.frame_b);
      const auto overlap = [&](const Vec3& normal) {
        return overlap_along(normal, *a, pose.frame_a, *b, pose.frame_b);
      };
      EXPECT_NEAR(overlap(apart.normal), -apart.distance, 1e-12);
      const double deepest = -least_gap(manifold_of(a, pose.frame_a, b, pose.frame_b, 0));
      for (int k = 0; k < 20; ++k) {
        const Vec3 aside = 0.3 * k * 0.05 * random_direction(random);
        EXPECT_GE(overlap((apart.normal + aside).normalized()), deepest - 1e-9);
      }
      EXPECT_GT(overlap(random_direction(random)), 0);
    }
  EXPECT_EQ(overlap_along(Vec3::UnitZ(), *cube(), at(0, 0, 0), *make_sphere(1), at(0, 0, 1)),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace tw::test
