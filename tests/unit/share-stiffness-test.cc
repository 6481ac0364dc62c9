// How the contacts of a pair share its stiffness, by contacts made by hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/share-stiffness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/small-scene.h"

namespace tw::test {
namespace {

// A cube of 0.1 m on a floor: d0 = 2.5e-5 m, points nearer than 1e-3 m to each other begin to be
// one.
struct SharingCube : SmallScene {
  BodyId floor = add_floor();
  BodyId cube = add_cube(0.1, {0, 0, 0.05});
  Contacts contacts;

  NewContact& on_floor(double x, double y, double gap = 0) {
    return touch(contacts, floor, cube, {x, y, 0}, Vec3::UnitZ(), gap);
  }
  std::vector<double> shares() {
    share_stiffness(scene, contacts);
    std::vector<double> result;
    for (const NewContact& c : contacts.all) result.push_back(c.contact.share);
    return result;
  }
};

void expect_shares(const std::vector<double>& shares, const std::vector<double>& expected) {
  ASSERT_EQ(shares.size(), expected.size());
  for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_NEAR(shares[i], expected[i], 1e-12) << i;
}

constexpr double static_depth = 2.5e-5;

TEST(ShareStiffness, four_points_of_a_box_have_a_quarter_each) {
  SharingCube small;
  for (const double x : {-0.05, 0.05})
    for (const double y : {-0.05, 0.05}) small.on_floor(x, y);
  expect_shares(small.shares(), {0.25, 0.25, 0.25, 0.25});
}

// m_i = 2 of the two, 1 of the third; n = 1/2 + 1/2 + 1: shares 1 / (n m).
TEST(ShareStiffness, two_at_one_place_have_half_of_one) {
  SharingCube small;
  small.on_floor(-0.05, 0);
  small.on_floor(0.05, 0);
  small.on_floor(0.05, 0);
  expect_shares(small.shares(), {0.5, 0.25, 0.25});
}

// Half of 1e-3 m apart: m = 3/2 of both, n = 2/m + 1 = 7/3.
TEST(ShareStiffness, points_become_one_by_degrees) {
  SharingCube small;
  small.on_floor(-0.05, 0);
  small.on_floor(0.05, 0);
  small.on_floor(0.05, 5e-4);
  expect_shares(small.shares(), {3.0 / 7, 2.0 / 7, 2.0 / 7});
}

// Counts are 1 up to a gap of d0 and go to 0 at twice that.
TEST(ShareStiffness, a_point_counts_by_how_near_it_is) {
  const auto share_beside = [](double gap) {
    SharingCube small;
    small.on_floor(-0.05, 0);
    small.on_floor(0.05, 0, gap).tag.parts = 1;
    return small.shares().front();
  };
  EXPECT_NEAR(share_beside(static_depth), 1 / 2.0, 1e-12);
  EXPECT_NEAR(share_beside(1.5 * static_depth), 1 / 1.5, 1e-9);
  EXPECT_EQ(share_beside(2.5 * static_depth), 1);
}

// Of one pair of parts, what lies flat beside what touches counts as flat as it lies; and so do
// those that are not here.
TEST(ShareStiffness, a_far_point_counts_as_flat_as_it_lies) {
  SharingCube small, rocks;
  small.on_floor(-0.05, 0);
  small.on_floor(0.05, 0, 1e-3).tag.flatness = 0.6;
  expect_shares(small.shares(), {1 / 1.6, 1 / 1.6});
  rocks.on_floor(-0.05, 0).tag.beyond = 3;
  expect_shares(rocks.shares(), {1.0 / 4});
}

// As far as their normals agree to 1e-3 rad; told by the ground's face or by the cube's.
TEST(ShareStiffness, coplanar_pieces_of_the_ground_are_one) {
  const auto shares_with_tilt = [](double tilt) {
    SharingCube small;
    const BodyId tile = small.add_fixed_box({1, 1, 0.1}, {0.5, 0, -0.05});
    small.on_floor(-0.05, -0.05);
    small.on_floor(-0.05, 0.05);
    const Vec3 down(std::sin(tilt), 0, -std::cos(tilt));
    small.touch(small.contacts, small.cube, tile, {0.05, -0.05, 0}, down);
    small.touch(small.contacts, small.cube, tile, {0.05, 0.05, 0}, down);
    return small.shares();
  };
  expect_shares(shares_with_tilt(0.9e-3), {0.25, 0.25, 0.25, 0.25});
  expect_shares(shares_with_tilt(1.1e-3), {0.5, 0.5, 0.5, 0.5});
}

TEST(ShareStiffness, a_wall_beside_the_floor_takes_nothing_from_it) {
  SharingCube small;
  const BodyId wall = small.add_fixed_box({0.1, 1, 1}, {0.1, 0, 0});
  small.on_floor(-0.05, 0);
  small.on_floor(0.05, 0);
  small.touch(small.contacts, wall, small.cube, {0.05, 0, 0}, -Vec3::UnitX());
  expect_shares(small.shares(), {0.5, 0.5, 1});
}

// Normals do not matter between two that move: all points are of one pair.
TEST(ShareStiffness, two_moving_bodies_share_over_all_normals) {
  SharingCube small;
  const BodyId other = small.add_cube(0.1, {0.1, 0, 0.1});
  small.touch(small.contacts, small.cube, other, {0.05, 0, 0.05}, Vec3::UnitX());
  small.touch(small.contacts, small.cube, other, {0.05, 0, 0.09}, Vec3::UnitZ());
  expect_shares(small.shares(), {0.5, 0.5});
}

// Beyond ten hardening depths, 5e-4 m here: energy must not come from points that part.
TEST(ShareStiffness, a_deep_contact_gets_no_larger_share_than_before) {
  const auto share_at = [](double depth) {
    SharingCube small;
    small.on_floor(0, 0, -depth).share_before = 0.25;
    return small.shares().front();
  };
  EXPECT_EQ(share_at(4.9e-4), 1);
  EXPECT_EQ(share_at(5.1e-4), 0.25);
}

}  // namespace
}  // namespace tw::test
