// Seams of fixed bodies and unions: no ghosts, and nothing real is lost.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>

#include "base/random.h"
#include "collision/distance/separation.h"
#include "collision/manifold/manifold-parts.h"
#include "convex-oracles.h"
#include "seam-ground.h"

namespace tw::test {
namespace {

// 10 tiles of 0.5 m along x with coplanar tops at z = 0, from x = 0.
Ground tiled_floor() {
  Ground floor;
  for (int i = 0; i < 10; ++i) floor.add(make_box({0.5, 4, 1}), at(0.25 + 0.5 * i, 0, -0.5));
  return floor;
}

// Places near the seams and between.
std::vector<double> crossing_places() {
  std::vector<double> places;
  for (int i = 0; i < 40; ++i) places.push_back(2 + 0.025 * i);
  for (double offset : {1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 3e-5, 9e-5, 1.1e-4, 1e-3, 1e-2})
    for (double sign : {-1.0, 1.0}) places.push_back(2.5 + sign * offset);
  return places;
}

double least_gap(const Points& points) {
  double least = 1e300;
  for (const ManifoldPoint& p : points) least = std::min(least, p.gap);
  return least;
}

TEST(Seams, a_box_sunk_into_a_tiled_floor_feels_one_plane) {
  const Ground floor = tiled_floor();
  const Vec3 edges(0.4, 0.3, 0.2);
  const ShapePtr box = make_box(edges);
  for (double depth : {1e-6, 1e-4, 1e-3})
    for (double x : crossing_places())
      for (double corner : {-0.2, 0.0, 0.2})
        for (bool moving_is_a : {true, false}) {
          const Frame frame = at(x + corner, 0.1, 0.1 - depth);
          const Points points = floor.meets(box, frame, 0.01, moving_is_a);
          Aabb support;
          for (const ManifoldPoint& p : points) {
            ASSERT_EQ(p.normal, Vec3::UnitZ()) << x + corner;
            ASSERT_NEAR(p.gap, -depth, 1e-14);
            support.add(p.core_point);
          }
          ASSERT_NEAR(support.size().x(), edges.x(), 1.01 * depth) << x + corner;
          ASSERT_NEAR(support.size().y(), edges.y(), 1e-12);
        }
}

// What is asked of face planes first is what the distance says.
TEST(Seams, a_part_holds_what_is_as_deep_in_it_as_its_surface_is_far) {
  Engine random(38);
  const ShapePtr shapes[] = {
      make_box({0.4, 0.3, 0.2}), random_rock(random, 14, {0.5, 0.4, 0.3}), make_sphere(0.2),
      make_cylinder(0.2, 0.3),
      place_shape(make_box({0.2, 0.2, 0.2}), {Vec3(0.1, 0, 0.05), random_rotation(random)})};
  int held = 0, beside = 0;
  for (const ShapePtr& shape : shapes)
    for (int i = 0; i < 4000; ++i) {
      const SeamNeighbour part{&shape->part(0),
                               Frame({random_vector(random, 1), random_rotation(random)})};
      const Vec3 point = part.frame * random_vector(random, 0.3);
      const double height = height_over(part, point);
      for (const double depth : {0.0, 0.01, -0.01, -height, -0.99 * height, -1.01 * height}) {
        const bool holding = holds(part, point, depth);
        ASSERT_EQ(holding, height <= -depth) << depth << " " << height;
        held += holding;
        beside += holding && height > 0;
      }
    }
  EXPECT_GT(held, 10000);
  EXPECT_GT(beside, 1000);
}

TEST(Seams, a_tilted_box_is_carried_at_its_deepest_corner) {
  const Ground floor = tiled_floor();
  const ShapePtr box = make_box({0.4, 0.3, 0.2});
  Engine random(1);
  for (int i = 0; i < 3000; ++i) {
    const double tilt = std::pow(10, uniform(random, -6, -0.5));
    Frame frame = turned(tilt * random_direction(random), {0, 0, 0});
    const double depth = std::pow(10, uniform(random, -6, -3));
    frame.p.x() = crossing_places()[random() % crossing_places().size()];
    // half of them have the lowest corner at the place
    Vec3 lowest = Vec3::UnitZ();
    for (const Vec3& v : box->parts()[0].core->vertices())
      if ((frame.R * v).z() < lowest.z()) lowest = frame.R * v;
    if (i % 2 == 0) frame.p.x() -= lowest.x();
    frame.p.z() = -lowest.z() - depth;
    const Points points = floor.meets(box, frame, 0.01, i % 3 == 0);
    ASSERT_FALSE(points.empty()) << i;
    ASSERT_NEAR(least_gap(points), -depth, 2e-3 * depth + 1e-6) << "tilt " << tilt;
    for (const ManifoldPoint& p : points) ASSERT_GT(p.normal.z(), 1 - 1e-12) << tilt;
  }
}

TEST(Seams, a_ball_on_a_tiled_floor_feels_one_plane) {
  const Ground floor = tiled_floor();
  const ShapePtr ball = make_sphere(0.1);
  for (double x : crossing_places()) {
    const Points points = floor.meets(ball, at(x, 0.1, 0.1 - 1e-4), 0.01, false);
    ASSERT_GE(points.size(), 1u) << x;
    ASSERT_LE(points.size(), 2u) << x;
    for (const ManifoldPoint& p : points) {
      ASSERT_NEAR(p.gap, -1e-4, 1e-9);
      ASSERT_GT(p.normal.z(), 1 - 1e-8) << x;
    }
  }
}

TEST(Seams, cylinders_on_a_tiled_floor_feel_one_plane) {
  const Ground floor = tiled_floor();
  const ShapePtr can = make_cylinder(0.15, 0.3);
  const ShapePtr coin = make_cylinder(0.15, 0.02);
  const Mat3 across = rotation_by({pi / 2, 0, 0}).toRotationMatrix();
  const Mat3 along = rotation_by({0, pi / 2, 0}).toRotationMatrix();
  const double tilt = 0.3;
  const Mat3 tilted = rotation_by({0, tilt, 0}).toRotationMatrix();
  for (double x : crossing_places())
    for (double depth : {1e-6, 1e-4}) {
      // rolling over the seams, lying along the floor, standing with the rim at the place
      for (const Frame& frame :
           {Frame(across, Vec3(x, 0.1, 0.15 - depth)), Frame(along, Vec3(x, 0.1, 0.15 - depth)),
            Frame(Mat3::Identity(), Vec3(x + 0.15, 0.1, 0.15 - depth))}) {
        const Points points = floor.meets(can, frame, 0.005, false);
        ASSERT_FALSE(points.empty()) << x;
        ASSERT_NEAR(least_gap(points), -depth, 1e-8) << x;
        for (const ManifoldPoint& p : points) ASSERT_GT(p.normal.z(), 1 - 1e-8) << x;
      }
      // on its rim, the lowest point at the place
      const double height = 0.15 * std::sin(tilt) + 0.01 * std::cos(tilt);
      const double beside = 0.15 * std::cos(tilt) - 0.01 * std::sin(tilt);
      const Frame rim(tilted, Vec3(x - beside, 0.1, height - depth));
      const Points points = floor.meets(coin, rim, 0.001, false);
      ASSERT_FALSE(points.empty()) << x - 2.5;
      ASSERT_NEAR(least_gap(points), -depth, 5e-6) << x - 2.5;
      for (const ManifoldPoint& p : points) ASSERT_GT(p.normal.z(), 1 - 1e-8) << x - 2.5;
    }
}

TEST(Seams, a_spike_just_past_a_seam_is_carried) {
  const Ground floor = tiled_floor();
  const ShapePtr spike =
      make_hull({{0, 0, 0}, {0.2, 0, 0.3}, {-0.1, 0.2, 0.3}, {-0.1, -0.2, 0.3}, {0, 0, 0.5}});
  for (double offset : {-1e-3, -5e-5, -1e-7, 0.0, 1e-7, 5e-5, 1e-3}) {
    const Points points = floor.meets(spike, at(2.5 + offset, 0, -1e-4), 0.001, true);
    ASSERT_FALSE(points.empty()) << offset;
    for (const ManifoldPoint& p : points) ASSERT_GT(p.normal.z(), 1 - 1e-12) << offset;
    ASSERT_NEAR(least_gap(points), -1e-4, 3e-6) << offset;
  }
}

TEST(Seams, the_wall_at_the_end_of_the_floor_and_a_step_are_real) {
  Ground floor = tiled_floor();
  const ShapePtr box = make_box({0.4, 0.3, 0.2});
  // against the first tile's outer wall, below the top
  const Points wall = floor.meets(box, at(-0.2 + 1e-5, 0, -0.3), 0.01, true);
  ASSERT_FALSE(wall.empty());
  for (const ManifoldPoint& p : wall) EXPECT_EQ(p.normal, -Vec3::UnitX());
  // a tile that stands 5 cm proud
  floor.frames[6].p.z() += 0.05;
  const Points step = floor.meets(box, at(3 - 0.2 + 1e-5, 0, 0.1 - 1e-4), 1e-3, true);
  int pushing_back = 0;
  for (const ManifoldPoint& p : step) pushing_back += p.normal.x() < -0.9 ? 1 : 0;
  EXPECT_GE(pushing_back, 2);
}

TEST(Seams, both_slopes_of_a_valley_carry) {
  Ground valley;
  valley.add(make_box({2, 2, 2}), turned({0, 0.5, 0}, Vec3(-1, 0, -1)));
  valley.add(make_box({2, 2, 2}), turned({0, -0.5, 0}, Vec3(1, 0, -1)));
  // the slopes meet above x = 0; a ball and the edge of a box lie in the groove
  const double groove = -1 + 1 / std::cos(0.5) - std::tan(0.5);
  const ShapePtr ball = make_sphere(0.2);
  const Points ball_points =
      valley.meets(ball, at(0, 0, groove + 0.2 / std::cos(0.5) - 1e-4), 1e-3, false);
  ASSERT_EQ(ball_points.size(), 2u);
  EXPECT_LT(ball_points[0].normal.x() * ball_points[1].normal.x(), -0.2);
  const ShapePtr box = make_box({0.4, 0.4, 0.4});
  const Points edge_points = valley.meets(
      box, turned({0, pi / 4, 0}, {0, 0, groove + 0.2 * std::sqrt(2.0) - 1e-4}), 1e-3, true);
  bool left = false;
  bool right = false;
  for (const ManifoldPoint& p : edge_points) {
    left = left || p.normal.x() < -0.2;
    right = right || p.normal.x() > 0.2;
  }
  EXPECT_TRUE(left && right);
}

TEST(Seams, the_inner_seams_of_a_moving_union_are_no_features) {
  // a plank of two boxes on a thin bar under the joint
  const ShapePtr board = make_box({1, 0.3, 0.1});
  const ShapePtr plank = make_union({place_shape(board, {Vec3(-0.5, 0, 0), Quat::Identity()}),
                                     place_shape(board, {Vec3(0.5, 0, 0), Quat::Identity()})});
  Ground bar;
  bar.add(make_box({0.1, 1, 0.1}), at(0, 0, -0.1));
  for (double shift : {-0.05, -0.049, -0.01, 0.0, 1e-5, 0.03, 0.05})
    for (double depth : {1e-6, 1e-4, 1e-3}) {
      const Points points = bar.meets(plank, at(shift, 0, -depth), 0.01, true);
      ASSERT_FALSE(points.empty());
      for (const ManifoldPoint& p : points) {
        ASSERT_EQ(p.normal, Vec3::UnitZ()) << shift;
        ASSERT_NEAR(p.gap, -depth, 1e-14);
      }
    }
}

// A rough mountainside: a grid of heights, two triangular columns a cell.
struct Mountain : Ground {
  explicit Mountain(Engine& random) {
    constexpr int cells = 6;
    std::map<std::pair<int, int>, double> height;
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= cells; ++j) height[{i, j}] = 0.4 * i + uniform(random, -0.25, 0.25);
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        column({{i, j}, {i + 1, j}, {i + 1, j + 1}}, height);
        column({{i, j}, {i + 1, j + 1}, {i, j + 1}}, height);
      }
  }
  void column(const std::vector<std::pair<int, int>>& corners,
              const std::map<std::pair<int, int>, double>& height) {
    std::vector<Vec3> points;
    for (const auto& c : corners) {
      points.emplace_back(c.first, c.second, height.at(c));
      points.emplace_back(c.first, c.second, -3);
    }
    add(make_hull(points), Frame());
  }
};

