// Impulses passed on through contacts, by contacts made by hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/propagation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/small-scene.h"

namespace tw::test {
namespace {

// Cubes of 0.1 m and 1 kg in free space in a row along x that touch at the middles of their faces.
struct FreeRow : SmallScene {
  std::vector<BodyId> cubes;
  Contacts contacts;

  // `gap`: of all contacts, m.  By default a contact bears 0.07 sqrt(g 0.1 m) = 0.0693 m/s.
  explicit FreeRow(int count, double gap = 0) {
    for (int i = 0; i < count; ++i) cubes.push_back(add_cube(0.1, {0.1 * i, 0, 1}));
    for (int i = 1; i < count; ++i)
      touch(contacts, at(i - 1), at(i), {0.1 * i - 0.05, 0, 1}, Vec3::UnitX(), gap);
  }
  BodyId at(int i) const { return cubes[static_cast<std::size_t>(i)]; }
};

const Key blow_key{0, 1, KeyKind::impact, 0};

double momentum_along_x(const FreeRow& row, Question& asked) {
  double sum = 0;
  for (const BodyId cube : row.cubes) sum += row.scene.body(cube).mass * asked.of(cube).point.v.x();
  return sum;
}

TEST(PassOnImpulses, of_two_cubes_that_meet_neither_is_faster) {
  FreeRow row(2);
  row.scene.bodies[row.at(1)]->mass = 3;
  Question asked(row, blow_key, Cause::impact, row.cubes);
  asked.set_velocity(row.at(0), {1, 2, 0});
  row.contacts.all.front().contact.law.mu = 0;
  const PassedOn passed = pass_on_impulses(asked.work, row.contacts);
  EXPECT_TRUE(passed.at_border.empty());
  EXPECT_TRUE(passed.parted.empty());
  // 1 kg m/s over 4 kg; along the contact, without friction, nothing changes
  EXPECT_NEAR((asked.of(row.at(0)).point.v - Vec3(0.25, 2, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((asked.of(row.at(1)).point.v - Vec3(0.25, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(asked.of(row.at(1)).data.v, asked.of(row.at(1)).point.v);
}

// Springs so stiff that they bear next to nothing: 0.07 sqrt(g d0 / 2.5e-4), d0 = m g / k.
TEST(PassOnImpulses, a_row_goes_on_with_one_velocity_and_all_momentum) {
  FreeRow row(6);
  const double stiffness = 1e12, borne = 0.07 * 9.81 * std::sqrt(1 / (stiffness * 2.5e-4));
  for (NewContact& c : row.contacts.all) c.contact.law.depth = 9.81 / stiffness;
  ContactSettings settings;
  settings.fusion_speed = 1e-9;
  row.scene.contacts.add({}, {}, settings);
  Question asked(row, blow_key, Cause::impact, row.cubes);
  asked.set_velocity(row.at(0), {1, 0, 0});
  pass_on_impulses(asked.work, row.contacts);
  EXPECT_NEAR(momentum_along_x(row, asked), 1, 1e-12);
  for (const BodyId cube : row.cubes)
    EXPECT_NEAR(asked.of(cube).point.v.x(), 1.0 / 6, 6 * borne) << cube;
}

TEST(PassOnImpulses, what_a_spring_bears_it_is_left) {
  const double borne = 0.07 * std::sqrt(9.81 * 0.1);
  for (const double share : {0.99, 1.01}) {
    FreeRow row(2);
    Question asked(row, blow_key, Cause::impact, row.cubes);
    asked.set_velocity(row.at(0), {share * borne, 0, 0});
    pass_on_impulses(asked.work, row.contacts);
    EXPECT_NEAR(asked.of(row.at(1)).point.v.x(), share < 1 ? 0 : share * borne / 2, 1e-12);
  }
}

// Deeper than ten hardening depths, 5e-4 m here, it bears any speed.
TEST(PassOnImpulses, a_deep_contact_gets_none) {
  for (const double depth : {4.9e-4, 5.1e-4}) {
    FreeRow row(2, -depth);
    Question asked(row, blow_key, Cause::impact, row.cubes);
    asked.set_velocity(row.at(0), {1, 0, 0});
    pass_on_impulses(asked.work, row.contacts);
    EXPECT_NEAR(asked.of(row.at(1)).point.v.x(), depth < 5e-4 ? 0.5 : 0, 1e-12);
  }
}

TEST(PassOnImpulses, one_that_reaches_the_border_names_who_stands_there_and_changes_nothing) {
  FreeRow row(4);
  Question asked(row, blow_key, Cause::impact, {row.at(0), row.at(1), row.at(2)}, {row.at(3)});
  asked.set_velocity(row.at(0), {1, 0, 0});
  const PassedOn passed = pass_on_impulses(asked.work, row.contacts);
  EXPECT_EQ(passed.at_border, row.processes({row.at(3)}));
  EXPECT_EQ(asked.of(row.at(0)).point.v, Vec3(1, 0, 0));
  for (const int i : {1, 2, 3}) EXPECT_EQ(asked.of(row.at(i)).point.v, Vec3(0, 0, 0)) << i;
}

TEST(PassOnImpulses, one_that_dies_away_before_the_border_names_nobody) {
  FreeRow row(4);
  Question asked(row, blow_key, Cause::impact, {row.at(0), row.at(1), row.at(2)}, {row.at(3)});
  // 0.1, 0.05: the next contact bears that
  asked.set_velocity(row.at(0), {0.1, 0, 0});
  EXPECT_TRUE(pass_on_impulses(asked.work, row.contacts).at_border.empty());
  EXPECT_NEAR(asked.of(row.at(0)).point.v.x(), 0.05, 1e-12);
  EXPECT_NEAR(asked.of(row.at(1)).point.v.x(), 0.05, 1e-12);
}

// A gap beyond answer::touching of the static depth carries nothing: it is for collision checks,
// where it closes fast.
TEST(PassOnImpulses, pairs_that_carry_nothing_and_close_fast_are_parted) {
  const auto parted = [](double gap, double speed) {
    FreeRow row(2, gap);
    Question asked(row, blow_key, Cause::impact, row.cubes);
    asked.set_velocity(row.at(0), {speed, 0, 0});
    const std::vector<std::uint64_t> pairs = pass_on_impulses(asked.work, row.contacts).parted;
    if (!pairs.empty()) {
      EXPECT_EQ(pairs, std::vector<std::uint64_t>{pair_id(row.at(0), row.at(1))});
      EXPECT_EQ(asked.of(row.at(0)).point.v.x(), speed);
    }
    return !pairs.empty();
  };
  EXPECT_TRUE(parted(1e-5, 1));
  EXPECT_FALSE(parted(1e-5, 0.05));
  EXPECT_FALSE(parted(1e-5, -1));
  EXPECT_FALSE(parted(0, 1));
  EXPECT_FALSE(parted(1e-9, 1));
}

// A cube that turns about the point where it touches comes with another at 20 rad/s 0.05 m.
TEST(PassOnImpulses, a_pair_that_carries_at_one_point_is_not_parted) {
  FreeRow row(2);
  row.touch(row.contacts, row.at(0), row.at(1), {0.05, 0.05, 1}, Vec3::UnitX(), 1e-5);
  Question asked(row, blow_key, Cause::impact, row.cubes);
  asked.of(row.at(0)).point.w = {0, 0, -20};
  EXPECT_TRUE(pass_on_impulses(asked.work, row.contacts).parted.empty());
  row.contacts.all[0].gap = 1e-5;
  EXPECT_EQ(pass_on_impulses(asked.work, row.contacts).parted.size(), 1u);
}

// What one impulse makes fast counts: the cube in the middle is struck, and flies at the third.
TEST(PassOnImpulses, pairs_are_parted_by_what_comes_of_impulses) {
  FreeRow row(3);
  row.contacts.all[1].gap = 1e-5;
  Question asked(row, blow_key, Cause::impact, row.cubes);
  asked.set_velocity(row.at(0), {1, 0, 0});
  EXPECT_EQ(pass_on_impulses(asked.work, row.contacts).parted,
            std::vector<std::uint64_t>{pair_id(row.at(1), row.at(2))});
  EXPECT_NEAR(asked.of(row.at(1)).point.v.x(), 0.5, 1e-12);
}

// A wall of 1 m/s pushes 1 kg, which takes 1 N s: 1 J, of which the cube has half.
TEST(PassOnImpulses, the_work_of_kinematic_bodies_is_told) {
  FreeRow row(1);
  const BodyId wall = row.add_fixed_box({0.1, 1, 1}, {-0.1, 0, 1});
  row.scene.bodies[wall]->info.kind = BodyKind::kinematic;
  row.touch(row.contacts, wall, row.at(0), {-0.05, 0, 1}, Vec3::UnitX());
  Question asked(row, blow_key, Cause::impact, {row.at(0)}, {wall});
  asked.of(wall).point.v = {1, 0, 0};
  const PassedOn passed = pass_on_impulses(asked.work, row.contacts);
  EXPECT_TRUE(passed.at_border.empty());
  EXPECT_NEAR(asked.of(row.at(0)).point.v.x(), 1, 1e-12);
  EXPECT_NEAR(passed.tally.kinematic_work, 1, 1e-12);
}

}  // namespace
}  // namespace tw::test
