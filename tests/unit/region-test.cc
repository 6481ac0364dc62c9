// Regions without a world: who gets new arcs, and who at the border would notice.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/region.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "groups/contacts/contact-graph.h"
#include "groups/contacts/share-stiffness.h"
#include "groups/regroup/make-groups.h"
#include "support/small-scene.h"

namespace tw::test {
namespace {

// Neighbours that press, and ones that are in contact but apart: by less than a static depth, and
// more than what is placed touching may be.
constexpr double pressed_gap = -1e-6, open_gap = 1e-5;

// The numbers of these among the cubes of a row; -1: somebody else.
std::vector<int> numbers_in(const Row& row, const std::vector<ProcessId>& processes) {
  std::vector<int> numbers;
  for (const ProcessId process : processes) {
    const auto at = std::find(row.cubes.begin(), row.cubes.end(), row.scene.body_of(process).id());
    numbers.push_back(at != row.cubes.end() ? static_cast<int>(at - row.cubes.begin()) : -1);
  }
  return numbers;
}
Region region_around(const Row& row, std::size_t cube, bool whole = false) {
  return region_of(row.before(row.after()), row.processes({row.cubes[cube]}), whole);
}
using InRow = std::vector<int>;

TEST(Region, is_who_is_struck_and_the_neighbours_that_press) {
  const Row row(12, pressed_gap);
  const Region region = region_around(row, 5);
  EXPECT_EQ(numbers_in(row, region.inside), (InRow{4, 5, 6}));
  EXPECT_EQ(numbers_in(row, region.border), (InRow{3, 7}));
}

TEST(Region, leaves_out_neighbours_that_carry_nothing) {
  const Row row(12, open_gap);
  const Region region = region_around(row, 5);
  EXPECT_EQ(numbers_in(row, region.inside), InRow{5});
  EXPECT_EQ(numbers_in(row, region.border), (InRow{4, 6}));
}

TEST(Region, leaves_out_neighbours_that_rest) {
  const Row row(12, pressed_gap);
  row.graph.tail(row.process(row.cubes[0]))->group->at_rest = true;
  const Region region = region_around(row, 5);
  EXPECT_EQ(numbers_in(row, region.inside), InRow{5});
  EXPECT_EQ(numbers_in(row, region.border), (InRow{4, 6}));
}

// answer::least_divided members: one less is not worth a border.
TEST(Region, of_a_small_group_is_all_of_it) {
  const Row small(7, open_gap), large(8, open_gap);
  EXPECT_EQ(region_around(small, 3).inside.size(), 7u);
  EXPECT_TRUE(region_around(small, 3).border.empty());
  EXPECT_EQ(region_around(large, 3).inside.size(), 1u);
  EXPECT_EQ(region_around(large, 3, true).inside.size(), 8u);
}

TEST(Region, that_is_widened_doubles_if_so_many_touch) {
  const Row row(12, pressed_gap);
  const Before before = row.before(row.after());
  Region region = region_around(row, 5);
  // from 3 to 6, on the side of who noticed
  widen(region, before, row.processes({row.cubes[7]}));
  EXPECT_EQ(numbers_in(row, region.inside), (InRow{4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(numbers_in(row, region.border), (InRow{3, 10}));
  // to 12, but beyond the end there is nobody
  widen(region, before, row.processes({row.cubes[10]}));
  EXPECT_EQ(numbers_in(row, region.inside), (InRow{4, 5, 6, 7, 8, 9, 10, 11}));

  const Row loose(12, open_gap);
  Region lone = region_around(loose, 5);
  widen(lone, loose.before(loose.after()), loose.processes({loose.cubes[6]}));
  EXPECT_EQ(numbers_in(loose, lone.inside), (InRow{5, 6}));
}

// ---- who notices ----

// After the phases before it.
Noticed noticed_after(const Question& asked) {
  Contacts contacts = find_contacts(asked.work, {});
  contacts.sort();
  share_stiffness(asked.work.scene(), contacts);
  Parts parts = parts_of(asked.work, contacts);
  const MadeGroups made = make_groups(asked.work, contacts, parts);
  enter_groups(asked.work, made);
  return who_notices(asked.work, contacts, made.all);
}

// Three cubes in a row of which the middle one gets a velocity: who notices that.
struct Pushed : SmallScene {
  BodyId floor = add_floor(), left = add_cube(0.1, {-0.1, 0, 0.05}),
         middle = add_cube(0.1, {0, 0, 0.05}), right = add_cube(0.1, {0.1, 0, 0.05});

  Noticed by(const Vec3& v) {
    // checks every 2 ms: what is pushed comes back after half a swing, pi sqrt(d0/g) = 5 ms
    options.group_check_rate = 16000;
    std::uint32_t microstep = 0;
    for (const BodyId cube : {left, middle, right}) fuse(floor, cube, 0, ++microstep);
    for (const BodyId cube : {left, right}) fuse(middle, cube, 0, ++microstep);
    Question asked(*this, {0, ++microstep, KeyKind::callback, 0}, Cause::callback, {middle},
                   {left, right});
    asked.set_velocity(middle, v);
    return noticed_after(asked);
  }
};

TEST(Region, nobody_notices_that_nothing_changes) {
  const Noticed noticed = Pushed().by(Vec3::Zero());
  EXPECT_TRUE(noticed.by.empty());
  EXPECT_EQ(noticed.momentum_dropped, 0);
}

TEST(Region, who_is_pushed_notices_and_who_is_left_does_not) {
  Pushed small, back;
  EXPECT_EQ(small.by({0.05, 0, 0}).by, small.processes({small.right}));
  EXPECT_EQ(back.by({-0.05, 0, 0}).by, back.processes({back.left}));
}

// Of 50 kg it may miss answer::missed_share of the tolerance 1e-4 sqrt(g size) of velocities times
// its mass, 1.5e-3 N s, of 1 kg 3e-5; 1 kg that comes with 2e-4 m/s gives it at most twice its
// momentum.
TEST(Region, what_nobody_notices_is_told_as_dropped) {
  Pushed light, heavy;
  heavy.scene.bodies[heavy.right]->mass = 50;
  EXPECT_EQ(light.by({2e-4, 0, 0}).by, light.processes({light.right}));
  const Noticed noticed = heavy.by({2e-4, 0, 0});
  EXPECT_TRUE(noticed.by.empty());
  EXPECT_GT(noticed.momentum_dropped, 0.2 * 2e-4);
  EXPECT_LT(noticed.momentum_dropped, 2 * 2e-4);
}

// A cube that slides on another without friction presses on as it did.
TEST(Region, a_load_that_stays_is_not_noticed) {
  SmallScene small;
  small.options.group_check_rate = 16000;
  ContactSettings slippery;
  slippery.friction = 0;
  small.scene.contacts.add({}, {}, slippery);
  const BodyId floor = small.add_floor(), lower = small.add_cube(0.1, {0, 0, 0.05}),
               upper = small.add_cube(0.1, {0, 0, 0.15});
  small.fuse(floor, lower, 0, 1);
  small.fuse(lower, upper, 0, 2);
  Question asked(small, {0, 3, KeyKind::callback, 0}, Cause::callback, {upper}, {lower});
  asked.set_velocity(upper, {0.01, 0, 0});
  const Noticed noticed = noticed_after(asked);
  EXPECT_TRUE(noticed.by.empty());
  // of 9.81 N for 2 ms
  EXPECT_LT(noticed.momentum_dropped, 1e-3 * 9.81 * 2e-3);
}

// A cube on another, both at rest; the upper one is taken away.
std::vector<ProcessId> noticed_of_relief(double upper_mass) {
  SmallScene small;
  const BodyId floor = small.add_floor(), lower = small.add_cube(0.1, {0, 0, 0.05}),
               upper = small.add_cube(0.1, {0, 0, 0.15});
  small.scene.bodies[upper]->mass = upper_mass;
  // placed touching: it starts with the loads of what stands
  small.fuse(floor, lower, 0, 1);
  small.fuse(lower, upper, 0, 2);
  small.graph.tail(small.process(lower))->group->at_rest = true;
  Question asked(small, {0, 3, KeyKind::edit, 0}, Cause::edit, {upper}, {lower});
  asked.of(upper).placed = true;
  const Contacts contacts = find_contacts(asked.work, {});
  EXPECT_TRUE(contacts.pairs.empty());
  return who_notices(asked.work, contacts, {}).by;
}

// answer::wake_share of the lower one's weight.
TEST(Region, what_rests_notices_that_a_fiftieth_of_its_weight_is_gone) {
  EXPECT_EQ(noticed_of_relief(0.021).size(), 1u);
  EXPECT_TRUE(noticed_of_relief(0.019).empty());
}

}  // namespace
}  // namespace tw::test