// A rod across one of two bars that cross, a hair's breadth deep: the axis along which it is
// nearest to the other bar is buried.  Over an edge of that bar it would be deep, but it crosses
// the edge's line beyond the end of the edge (a scene of the fuzzer, whose energy rose fourfold).
// Whatever of its parts' surfaces is inside others: what is in a union is held by some of it.
TEST(Seams, a_union_does_not_bury_all_that_a_body_is_in) {
  tw::Random random(3);
  const auto draw = [&]() -> ShapePtr {
    const double size = random.real(0.1, 0.3);
    switch (static_cast<int>(random.real(0, 5))) {
      case 0: return make_sphere(size);
      case 1: return make_box({size, 2 * size, size});
      case 2: return make_cylinder(size, size);
      case 3: return make_capsule(0.5 * size, size);
    }
    return make_ellipsoid({size, 0.5 * size, 0.7 * size});
  };
  const auto place = [&](double room) {
    Pose pose;
    for (int k = 0; k < 3; ++k) pose.p[k] = random.real(-room, room);
    for (int k = 0; k < 4; ++k) pose.q.coeffs()[k] = random.real(-1, 1);
    pose.q.normalize();
    return pose;
  };
  int in = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<ShapePtr> parts;
    for (int k = 0; k < 3; ++k) parts.push_back(place_shape(draw(), place(0.15)));
    const ShapePtr whole = make_union(parts), other = draw();
    const Frame here(place(0.4));
    const double size = std::min(whole->least_width(), other->least_width());
    const double distance = separation(*whole, Frame(), *other, here).distance;
    if (distance > -0.003 * size || distance < -0.1 * size) continue;
    ++in;
    Points points;
    manifold_at_seams(*whole, Frame(), {}, *other, here, {}, 0.01 * size, size, points);
    EXPECT_FALSE(points.empty()) << i << ", " << distance / size;
  }
  EXPECT_GT(in, 100);
}

