// What trajectories promise: bounds hold, and each kind answers as what it is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "analytic/group-arc-scenes.h"
#include "integrate/arc/member-trajectory.h"
#include "integrate/flight.h"
#include "integrate/given/keyframes.h"
#include "integrate/standing.h"

namespace tw {
namespace {

const Vec3 moments(0.1, 0.25, 0.3);

Flight tumbling() {
  const FreeRotation rotation(moments, Quat(0.5, 0.5, -0.5, 0.5), Vec3(0.2, 1.5, -0.4));
  return Flight(rotation, {2, {1, 2, 3}, {3, -1, 5}, {0, 0.5, -9.81}});
}

// The bounds over [from, to] against samples of the path and differences of its rates.
void expect_bounds_hold(const Trajectory& trajectory, double from, double to) {
  const MotionBounds bounds = trajectory.bounds(from, to);
  EXPECT_GE(bounds.valid_until, to);
  Aabb path = bounds.path, acceleration = bounds.acceleration;
  path.grow(1e-12);
  acceleration.grow(1e-5);
  constexpr int parts = 200;
  const double h = (to - from) / parts;
  PoseTwist last = trajectory.path_at(from);
  for (int i = 0; i <= parts; ++i) {
    const double time = std::min(to, from + i * h);
    const PoseTwist now = trajectory.path_at(time);
    EXPECT_TRUE(path.contains(now.x)) << time;
    EXPECT_EQ(now.x, trajectory.pose(time).p);
    EXPECT_EQ(now.x, trajectory.center(time));
    EXPECT_LE(now.v.norm(), bounds.speed * (1 + 1e-12));
    EXPECT_LE(now.w.norm(), bounds.turn * (1 + 1e-12));
    if (i > 0 && !bounds.velocity_may_jump()) {
      EXPECT_TRUE(acceleration.contains(Vec3((now.v - last.v) / h))) << time;
      EXPECT_LE((now.w - last.w).norm() / h, bounds.turn_change * (1 + 1e-6) + 1e-6);
    }
    last = now;
  }
}

TEST(Trajectories, bounds_of_a_flight_hold) {
  const Flight flight = tumbling();
  // before, about and after the apex of each coordinate
  for (const auto& [from, to] : {std::pair{2.0, 2.3}, {2.0, 4.0}, {3.0, 9.5}, {2.5, 2.5001}})
    expect_bounds_hold(flight, from, to);
  const MotionBounds ever = flight.bounds(2, never);
  EXPECT_TRUE(ever.path.unbounded());
  EXPECT_EQ(ever.valid_until, never);
  EXPECT_EQ(ever.acceleration.lo, Vec3(0, 0.5, -9.81)) << "bounds that need no end";
}

TEST(Trajectories, a_flight_is_ballistic_and_never_ends) {
  const Flight flight = tumbling();
  ASSERT_TRUE(flight.ballistic());
  EXPECT_EQ(flight.ballistic()->position(3), flight.at(3).x);
  EXPECT_EQ(flight.ballistic()->velocity(3), flight.at(3).v);
  EXPECT_EQ(flight.free_acceleration(0), Vec3(0, 0.5, -9.81));
  EXPECT_EQ(flight.end(), never);
  EXPECT_FALSE(flight.stepped());
  EXPECT_EQ(flight.effort().steps, 0u);
}

// A state is copied wherever a callback only looked: the arc goes along, bit for bit.
TEST(Trajectories, a_copy_of_a_flight_has_the_same_bits) {
  const Flight flight = tumbling();
  const Flight copy = flight;
  for (const double time : {2.0, 3.7, 11.0}) {
    EXPECT_EQ(copy.at(time).x, flight.at(time).x);
    EXPECT_EQ(copy.at(time).q.coeffs(), flight.at(time).q.coeffs());
    EXPECT_EQ(copy.at(time).w, flight.at(time).w);
  }
}

TEST(Trajectories, what_rests_is_carried_and_what_is_fixed_falls_nowhere) {
  const Pose pose{{1, 2, 3}, Quat(0.5, 0.5, -0.5, 0.5)};
  for (const TrajectoryPtr& still : {make_standing(pose), make_resting(pose)}) {
    expect_bounds_hold(*still, 0, 5);
    EXPECT_EQ(still->pose(7).q.coeffs(), pose.q.coeffs());
    EXPECT_EQ(still->bounds(0, never).path.lo, pose.p);
    EXPECT_EQ(still->bounds(0, never).speed, 0);
    EXPECT_EQ(still->free_acceleration(0), Vec3::Zero());
    EXPECT_EQ(still->end(), never);
  }
  EXPECT_TRUE(make_standing(pose)->ballistic());
  EXPECT_FALSE(make_resting(pose)->ballistic());
}

TEST(Trajectories, given_motion_is_bounded_as_far_as_its_velocity_does_not_jump) {
  const TrajectoryPtr motion =
      make_keyframes({{0, {0, 0, 0}, {}}, {1, {1, 0, 2}, rotation_by(Vec3(0, 1, 0))}}, false);
  expect_bounds_hold(*motion, -0.5, -0.1);
  expect_bounds_hold(*motion, 0.1, 0.7);
  EXPECT_EQ(motion->bounds(-0.5, 0.7).valid_until, 0);
  const MotionBounds bounds = motion->bounds(0.2, 3);
  EXPECT_EQ(bounds.valid_until, 1);
  EXPECT_EQ(bounds.acceleration.size(), Vec3(0, 0, 0));
  EXPECT_EQ(bounds.turn_change, 0);
  EXPECT_FALSE(motion->ballistic());
}

std::shared_ptr<GroupArc> settling_stack() {
  GroupStart start = group_scenes::stack(2, 0.5, 0.2, 1e-3);
  start.members[0].v = Vec3(0.3, 0.1, 0);
  start.members[1].L = Vec3(0.01, 0.02, 0.03);
  return std::make_shared<GroupArc>(std::move(start));
}

TEST(Trajectories, a_member_follows_its_arc_and_keeps_it_alive) {
  std::shared_ptr<GroupArc> arc = settling_stack();
  arc->extend(arc->start().end);
  const double end = arc->start().end, time = 0.4 * end;
  const GroupSample sample = arc->evaluate(1, time);
  const std::int64_t alive = GroupArc::alive();
  TrajectoryPtr member = member_trajectory(arc, 1);
  arc.reset();
  EXPECT_EQ(GroupArc::alive(), alive);
  EXPECT_EQ(member->at(time).x, sample.x);
  EXPECT_EQ(member->at(time).v, sample.v);
  EXPECT_EQ(member->at(time).w, sample.w);
  EXPECT_EQ(member->pose(time).q.coeffs(), sample.q.coeffs());
  EXPECT_TRUE(member->stepped());
  EXPECT_FALSE(member->ballistic());
  for (const double from : {0.0, 0.1 * end, 0.9 * end})
    expect_bounds_hold(*member, from, from + 0.1 * end);
  member.reset();
  EXPECT_EQ(GroupArc::alive(), alive - 1);
}

TEST(Trajectories, bounds_of_a_member_hold_as_long_as_its_arc_goes_on) {
  const std::shared_ptr<GroupArc> arc = settling_stack();
  const double end = arc->start().end;
  arc->extend(end);
  const TrajectoryPtr member = member_trajectory(arc, 0);
  EXPECT_EQ(member->end(), end);
  EXPECT_EQ(member->bounds(0, end).valid_until, never);
  EXPECT_EQ(member->bounds(0, 0.5 * end).valid_until, 0.5 * end);
  const double step_end = member->step_end(0.5 * end);
  EXPECT_GT(step_end, 0.5 * end);
  // what the end test finds out holds for trajectories that were given out before
  arc->lower_ends({{0.75 * end, EndReason::unseen}, {end, EndReason::motion}});
  EXPECT_EQ(member->end(), 0.75 * end);
  EXPECT_EQ(member_trajectory(arc, 1)->end(), end);
  EXPECT_EQ(member->bounds(0, 0.75 * end).valid_until, never);
  EXPECT_EQ(member->step_end(0.75 * end), never);
}

TEST(TrajectoriesDeathTest, ends_are_told_once) {
  const std::shared_ptr<GroupArc> arc = settling_stack();
  arc->lower_ends({{0.1, EndReason::fast}, {0.1, EndReason::fast}});
  EXPECT_DEATH(arc->lower_ends({{0.05, EndReason::fast}, {0.05, EndReason::fast}}), "told twice");
}

TEST(Trajectories, the_effort_of_a_group_is_told_by_its_first_member) {
  const std::shared_ptr<GroupArc> arc = settling_stack();
  arc->extend(0.5 * arc->start().end);
  const Effort first = member_trajectory(arc, 0)->effort();
  const Effort second = member_trajectory(arc, 1)->effort();
  EXPECT_EQ(first.steps, arc->counts().steps);
  EXPECT_GT(first.steps, 0u);
  EXPECT_EQ(second.steps, 0u);
  EXPECT_EQ(first.length, arc->reached() - arc->start().time);
  EXPECT_EQ(second.length, first.length);
}

TEST(Trajectories, an_excerpt_of_a_member_is_bounded_like_the_member) {
  const std::shared_ptr<GroupArc> arc = settling_stack();
  const double end = arc->start().end;
  arc->extend(end);
  const TrajectoryPtr excerpt = arc->excerpt(0, 0.3 * end, 0.9 * end);
  expect_bounds_hold(*excerpt, 0.3 * end, 0.9 * end);
  EXPECT_EQ(excerpt->bounds(0.3 * end, 0.5 * end).speed,
            arc->bounds(0, 0.3 * end, 0.5 * end).speed);
}

}  // namespace
}  // namespace tw
