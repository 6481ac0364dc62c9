// Who is squeezed, by contacts made by hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/told/squeezed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/small-scene.h"

namespace tw::test {
namespace {

// A cube of 0.1 m between two walls along x: a depth of 2e-3 m is answer::squeezed_share of it.
// Contacts are soft, with their limit far below: none alone squeezes anybody.
struct Vice : SmallScene {
  BodyId left, cube, right;
  Contacts contacts;

  Vice() {
    ContactSettings soft;
    soft.stiffness = 100;
    scene.contacts.add({}, {}, soft);
    left = add_fixed_box({0.1, 1, 1}, {-0.1, 0, 1});
    cube = add_cube(0.1, {0, 0, 1});
    right = add_fixed_box({0.1, 1, 1}, {0.1, 0, 1});
  }
  NewContact& press_left(double depth) {
    return touch(contacts, left, cube, {-0.05, 0, 1}, Vec3::UnitX(), -depth);
  }
  // From the other side, at an angle to the line through both, rad.
  NewContact& press_right(double depth, double angle = 0) {
    const Vec3 normal(std::cos(angle), std::sin(angle), 0);
    return touch(contacts, cube, right, {0.05, 0, 1}, normal, -depth);
  }
};

constexpr double pressed_long_ago = -1;

struct Squeezing {
  Told told;
  double since = never;  // of the cube