TEST(Seams, a_rod_is_not_on_an_edge_that_it_crosses_beyond_its_end) {
  const double rod = 5.507701874066766e-05, wide = 0.00011096680843160528;
  const ShapePtr cylinder = make_cylinder(rod, 0.00059205701022086);
  const ShapePtr cross = make_union({make_box({0.0005419953749003153, wide, wide}),
                                     make_box({wide, 0.0005419953749003153, wide})});
  const Quat q_rod(0.63900777216401217, 0.37216954331287938, -0.57155861614326497,
                   -0.35563977063408486);
  const Quat q_cross(0.33045174745059414, 0.020386179093721632, 0.2236568083779806,
                     -0.91671352034045128);
  const Frame at_rod(q_rod.toRotationMatrix(),
                     {-0.00014962369822158484, -0.00029463732364130293, 0.00033879832385189421});
  const Frame at_cross(q_cross.toRotationMatrix(),
                       {8.7941603505940213e-05, -0.00026275044271464198, 0.00020475363535375833});
  Points points;
  manifold_at_seams(*cylinder, at_rod, {}, *cross, at_cross, {}, 6.6e-6, 2 * rod, points);
  ASSERT_FALSE(points.empty());
  for (const ManifoldPoint& p : points) EXPECT_GT(p.gap, -1e-9) << p.pair;
}

