// Loads at the start, by contacts and starts made by hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/placed/placed-loads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/small-scene.h"

namespace tw::test {
namespace {

constexpr double one_weight = 9.81;  // N, of 1 kg

// Cubes of 0.1 m and 1 kg on each other on a floor, with four contacts between two; the i-th counts
// from below.
struct PlacedStack : SmallScene {
  BodyId floor = add_floor();
  std::vector<BodyId> cubes;
  Contacts contacts;
  GroupStart start;
  PlacedLoads loads;

  explicit PlacedStack(int count) {
    for (int i = 0; i < count; ++i) cubes.push_back(add_cube(0.1, {0, 0, 0.1 * i + 0.05}));
    for (int i = 0; i < count; ++i)
      add_face(i == 0 ? floor : at(i - 1), at(i), 0, Vec3(0, 0, 0.1 * i), Vec3::UnitZ());
  }
  BodyId at(int i) const { return cubes[static_cast<std::size_t>(i)]; }
  // Four contacts of a square of 0.1 m.
  void add_face(BodyId reference, BodyId other, double gap, const Vec3& middle,
                const Vec3& normal) {
    const Vec3 one = normal.unitOrthogonal(), two = normal.cross(one);
    for (const double u : {-0.05, 0.05})
      for (const double v : {-0.05, 0.05})
        touch(contacts, reference, other, middle + u * one + v * two, normal, gap).contact.share =
            0.25;
  }
  // All laws linear, so that a spring has F^2/2k.
  void soften() {
    for (NewContact& c : contacts.all) {
      c.contact.law.hardening = 0;
      c.contact.law.firm = {};
    }
  }

