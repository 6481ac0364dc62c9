// Where two bodies touch, with the ground around them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/pair-manifold.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/small-scene.h"

namespace tw::test {
namespace {

// Two tiles whose tops are at z = 0, the second from `slot` on along x, and a cube of 0.1 m that is
// sunk into the first by `sunk` and reaches `beyond` the second one's side.
struct TiledFloor : SmallScene {
  static constexpr double slot_end = 0.5;
  BodyId first = 0, second = 0, cube = 0;
  std::vector<ManifoldPoint> points;

  TiledFloor(double slot, double sunk, double beyond, bool cube_is_first = false) {
    const Vec3 place(slot_end + beyond - 0.05, 0, 0.05 - sunk);
    if (cube_is_first) cube = add_cube(0.1, place);
    first = add_fixed_box({1, 1, 0.2}, {slot_end - slot - 0.5, 0, -0.1});
    second = add_fixed_box({1, 1, 0.2}, {slot_end + 0.5, 0, -0.1});
    if (!cube_is_first) cube = add_cube(0.1, place);
  }
  PairManifold meet(BodyId tile, bool with_ground, const std::vector<StandingPlane>& planes = {}) {
    const Body &a = scene.body(std::min(tile, cube)), &b = scene.body(std::max(tile, cube));
    const Frame of_cube = tail(cube).trajectory().at(0).frame(),
                of_tile(scene.body(tile).motion->pose(0));
    const NearGround ground = surroundings.ground_around(scene.body(cube), {of_cube});
    points.clear();
    return pair_manifold({a, tile < cube ? of_tile : of_cube, b, tile < cube ? of_cube : of_tile},
                         with_ground ? PairGround(surroundings, a, b, ground) : PairGround(),
                         planes, 1e-3, points);
  }
  // How many of the points have a normal along x; the others' are along z.
  std::ptrdiff_t sideways() const {
    return std::count_if(points.begin(), points.end(),
                         [](const ManifoldPoint& p) { return std::abs(p.normal.x()) > 0.99; });
  }
};

const std::vector<StandingPlane> level_ground{{Vec3::UnitZ(), 0}};

TEST(PairManifold, a_cube_on_one_tile_has_four_points_as_deep_as_it_is_sunk) {
  TiledFloor small(0, 1e-5, -0.2);
  const PairManifold found = small.meet(small.first, true, level_ground);
  EXPECT_NEAR(found.distance, -1e-5, 1e-15);
  EXPECT_FALSE(found.left_out);
  ASSERT_EQ(small.points.size(), 4u);
  for (const ManifoldPoint& p : small.points) {
    EXPECT_TRUE(p.reference_is_a);
    EXPECT_EQ(p.normal, Vec3(0, 0, 1));
    EXPECT_NEAR(p.gap, -1e-5, 1e-15);
  }
}

// The cube is 1e-5 m beyond the wall between the tiles and 1e-4 m below their tops: out of the
// second one alone it would go back by the least of both.
TEST(PairManifold, a_buried_wall_between_tiles_is_left_out_but_for_the_least_distance) {
  TiledFloor small(0, 1e-4, 1e-5);
  const PairManifold alone = small.meet(small.second, false);
  EXPECT_NEAR(alone.distance, -1e-5, 1e-15);
  EXPECT_GT(small.sideways(), 0);
  const PairManifold found = small.meet(small.second, true);
  EXPECT_NEAR(found.distance, -1e-5, 1e-15);
  EXPECT_EQ(small.sideways(), 0);
  for (const ManifoldPoint& p : small.points) EXPECT_NEAR(p.gap, -1e-4, 1e-12);
}

// Tiles 1 mm apart bury nothing: that takes the plane on which the cube stands.
TEST(PairManifold, beyond_a_slot_the_low_side_is_left_out_of_what_stands_on_the_plane) {
  for (const bool cube_is_first : {false, true}) {
    TiledFloor small(1e-3, 1e-5, 1e-6, cube_is_first);
    EXPECT_FALSE(small.meet(small.second, true).left_out);
    EXPECT_GT(small.sideways(), 0);
    const PairManifold found = small.meet(small.second, true, level_ground);
    EXPECT_TRUE(found.left_out);
    EXPECT_EQ(small.sideways(), 0);
    EXPECT_NEAR(found.distance, -1e-6, 1e-15);
  }
}

// The next top is 3e-5 m above the plane, more than seam::flush of the size; or the cube hangs
// deeper below it than seam::low, 2e-4 m.
TEST(PairManifold, beyond_a_slot_a_side_that_stands_out_is_met) {
  TiledFloor small(1e-3, 1e-5, 1e-6), hangs(1e-3, 3e-4, 1e-6);
  EXPECT_FALSE(small.meet(small.second, true, {{Vec3::UnitZ(), -3e-5}}).left_out);
  EXPECT_GT(small.sideways(), 0);
  EXPECT_FALSE(hangs.meet(hangs.second, true, level_ground).left_out);
  EXPECT_GT(hangs.sideways(), 0);
}

// The cube's own face is smaller and larger than the fixed box's.
TEST(PairManifold, the_face_of_what_is_fixed_is_the_reference_whichever_is_larger) {
  for (const double edge : {0.05, 0.2}) {
    SmallScene small;
    const BodyId below = small.add_fixed_box({edge, edge, edge}, {0, 0, -0.5 * edge}),
                 cube = small.add_cube(0.1, {0, 0, 0.05}),
                 above = small.add_fixed_box({edge, edge, edge}, {0, 0, 0.1 + 0.5 * edge});
    const Frame middle(Mat3::Identity(), {0, 0, 0.05});
    std::vector<ManifoldPoint> points;
    const auto meet = [&](BodyId a, BodyId b) {
      const auto frame = [&](BodyId id) {
        return id == cube ? middle : Frame(small.scene.body(id).motion->pose(0));
      };
      const Frame frame_a = frame(a), frame_b = frame(b);
      points.clear();
      pair_manifold({small.scene.body(a), frame_a, small.scene.body(b), frame_b}, {}, {}, 1e-3,
                    points);
      EXPECT_EQ(points.size(), 4u);
    };
    meet(below, cube);
    for (const ManifoldPoint& p : points) EXPECT_TRUE(p.reference_is_a);
    meet(cube, above);
    for (const ManifoldPoint& p : points) EXPECT_FALSE(p.reference_is_a);
  }
}

// Slats of a belt are ground, too; no face of the cube is, though one lies in a plane.
TEST(PairManifold, sides_are_left_out_of_what_moves_as_told_but_of_nothing_dynamic) {
  for (const BodyKind kind : {BodyKind::kinematic, BodyKind::dynamic}) {
    TiledFloor small(1e-3, 1e-5, 1e-6);
    small.scene.bodies[small.second]->info.kind = kind;
    const std::vector<StandingPlane> planes{level_ground[0], {-Vec3::UnitZ(), 1e-5}};
    EXPECT_EQ(small.meet(small.second, true, planes).left_out, kind == BodyKind::kinematic);
    EXPECT_EQ(small.sideways() > 0, kind == BodyKind::dynamic);
  }
}

TEST(PairManifold, of_two_that_move_the_larger_face_is_the_reference) {
  SmallScene small;
  const BodyId less = small.add_cube(0.1, {0, 0, 0.05}), more = small.add_cube(0.3, {0, 0, 0.25});
  const Frame frame_a(Mat3::Identity(), {0, 0, 0.05}), frame_b(Mat3::Identity(), {0, 0, 0.25});
  std::vector<ManifoldPoint> points;
  pair_manifold({small.scene.body(less), frame_a, small.scene.body(more), frame_b}, {}, {}, 1e-3,
                points);
  EXPECT_EQ(points.size(), 4u);
  for (const ManifoldPoint& p : points) EXPECT_FALSE(p.reference_is_a);
}

TEST(PairManifold, what_is_farther_than_the_reach_has_no_points) {
  TiledFloor small(0, -1.1e-3, -0.2);
  EXPECT_EQ(small.meet(small.first, true).distance, never);
  EXPECT_TRUE(small.points.empty());
  TiledFloor near(0, -0.9e-3, -0.2);
  EXPECT_NEAR(near.meet(near.first, true).distance, 0.9e-3, 1e-15);
  EXPECT_EQ(near.points.size(), 4u);
}

}  // namespace
}  // namespace tw::test