TEST(Seams, a_rock_that_comes_down_on_a_rough_mountainside_keeps_what_it_touches) {
  Engine random(5);
  int lost = 0;
  int ghosts = 0;
  int landed = 0;
  const int rocks = 600;
  for (int i = 0; i < rocks; ++i) {
    const Mountain mountain(random);
    const ShapePtr rock = random_rock(random, 16, {0.4, 0.3, 0.3});
    Frame frame = random_frame(random, 1);
    frame.p = Vec3(uniform(random, 2, 4), uniform(random, 2, 4), 8);
    // down until it touches, then in by a little along the normal
    Separation touch;
    for (int step = 0; step < 100; ++step) {
      touch.distance = 1e300;
      double fall = 1e300;
      for (std::size_t k = 0; k < mountain.shapes.size(); ++k) {
        const Separation s = separation(*mountain.shapes[k], mountain.frames[k], *rock, frame);
        if (s.distance < touch.distance) touch = s;
        fall = std::min(fall, s.distance / std::max(s.normal.z(), 1e-3));
      }
      if (touch.distance < 1e-10) break;
      frame.p.z() -= std::max(touch.distance, 1e-12);
    }
    if (touch.distance > 1e-6) continue;
    const double depth = std::pow(10, uniform(random, -6, -3));
    frame.p -= depth * touch.normal;
    const Points points = mountain.meets(rock, frame, 2e-3, i % 2 == 0);
    bool found = false;
    for (const ManifoldPoint& p : points) {
      found = found || (p.gap < -0.5 * depth && p.normal.dot(touch.normal) > 0.95);
      ghosts += p.gap < -3 * depth - 1e-5 ? 1 : 0;
    }
    lost += found ? 0 : 1;
    ++landed;
  }
  EXPECT_GT(landed, rocks / 2);
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(ghosts, 0);
}

}  // namespace
}  // namespace tw::test