  // As a fusion of the first cube with the floor that takes all with it.
  void load(const Vec3& velocity_of_last = Vec3::Zero()) {
    std::vector<BodyId> bodies{floor};
    bodies.insert(bodies.end(), cubes.begin(), cubes.end());
    Question asked(*this, {0, 1, KeyKind::impact, 0}, Cause::fusion, bodies);
    asked.of(floor).role = Role::no_state;
    asked.set_velocity(cubes.back(), velocity_of_last);
    const PlacedTogether together;
    asked.request.together = &together;
    for (const BodyId cube : cubes) {
      GroupMember& member = start.members.emplace_back();
      const Body& body = scene.body(cube);
      member.mass = body.mass;
      member.moments = body.moments;
      member.radius = body.radius;
      member.x = tail(cube).x;
      member.force = body.mass * options.gravity;
    }
    const auto member_of = [&](BodyId id) {
      const auto at = std::find(cubes.begin(), cubes.end(), id);
      return at != cubes.end() ? static_cast<int>(at - cubes.begin()) : ~0;
    };
    for (NewContact& c : contacts.all) {
      c.contact.a = member_of(c.tag.reference);
      c.contact.b = member_of(c.tag.other);
      start.contacts.push_back(c.contact);
    }
    loads = load_placed(asked.work, start, contacts.all);
  }
  // Of the springs of a pair, N.
  double load_of(std::size_t pair) const {
    double sum = 0;
    each_contact(contacts.pairs[pair], [&](std::uint32_t c) {
      const GroupContact& contact = start.contacts[c];
      sum += spring_force(contact.law, contact.share, contact.offset - contacts.all[c].gap);
    });
    return sum;
  }
  // What friction holds of a pair, on the second, N: at a spring's own depth it hardens by its
  // grip.
  Vec3 friction_of(std::size_t pair) const {
    Vec3 sum = Vec3::Zero();
    each_contact(contacts.pairs[pair], [&](std::uint32_t c) {
      const GroupContact& contact = start.contacts[c];
      const double grip = friction_grip(contact.law, contact.offset - contacts.all[c].gap);
      sum -= grip * contact.share * contact.law.kt * contact.stretch;
    });
    return sum;
  }
};

TEST(PlacedLoads, each_cube_of_a_stack_bears_those_above_it) {
  PlacedStack small(5);
  small.load();
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(small.load_of(i), static_cast<double>(5 - i) * one_weight, 1e-6) << i;
}

// k d0 = m g: 5^2 + 4^2 + ... + 1 = 55 times m g d0 / 2, with d0 = 2.5e-5 m.
TEST(PlacedLoads, linear_springs_get_the_energy_of_their_loads) {
  PlacedStack small(5);
  small.soften();
  small.load();
  EXPECT_NEAR(small.loads.energy, 55 * 0.5 * one_weight * 2.5e-5, 1e-6 * small.loads.energy);
}

// k/2 (d0^2 - 1e-10 m^2).
TEST(PlacedLoads, energy_is_what_springs_get_beyond_what_they_had) {
  PlacedStack small(1);
  small.soften();
  for (NewContact& c : small.contacts.all) c.gap = -1e-5;
  small.load();
  EXPECT_NEAR(small.load_of(0), one_weight, 1e-6);
  EXPECT_NEAR(small.loads.energy, 0.5 * one_weight / 2.5e-5 * (2.5e-5 * 2.5e-5 - 1e-10), 1e-10);
}

// d (1 + (d / 2 d0)^2) = d0.
TEST(PlacedLoads, a_contact_is_offset_by_the_depth_of_its_own_law) {
  PlacedStack small(1);
  small.load();
  for (const GroupContact& contact : small.start.contacts) {
    const double y = contact.offset / 2.5e-5;
    EXPECT_NEAR(y + y * y * y / 4, 1, 1e-6);
  }
}

// The gap does not matter up to answer::start_gap, 5e-6 m here, to which the offset is added.
TEST(PlacedLoads, what_is_placed_a_little_apart_touches_as_well) {
  for (const double gap : {4.9e-6, 5.1e-6}) {
    PlacedStack small(1);
    for (NewContact& c : small.contacts.all) c.gap = gap;
    small.load();
    EXPECT_NEAR(small.load_of(0), gap < 5e-6 ? one_weight : 0, 1e-6);
  }
}

// sqrt(2 1e-6 size g) = 1.4e-3 m/s: what closes faster falls.
TEST(PlacedLoads, what_comes_faster_than_placed_is_not_loaded) {
  const double slow = std::sqrt(2e-7 * one_weight);
  EXPECT_DOUBLE_EQ(placed_speed(SmallScene().scene, 0.1), slow);
  PlacedStack still(1), comes(1);
  still.load({0, 0, -0.99 * slow});
  EXPECT_NEAR(still.load_of(0), one_weight, 1e-6);
  comes.load({0, 0, -1.01 * slow});
  EXPECT_EQ(comes.load_of(0), 0);
  EXPECT_EQ(comes.loads.energy, 0);
}

// A pull of 3 N along x is held by friction, one of 6 N is more than mu m g = 4.905 N.
TEST(PlacedLoads, friction_holds_what_pulls_along_up_to_its_cone) {
  for (const double pull : {3.0, 6.0}) {
    PlacedStack small(1);
    small.options.gravity = {pull, 0, -one_weight};
    small.load();
    EXPECT_NEAR(small.load_of(0), one_weight, 1e-5);
    // what slides at once gets half as much again
    const double expected = pull < 4.905 ? pull : answer::preload_beyond * 4.905;
    EXPECT_NEAR(small.friction_of(0).x(), -expected, 1e-4);
  }
}

// Two side by side on the floor, with a gap between them.
struct PlacedPair : PlacedStack {
  explicit PlacedPair(double gap) : PlacedStack(1) {
    cubes.push_back(add_cube(0.1, {0.1, 0, 0.05}));
    add_face(floor, at(1), 0, {0.1, 0, 0}, Vec3::UnitZ());
    add_face(at(0), at(1), gap, {0.05, 0, 0.05}, Vec3::UnitX());
  }
};

TEST(PlacedLoads, a_pair_that_carries_nothing_is_named_and_nothing_is_loaded) {
  PlacedPair small(0);
  small.load();
  EXPECT_EQ(small.loads.unloaded, std::vector<std::uint64_t>{pair_id(small.at(0), small.at(1))});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(small.load_of(i), 0) << i;
}

// It is in contact until it has parted, and presses nothing.
TEST(PlacedLoads, a_pair_that_overlaps_is_not_named) {
  PlacedPair small(-2e-6);
  small.load();
  EXPECT_TRUE(small.loads.unloaded.empty());
  EXPECT_NEAR(small.load_of(0), one_weight, 1e-6);
  EXPECT_NEAR(small.load_of(1), one_weight, 1e-6);
  // its springs would press with 0.8 N
  EXPECT_NEAR(small.load_of(2), 0, 1e-9);
  // and begin a hair beyond where they are, not at it
  for (std::size_t c = 8; c < 12; ++c)
    EXPECT_LT(small.start.contacts[c].offset, -2e-6 - 0.5 * answer::start_depth * 0.1) << c;
}

}  // namespace
}  // namespace tw::test
