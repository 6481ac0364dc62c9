// Contact groups without a world: who owns a contact, who gets a new arc, what is made of it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/regroup.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/small-scene.h"

namespace tw::test {
namespace {

Role role_of(const std::vector<Successor>& successors, BodyId id) {
  const auto at = std::find_if(successors.begin(), successors.end(),
                               [&](const Successor& s) { return s.body->id() == id; });
  return at == successors.end() ? Role::no_state : at->role;
}

TEST(Regroup, a_cube_that_fuses_with_the_floor_is_a_group_of_one) {
  SmallScene small;
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05});
  const std::vector<Successor> made = small.fuse(floor, cube, 0);
  EXPECT_EQ(role_of(made, cube), Role::new_arc);
  EXPECT_EQ(role_of(made, floor), Role::no_state);
  const Group& group = small.group_of(cube);
  EXPECT_EQ(group.members, small.processes({cube}));
  EXPECT_EQ(group.outside, std::vector<BodyId>{floor});
  EXPECT_FALSE(group.has_border);
  ASSERT_EQ(group.pairs.size(), 1u);
  EXPECT_EQ(group.pairs[0].count, 4u);
  // four points touch: each has a quarter of the stiffness
  for (const GroupContact& contact : group.arc->start().contacts) EXPECT_EQ(contact.share, 0.25);
}

// A cube that slides on: the time to its next check doubles, up to that of what hardly moves (1/30
// s); what comes meanwhile begins anew.
TEST(Regroup, what_goes_on_as_foreseen_is_checked_after_twice_the_time) {
  SmallScene small;
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05}, {0.5, 0, 0});
  ContactSettings slippery;
  slippery.friction = 0;
  small.scene.contacts.add({}, {}, slippery);
  small.fuse(floor, cube, 0);
  std::vector<double> lasted;
  for (int k = 0; k < 10; ++k) {
    const double from = small.group_of(cube).key.time;
    small.check(cube, {cube});
    lasted.push_back(small.group_of(cube).key.time - from);
  }
  EXPECT_EQ(small.group_of(cube).doublings, answer::most_halvings);
  EXPECT_DOUBLE_EQ(lasted.front(), 1.0 / 120);
  EXPECT_DOUBLE_EQ(lasted.back(), 1.0 / 30);
  small.regroup({small.group_of(cube).key.time + 1e-3, 1, KeyKind::impact, pair_id(floor, cube)},
                Cause::impact, {cube}, [](Successor& s) { s.data.v.y() = s.point.v.y() = 0.1; });
  EXPECT_EQ(small.group_of(cube).doublings, 0);
}

TEST(Regroup, what_hangs_together_is_one_group_but_not_over_the_floor) {
  SmallScene small;
  const BodyId floor = small.add_floor();
  const BodyId left = small.add_cube(0.1, {0, 0, 0.05}), right = small.add_cube(0.1, {1, 0, 0.05});
  small.fuse(floor, left, 0, 1);
  small.fuse(floor, right, 0, 2);
  EXPECT_NE(small.tail(left).group, small.tail(right).group);
  const BodyId on_top = small.add_cube(0.1, {1, 0, 0.15});
  small.fuse(right, on_top, 0, 3);
  EXPECT_EQ(small.tail(on_top).group, small.tail(right).group);
  EXPECT_EQ(small.group_of(right).members, small.processes({right, on_top}));
}

TEST(Regroup, a_small_group_gets_new_arcs_whole) {
  Row row(5);
  const std::vector<Successor> made =
      row.regroup(row.after(), Cause::impact, {row.cubes[0]}, [](Successor&) {});
  EXPECT_EQ(made.size(), 5u);
  for (const BodyId cube : row.cubes) EXPECT_EQ(role_of(made, cube), Role::new_arc);
}

TEST(Regroup, of_a_large_group_those_that_it_concerns_and_their_border) {
  Row row(12);
  ASSERT_EQ(row.group_of(row.cubes[0]).members.size(), 12u);
  const std::vector<Successor> made =
      row.regroup(row.after(), Cause::callback, {row.cubes[5]}, [](Successor&) {});
  // nobody notices anything: the one, and records of its neighbours on either side
  const Group& group = row.group_of(row.cubes[5]);
  EXPECT_TRUE(group.has_border);
  EXPECT_LT(group.members.size(), 12u);
  EXPECT_EQ(role_of(made, row.cubes[5]), Role::new_arc);
  EXPECT_EQ(role_of(made, row.cubes[0]), Role::no_state);
  for (const Successor& successor : made) {
    if (successor.role != Role::border) continue;
    EXPECT_EQ(successor.data.group.get(), &row.group_of(row.cubes[0]));
    EXPECT_FALSE(successor.data.changed);
  }
  EXPECT_EQ(std::count_if(made.begin(), made.end(),
                          [](const Successor& s) { return s.role == Role::border; }),
            2);
}

