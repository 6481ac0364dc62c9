// Motion by a procedure: the sampled curve against the procedure, its bounds, and where it ends.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/sampled-motion.h"

#include <gtest/gtest.h>

#include "base/constants.h"
#include "math/rotation-vector.h"
#include "support/motions.h"
#include "support/scene.h"

namespace tw::test {
namespace {

constexpr double span = answer::motion_span;

// A motion with its rates in closed form.
struct ClosedForm {
  const char* name;
  std::function<Pose(double)> pose;
  std::function<Twist(double)> twist;
};

const Vec3 axis = Vec3(1, 2, -2) / 3;

// Straight or curved, turning about a fixed axis by a rate of its own.
ClosedForm along(const char* name, std::function<Vec3(double)> x, std::function<Vec3(double)> v,
                 std::function<double(double)> angle, std::function<double(double)> rate) {
  return {name,
          [=](double t) {
            return Pose{x(t), rotation_by(angle(t) * axis)};
          },
          [=](double t) {
            return Twist{v(t), rate(t) * axis};
          }};
}

std::vector<ClosedForm> closed_forms() {
  const auto sine = [](double a, double w) {
    return [=](double t) { return a * std::sin(w * t); };
  };
  const auto cosine = [](double a, double w) {
    return [=](double t) { return a * std::cos(w * t); };
  };
  return {
      along(
          "circle", [](double t) { return Vec3(std::cos(3 * t), std::sin(3 * t), 0.5); },
          [](double t) { return Vec3(-3 * std::sin(3 * t), 3 * std::cos(3 * t), 0); },
          [](double t) { return 3 * t; }, [](double) { return 3.0; }),
      along(
          "shaker, 20 Hz", [](double t) { return Vec3(0, 0, 0.002 * std::sin(40 * pi * t)); },
          [](double t) { return Vec3(0, 0, 0.08 * pi * std::cos(40 * pi * t)); }, sine(0.1, 30),
          cosine(3, 30)),
      along(
          "sum of sines",
          [](double t) {
            return Vec3(std::sin(t) + 0.3 * std::sin(7.3 * t), 0.05 * std::cos(50 * t), 0);
          },
          [](double t) {
            return Vec3(std::cos(t) + 2.19 * std::cos(7.3 * t), -2.5 * std::sin(50 * t), 0);
          },
          sine(1.5, 2), cosine(3, 2)),
      along(
          "polynomial",
          [](double t) {
            const double u = t / 8;
            return Vec3(u, 1 - u * u, u * u * u * (10 + u * (6 * u - 15)));
          },
          [](double t) {
            const double u = t / 8;
            return Vec3(0.125, -0.25 * u, 3.75 * u * u * (1 - u) * (1 - u));
          },
          [](double t) { return 0.1 * t * t; }, [](double t) { return 0.2 * t; }),
  };
}

TEST(SampledMotion, follows_closed_forms_to_rounding) {
  for (const ClosedForm& form : closed_forms()) {
    const Sampled sampled(form.pose);
    double miss = 0, turned = 0, speed = 0, turning = 0;
    for (int i = 0; i < 4000; ++i) {
      const double t = 0.001 * i * 1.9;
      const PoseTwist there = sampled.motion->at(t);
      const Pose pose = form.pose(t);
      const Twist twist = form.twist(t);
      miss = std::max(miss, (there.x - pose.p).norm());
      turned = std::max(turned, turn_between(there.q, pose.q).norm());
      speed = std::max(speed, (there.v - twist.v).norm());
      turning = std::max(turning, (there.w - twist.w).norm());
    }
    RecordProperty(form.name, show(miss) + " " + show(turned) + " " + show(speed) + " " +
                                  show(turning) + " " + std::to_string(sampled.procedure->calls));
    // of a body of 0.1 m
    EXPECT_LT(miss, 1e-13) << form.name;
    EXPECT_LT(turned, 1e-12) << form.name;
    EXPECT_LT(speed, 2e-9) << form.name;
    EXPECT_LT(turning, 2e-8) << form.name;
    // 7.6 s: what oscillates at 20 Hz takes eight pieces a span, and the tries that led there
    EXPECT_LE(sampled.procedure->calls, 7.6 / span * 17 * 16) << form.name;
  }
}

TEST(SampledMotion, calls_the_procedure_17_times_a_span_whoever_asks) {
  const Sampled sampled(closed_forms().front().pose);
  for (int i = 0; i < 10000; ++i) {
    const double t = 1e-4 * i;
    sampled.motion->at(t);
    sampled.motion->bounds(t, std::min(t + 0.01, 1 - 1e-9));
    sampled.motion->step_end(t);
  }
  EXPECT_EQ(sampled.procedure->calls, 17 / span);
}

TEST(SampledMotion, a_long_way_off_follows_as_far_as_times_can_be_told_apart) {
  const ClosedForm circle = closed_forms().front();
  const Sampled sampled(circle.pose);
  for (const double start : {1e3, 1e6, 1e8}) {
    const long before = sampled.procedure->calls;
    for (int i = 0; i < 100; ++i) {
      const double t = start + i * 0.013;
      const double spacing = std::nextafter(t, never) - t;
      EXPECT_LT((sampled.motion->pose(t).p - circle.pose(t).p).norm(), 1e-13 + 20 * spacing) << t;
    }
    EXPECT_LE(sampled.procedure->calls - before, 1.4 / span * 17 * 32) << start;
  }
}

// What certificates and swept boxes rely on.
TEST(SampledMotion, bounds_hold_over_any_interval) {
  Random random(3);
  for (const ClosedForm& form : closed_forms()) {
    const Sampled sampled(form.pose);
    for (int i = 0; i < 60; ++i) {
      const double from = random.real(0, 4), to = from + std::pow(10, random.real(-5, -0.5));
      const MotionBounds bounds = sampled.motion->bounds(from, to);
      EXPECT_GT(bounds.valid_until, from);
      EXPECT_LE(bounds.valid_until, to);
      Aabb path = bounds.path;
      for (int k = 0; k <= 100; ++k) {
        const double t = from + (to - from) * k / 100;
        const PoseTwist there = sampled.motion->at(t);
        EXPECT_TRUE(path.contains(there.x)) << form.name << " " << t;
        EXPECT_LE(there.v.norm(), bounds.speed) << form.name;
        EXPECT_LE(there.w.norm(), bounds.turn) << form.name;
      }
      // changes: against differences within the piece
      const double valid = bounds.valid_until - from, step = valid / 50;
      const double blur = 1e-15 / step * 50 + 1e-9;
      Aabb acceleration = bounds.acceleration;
      acceleration.grow(blur);
      for (int k = 0; k + 1 < 50; ++k) {
        const PoseTwist a = sampled.motion->at(from + k * step);
        const PoseTwist b = sampled.motion->at(from + (k + 1) * step);
        EXPECT_TRUE(acceleration.contains(Vec3((b.v - a.v) / step))) << form.name;
        EXPECT_LE((b.w - a.w).norm() / step, bounds.turn_change + blur) << form.name;
      }
    }
  }
}

// A turn about an axis that itself turns: |w'| is more than |theta''|.
TEST(SampledMotion, bounds_of_a_turning_axis_hold_and_are_narrow) {
  const auto tumble = [](double t) {
    return Pose{Vec3::Zero(), rotation_by(Vec3(0, 0, 9 * t)) * rotation_by(Vec3(5 * t, 0, 0))};
  };
  const Sampled sampled(tumble);
  for (double from = 0; from < 1; from += 0.0083) {
    const MotionBounds bounds = sampled.motion->bounds(from, from + 0.01);
    const double exact = std::hypot(9, 5), change = 45;  // w = 9 z + 5 x', w' = 9 z x 5 x'
    EXPECT_GE(bounds.turn, exact * (1 - 1e-9));
    EXPECT_LE(bounds.turn, exact * 1.05);
    EXPECT_GE(bounds.turn_change, change * (1 - 1e-6));
    EXPECT_LE(bounds.turn_change, change * 1.5);
  }
}

TEST(SampledMotion, the_same_bits_whoever_asks_first_and_after_forgetting) {
  for (const ClosedForm& form : closed_forms()) {
    const double any_speed = 1e15;
    const Sampled forward(form.pose, any_speed), backward(form.pose, any_speed);
    std::vector<PoseTwist> seen;
    for (int i = 0; i < 300; ++i) seen.push_back(forward.motion->at(0.01 * i));
    for (int i = 299; i >= 0; --i) {
      const PoseTwist there = backward.motion->at(0.01 * i);
      const PoseTwist& expected = seen[static_cast<std::size_t>(i)];
      EXPECT_EQ(there.x, expected.x);
      EXPECT_EQ(there.q.coeffs(), expected.q.coeffs());
      EXPECT_EQ(there.v, expected.v);
      EXPECT_EQ(there.w, expected.w);
    }
    // so many more that the first are forgotten
    const auto spans = static_cast<int>(cost::kept_motion_pieces) + 100;
    for (int i = 0; i < spans; ++i) forward.motion->pose((i + 1000) * span);
    const long before = forward.procedure->calls;
    EXPECT_EQ(forward.motion->at(0.01).x, seen[1].x);
    EXPECT_GT(forward.procedure->calls, before) << "nothing was forgotten";
  }
}

TEST(SampledMotion, a_kink_is_followed_to_within_its_shortest_piece) {
  const double kink = 0.3;
  // 3 m/s, then 1 m/s the other way
  const auto zigzag = [=](double t) {
    return Pose{{t < kink ? 3 * t : 3 * kink - (t - kink), 0, 0}, Quat::Identity()};
  };
  const Sampled sampled(zigzag, 3);
  double miss = 0;
  for (int i = -1000; i <= 1000; ++i) {
    const double t = kink + i * 1e-9;
    miss = std::max(miss, (sampled.motion->pose(t).p - zigzag(t).p).norm());
  }
  EXPECT_LE(miss, 3 * answer::shortest_motion_piece);
  EXPECT_GT(miss, 0);
  EXPECT_NEAR(sampled.motion->twist(kink - 1e-7).v.x(), 3, 1e-7);
  EXPECT_NEAR(sampled.motion->twist(kink + 1e-7).v.x(), -1, 1e-7);
  EXPECT_NEAR(sampled.motion->twist(0.29).v.x(), 3, 1e-12);
  for (double t = 0.0005; t < 0.6; t += 1e-3)
    EXPECT_LT((sampled.motion->pose(t).p - zigzag(t).p).norm(), 1e-12) << t;
  EXPECT_LT(sampled.procedure->calls, 1500);
  // bounds across it
  const MotionBounds bounds = sampled.motion->bounds(0.29, 0.31);
  EXPECT_TRUE(bounds.path.contains(sampled.motion->pose(kink).p));
  EXPECT_GE(bounds.speed, 3);
  EXPECT_LT(bounds.valid_until, kink + 1e-7) << "the velocity jumps there";
}

std::string failure_at(const SampledMotion& motion, double time) {
  try {
    motion.pose(time);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(SampledMotion, a_jump_is_too_fast_where_it_is_and_not_before) {
  const double jump = 0.3;
  const Sampled sampled(
      [=](double t) {
        return Pose{{t < jump ? 0.0 : 0.01, 0, 0}, Quat::Identity()};
      },
      50);
  EXPECT_EQ(sampled.motion->pose(jump - 1e-7).p, Vec3::Zero());
  EXPECT_LE(sampled.motion->step_end(0.29), jump);
  EXPECT_GT(sampled.motion->step_end(0.29), jump - 1e-7);
  EXPECT_EQ(failure_at(*sampled.motion, jump).substr(0, 22), "faster than 50 m/s at ");
  EXPECT_THROW(sampled.motion->bounds(jump, jump + 0.001), UserError);
  EXPECT_THROW(sampled.motion->step_end(jump), UserError);
  EXPECT_EQ(sampled.motion->bounds(0.29, 0.31).path.hi.x(), 0) << "up to where it fails";
  // on a border of the grid of spans too
  const Sampled at_border(
      [](double t) {
        return Pose{{t < 0.5 ? 0.0 : 0.01, 0, 0}, Quat::Identity()};
      },
      50);
  EXPECT_LT(at_border.motion->step_end(0.49), 0.5);
}

TEST(SampledMotion, a_motion_that_ends_holds_to_its_last_time) {
  for (const double last : {0.3, 0.5, 0.7123}) {
    const Sampled sampled([=](double t) {
      TW_REQUIRE(t <= last, "no row for " + show(t));
      return Pose{{t, t * t, 0}, Quat::Identity()};
    });
    EXPECT_EQ(failure_at(*sampled.motion, last), "");
    EXPECT_LT((sampled.motion->pose(last).p - Vec3(last, last * last, 0)).norm(), 1e-7);
    EXPECT_LT((sampled.motion->pose(last - 1e-6).p.x() - last + 1e-6), 1e-12);
    const double after = std::nextafter(last, never);
    EXPECT_EQ(failure_at(*sampled.motion, after), "no row for " + show(after));
    EXPECT_EQ(sampled.motion->step_end(last), after);
  }
}

TEST(SampledMotion, is_not_sampled_beyond_the_span_that_is_asked_for) {
  const Sampled sampled([](double t) { return Pose{{t, 0, 0}, Quat::Identity()}; });
  sampled.motion->at(0);
  EXPECT_EQ(sampled.procedure->earliest, 0);
  EXPECT_EQ(sampled.procedure->latest, span);
  sampled.motion->bounds(0, 5 * span);
  EXPECT_EQ(sampled.procedure->latest, 5 * span);
}

TEST(SampledMotion, a_procedure_that_never_works_says_so) {
  const Sampled sampled([](double t) -> Pose { throw UserError("bad at " + show(t)); });
  EXPECT_EQ(failure_at(*sampled.motion, 0), "bad at 0");
  EXPECT_EQ(failure_at(*sampled.motion, 0.01), "bad at 0");
  EXPECT_EQ(sampled.procedure->calls, 1) << "an error may take long to describe";
}

TEST(SampledMotion, an_interrupt_passes_and_leaves_nothing_behind) {
  bool interrupted = true;
  const Sampled sampled([&](double t) {
    if (interrupted && t > 0.03) throw std::runtime_error("interrupted");
    return Pose{{t, 0, 0}, Quat::Identity()};
  });
  EXPECT_THROW(sampled.motion->pose(0.01), std::runtime_error);
  interrupted = false;
  EXPECT_NEAR(sampled.motion->pose(0.05).p.x(), 0.05, 1e-15);
}

// What solves equations to a tolerance is rough at that scale.
TEST(SampledMotion, noise_far_below_the_accuracy_costs_few_calls) {
  const auto noisy = [](double t) {
    const double noise = 2e-12 * std::sin(1e13 * t);
    return Pose{{std::sin(t) + noise, 0, 0}, Quat::Identity()};
  };
  const Sampled sampled(noisy);
  for (double t = 0; t < 1; t += 0.001)
    EXPECT_LT((sampled.motion->pose(t).p - noisy(t).p).norm(), 1e-10);
  EXPECT_LT(sampled.procedure->calls, 17 * 16 / span);
}

TEST(SampledMotion, what_is_rough_everywhere_is_an_error) {
  const Sampled sampled(
      [](double t) {
        return Pose{{1e-5 * std::sin(1e7 * t), 0, 0}, Quat::Identity()};
      },
      1000);
  EXPECT_NE(failure_at(*sampled.motion, 0.06).find("expected a motion that is smooth"),
            std::string::npos);
  EXPECT_LT(sampled.procedure->calls, 300000);
}

TEST(SampledMotion, fast_spins_are_cut_into_pieces_that_turn_little) {
  const double rate = 1000;
  const auto spin = [=](double t) { return Pose{Vec3::Zero(), rotation_by(Vec3(0, rate * t, 0))}; };
  const Sampled sampled(spin);
  for (double t = 0; t < 0.2; t += 0.00037) {
    EXPECT_LT(turn_between(sampled.motion->pose(t).q, spin(t).q).norm(), 1e-11) << t;
    EXPECT_NEAR(sampled.motion->twist(t).w.y(), rate, 1e-6) << t;
  }
  EXPECT_LT(sampled.procedure->calls, 0.25 * rate * 30);
}

TEST(SampledMotion, what_stands_still_has_no_velocity_at_all) {
  const Pose pose{{0.1, -7, 3}, rotation_by(Vec3(1, 2, 3))};
  const Sampled sampled([=](double) { return pose; }, 0);
  for (double t = 0; t < 1; t += 0.013) {
    const PoseTwist there = sampled.motion->at(t);
    EXPECT_EQ(there.x, pose.p);
    EXPECT_EQ(there.v, Vec3::Zero());
    EXPECT_EQ(there.w, Vec3::Zero());
  }
  EXPECT_EQ(sampled.motion->bounds(0, 1).turn, 0);
}

}  // namespace
}  // namespace tw::test
