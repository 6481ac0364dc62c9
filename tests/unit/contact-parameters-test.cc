// Who set what for whom: the more specific rule wins, keyword by keyword; at ties the later.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace tw::test {
namespace {

ContactSide all() { return {}; }
ContactSide material(const std::string& name) { return {ContactSide::Kind::material, name, 0}; }
ContactSide body(std::uint32_t id) { return {ContactSide::Kind::body, "", id}; }

ContactSettings restitution(double e) {
  ContactSettings s;
  s.restitution = e;
  return s;
}
ContactSettings friction(double mu) {
  ContactSettings s;
  s.friction = mu;
  return s;
}

const ContactBody ball{1, "rubber"}, box{2, "wood"}, floor_{3, ""};

TEST(ContactParameters, without_rules_are_the_defaults) {
  const ContactTable table;
  const ContactParameters p = table.look_up(ball, box);
  EXPECT_EQ(p.restitution, 0.3);
  EXPECT_EQ(p.friction, 0.5);
  EXPECT_TRUE(p.collide);
  EXPECT_FALSE(p.fusion_speed);
}

TEST(ContactParameters, body_beats_material_beats_everybody_whatever_the_order_of_calls) {
  // the more specific side first, then the other one
  const std::pair<ContactSide, ContactSide> ranks[] = {{body(1), body(2)},
                                                       {body(1), material("wood")},
                                                       {body(1), all()},
                                                       {material("rubber"), material("wood")},
                                                       {material("rubber"), all()},
                                                       {all(), all()}};
  for (const bool backwards : {false, true}) {
    for (std::size_t least = 0; least < std::size(ranks); ++least) {
      // rules `least` and below in rank, in either order of calls
      ContactTable table;
      for (std::size_t k = least; k < std::size(ranks); ++k) {
        const std::size_t i = backwards ? std::size(ranks) - 1 - (k - least) : k;
        table.add(ranks[i].first, ranks[i].second, restitution(0.1 * static_cast<double>(i)));
      }
      EXPECT_EQ(table.look_up(ball, box).restitution, 0.1 * static_cast<double>(least));
    }
  }
}

TEST(ContactParameters, order_of_sides_and_bodies_does_not_matter) {
  ContactTable table;
  table.add(material("wood"), body(1), restitution(0.7));
  EXPECT_EQ(table.look_up(ball, box).restitution, 0.7);
  EXPECT_EQ(table.look_up(box, ball).restitution, 0.7);
  EXPECT_EQ(table.look_up(ball, floor_).restitution, 0.3);
}

TEST(ContactParameters, at_ties_the_later_call_wins) {
  ContactTable table;
  table.add(material("rubber"), all(), restitution(0.1));
  table.add(all(), material("wood"), restitution(0.2));
  EXPECT_EQ(table.look_up(ball, box).restitution, 0.2);
  table.add(all(), material("rubber"), restitution(0.4));
  EXPECT_EQ(table.look_up(ball, box).restitution, 0.4);
}

TEST(ContactParameters, each_keyword_is_looked_up_on_its_own) {
  ContactTable table;
  table.add(body(1), body(2), restitution(0.9));
  table.add(material("rubber"), all(), friction(0.8));
  ContactSettings both = restitution(0.1);
  both.friction = 0.2;
  table.add(all(), all(), both);
  const ContactParameters p = table.look_up(ball, box);
  EXPECT_EQ(p.restitution, 0.9);
  EXPECT_EQ(p.friction, 0.8);
  EXPECT_EQ(table.look_up(box, floor_).friction, 0.2);
}

TEST(ContactParameters, two_bodies_of_one_material_match_its_rule) {
  ContactTable table;
  table.add(material("rubber"), material("rubber"), restitution(0.95));
  EXPECT_EQ(table.look_up(ball, {9, "rubber"}).restitution, 0.95);
  EXPECT_EQ(table.look_up(ball, box).restitution, 0.3);
}

// No material is no common material.
TEST(ContactParameters, bodies_without_a_material_match_no_material) {
  ContactTable table;
  table.add(material(""), all(), restitution(0.9));
  EXPECT_EQ(table.look_up(floor_, ball).restitution, 0.3);
}

// What joins two bodies keeps them from colliding unless a rule that names both lets them.
TEST(ContactParameters, it_is_told_whether_the_rule_on_collisions_names_both) {
  ContactSettings on, off;
  on.collide = true;
  off.collide = false;
  ContactTable table;
  EXPECT_FALSE(table.look_up(ball, box).collide_names_both);
  table.add(body(1), all(), on);
  table.add(body(1), body(2), restitution(0.5));
  EXPECT_FALSE(table.look_up(ball, box).collide_names_both);
  table.add(body(2), body(1), on);
  EXPECT_TRUE(table.look_up(ball, box).collide_names_both);
  EXPECT_FALSE(table.look_up(ball, floor_).collide_names_both);
  table.add(body(1), body(2), off);
  EXPECT_FALSE(table.look_up(ball, box).collide);
  table.take_back(3);
  EXPECT_TRUE(table.look_up(ball, box).collide);
}

TEST(ContactParameters, values_out_of_range_are_errors_that_name_the_keyword) {
  ContactTable table;
  const double nan = std::nan("");
  for (const double e : {-0.1, 1.1, nan}) {
    try {
      table.add(all(), all(), restitution(e));
      FAIL() << e;
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find("restitution"), std::string::npos);
    }
  }
  for (const double mu : {-1.0, nan, HUGE_VAL})
    EXPECT_THROW(table.add(all(), all(), friction(mu)), UserError);
  EXPECT_TRUE(table.empty()) << "a refused rule leaves no trace";
}

}  // namespace
}  // namespace tw::test
