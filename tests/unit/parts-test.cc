// Parts: who hangs together with whom, by contacts made by hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "groups/contacts/contact-graph.h"
#include "support/small-scene.h"

namespace tw::test {
namespace {

const Key parting_key{0, 1, KeyKind::impact, 0};

// Cubes far above the floor, but said to touch.
struct Said : SmallScene {
  BodyId floor = add_floor();
  std::vector<BodyId> cubes;
  Contacts contacts;

  explicit Said(int count) {
    for (int i = 0; i < count; ++i) cubes.push_back(add_cube(0.1, {0.1 * i, 0, 1}));
  }
  void say(BodyId a, BodyId b) { touch(contacts, a, b, {0, 0, 0}, Vec3::UnitZ()); }
};

bool is_one_part(const Question& asked, Parts& parts, BodyId a, BodyId b) {
  const auto root = [&](BodyId id) {
    return parts.together.root(asked.work.place_of(asked.work.successor_of(id)));
  };
  return root(a) == root(b);
}

TEST(Parts, what_touches_in_a_row_hangs_together) {
  Said small(4);
  const std::vector<BodyId>& c = small.cubes;
  small.say(c[0], c[1]);
  small.say(c[1], c[2]);
  Question asked(small, parting_key, Cause::impact, c);
  Parts parts = parts_of(asked.work, small.contacts);
  EXPECT_TRUE(is_one_part(asked, parts, c[0], c[2]));
  EXPECT_FALSE(is_one_part(asked, parts, c[0], c[3]));
  EXPECT_EQ(parts.touching, (std::vector<bool>{true, true, true, false}));
  EXPECT_EQ(parts.held, parts.touching);
}

TEST(Parts, the_ground_holds_nothing_together) {
  Said small(2);
  const std::vector<BodyId>& c = small.cubes;
  small.say(small.floor, c[0]);
  small.say(small.floor, c[1]);
  Question asked(small, parting_key, Cause::impact, {small.floor, c[0], c[1]});
  // a fixed body takes part, but has no arc
  asked.of(small.floor).role = Role::no_state;
  Parts parts = parts_of(asked.work, small.contacts);
  EXPECT_FALSE(is_one_part(asked, parts, c[0], c[1]));
  EXPECT_EQ(parts.touching, (std::vector<bool>{false, true, true}));
}

TEST(Parts, who_stands_at_the_border_holds_nothing_together) {
  Said small(3);
  const std::vector<BodyId>& c = small.cubes;
  small.say(c[0], c[1]);
  small.say(c[1], c[2]);
  Question asked(small, parting_key, Cause::impact, {c[0], c[2]}, {c[1]});
  Parts parts = parts_of(asked.work, small.contacts);
  EXPECT_FALSE(is_one_part(asked, parts, c[0], c[2]));
  EXPECT_EQ(parts.held, (std::vector<bool>{true, true, false}));
}

// A ghost at a seam.
TEST(Parts, a_pair_without_points_holds_as_one_with) {
  Said small(2);
  small.contacts.pairs.push_back({pair_id(small.cubes[0], small.cubes[1]), 0, 0, false, {}});
  Question asked(small, parting_key, Cause::impact, small.cubes);
  Parts parts = parts_of(asked.work, small.contacts);
  EXPECT_TRUE(is_one_part(asked, parts, small.cubes[0], small.cubes[1]));
  EXPECT_EQ(parts.touching, (std::vector<bool>{true, true}));
}

// Without touching, whatever happens.
TEST(Parts, what_a_spring_ties_is_held_together) {
  Said small(3);
  const std::vector<BodyId>& c = small.cubes;
  Question asked(small, parting_key, Cause::impact, c);
  auto spring = std::make_shared<Bond>();
  spring->a = c[0];
  spring->b = c[2];
  spring->spring = {1, 0, 0};
  for (const BodyId id : {c[0], c[2]}) asked.of(id).data.forces = with_bond(nullptr, spring);
  Parts parts = parts_of(asked.work, small.contacts);
  EXPECT_TRUE(is_one_part(asked, parts, c[0], c[2]));
  EXPECT_EQ(parts.held, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(parts.touching, (std::vector<bool>{false, false, false}));
}

TEST(Parts, books_are_of_who_is_held) {
  Said small(2);
  small.say(small.floor, small.cubes[0]);
  Question asked(small, parting_key, Cause::impact, small.cubes);
  const Parts parts = parts_of(asked.work, small.contacts);
  // both stand still, as far as their states say
  EXPECT_EQ(parts.stillness[0].since, 0);
  EXPECT_EQ(parts.stillness[1].since, never);
}

// ---- who rests ----

// A row all of which were slow for long, but the first got faster; the parts at its next check.
struct RestlessFirst : Row {
  explicit RestlessFirst(int count) : Row(count) {
    while (tail(cubes[0]).key.time < 0.15) check(cubes[0], cubes);
    for (const BodyId cube : cubes)
      tail(cube).group->stillness[tail(cube).member] = {
          0, 0.1, 1e-4, cube == cubes[0] ? 2e-4 : 1e-5, tail(cube).x, tail(cube).q};
  }
  // How many rest, and whether the first hangs together with its neighbour.
  std::pair<std::size_t, bool> parts_at(Cause cause) const {
    Key key = group_check_key(group_of(cubes[0]), tail(cubes[0]).key.time);
    key.microstep += 1;
    Question asked(*this, key, cause, cubes);
    Contacts contacts = find_contacts(asked.work, processes(cubes));
    contacts.sort();
    Parts parts = parts_of(asked.work, contacts);
    const auto resting = std::count(parts.rests.begin(), parts.rests.end(), true);
    return {resting, is_one_part(asked, parts, cubes[0], cubes[1])};
  }
};

TEST(Parts, what_rests_and_what_is_awake_are_parts_of_their_own) {
  EXPECT_EQ(RestlessFirst(12).parts_at(Cause::check), std::pair(std::size_t{11}, false));
}

// Seven are fewer than answer::least_resting.
TEST(Parts, a_few_that_could_rest_stay_with_the_others) {
  EXPECT_EQ(RestlessFirst(8).parts_at(Cause::check), std::pair(std::size_t{0}, true));
}

TEST(Parts, rest_comes_at_checks_alone) {
  const RestlessFirst row(12);
  for (const Cause cause : {Cause::early_check, Cause::impact})
    EXPECT_EQ(row.parts_at(cause), std::pair(std::size_t{0}, true));
}

}  // namespace
}  // namespace tw::test