TEST(Regroup, a_blow_takes_in_whom_it_reaches) {
  Row row(12);
  const std::vector<Successor> made =
      row.regroup(row.after(), Cause::impact, {row.cubes[0]}, [](Successor& successor) {
        successor.data.v = successor.point.v = {1, 0, 0};
      });
  // 1 m/s against neighbours at touch: impulses go through the whole row
  for (const BodyId cube : row.cubes) EXPECT_EQ(role_of(made, cube), Role::new_arc);
  double momentum = 0;
  for (const Successor& successor : made) momentum += successor.point.v.x();
  EXPECT_NEAR(momentum, 1, 1e-12);
  EXPECT_GT(made.back().point.v.x() + row.tail(row.cubes[1]).v.x(), 0);
}

TEST(Regroup, an_edit_takes_whole_groups) {
  Row row(12);
  const std::vector<Successor> made =
      row.regroup({0, 100, KeyKind::edit, 0}, Cause::edit, {row.cubes[5]});
  EXPECT_EQ(made.size(), 12u);
}

TEST(Regroup, a_body_that_was_put_elsewhere_leaves_its_contacts) {
  Row row(3);
  row.regroup({0, 100, KeyKind::edit, 0}, Cause::edit, {row.cubes[2]}, [](Successor& successor) {
    successor.data.x = successor.point.x = {5, 0, 3};
    successor.placed = true;
  });
  EXPECT_FALSE(row.tail(row.cubes[2]).group);
  EXPECT_EQ(row.group_of(row.cubes[0]).members, row.processes({row.cubes[0], row.cubes[1]}));
}

TEST(Regroup, waits_for_those_whose_arcs_are_not_known_and_changes_nothing) {
  Row row(4);
  const Key key = row.after();
  const std::vector<Successor> given{
      make_successor(row.before(key), row.process(row.cubes[0]), true)};
  const std::size_t states = row.graph.state_count();
  const auto all_but_the_last = [&](ProcessId id) { return id != row.process(row.cubes[3]); };
  const auto result = regroup(row.before(key), row.surroundings, all_but_the_last, {Cause::impact},
                              given, row.counters);
  const Waits* waits = std::get_if<Waits>(&result);
  ASSERT_TRUE(waits);
  EXPECT_TRUE(holds(waits->region.inside, row.process(row.cubes[3])));
  EXPECT_EQ(row.graph.state_count(), states);
}

TEST(Regroup, is_a_function_of_what_stands_before_the_key) {
  Row row(12);
  const Key key = row.after();
  const std::vector<Successor> given{
      make_successor(row.before(key), row.process(row.cubes[4]), true)};
  const auto all = [](ProcessId) { return true; };
  const auto once = [&] {
    auto result =
        regroup(row.before(key), row.surroundings, all, {Cause::impact}, given, row.counters);
    return std::move(std::get<Regrouped>(result).successors);
  };
  const std::vector<Successor> first = once(), second = once();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].process(), second[i].process());
    EXPECT_EQ(first[i].role, second[i].role);
    EXPECT_EQ(first[i].data.v, second[i].data.v);
    if (first[i].role != Role::new_arc) continue;
    EXPECT_EQ(first[i].data.group->next_check(), second[i].data.group->next_check());
    EXPECT_EQ(first[i].data.group->gaps, second[i].data.group->gaps);
  }
}

// ---- who owns a contact ----

TEST(Owner, is_the_group_that_was_made_last) {
  Row row(12);
  const std::uint64_t middle = pair_id(row.cubes[5], row.cubes[6]);
  const Group* old = &row.group_of(row.cubes[0]);
  EXPECT_EQ(row.before(row.after()).owned(middle).owner.get(), old);
  row.regroup(row.after(), Cause::callback, {row.cubes[5]});
  const Group* fresh = &row.group_of(row.cubes[5]);
  ASSERT_NE(fresh, old);
  const Before later = row.before({0, 101, KeyKind::impact, 0});
  EXPECT_EQ(later.owned(middle).owner.get(), fresh);
  // before the blow it is as it was
  EXPECT_EQ(row.before(row.after()).owned(middle).owner.get(), old);
  // far from it nothing has changed
  EXPECT_EQ(later.owned(pair_id(row.cubes[0], row.cubes[1])).owner.get(), old);
}

TEST(Owner, all_that_hangs_together_is_found_over_both_groups) {
  Row row(12);
  row.regroup(row.after(), Cause::callback, {row.cubes[5]});
  const Before later = row.before({0, 101, KeyKind::impact, 0});
  EXPECT_EQ(later.hanging_together(row.process(row.cubes[11])), row.processes(row.cubes));
}

// Nothing has contacts before it has come to touch.
TEST(Owner, nobody_owns_what_does_not_touch) {
  SmallScene small;
  const BodyId a = small.add_cube(0.1, {0, 0, 1}), b = small.add_cube(0.1, {0.5, 0, 1});
  const Before::Owned owned = small.before({1, 0, KeyKind::step, 0}).owned(pair_id(a, b));
  EXPECT_FALSE(owned.pair);
  EXPECT_FALSE(owned.owner);
}

}  // namespace
}  // namespace tw::test
