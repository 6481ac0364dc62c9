// What new contacts have of old ones, by contacts and a group made by hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/match-contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "support/small-scene.h"

namespace tw::test {
namespace {

TEST(TurnedInto, is_as_long_in_the_other_plane) {
  const Vec3 normal = Vec3(1, 0, 1).normalized(), stretch(3e-6, 4e-6, 0);
  const Vec3 turned = turned_into(stretch, normal);
  EXPECT_NEAR(turned.norm(), 5e-6, 1e-20);
  EXPECT_NEAR(turned.dot(normal), 0, 1e-20);
  // (3, 4, 0) less its part along the normal is (1.5, 4, -1.5)
  EXPECT_NEAR(turned.cross(Vec3(1.5, 4, -1.5)).norm(), 0, 1e-18);
  EXPECT_GT(turned.y(), 0);
  // nothing is left of what is along the normal
  EXPECT_EQ(turned_into({0, 0, 2}, Vec3::UnitZ()), Vec3(Vec3::Zero()));
}

// A cube of 0.1 m on a floor (d0 = 2.5e-5 m) with a group of contacts made by hand since time 0.
struct Remembered : SmallScene {
  BodyId floor = add_floor(), cube = add_cube(0.1, {0, 0, 0.05});
  std::shared_ptr<Group> group = std::make_shared<Group>();
  GroupStart start;
  Contacts contacts;  // new ones

