// What the arcs of contact groups promise beside their motion.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "analytic/group-arc-scenes.h"

namespace tw {
namespace {

using namespace group_scenes;

// -0 and 0 are not the same.
template <class Numbers>
bool same_bits(const Numbers& x, const Numbers& y) {
  return std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) == 0;
}
bool same_bits(const GroupSample& x, const GroupSample& y) {
  return same_bits(x.x, y.x) && same_bits(x.v, y.v) && same_bits(x.w, y.w) && same_bits(x.L, y.L) &&
         same_bits(x.q.coeffs(), y.q.coeffs());
}

GroupStart falling_stack(int count) {
  GroupStart start = stack(count, 0.5, 0.4, 1e-3);
  for (GroupMember& m : start.members) m.v = Vec3(0.3, 0.1, 0);
  return start;
}

TEST(GroupArc, extending_in_pieces_gives_the_same_bits) {
  // dense and sparse
  for (const int count : {1, 3, 9}) {
    const GroupStart start = falling_stack(count);
    GroupArc whole(start), pieces(start);
    whole.extend(start.end);
    for (int i = 0; i <= 37; ++i) {
      const double time = std::min(start.end, i * start.end / 37);
      pieces.extend(std::max(time, 1e-9));
      const Vec3 stretch = pieces.stretch(0, time);
      Vec3 dx, w, dx_whole, w_whole;
      pieces.pose_rates(0, time, dx, w);
      whole.pose_rates(0, time, dx_whole, w_whole);
      EXPECT_EQ(dx, dx_whole);
      EXPECT_EQ(w, w_whole);
      for (int m = 0; m < count; ++m)
        EXPECT_TRUE(same_bits(whole.evaluate(m, time), pieces.evaluate(m, time)));
      EXPECT_EQ(stretch, whole.stretch(0, time));
      EXPECT_EQ(whole.contact_force(0, time).friction, pieces.contact_force(0, time).friction);
      EXPECT_EQ(whole.elastic_energy(time), pieces.elastic_energy(time));
    }
    EXPECT_EQ(whole.counts().steps, pieces.counts().steps);
    EXPECT_EQ(whole.next_step(), pieces.next_step());
  }
}

// What is struck again at the instant at which its arc began may have been integrated or not.
TEST(GroupArc, its_start_looks_the_same_with_and_without_a_first_step) {
  GroupStart start = falling_stack(3);
  for (GroupMember& m : start.members) {
    m.x.y() = m.v.y() = m.L.x() = m.L.z() = m.q.x() = -0.0;
    m.v.x() = -0.3;
  }
  for (GroupContact& c : start.contacts) c.stretch = Vec3(-0.0, 0, -0.0);
  GroupArc arc(start);
  std::vector<GroupSample> before;
  for (int m = 0; m < 3; ++m) before.push_back(arc.evaluate(m, start.time));
  const Vec3 stretch = arc.stretch(0, start.time);
  arc.extend(start.end);
  EXPECT_GT(arc.counts().steps, 0u);
  for (int m = 0; m < 3; ++m)
    EXPECT_TRUE(same_bits(before[static_cast<std::size_t>(m)], arc.evaluate(m, start.time)));
  EXPECT_TRUE(same_bits(stretch, arc.stretch(0, start.time)));
}

TEST(GroupArc, step_end_lies_after_the_time) {
  const GroupStart start = falling_stack(3);
  const CompleteArc arc(start);
  for (int i = 0; i < 20; ++i) {
    const double time = start.time + i * (start.end - start.time) / 20;
    EXPECT_GT(arc.step_end(time), time);
  }
  EXPECT_EQ(arc.step_end(start.end), start.end);
}

// An arc may be told how many steps it may take: it is complete then, and its steps are those of
// the one that goes on.
TEST(GroupArc, goes_no_further_than_its_most_steps) {
  GroupStart start = falling_stack(3);
  const CompleteArc whole(start);
  start.most_steps = 5;
  GroupArc arc(start);
  EXPECT_EQ(arc.last(), start.end);
  EXPECT_FALSE(arc.extend(start.end));
  EXPECT_TRUE(arc.complete());
  EXPECT_TRUE(arc.failure().empty());
  EXPECT_EQ(arc.counts().steps, 5u);
  EXPECT_EQ(arc.last(), arc.reached());
  EXPECT_EQ(arc.end(0), arc.reached());
  EXPECT_LT(arc.reached(), start.end);
  EXPECT_EQ(arc.evaluate(0, arc.reached()).x, whole.evaluate(0, arc.reached()).x);
}

// Completing and looking are two things.
TEST(GroupArcDeathTest, nobody_looks_past_what_is_completed) {
  const GroupStart start = falling_stack(3);
  GroupArc arc(start);
  EXPECT_EQ(arc.evaluate(0, start.time).x, start.members[0].x);
  EXPECT_EQ(arc.bounds(0, start.time, start.time).path.lo, start.members[0].x);
  arc.extend(0.5 * start.end);
  const double reached = arc.reached(), beyond = std::nextafter(reached, start.end);
  const std::uint64_t steps = arc.counts().steps;
  ASSERT_LT(reached, start.end);
  Vec3 x;
  Quat q;
  EXPECT_DEATH(GroupArc(start).bounds(0, start.time, reached), "before its first step");
  EXPECT_DEATH(arc.pose(0, beyond, x, q), "completed to .* s was looked at");
  EXPECT_DEATH(arc.evaluate(0, beyond), "completed to .* s was looked at");
  EXPECT_DEATH(arc.bounds(0, start.time, beyond), "completed to .* s was looked at");
  EXPECT_DEATH(arc.excerpt(0, start.time, beyond), "completed to .* s was looked at");
  EXPECT_DEATH(arc.contact_force(0, beyond), "completed to .* s was looked at");
  EXPECT_DEATH(arc.elastic_energy(beyond), "completed to .* s was looked at");
  EXPECT_DEATH(arc.step_end(reached), "is not completed");
  arc.pose(0, reached, x, q);
  arc.bounds(0, start.time, reached);
  EXPECT_EQ(arc.counts().steps, steps) << "looking makes no steps";
  EXPECT_EQ(arc.reached(), reached);
}

// What another group meets at its border is a copy: were it the arc itself, each group would keep
// those at its border, with the borders that they had, and so on to the first.
TEST(GroupArc, motion_of_a_member_has_the_bits_of_the_arc_and_outlives_it) {
  const GroupStart start = falling_stack(3);
  const CompleteArc whole(start);
  const std::int64_t alive = GroupArc::alive();
  const double from = start.time + 0.3 * (start.end - start.time), to = start.end;
  // as seen from the middle of a step, and from its very end
  for (const double seen : {from, whole.step_end(from)}) {
    const TrajectoryPtr motion = CompleteArc(start).excerpt(1, seen, to);
    EXPECT_EQ(GroupArc::alive(), alive);
    for (int i = 0; i <= 40; ++i) {
      const double time = std::min(to, seen + i * (to - seen) / 40);
      Vec3 x, v_arc, w_arc;
      Quat q;
      whole.pose(1, time, x, q);
      whole.pose_rates(1, time, v_arc, w_arc);
      const Twist rates = motion->twist(time);
      EXPECT_EQ(motion->pose(time).p, x);
      EXPECT_EQ(motion->pose(time).q.coeffs(), q.coeffs());
      EXPECT_EQ(rates.v, v_arc);
      EXPECT_EQ(rates.w, w_arc);
      for (const PoseTwist& both : {motion->path_at(time), whole.path_at(1, time)}) {
        EXPECT_TRUE(same_bits(both.x, x) && same_bits(both.q.coeffs(), q.coeffs()));
        EXPECT_TRUE(same_bits(both.v, v_arc) && same_bits(both.w, w_arc));
      }
      const double later = std::min(to, time + 0.1 * (to - seen));
      const MotionBounds bounds = whole.bounds(1, time, later);
      const MotionBounds known = motion->bounds(time, later);
      EXPECT_EQ(known.path.lo, bounds.path.lo);
      EXPECT_EQ(known.path.hi, bounds.path.hi);
      EXPECT_EQ(known.speed, bounds.speed);
      EXPECT_EQ(known.turn, bounds.turn);
    }
  }
}

// ½ kt xi^2 up to the cone, mu N/(y kt); what lies beyond is lost in sliding.
TEST(GroupArc, stretch_beyond_the_cone_has_no_more_energy) {
  GroupStart start = stack(1, 0.5, 0.4);
  start.members[0].x.z() -= 1e-4;
  GroupContact& c = start.contacts[0];
  const auto energy = [&](double stretch) {
    c.stretch = Vec3(stretch, 0, 0);
    return GroupArc(start).elastic_energy(start.time);
  };
  const double kt = c.share * c.law.kt;
  const double grip = friction_grip(c.law, 1e-4);
  const double cone =
      c.law.mu * GroupArc(start).contact_force(0, start.time).normal_force / (grip * kt);
  ASSERT_GT(cone, 0);
  const double none = energy(0), most = 0.5 * kt * cone * cone;
  EXPECT_NEAR(energy(0.5 * cone), none + 0.25 * most, 1e-9 * most);
  EXPECT_NEAR(energy(cone), none + most, 1e-9 * most);
  EXPECT_NEAR(energy(100 * cone), none + most, 1e-9 * most);
}

TEST(GroupArc, other_arcs_in_between_change_nothing) {
  const GroupStart start = falling_stack(9), other = falling_stack(2);
  GroupArc alone(start), disturbed(start), disturbing(other);
  for (int i = 0; i <= 20; ++i) {
    disturbed.extend(i * start.end / 20);
    disturbing.extend(i * other.end / 20);
    GroupArc(falling_stack(12)).extend(0.01);
  }
  alone.extend(start.end);
  disturbed.extend(start.end);
  for (int m = 0; m < 9; ++m)
    EXPECT_TRUE(same_bits(alone.evaluate(m, start.end), disturbed.evaluate(m, start.end)));
}

TEST(GroupArc, nodes_give_the_states_that_a_later_arc_may_start_from) {
  const GroupStart start = falling_stack(2);
  GroupArc arc(start);
  arc.extend(start.end);
  EXPECT_EQ(arc.reached(), start.end);
  EXPECT_EQ(arc.evaluate(0, start.time).x, start.members[0].x);
  EXPECT_EQ(arc.evaluate(0, start.time - 1).x, start.members[0].x);
  const GroupSample end = arc.evaluate(1, start.end);
  EXPECT_NEAR(end.q.coeffs().norm(), 1, 1e-15);
}

TEST(GroupArc, pose_is_that_of_evaluate_and_rates_are_its_derivative) {
  GroupStart start = falling_stack(2);
  start.members[0].L = Vec3(0.3, 0.2, 0.1);
  const CompleteArc arc(start);
  for (int i = 1; i < 40; ++i) {
    const double time = i * start.end / 40, d = 1e-7;
    Vec3 x, x0, x1, dx, w;
    Quat q, q0, q1;
    arc.pose(0, time, x, q);
    EXPECT_EQ(x, arc.evaluate(0, time).x);
    EXPECT_EQ(q.coeffs(), arc.evaluate(0, time).q.coeffs());
    arc.pose(0, time - d, x0, q0);
    arc.pose(0, time + d, x1, q1);
    arc.pose_rates(0, time, dx, w);
    EXPECT_LT(((x1 - x0) / (2 * d) - dx).norm(), 1e-6);
    const Quat turn = q1 * q0.conjugate();
    EXPECT_LT((2 * turn.vec() / (2 * d) - w).norm(), 1e-6);
    // and near the velocities of the state
    const GroupSample s = arc.evaluate(0, time);
    EXPECT_LT((dx - s.v).norm(), 1e-3);
    EXPECT_LT((w - s.w).norm(), 2e-2);
  }
}

TEST(GroupArc, bounds_hold_everything_between_and_are_tight) {
  GroupStart start = falling_stack(2);
  start.members[0].L = Vec3(0.3, 0.2, 0.1);
  const CompleteArc arc(start);
  for (int i = 0; i < 16; ++i) {
    const double from = i * start.end / 17, to = from + start.end / (1 + i % 5 * 4) / 17;
    const MotionBounds bounds = arc.bounds(0, from, to);
    Vec3 last_dx = Vec3::Zero(), last_w = Vec3::Zero();
    double acceleration = 0, turn = 0, turn_change = 0;
    constexpr int parts = 400;
    for (int j = 0; j <= parts; ++j) {
      const double time = from + (to - from) * j / parts, h = (to - from) / parts;
      Vec3 x, dx, w;
      Quat q;
      arc.pose(0, time, x, q);
      arc.pose_rates(0, time, dx, w);
      EXPECT_TRUE(bounds.path.contains(x));
      if (j > 0) {
        acceleration = std::max(acceleration, (dx - last_dx).norm() / h);
        turn_change = std::max(turn_change, (w - last_w).norm() / h);
      }
      turn = std::max(turn, w.norm());
      last_dx = dx;
      last_w = w;
    }
    EXPECT_LE(turn, bounds.turn);
    EXPECT_LE(bounds.turn, 1.5 * turn + 1e-9);
    const double most =
        bounds.acceleration.lo.cwiseAbs().cwiseMax(bounds.acceleration.hi.cwiseAbs()).norm();
    EXPECT_LE(acceleration, most * (1 + 1e-6) + 1e-6);
    EXPECT_LE(most, 1.8 * acceleration + 1e-6);
    EXPECT_LE(turn_change, bounds.turn_change * (1 + 1e-6) + 1e-6);
    EXPECT_LE(bounds.turn_change, 1.2 * turn_change + 1e-3);
    EXPECT_LE(bounds.path.size().maxCoeff(), 2 * (to - from) * 0.6 + 1e-4);
  }
}

// A ball slides round and round inside a shell or a tube of radius .3 (a negative radius: hollow).
// A normal that kept to one side of a's frame would turn over.
TEST(GroupArc, normals_of_points_and_lines_go_round_with_the_contact) {
  GroupStart start;
  start.end = 3;
  start.outside = {make_standing({})};
  const ContactConstants c = constants(1, 0.2, 0);
  start.members = {ball(1, 0.1, Vec3(0, 0, -0.2 + c.depth), Vec3::Zero())};
  start.members[0].v = Vec3(1, 0, 0);
  GroupContact contact;
  contact.a = -1;
  contact.b = 0;
  contact.direction = Vec3(0, 1, 0);
  contact.radius_a = -0.3;
  contact.radius_b = 0.1;
  // n from the wall to the ball, against p_b - p_a
  contact.normal = Vec3(0, 0, 1);
  contact.law = c;
  for (const ContactFeature feature : {ContactFeature::point, ContactFeature::line}) {
    contact.feature = feature;
    start.contacts = {contact};
    const CompleteArc arc(start);
    for (int i = 1; i <= 30; ++i) {
      const double time = i / 10.0;
      const GroupSample s = arc.evaluate(0, time);
      const ContactForce force = arc.contact_force(0, time);
      EXPECT_LT((force.normal + s.x.normalized()).norm(), 1e-9) << i;
      EXPECT_NEAR(s.x.norm(), 0.2, 1e-4);
      // m v^2/r
      EXPECT_NEAR(force.normal_force, 1 / 0.2, 0.2);
      EXPECT_NEAR(s.v.norm(), 1, 1e-3);
    }
  }
}

TEST(GroupArc, states_that_are_not_finite_end_in_a_failure_text) {
  GroupStart start = falling_stack(2);
  start.members[1].v.x() = std::numeric_limits<double>::quiet_NaN();
  GroupArc arc(start);
  EXPECT_FALSE(arc.extend(start.end));
  EXPECT_NE(arc.failure().find("0 s"), std::string::npos) << arc.failure();
  EXPECT_NE(arc.failure().find("contact"), std::string::npos);
  EXPECT_GE(arc.failed_contact(), 0);
  EXPECT_EQ(arc.reached(), start.time);
  EXPECT_EQ(arc.evaluate(0, start.end).x, start.members[0].x);
}

TEST(GroupArc, a_stack_of_ten_settles_without_drift) {
  GroupStart start = stack(10, 0.5, 10);
  const CompleteArc arc(start);
  const GroupSample early = arc.evaluate(9, 5), late = arc.evaluate(9, 10);
  EXPECT_LT(late.v.norm(), 1e-9);
  EXPECT_LT((late.x - early.x).norm(), 1e-8);
  EXPECT_LT(late.x.head<2>().norm(), 1e-9);
  // each contact carries what lies above
  for (int i = 0; i < 10; ++i) {
    double load = 0;
    for (int corner = 0; corner < 4; ++corner)
      load += arc.contact_force(4 * i + corner, 10).normal_force;
    EXPECT_NEAR(load, 8 * g * (10 - i), 1e-5);
  }
}

TEST(GroupArc, dense_and_sparse_solutions_agree) {
  // the same stack of eight (dense) with and without a ninth body far away (sparse)
  GroupStart dense = stack(8, 0.5, 0.2, 1e-3), sparse = dense;
  sparse.members.push_back(ball(1, 0.1, Vec3(100, 0, 0), Vec3::Zero()));
  dense.first_step = sparse.first_step = 1e-4;
  dense.position_tolerance = sparse.position_tolerance = 1e-9;
  dense.velocity_tolerance = sparse.velocity_tolerance = 1e-8;
  const CompleteArc a(dense), b(sparse);
  for (int m = 0; m < 8; ++m) EXPECT_LT((a.evaluate(m, 0.2).x - b.evaluate(m, 0.2).x).norm(), 1e-8);
}

}  // namespace
}  // namespace tw
