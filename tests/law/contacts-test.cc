// The contacts that users see balance the weights that they carry.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/heap-scenes.h"

namespace tw::test {
namespace {

// Of the contacts on a body: their force, N, and their torque about its centre, N m.
struct Load {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

Load load_on(const World& world, BodyId body, const ContactSurvey& survey) {
  Load load;
  for (const ContactReading& c : survey.contacts) {
    if (c.body1 != body && c.body2 != body) continue;
    const Vec3 force = (c.body2 == body ? 1 : -1) * (c.force * c.normal + c.friction);
    load.force += force;
    load.torque += (c.point - world.state(body).position).cross(force);
  }
  return load;
}

TEST(Contacts, a_box_at_rest_has_four_and_they_carry_its_weight) {
  World world;
  const BodyId floor = add_wall(world, Vec3::UnitZ(), 0);
  const BodyId box = add_box(world, {0.2, 0.2, 0.2}, {0, 0, 0.1});
  world.advance(2);
  const ContactSurvey survey = world.survey_contacts(world.time());
  EXPECT_EQ(survey.groups, 1u);
  EXPECT_EQ(survey.bodies_at_rest, 1u);
  ASSERT_EQ(survey.contacts.size(), 4u);
  for (const ContactReading& c : survey.contacts) {
    EXPECT_EQ(c.body1, floor);
    EXPECT_EQ(c.body2, box);
    EXPECT_NEAR((c.normal - Vec3::UnitZ()).norm(), 0, 1e-9);
    EXPECT_NEAR(c.gap, 0, 1e-12) << "placed touching";
    EXPECT_GT(c.force, 0);
    EXPECT_FALSE(c.slipping);
  }
  const double weight = world.body(box).mass * g;
  EXPECT_NEAR(load_on(world, box, survey).force.z(), weight, 1e-4 * weight);
}

TEST(Contacts, the_normal_leads_from_the_body_added_first_to_the_other) {
  World world;
  const BodyId box = add_box(world, {0.2, 0.2, 0.2}, {0, 0, 0.1});
  add_wall(world, Vec3::UnitZ(), 0);
  world.advance(2);
  const ContactSurvey survey = world.survey_contacts(world.time());
  ASSERT_FALSE(survey.contacts.empty());
  for (const ContactReading& c : survey.contacts) {
    EXPECT_EQ(c.body1, box);
    EXPECT_NEAR(c.normal.z(), -1, 1e-9);
  }
}

TEST(Contacts, a_sliding_box_slips_with_friction_mu_N_against_its_motion) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  add_wall(world, Vec3::UnitZ(), 0);
  add_box(world, {0.4, 0.4, 0.1}, {0, 0, 0.05}, {2, 0, 0});
  world.advance(0.3);
  const ContactSurvey survey = world.survey_contacts(world.time());
  EXPECT_EQ(survey.bodies_at_rest, 0u);
  ASSERT_FALSE(survey.contacts.empty());
  double loaded = 0;
  for (const ContactReading& c : survey.contacts) {
    if (c.force == 0) continue;
    ++loaded;
    EXPECT_TRUE(c.slipping);
    EXPECT_NEAR(c.friction.x(), -0.3 * c.force, 1e-6 * c.force);
  }
  EXPECT_GE(loaded, 3);
}

TEST(Contacts, forces_and_torques_on_every_box_of_a_stack_on_a_slope_balance) {
  World world;
  set_contact_for_all(world, 0, 0.6);
  const double slope = 0.2, size = 0.3;
  const Vec3 up(-std::sin(slope), 0, std::cos(slope));
  add_wall(world, up, 0);
  for (int i = 0; i < 3; ++i) {
    BodyDef def = body_of(make_box({size, size, size}), (i + 0.5) * size * up, Vec3::Zero());
    def.orientation = Quat(Eigen::AngleAxisd(-slope, Vec3::UnitY()));
    world.add_body(def);
  }
  world.advance(4);
  const ContactSurvey survey = world.survey_contacts(world.time());
  EXPECT_EQ(survey.bodies_at_rest, 3u);
  for (BodyId box = 1; box <= 3; ++box) {
    const double weight = world.body(box).mass * g;
    const Load load = load_on(world, box, survey);
    // rest stops what is slow: up to 1.3 % of a weight were still unbalanced
    EXPECT_NEAR((load.force - weight * Vec3::UnitZ()).norm(), 0, 0.03 * weight);
    EXPECT_NEAR(load.torque.norm(), 0, 0.03 * weight * size);
  }
}

// a blow gives new arcs to a part of the heap only: links at the border stand in two groups
TEST(Contacts, in_a_heap_every_body_obeys_newton_so_no_contact_is_missing_or_there_twice) {
  World world;
  // velocities are differences over so short a time that looser steps show in them
  world.set_accuracy(1e-8);
  heap_scene(30, 1.2).fill(world);
  int looked_at = 0, off = 0;
  // not at checks, which pass impulses on
  for (const double when : {0.7007, 0.9007, 1.1007}) {
    const double step = 1e-6;
    world.advance(when - step);
    const ContactSurvey before = world.survey_contacts(world.time());
    std::vector<Vec3> velocities;
    for (BodyId id = 0; id < world.body_count(); ++id)
      velocities.push_back(world.state(id).velocity);
    world.advance(when);
    const ContactSurvey after = world.survey_contacts(world.time());
    for (BodyId id = 0; id < world.body_count(); ++id) {
      if (world.body(id).kind != BodyKind::dynamic) continue;
      const double mass = world.body(id).mass;
      const Vec3 change = mass * ((world.state(id).velocity - velocities[id]) / step);
      const Vec3 one = load_on(world, id, before).force, two = load_on(world, id, after).force;
      // impacts in between
      if ((two - one).norm() > 0.05 * mass * g) continue;
      ++looked_at;
      const Vec3 missing = 0.5 * (one + two) - mass * g * Vec3::UnitZ() - change;
      off += missing.norm() > 0.1 * mass * g;
    }
  }
  EXPECT_GT(looked_at, 60);
  EXPECT_EQ(off, 0);
}

TEST(Contacts, they_come_by_ascending_pairs_and_reading_them_moves_no_bit) {
  const auto run = [](bool look) {
    World world;
    world.set_hash(true);
    heap_scene(20, 1).fill(world);
    for (int i = 1; i <= 20; ++i) {
      world.advance(0.05 * i);
      if (!look) continue;
      const ContactSurvey survey = world.survey_contacts(world.time());
      for (std::size_t c = 1; c < survey.contacts.size(); ++c) {
        const ContactReading &x = survey.contacts[c - 1], &y = survey.contacts[c];
        EXPECT_LE(std::pair(x.body1, x.body2), std::pair(y.body1, y.body2));
      }
    }
    return world.history_hash();
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(Contacts, what_flies_has_none) {
  World world;
  add_ball(world, 0.1, {0, 0, 5}, {1, 0, 0});
  world.advance(0.5);
  const ContactSurvey survey = world.survey_contacts(world.time());
  EXPECT_TRUE(survey.contacts.empty());
  EXPECT_EQ(survey.groups, 0u);
}

}  // namespace
}  // namespace tw::test