  // An old contact of the floor with a point of the cube.
  GroupContact& old(double x, const Vec3& stretch, std::uint64_t feature = 0, double gap = 0) {
    group->tags.push_back({floor, cube, 0, feature});
    GroupContact contact;
    contact.a = ~0;
    contact.b = 0;
    contact.point_b = {x, 0, gap - 0.05};
    contact.stretch = stretch;
    Contacts made;
    contact.law = touch(made, floor, cube, {x, 0, 0}, Vec3::UnitZ()).contact.law;
    return start.contacts.emplace_back(contact);
  }
  NewContact& fresh(double x, double gap = 0) {
    return touch(contacts, floor, cube, {x, 0, 0}, Vec3::UnitZ(), gap);
  }
  // The group is as it is now.
  void remember(double until = 0) {
    start.members.emplace_back().x = {0, 0, 0.05};
    start.outside = {scene.body(floor).motion};
    start.end = 1;
    group->members = {process(cube)};
    group->outside = {floor};
    group->pairs = {
        {pair_id(floor, cube), 0, static_cast<std::uint32_t>(start.contacts.size()), true, {}}};
    group->pair_starts = {0, 1};
    group->pairs_by_member = {0};
    group->arc = std::make_shared<GroupArc>(start);
    group->arc->extend(until);
  }
  // Matches new ones with old ones at that time.
  const std::vector<NewContact>& match(double when = 0) {
    remember(when);
    Question asked(*this, {when, 1, KeyKind::group_check, 0}, Cause::check, {cube});
    match_old(asked.work, contacts.all, contacts.pairs.front(),
              {group->pairs.front().id, group, &group->pairs.front()});
    return contacts.all;
  }
};

const Vec3 one_way(1e-6, 0, 0), other_way(0, 2e-6, 0);

TEST(MatchContacts, a_new_contact_takes_the_stretch_of_the_nearest_old_one) {
  Remembered small;
  small.old(-0.05, one_way).share = 0.25;
  small.old(0.05, other_way).share = 0.75;
  small.fresh(0.045);
  small.fresh(-0.049);
  const std::vector<NewContact>& now = small.match();
  EXPECT_NEAR((now[0].contact.stretch - other_way).norm(), 0, 1e-20);
  EXPECT_NEAR((now[1].contact.stretch - one_way).norm(), 0, 1e-20);
  EXPECT_EQ(now[0].share_before, 0.75);
  EXPECT_TRUE(now[0].law_before);
}

// 3 mm from the old one of the same feature, 2 mm from another.
TEST(MatchContacts, of_the_same_feature_it_counts_as_half_as_far) {
  for (const bool same_feature : {true, false}) {
    Remembered small;
    small.old(0, one_way, 7);
    small.old(0.005, other_way, 8);
    small.fresh(0.003).tag.feature = same_feature ? 7 : 9;
    EXPECT_NEAR((small.match()[0].contact.stretch - (same_feature ? one_way : other_way)).norm(), 0,
                1e-20);
  }
}

// A tenth of the size, 10 mm; twice that by the feature.
TEST(MatchContacts, what_is_too_far_is_another_one) {
  const auto is_known = [](double x, std::uint64_t feature) {
    Remembered small;
    small.old(0, one_way, 7);
    small.fresh(x).tag.feature = feature;
    return small.match()[0].contact.stretch != Vec3(Vec3::Zero());
  };
  EXPECT_TRUE(is_known(9.9e-3, 8));
  EXPECT_FALSE(is_known(10.1e-3, 8));
  EXPECT_TRUE(is_known(19.9e-3, 7));
  EXPECT_FALSE(is_known(20.1e-3, 7));
}

TEST(MatchContacts, where_one_becomes_two_the_nearer_is_it) {
  Remembered small;
  small.old(0, one_way);
  small.fresh(0.002);
  small.fresh(-0.001);
  const std::vector<NewContact>& now = small.match();
  EXPECT_EQ(now[0].contact.stretch, Vec3(Vec3::Zero()));
  EXPECT_NEAR((now[1].contact.stretch - one_way).norm(), 0, 1e-20);
}

TEST(MatchContacts, seen_from_the_other_body_the_stretch_is_the_other_way) {
  Remembered small;
  small.old(0, one_way);
  NewContact& turned = small.fresh(0);
  std::swap(turned.tag.reference, turned.tag.other);
  turned.normal = -turned.normal;
  EXPECT_NEAR((small.match()[0].contact.stretch + one_way).norm(), 0, 1e-20);
}

// An offset goes as the contact opens, over the time 2 pi sqrt(d0/g) = 0.01003 s.
TEST(MatchContacts, an_offset_goes_by_how_far_a_contact_opens_and_for_how_long) {
  const double offset = 2e-5, gap = 1e-5, swing = 2 * pi * std::sqrt(2.5e-5 / 9.81);
  const auto left = [&](double now_gap, double when) {
    Remembered small;
    small.old(0, Vec3::Zero()).offset = offset;
    small.fresh(0, now_gap);
    return small.match(when)[0].contact.offset;
  };
  EXPECT_EQ(left(gap, 0), offset);
  EXPECT_NEAR(left(gap, 0.5 * swing), offset - 0.5 * gap, 1e-15);
  EXPECT_NEAR(left(gap, 3 * swing), offset - gap, 1e-15);
  EXPECT_EQ(left(-gap, 3 * swing), offset);
  EXPECT_EQ(left(3 * offset, 3 * swing), 0);
}

TEST(MatchContacts, a_point_beside_loaded_ones_presses_from_the_same_depth) {
  for (const int parts : {0, 1}) {
    Remembered small;
    small.old(-0.01, one_way).offset = 1e-5;
    small.old(-0.05, one_way).offset = 2e-5;
    small.fresh(0.05).tag.parts = parts;
    const NewContact& now = small.match()[0];
    EXPECT_EQ(now.contact.offset, parts == 0 ? 1e-5 : 0);
    EXPECT_EQ(now.contact.stretch, Vec3(Vec3::Zero()));
  }
}

TEST(MatchContacts, of_another_piece_of_the_ground_too_but_not_of_a_wall) {
  Remembered small;
  small.old(0.05, one_way).offset = 2e-5;
  small.remember();
  const BodyId tile = small.add_fixed_box({1, 1, 0.1}, {0.55, 0, -0.05});
  NewContact level = small.touch(small.contacts, tile, small.cube, {0.05, 0, 0}, Vec3::UnitZ());
  NewContact wall = small.touch(small.contacts, tile, small.cube, {0.05, 0, 0}, -Vec3::UnitX());
  Question asked(small, {0, 1, KeyKind::group_check, 0}, Cause::check, {small.cube});
  asked.of(small.cube).data.group = small.group;
  for (NewContact* c : {&level, &wall})
    take_ground_offset(asked.work, small.scene.body(tile), small.scene.body(small.cube), *c);
  EXPECT_EQ(level.contact.offset, 2e-5);
  EXPECT_EQ(wall.contact.offset, 0);
}

// The offset of a contact that is found with that gap, of a cube whose others are `known`.
double born_offset(double gap, double known) {
  Remembered small;
  small.old(0.05, Vec3::Zero(), 0, known);
  small.remember();
  Question asked(small, {0, 1, KeyKind::group_check, 0}, Cause::check, {small.cube});
  asked.of(small.cube).data.group = small.group;
  NewContact& fresh = small.fresh(0, gap);
  start_unpressed(asked.work, small.scene.body(small.floor), small.scene.body(small.cube), fresh);
  return fresh.contact.offset;
}

// answer::born_depth times d0, or what there was.
TEST(StartUnpressed, a_contact_deeper_than_four_static_depths_presses_from_there_on) {
  EXPECT_EQ(born_offset(1e-5, 0), 0);
  EXPECT_EQ(born_offset(-0.9e-4, 0), 0);
  EXPECT_NEAR(born_offset(-3e-4, 0), -2e-4, 1e-18);
  EXPECT_NEAR(born_offset(-3e-4, -2e-4), -1e-4, 1e-16);
  EXPECT_EQ(born_offset(-3e-4, -4e-4), 0);
}

}  // namespace
}  // namespace tw::test
