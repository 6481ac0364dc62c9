// Keyframes: pose, velocity by differences, and bounds that hold.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "integrate/given/keyframes.h"
#include "support/scene.h"

namespace tw::test {
namespace {

std::vector<Keyframe> random_keyframes(Random& random) {
  std::vector<Keyframe> frames;
  double now = random.real(-1, 1);
  for (int i = 0; i < 6; ++i) {
    Keyframe frame{now, random_vector(random, 3), std::nullopt};
    if (random.below(4)) frame.orientation = random_attitude(random);
    frames.push_back(frame);
    now += random.real(0.1, 1);
  }
  return frames;
}

double angle_between(const Quat& a, const Quat& b) { return 2 * (a * b.conjugate()).vec().norm(); }

TEST(Keyframes, pose_passes_through_every_keyframe_and_rests_outside) {
  Random random(1);
  for (const bool smooth : {false, true}) {
    const auto frames = random_keyframes(random);
    const TrajectoryPtr motion = make_keyframes(frames, smooth);
    Quat before = Quat::Identity();
    for (const Keyframe& frame : frames) {
      if (frame.orientation) before = *frame.orientation;
      const Pose pose = motion->pose(frame.time);
      EXPECT_LT((pose.p - frame.position).norm(), 1e-14);
      EXPECT_LT(angle_between(pose.q, before), 1e-14);
    }
    for (const double outside : {frames.front().time - 2, frames.back().time + 2}) {
      const auto [v, w] = motion->twist(outside);
      EXPECT_EQ(v, Vec3::Zero());
      EXPECT_EQ(w, Vec3::Zero());
    }
  }
}

TEST(Keyframes, velocity_is_the_derivative_of_the_pose) {
  Random random(2);
  for (const bool smooth : {false, true})
    for (int i = 0; i < 20; ++i) {
      const auto frames = random_keyframes(random);
      const TrajectoryPtr motion = make_keyframes(frames, smooth);
      for (int k = 0; k < 20; ++k) {
        const double now = random.real(frames.front().time, frames.back().time), step = 1e-6;
        bool at_corner = false;
        for (const Keyframe& frame : frames)
          at_corner = at_corner || std::abs(frame.time - now) <= 2 * step;
        if (at_corner) continue;
        const auto [v, w] = motion->twist(now);
        const Pose a = motion->pose(now - step), b = motion->pose(now + step);
        EXPECT_LT((v - (b.p - a.p) / (2 * step)).norm(), 1e-6 * (1 + v.norm()));
        Quat turn = b.q * a.q.conjugate();
        if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
        EXPECT_LT((w - turn.vec() / step).norm(), 1e-6 * (1 + w.norm()));
      }
    }
}

// What certificates and swept boxes rely on.
TEST(Keyframes, bounds_hold_over_any_interval) {
  Random random(3);
  for (const bool smooth : {false, true})
    for (int i = 0; i < 40; ++i) {
      const auto frames = random_keyframes(random);
      const TrajectoryPtr motion = make_keyframes(frames, smooth);
      const double from = random.real(frames.front().time - 1, frames.back().time);
      const double to = from + random.real(0, 2);
      const MotionBounds bounds = motion->bounds(from, to);
      const double speed = bounds.speed, turn = bounds.turn;
      EXPECT_FALSE(bounds.velocity_may_jump());
      EXPECT_GT(bounds.valid_until, from);
      EXPECT_LE(bounds.valid_until, to);
      const Twist start = motion->twist(from);
      Aabb path = bounds.path;
      path.grow(1e-14);
      for (int k = 0; k <= 100; ++k) {
        const double now = from + (to - from) * k / 100;
        const auto [v, w] = motion->twist(now);
        EXPECT_LE(v.norm(), speed * (1 + 1e-14));
        EXPECT_LE(w.norm(), turn * (1 + 1e-14));
        EXPECT_TRUE(path.contains(motion->pose(now).p));
        if (now >= bounds.valid_until) continue;
        // as long as the velocity does not jump
        Aabb change = bounds.acceleration;
        const double since = now - from;
        change.lo *= since;
        change.hi *= since;
        change.grow(1e-12 * (1 + speed));
        EXPECT_TRUE(change.contains(v - start.v));
        EXPECT_LE((w - start.w).norm(), bounds.turn_change * since + 1e-12 * (1 + turn));
      }
    }
}

TEST(Keyframes, smooth_motion_is_at_rest_at_each_keyframe) {
  Random random(4);
  const auto frames = random_keyframes(random);
  const TrajectoryPtr motion = make_keyframes(frames, true);
  for (const Keyframe& frame : frames) {
    const auto [v, w] = motion->twist(frame.time);
    EXPECT_LT(v.norm() + w.norm(), 1e-12);
  }
}

TEST(Keyframes, the_shorter_way_round_is_taken) {
  const Quat turned = rotation_by(Vec3(0, 0, 3));
  const Quat negative(-turned.w(), -turned.x(), -turned.y(), -turned.z());
  const TrajectoryPtr motion =
      make_keyframes({{0, Vec3::Zero(), Quat::Identity()}, {1, Vec3::Zero(), negative}}, false);
  const auto [v, w] = motion->twist(0.5);
  EXPECT_NEAR(w.z(), 3, 1e-14);
}

TEST(Keyframes, bad_ones_are_errors) {
  const double nan = std::nan("");
  EXPECT_THROW(make_keyframes({}, false), UserError);
  EXPECT_THROW(make_keyframes({{1, Vec3::Zero(), {}}, {1, Vec3::Zero(), {}}}, false), UserError);
  EXPECT_THROW(make_keyframes({{1, Vec3::Zero(), {}}, {0, Vec3::Zero(), {}}}, false), UserError);
  EXPECT_THROW(make_keyframes({{nan, Vec3::Zero(), {}}}, false), UserError);
  EXPECT_THROW(make_keyframes({{0, {nan, 0, 0}, {}}}, false), UserError);
  EXPECT_THROW(make_keyframes({{0, Vec3::Zero(), Quat(0, 0, 0, 0)}}, false), UserError);
}

TEST(Keyframes, a_single_one_never_moves) {
  const TrajectoryPtr motion = make_keyframes({{3, {1, 2, 3}, {}}}, false);
  for (const double now : {-1.0, 3.0, 9.0}) EXPECT_EQ(motion->pose(now).p, Vec3(1, 2, 3));
  EXPECT_EQ(motion->bounds(0, 10).speed, 0);
}

}  // namespace
}  // namespace tw::test
