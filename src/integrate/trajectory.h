// Trajectories: how anything moves, from the discontinuity that starts it to the next one.
//
// One interface for flight, given motion, rest and the members of contact groups.  A trajectory is
// a function of the state that starts it (or, given motion, of the scene) and the time alone: same
// time, same bits.  Once a state has one it never changes; what is computed step by step is
// completed before anybody looks, and to look past what was completed is a mistake.
//
// Frames: of the body's principal frame at the centre of mass, in the world; of bodies whose motion
// is given, of their body frame.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>

#include "base/never.h"
#include "dynamics/pose-twist.h"
#include "math/aabb.h"

namespace tw {

// Where the frame may be and how it may move over a stretch of time.  Path, speed and turn hold as
// far as was asked, the others as far as `valid_until`.
struct MotionBounds {
  Aabb path;                   // of the origin, m
  double speed = 0;            // of the origin, m/s; `never`: not told, its path is (ballistic)
  Aabb acceleration;           // of the origin, m/s^2; everywhere: its velocity may jump
  double turn = 0;             // angular speed, rad/s
  double turn_change = 0;      // |w'|, rad/s^2; nothing where the velocity may jump
  double valid_until = never;  // s; `never`: as long as the trajectory goes on

  // Of all times nothing is known.
  static MotionBounds unknown() {
    MotionBounds bounds;
    bounds.path = bounds.acceleration = Aabb::everywhere();
    bounds.speed = bounds.turn = never;
    return bounds;
  }
  // Both hold then, one after the other.
  void add(const MotionBounds& other) {
    path.add(other.path);
    acceleration.add(other.acceleration);
    speed = std::max(speed, other.speed);
    turn = std::max(turn, other.turn);
    turn_change = std::max(turn_change, other.turn_change);
    valid_until = std::min(valid_until, other.valid_until);
  }
  // Only the speeds are bounded.
  bool velocity_may_jump() const { return acceleration.unbounded(); }
};

// Bounds of how a frame moves, each order by the next one's norm: |w|, |w'|, |w''|, |v|, |a|, |a'|.
struct MotionRates {
  double turn = 0, turn_change = 0, turn_jerk = 0;
  double speed = 0, acceleration = 0, jerk = 0;

  // Of a point fixed in the frame, at this distance from its origin.
  MotionRates at(double arm) const {
    return {turn,
            turn_change,
            turn_jerk,
            speed + turn * arm,
            acceleration + (turn_change + turn * turn) * arm,
            jerk + (turn_jerk + 3 * turn_change * turn + turn * turn * turn) * arm};
  }
};

// The origin's path where nothing acts but a constant acceleration: what exact prediction asks for.
struct Parabola {
  double start = 0;  // s
  Vec3 x = Vec3::Zero();
  Vec3 v = Vec3::Zero();
  Vec3 acceleration = Vec3::Zero();

  Vec3 position(double time) const {
    const double s = time - start;
    return x + s * (v + (0.5 * s) * acceleration);
  }
  Vec3 velocity(double time) const { return v + (time - start) * acceleration; }
};

// What it took to compute, for statistics.
struct Effort {
  double length = 0;     // s, of the stretch that was computed
  double forgotten = 0;  // s, of what was computed besides, and taken back by halt
  // of the integrator: those of a whole group, told by its first member
  std::uint64_t steps = 0, rejected = 0, factorizations = 0, evaluations = 0;
  bool implicit = false;
};

class Trajectory {
 public:
  virtual ~Trajectory() = default;

  virtual Pose pose(double time) const = 0;
  // The rates of the pose; at a corner the right derivative.
  virtual Twist twist(double time) const = 0;
  // Pose and twist of the motion.  What is integrated has velocities of its own, which differ from
  // the rates of its interpolated pose by the integration error.
  virtual PoseTwist at(double time) const { return joined(time); }
  // Bounds over [from, to] on the path of the pose and its rates.
  virtual MotionBounds bounds(double from, double to) const = 0;
  // |w' across the unit vector n|, rad/s^2, over what `bounds` tell of [from, to]:
  // `known.turn_change` or less.  Dearer than they are.
  virtual double turn_change_across(const Vec3& /*n*/, double /*from*/, double /*to*/,
                                    const MotionBounds& known) const {
    return known.turn_change;
  }
  // Where it ends by itself, s; what follows is another state's.
  virtual double end() const { return never; }
  // Beyond this time bounds from `time` on may be much wider, the end of a step of the integrator,
  // or not known at all yet, the end of a span of a motion by a procedure.
  virtual double step_end(double /*time*/) const { return never; }
  // The origin's path in closed form; null where other things act.
  virtual const Parabola* ballistic() const { return nullptr; }
  // What is integrated by itself ends a step there, and forgets what lies beyond: where everybody
  // is to stand at the same time (kernel/loop/policy.h).
  virtual void halt(double /*time*/) const {}
  // Whether it is computed step by step.
  virtual bool stepped() const { return false; }
  // What would move it if nothing held it: none of what is carried, or moves as it was given.
  virtual Vec3 free_acceleration(double /*time*/) const {
    const Parabola* path = ballistic();
    return path ? path->acceleration : Vec3(Vec3::Zero());
  }
  // Whether a look at it may call a procedure of the user's.
  virtual bool calls_out() const { return false; }
  // ---- of given motions: what hangs on such a body by a joint asks for ----
  // The rates of the twist; at a corner the right ones.
  virtual Twist twist_rates(double /*time*/) const { return {}; }
  // The first time in (from, to] at which the twist jumps, or it fails; `never`: none.
  virtual double next_corner(double /*from*/, double /*to*/) const { return never; }
  // Between two such times.
  virtual MotionRates most_rates(double /*from*/, double /*to*/) const { return {}; }

  // Why it ends, where that is an error; null: it doesn't, or nobody looked so far yet.
  virtual std::exception_ptr failure() const { return nullptr; }
  virtual Effort effort() const { return {}; }

  Frame frame(double time) const { return Frame(pose(time)); }
  virtual Vec3 center(double time) const {
    const Parabola* path = ballistic();
    return path ? path->position(time) : pose(time).p;
  }
  // The pose and its own rates: what `bounds` are about.
  virtual PoseTwist path_at(double time) const { return stepped() ? joined(time) : at(time); }

 protected:
  PoseTwist joined(double time) const {
    const Pose there = pose(time);
    const Twist rates = twist(time);
    return {there.p, there.q, rates.v, rates.w};
  }
};

using TrajectoryPtr = std::shared_ptr<const Trajectory>;

}  // namespace tw
