// The order of contacts in a sweep, and sweeps in lanes against one contact after the other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/sweep-order.h"

#include <gtest/gtest.h>

#include <algorithm>
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
    ContactSweeps sweeps;
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

// The law of contact-sweeps.h for one contact after the other, in plain vectors and momenta.
class OneByOne {
 public:
  OneByOne(const std::vector<SweepMember>& members, const SweepTimes& times,
           std::vector<StepContact>& contacts)
      : members_(members), times_(times), contacts_(contacts), gaps_(contacts.size()) {
    v_.assign(members.size(), Vec3::Zero());
    w_ = x_ = turned_ = v_;
  }
  void solve();
  // Change of the velocity, and motion by it.
  Vec3 velocity(std::size_t member) const { return v_[member]; }
  Vec3 turn(std::size_t member) const { return turned_end_[member]; }

 private:
  double inverse_mass(int i) const {
    return std::pow(members_[static_cast<std::size_t>(i)].inverse_root_mass, 2);
  }
  Mat3 inverse_inertia(int i) const {
    const Mat3& turning = members_[static_cast<std::size_t>(i)].turning;
    return turning.transpose() * turning;
  }
  static Vec3& at(std::vector<Vec3>& of, int i) { return of[static_cast<std::size_t>(i)]; }
  double stiffness(const StepContact& c, const Vec3& d) const {
    double sum = inverse_mass(c.b) + c.arm_b.cross(d).dot(inverse_inertia(c.b) * c.arm_b.cross(d));
    if (c.a >= 0)
      sum += inverse_mass(c.a) + c.arm_a.cross(d).dot(inverse_inertia(c.a) * c.arm_a.cross(d));
    return sum;
  }
  // By velocities v, w of the members: that of b's point against a's.
  Vec3 relative(const StepContact& c, std::vector<Vec3>& v, std::vector<Vec3>& w) {
    Vec3 u = at(v, c.b) + at(w, c.b).cross(c.arm_b);
    if (c.a >= 0) u -= at(v, c.a) + at(w, c.a).cross(c.arm_a);
    return u;
  }
  void push(const StepContact& c, const Vec3& impulse) {
    at(v_, c.b) += inverse_mass(c.b) * impulse;
    at(w_, c.b) += inverse_inertia(c.b) * c.arm_b.cross(impulse);
    if (c.a < 0) return;
    at(v_, c.a) -= inverse_mass(c.a) * impulse;
    at(w_, c.a) -= inverse_inertia(c.a) * c.arm_a.cross(impulse);
  }
  void sweep(bool pushing);
  void measure_gaps(double time);
  void move(double time);

  const std::vector<SweepMember>& members_;
  SweepTimes times_;
  std::vector<StepContact>& contacts_;
  std::vector<double> gaps_;
  std::vector<Vec3> v_, w_, x_, turned_, turned_end_;
};

void OneByOne::measure_gaps(double time) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const StepContact& c = contacts_[i];
    gaps_[i] = c.gap + c.normal.dot(time * c.velocity + relative(c, x_, turned_));
  }
}

void OneByOne::move(double time) {
  for (std::size_t i = 0; i < v_.size(); ++i) x_[i] += time * v_[i], turned_[i] += time * w_[i];
}

void OneByOne::sweep(bool pushing) {
  SweepOrder order;
  order.arrange(contacts_, members_.size());
  const double hs = times_.step / times_.substeps;
  for (const int number : order.order()) {
    const auto i = static_cast<std::size_t>(number);
    StepContact& c = contacts_[i];
    const Vec3 n = c.normal, t1 = n.unitOrthogonal(), t2 = n.cross(t1);
    const double gap = gaps_[i];
    double share = 1, kept = 0, bias = gap > 0 ? gap / hs : 0;
    if (pushing && gap <= 0) {
      const double f = (c.a < 0 ? 0.5 : 0.25) * times_.substeps / times_.unhalved;
      const double w = 2 * pi * f, damped = 2 * 10 + hs * w;
      kept = 1 / (1 + hs * w * damped);
      share = 1 - kept;
      bias = std::max(w / damped * gap, -4.0);
    }
    const double u = n.dot(c.velocity + relative(c, v_, w_));
    const double impulse =
        std::max(0.0, c.impulse - share / stiffness(c, n) * (u + bias) - kept * c.impulse);
    push(c, (impulse - c.impulse) * n);
    c.impulse = impulse;
    const Vec3 slip = c.velocity + relative(c, v_, w_);
    Vec3 force =
        c.tangential - 2 / (stiffness(c, t1) + stiffness(c, t2)) * (slip - n.dot(slip) * n);
    const double most = c.friction * impulse;
    if (force.norm() > most) force *= most / force.norm();
    push(c, force - c.tangential);
    c.tangential = force;
  }
}

void OneByOne::solve() {
  const double hs = times_.step / times_.substeps;
  measure_gaps(0.5 * hs);
  for (int substep = 0; substep < times_.substeps; ++substep) {
    for (std::size_t i = 0; i < v_.size(); ++i)
      v_[i] += hs * members_[i].inverse_root_mass * members_[i].push;
    for (const StepContact& c : contacts_) push(c, c.impulse * c.normal + c.tangential);
    for (int i = 0; i < times_.pushing; ++i) sweep(true);
    move(0.5 * hs);
    turned_end_ = turned_;
    move(0.5 * hs);
    measure_gaps((substep + 1.5) * hs);
    for (int i = 0; i < times_.relaxing; ++i) sweep(false);
  }
}

TEST(ContactSweeps, lanes_are_one_contact_after_the_other) {
  Random random(2);
  const auto any = [&](double size) {
    return Vec3(random.real(-size, size), random.real(-size, size), random.real(-size, size));
  };
  for (int run = 0; run < 20; ++run) {
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
      contact.impulse = random.real(0, 0.01);
    }
    std::vector<StepContact> copies = contacts;
    const SweepTimes times{1e-2, 2e-2, 2, 2, 2};
    ContactSweeps sweeps;
    sweeps.solve(members, times, contacts);
    OneByOne reference(members, times, copies);
    reference.solve();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      EXPECT_NEAR(contacts[i].impulse, copies[i].impulse, 1e-11);
      EXPECT_LT((contacts[i].tangential - copies[i].tangential).norm(), 1e-11);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
      const SweepMember& member = members[i];
      EXPECT_LT((member.inverse_root_mass * sweeps.velocity(i) - reference.velocity(i)).norm(),
                1e-11);
      EXPECT_LT((member.turning.transpose() * sweeps.turn(i) - reference.turn(i)).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace tw
