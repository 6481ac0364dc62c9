// The order of contacts in a sweep, and sweeps in lanes against one contact after the other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/sweep-order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "integrate/stepped/contact-sweeps.h"

namespace tw {
namespace {

std::vector<StepContact> any_contacts(Random& random, int count, int members) {
  std::vector<StepContact> contacts;
  for (int i = 0; i < count; ++i) {
    StepContact contact;
    contact.b = static_cast<int>(random.below(static_cast<std::uint64_t>(members)));
    contact.a = static_cast<int>(random.below(static_cast<std::uint64_t>(members))) - 1;
    if (contact.a >= contact.b) contact.a = -1;
    contacts.push_back(contact);
  }
  return contacts;
}

TEST(SweepOrder, hands_a_pile_down_from_the_top) {
  // a column of five: contacts from the ground up
  std::vector<StepContact> contacts(5);
  for (int i = 0; i < 5; ++i)
    contacts[static_cast<std::size_t>(i)].a = i - 1, contacts[static_cast<std::size_t>(i)].b = i;
  SweepOrder order;
  order.arrange(contacts, 5);
  EXPECT_EQ(order.order(), (std::vector{4, 3, 2, 1, 0}));
  EXPECT_EQ(order.level_count(), 5);
}

TEST(SweepOrder, levels_keep_the_order_of_whoever_shares_a_member) {
  Random random(1);
  for (int run = 0; run < 100; ++run) {
    const std::vector<StepContact> contacts = any_contacts(random, 200, 30);
    SweepOrder order;
    order.arrange(contacts, 30);
    std::vector<int> last(30, -1);
    ASSERT_EQ(order.order().size(), contacts.size());
    for (const int i : order.order()) {
      const StepContact& contact = contacts[static_cast<std::size_t>(i)];
      const int level = order.levels()[static_cast<std::size_t>(i)];
      for (const int member : {contact.a, contact.b}) {
        if (member < 0) continue;
        EXPECT_GT(level, last[static_cast<std::size_t>(member)]);
        last[static_cast<std::size_t>(member)] = level;
      }
    }
  }
}

// Blows between two members at a time: the law of one contact, by hand.
TEST(ContactSweeps, one_contact_takes_the_impulse_of_its_law) {
  std::vector<SweepMember> members(2);
  members[0].inverse_root_mass = 1;                                            // 1 kg
  members[1].inverse_root_mass = std::sqrt(0.25);                              // 4 kg
  for (SweepMember& member : members) member.turning = 10 * Mat3::Identity();  // 0.01 kg m^2
  StepContact contact;
  contact.a = 0;
  contact.b = 1;
  contact.normal = Vec3::UnitX();
  contact.velocity = Vec3(-2, 2, 0);
  contact.arm_a = Vec3(0.1, 0, 0);
  contact.arm_b = Vec3(-0.1, 0, 0);
  contact.friction = 0.2;
  for (const double e : {0.0, 0.5}) {
    StepContact struck = contact;
    struck.restitution = e;
    ContactSweeps<double> sweeps;
    sweeps.solve(members, {1e-3, 1e-3, 1, 4, 4}, {&struck, 1});
    const double mass = 1 / (1 + 0.25);
    EXPECT_NEAR(struck.impulse, (1 + e) * 2 * mass, 1e-12);
    // it slips: friction is at its bound against the slip, from the blow without the rebound
    EXPECT_NEAR(struck.tangential.y(), -0.2 * 2 * mass, 1e-12);
    EXPECT_NEAR(struck.tangential.z(), 0, 1e-12);
    // whitened: sqrt(m) dv
    EXPECT_NEAR(sweeps.velocity(1).x() * 0.5, struck.impulse / 4, 1e-12);
    EXPECT_NEAR(-sweeps.velocity(0).x(), struck.impulse, 1e-12);
  }
}

TEST(ContactSweeps, floats_and_doubles_agree) {
  Random random(2);
  const auto any = [&](double size) {
    return Vec3(random.real(-size, size), random.real(-size, size), random.real(-size, size));
  };
  std::vector<SweepMember> members(30);
  for (SweepMember& member : members) {
    member.inverse_root_mass = random.real(0.5, 1);
    member.turning = random.real(3, 6) * rotation_by(any(3)).toRotationMatrix();
    member.push = any(5);
  }
  std::vector<StepContact> contacts = any_contacts(random, 60, 30);
  for (StepContact& contact : contacts) {
    contact.normal = any(1).normalized();
    contact.arm_a = any(0.2), contact.arm_b = any(0.2), contact.velocity = any(1);
    contact.gap = random.real(-1e-3, 1e-3);
    contact.friction = 0.5;
  }
  std::vector<StepContact> copies = contacts;
  ContactSweeps<double> doubles;
  ContactSweeps<float> floats;
  doubles.solve(members, {1e-2, 1e-2, 2, 2, 2}, contacts);
  floats.solve(members, {1e-2, 1e-2, 2, 2, 2}, copies);
  for (std::size_t i = 0; i < members.size(); ++i) {
    EXPECT_LT((doubles.velocity(i) - floats.velocity(i)).norm(), 1e-4);
    EXPECT_LT((doubles.turn(i) - floats.turn(i)).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace tw
