// Valleys whose bottom is a seam: what is in them is held by all slopes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "collision/seams/seams.h"
#include "convex-oracles.h"
#include "seam-ground.h"

namespace tw::test {
namespace {

// A pit of abutting pieces, its lowest point at the origin, and the normals of its slopes.
struct Pit : Ground {
  std::vector<Vec3> normals;

  // Each slope goes down to the origin between two of the directions, which lie in a circle.
  void add_slope(const Vec3& from, const Vec3& to) {
    const Vec3 deep = -3 * Vec3::UnitZ();
    add(make_hull({Vec3::Zero(), from, to, deep, from + deep, to + deep}), Frame());
    normals.push_back(from.cross(to).normalized());
  }
};

// As many slopes as asked for, rising at the angle (rad).
Pit hole(int slopes, double angle) {
  Pit pit;
  const auto rim = [&](int i) {
    const double turn = 2 * pi * i / slopes + 0.1;
    const double height = std::cos(pi / slopes) * std::tan(angle);
    return Vec3(std::cos(turn), std::sin(turn), height);
  };
  for (int i = 0; i < slopes; ++i) pit.add_slope(rim(i), rim(i + 1));
  return pit;
}

// A groove along y, its slopes rising at the angles.
Pit groove(double left, double right) {
  Pit pit;
  for (const double side : {-1.0, 1.0}) {
    const double angle = side < 0 ? left : right;
    std::vector<Vec3> points;
    for (const double y : {-1.0, 1.0})
      for (const double z : {0.0, -3.0}) {
        points.emplace_back(0, y, z);
        points.emplace_back(side * std::cos(angle), y, z + std::sin(angle));
      }
    pit.add(make_hull(points), Frame());
    pit.normals.emplace_back(-side * std::sin(angle), 0, std::cos(angle));
  }
  return pit;
}

// Of the steepest slope: run over rise.
double run_of(const Pit& pit) {
  double least = 1;
  for (const Vec3& n : pit.normals) least = std::min(least, n.z() / std::hypot(n.x(), n.y()));
  return least;
}

// A tip that is less steep than the slopes, tail up.
ShapePtr spike_for(const Pit& pit) {
  const double width = 0.2 * run_of(pit);
  return make_hull({{0, 0, 0},
                    {width, width, 0.5},
                    {-width, width, 0.5},
                    {-width, -width, 0.5},
                    {width, -width, 0.5}});
}

// Of 200 tips under all slopes of pits, up to `deepest` of their width below the lowest point: how
// many are not held by every slope with their depth under it.
int lost_in(const std::function<Pit(Engine&)>& dig, double deepest) {
  Engine random(7);
  int lost = 0;
  for (int i = 0; i < 200; ++i) {
    const Pit pit = dig(random);
    const ShapePtr spike = spike_for(pit);
    const double depth = deepest * spike->least_width() * std::pow(10, uniform(random, -2, 0));
    const double aside = i % 3 == 0 ? 0 : 0.7 * run_of(pit) * depth;
    const Vec3 tip(uniform(random, -aside, aside), uniform(random, -aside, aside), -depth);
    const Points points = pit.meets(spike, at(tip.x(), tip.y(), tip.z()), 1e-6, i % 5 == 0);
    const auto is_held = [&](const Vec3& normal) {
      return std::any_of(points.begin(), points.end(), [&](const ManifoldPoint& p) {
        return p.normal.dot(normal) > 1 - 1e-6 && std::abs(p.gap - normal.dot(tip)) < 1e-9;
      });
    };
    lost += std::all_of(pit.normals.begin(), pit.normals.end(), is_held) ? 0 : 1;
  }
  return lost;
}

TEST(Valleys, a_tip_in_a_groove_is_held_by_both_slopes) {
  const auto dig = [](Engine& random) {
    const double left = uniform(random, 0.1, 1.5);
    return groove(left, left * uniform(random, 0.7, 1));
  };
  EXPECT_EQ(lost_in(dig, 1e-3), 0);
  EXPECT_EQ(lost_in(dig, 0.04), 0);
}

TEST(Valleys, a_tip_in_a_hole_is_held_by_all_slopes) {
  const auto dig = [](Engine& random) {
    return hole(static_cast<int>(3 + random() % 4), uniform(random, 0.1, 1.4));
  };
  EXPECT_EQ(lost_in(dig, 1e-3), 0);
  EXPECT_EQ(lost_in(dig, 0.04), 0);
}

// A crest along y over the wall between two pieces, at x = 0: what is beneath it, on that wall or a
// little beside, is held by the slope that it is nearer to.
TEST(Valleys, a_tip_on_the_wall_beneath_a_crest_is_held) {
  Engine random(3);
  for (int i = 0; i < 200; ++i) {
    const double left = uniform(random, 0.05, 0.5), right = uniform(random, 0.05, 0.5);
    const Pit crest = groove(-left, -right);
    const ShapePtr spike = make_hull(
        {{0, 0, 0}, {0.1, 0.1, 0.5}, {-0.1, 0.1, 0.5}, {-0.1, -0.1, 0.5}, {0.1, -0.1, 0.5}});
    const double depth = 0.04 * spike->least_width() * std::pow(10, uniform(random, -2, 0));
    const double aside = uniform(random, -1, 1) * depth * std::pow(10, uniform(random, -6, -1));
    const Vec3 tip(aside, uniform(random, -0.5, 0.5), -depth);
    const Points points = crest.meets(spike, at(tip.x(), tip.y(), tip.z()), 1e-6, i % 5 == 0);
    double deepest = 0;
    for (const ManifoldPoint& p : points) deepest = std::min(deepest, p.gap);
    const auto height = [&](const Vec3& normal) { return normal.dot(tip); };
    const double least = std::max(height(crest.normals[0]), height(crest.normals[1]));
    EXPECT_NEAR(deepest, least, 5e-5 * spike->least_width())
        << left << " " << right << " " << tip.transpose();
  }
}

// The ground is the plane z = 0, the wall stands on it at x < 0 and ends at y = 0.5.
TEST(Valleys, a_wall_that_stands_on_the_ground_holds_corners_that_lie_in_the_ground) {
  Ground ground;
  ground.add(make_box({4, 4, 1}), at(0, 0, -0.5));
  ground.add(make_box({1, 1, 1}), at(-0.5, 0, 0.5));
  const ShapePtr spike = make_hull({{0, 0, 0}, {0.2, 0.1, 0.1}, {0.2, -0.1, 0.1}, {0.2, 0, 0.3}});
  const auto pressing = [&](const Vec3& corner) {
    const Points points = ground.meets(spike, at(corner.x(), corner.y(), corner.z()), 1e-6, false);
    int walls = 0;
    for (const ManifoldPoint& p : points) walls += p.normal.x() > 0.9 && p.gap < 0 ? 1 : 0;
    return walls;
  };
  for (const double depth : {1e-6, 2e-5, 1e-4, 1e-3})
    for (const double into : {1e-6, 2e-5, 1e-4, 1e-3})
      EXPECT_EQ(pressing({-into, 0.1, -depth}), 1) << depth << " " << into;
  // what is beside the wall's end is not held by it
  for (const double depth : {1e-5, 1e-4, 1e-3})
    EXPECT_EQ(pressing({-1e-4, 0.502, -depth}), 0) << depth;
}

// A floor and a wall that leans away from it meet in an edge alone, along x.  The floor's side goes
// down in the wall's plane: a tip that slid down the wall is under the floor, beside it, and has
// its foot on it.
TEST(Valleys, a_floor_holds_what_slid_into_a_slit_that_leans_in_under_it) {
  for (const double lean : {0.05, 0.3, 0.8})
    for (const double depth : {1e-4, 1e-3, 3e-3})
      for (const double into : {1e-6, 1e-5, 1e-4}) {
        const Vec3 up(0, -std::sin(lean), std::cos(lean)), out(0, std::cos(lean), std::sin(lean));
        Ground ground;
        std::vector<Vec3> floor, wall;
        for (const double x : {-1.0, 1.0})
          for (const double along : {0.0, 1.0}) {
            const Vec3 edge(x, 0, 0), back = -Vec3::UnitY();
            floor.insert(floor.end(), {edge - along * up, edge - along * up - 3 * back});
            wall.insert(wall.end(), {edge + along * up, edge + along * up + back});
          }
        ground.add(make_hull(floor), Frame());
        ground.add(make_hull(wall), Frame());
        const Vec3 side = 0.05 * Vec3::UnitX();
        const ShapePtr spike =
            make_hull({Vec3::Zero(), 0.5 * up + side, 0.5 * up - side, 0.5 * up + side + 0.1 * out,
                       0.5 * up - side + 0.1 * out});
        const Vec3 tip = -depth / std::cos(lean) * up - into * out + 0.1 * Vec3::UnitX();
        const Points points = ground.meets(spike, Frame(Mat3::Identity(), tip), 1e-6, false);
        const auto holds = [&](const Vec3& normal) {
          return std::any_of(points.begin(), points.end(), [&](const ManifoldPoint& p) {
            return p.normal.dot(normal) > 1 - 1e-6 && std::abs(p.gap - normal.dot(tip)) < 1e-9;
          });
        };
        EXPECT_TRUE(holds(Vec3::UnitZ())) << lean << " " << depth << " " << into;
        // the end of a table is no floor
        Ground table;
        table.add(ground.shapes[0], Frame());
        for (const ManifoldPoint& p : table.meets(spike, Frame(Mat3::Identity(), tip), 1e-6, false))
          EXPECT_LT(p.normal.z(), 0.99) << lean << " " << depth << " " << into;
      }
}

// The plate ends just behind the wall's face; the corner, from below, is before the plate's end.
TEST(Valleys, what_is_behind_the_ground_under_a_wall_is_not_held_by_the_wall) {
  Ground ground;
  ground.add(make_box({1, 1, 0.5}), at(0.5 - 3e-4, 0, -0.25));
  ground.add(make_box({1, 1, 1}), at(-0.5, 0, 0.5));
  const ShapePtr spike =
      make_hull({{0, 0, 0}, {-0.2, 0.1, -0.1}, {-0.2, -0.1, -0.1}, {-0.2, 0, -0.3}});
  const Points points = ground.meets(spike, at(-5e-4, 0, -1e-3), 1e-5, false);
  for (const ManifoldPoint& p : points) EXPECT_GT(p.gap, 0) << p.normal.transpose();
}

// Between the ball and the bar of a dumbbell: the edge of a box is held by both, however the
// dumbbell is turned about its axis.
TEST(Valleys, an_edge_in_the_crease_of_a_dumbbell_is_held_by_both_pieces) {
  const Pose along_x{Vec3::Zero(), rotation_by({0, pi / 2, 0})};
  const auto ball = [](double x) {
    return place_shape(make_sphere(0.13), {{x, 0, 0}, Quat::Identity()});
  };
  const ShapePtr dumbbell =
      make_union({ball(-0.34), ball(0.34), place_shape(make_cylinder(0.05, 0.68), along_x)});
  const ShapePtr box = make_box({0.1, 0.3, 0.1});
  const Vec3 crease(0.22, 0, 0.05), bar(0, 0, 1), sphere = (crease - Vec3(0.34, 0, 0)) / 0.13;
  int held = 0, cases = 0;
  for (const double depth : {1e-6, 1e-4, 1e-3, 3e-3})
    for (const double tilt : {0.05, 0.2, 0.35}) {
      // as deep in the one as in the other
      const Vec3 edge = crease + depth * Vec3((1 - sphere.z()) / -sphere.x(), 0, -1);
      const Frame turn = turned({0, tilt, 0}, Vec3::Zero());
      const Frame frame(turn.R, edge - turn * Vec3(0.05, 0, -0.05));
      Points points;
      manifold_at_seams(*dumbbell, Frame(), {}, *box, frame, {}, 1e-4, 0.1, points);
      const auto holds = [&](const Vec3& normal) {
        return std::any_of(points.begin(), points.end(), [&](const ManifoldPoint& p) {
          const Vec3 outward = p.reference_is_a ? p.normal : Vec3(-p.normal);
          return outward.dot(normal) > 0.99 && std::abs(p.gap + depth) < 0.1 * depth + 1e-9;
        });
      };
      held += holds(bar) + holds(sphere);
      cases += 2;
    }
  EXPECT_EQ(held, cases);
}

// Three walls, the room is where all coordinates are positive.  Each runs on beneath another one or
// ends with the room, by the bits of `runs_on`: two of six a wall.
Ground corner(int runs_on) {
  const double length = 10, width = 1;
  Ground ground;
  for (int k = 0; k < 3; ++k) {
    Vec3 lo = Vec3::Zero(), hi = Vec3::Constant(length);
    lo[k] = -width;
    hi[k] = 0;
    for (int j = 0, bit = 2 * k; j < 3; ++j)
      if (j != k && (runs_on >> bit++) % 2 == 1) lo[j] = -width;
    ground.add(make_box(hi - lo), Frame(Mat3::Identity(), 0.5 * (lo + hi)));
  }
  return ground;
}

// Of 300 tips in a corner, as deep as `deepest` of their width in one of the three walls and hardly
// in others: what is missing of the 900 contacts that hold them.
int missing_in(const Ground& room, double deepest) {
  const ShapePtr tip =
      make_hull({{0, 0, 0}, {0.5, 0.1, 0.9}, {0.1, 0.6, 0.8}, {0.7, 0.6, 0.5}, {0.6, 0.7, 0.9}});
  const double size = tip->least_width();
  Engine random(1);
  int missing = 0;
  for (int i = 0; i < 300; ++i) {
    const double most = deepest * std::pow(10, uniform(random, -4, 0));
    Vec3 depth;
    for (double& d : depth) d = most * size * std::pow(10, uniform(random, -3, 0));
    const Frame frame = turned(0.3 * random_direction(random), -depth);
    const Points points = room.meets(tip, frame, 0.01 * size, i % 2 == 0);
    for (int k = 0; k < 3; ++k) {
      const auto is_held = [&](const ManifoldPoint& p) {
        return p.normal[k] > 0.9 && p.gap < -0.3 * depth[k];
      };
      const bool touches = depth[k] <= seam::buried_margin * size;
      missing += touches || std::any_of(points.begin(), points.end(), is_held) ? 0 : 1;
    }
  }
  return missing;
}

// It is beyond the corner in each, and each holds it, also where walls meet in an edge alone with
// nothing beneath, or end behind each other.
TEST(Valleys, a_tip_in_the_corner_of_a_room_is_held_by_floor_and_walls) {
  for (int runs_on = 0; runs_on < 64; ++runs_on) {
    const Ground room = corner(runs_on);
    EXPECT_EQ(missing_in(room, 1e-3), 0) << runs_on;
    EXPECT_LE(missing_in(room, 4e-2), 45) << runs_on;
  }
}

}  // namespace
}  // namespace tw::test