  explicit Squeezing(const Vice& small, double since_before = never,
                     const std::vector<BodyId>& others = {}) {
    std::vector<BodyId> bodies{small.cube};
    bodies.insert(bodies.end(), others.begin(), others.end());
    Question asked(small, {0, 1, KeyKind::group_check, 0}, Cause::check, bodies);
    asked.of(small.cube).data.squeezed_since = since_before;
    told = note_squeezed(asked.work, small.contacts);
    since = asked.of(small.cube).data.squeezed_since;
  }
  bool any() const { return since < never; }
};

TEST(Squeezed, is_who_is_pressed_from_two_sides_by_a_fiftieth_of_its_thickness) {
  Vice deep, shallow;
  deep.press_left(1.5e-3);
  deep.press_right(2.1e-3);
  const Squeezing squeezed(deep);
  EXPECT_EQ(squeezed.since, 0);
  EXPECT_EQ(squeezed.told.tally.squeezed, 1);
  EXPECT_NEAR(squeezed.told.tally.squeezed_depth, 2.1e-3, 1e-15);
  EXPECT_NEAR(squeezed.told.tally.squeezed_share, 0.021, 1e-12);
  shallow.press_left(1.9e-3);
  shallow.press_right(1.9e-3);
  EXPECT_FALSE(Squeezing(shallow).any());
}

TEST(Squeezed, the_report_names_both_walls_and_the_deeper_overlap) {
  Vice small;
  small.press_left(1.5e-3);
  small.press_right(2.1e-3);
  const Squeezing squeezed(small);
  ASSERT_EQ(squeezed.told.report.size(), 1u);
  const Collision& row = squeezed.told.report.front();
  EXPECT_EQ(row.kind, CollisionKind::squeezed);
  EXPECT_EQ(row.squeezed, small.cube);
  EXPECT_EQ(row.body1, small.left);
  EXPECT_EQ(row.body2, small.right);
  EXPECT_EQ(row.normal, Vec3(1, 0, 0));
  EXPECT_EQ(row.point, Vec3(0.05, 0, 1));
  EXPECT_EQ(row.depth, 2.1e-3);
}

TEST(Squeezed, who_was_stays_so_down_to_half_that_depth_and_is_told_of_once) {
  Vice less, free;
  less.press_left(1.1e-3);
  less.press_right(1.1e-3);
  const Squeezing stays(less, pressed_long_ago);
  EXPECT_EQ(stays.since, pressed_long_ago);
  EXPECT_EQ(stays.told.tally.squeezed, 0);
  EXPECT_TRUE(stays.told.report.empty());
  EXPECT_NEAR(stays.told.tally.squeezed_share, 0.011, 1e-12);
  free.press_left(0.9e-3);
  free.press_right(0.9e-3);
  EXPECT_FALSE(Squeezing(free, pressed_long_ago).any());
}

TEST(Squeezed, nobody_is_by_one_side_alone) {
  Vice small;
  small.press_left(5e-3);
  EXPECT_FALSE(Squeezing(small).any());
}

// The forces have to be more than 120 degrees apart.
TEST(Squeezed, nobody_is_by_forces_at_an_obtuse_angle) {
  Vice wedge, corner;
  wedge.press_left(3e-3);
  wedge.press_right(3e-3, 59 * pi / 180);
  EXPECT_TRUE(Squeezing(wedge).any());
  corner.press_left(3e-3);
  corner.press_right(3e-3, 61 * pi / 180);
  EXPECT_FALSE(Squeezing(corner).any());
}

// answer::squeezed_force_share: forces at one depth are as the shares of their springs.
TEST(Squeezed, nobody_is_by_a_force_a_tenth_of_the_other) {
  for (const double share : {0.09, 0.11}) {
    Vice small;
    small.press_left(3e-3);
    small.press_right(3e-3).contact.share = share;
    EXPECT_EQ(Squeezing(small).any(), share > 0.1);
    // two such on one side are twice as much
    small.press_right(3e-3).contact.share = share;
    EXPECT_TRUE(Squeezing(small).any());
  }
}

TEST(Squeezed, a_body_that_can_give_way_squeezes_nobody_until_it_is_held_too) {
  Vice small;
  const BodyId second = small.add_cube(0.1, {0.1, 0, 1});
  small.press_left(3e-3);
  small.touch(small.contacts, small.cube, second, {0.05, 0, 1}, Vec3::UnitX(), -3e-3);
  EXPECT_FALSE(Squeezing(small, never, {second}).any());
  // not by what stands under it
  small.touch(small.contacts, small.right, second, {0.1, 0, 0.95}, Vec3::UnitZ(), -3e-3);
  EXPECT_FALSE(Squeezing(small, never, {second}).any());
  small.touch(small.contacts, small.right, second, {0.15, 0, 1}, -Vec3::UnitX(), -1e-4);
  EXPECT_TRUE(Squeezing(small, never, {second}).any());
}

// Whether a cube is squeezed by default contacts, the limit of which is a hundredth of the
// thickness, with one wall or between two.
bool squeezed_by_default(double depth, int walls) {
  SmallScene small;
  const BodyId left = small.add_fixed_box({0.1, 1, 1}, {-0.1, 0, 1}),
               right = small.add_fixed_box({0.1, 1, 1}, {0.1, 0, 1}),
               cube = small.add_cube(0.1, {0, 0, 1});
  Contacts contacts;
  small.touch(contacts, left, cube, {-0.05, 0, 1}, Vec3::UnitX(), -depth);
  if (walls == 2) small.touch(contacts, right, cube, {0.05, 0, 1}, -Vec3::UnitX(), -depth);
  Question asked(small, {0, 1, KeyKind::group_check, 0}, Cause::check, {cube});
  note_squeezed(asked.work, contacts);
  return asked.of(cube).data.squeezed_since < never;
}

TEST(Squeezed, is_who_a_single_contact_presses_beyond_its_limit) {
  EXPECT_TRUE(squeezed_by_default(1.1e-3, 1));
  EXPECT_FALSE(squeezed_by_default(0.9e-3, 1));
}

// There the depth counts that begins between two.
TEST(Squeezed, between_two_the_limit_of_one_contact_is_none) {
  EXPECT_FALSE(squeezed_by_default(1.9e-3, 2));
  EXPECT_TRUE(squeezed_by_default(2.1e-3, 2));
}

// Of two that one contact presses so the one with the lesser mass is told of.
TEST(Squeezed, of_two_the_lighter_one) {
  SmallScene small;
  const BodyId one = small.add_cube(0.1, {0, 0, 1}), two = small.add_cube(0.1, {0.1, 0, 1});
  small.scene.bodies[two]->mass = 2;
  Contacts contacts;
  small.touch(contacts, one, two, {0.05, 0, 1}, Vec3::UnitX(), -2e-3);
  Question asked(small, {0, 1, KeyKind::group_check, 0}, Cause::check, {one, two});
  note_squeezed(asked.work, contacts);
  EXPECT_EQ(asked.of(one).data.squeezed_since, 0);
  EXPECT_EQ(asked.of(two).data.squeezed_since, never);
}

}  // namespace
}  // namespace tw::test
