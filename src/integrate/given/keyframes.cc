// Keyframes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/keyframes.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/limits.h"
#include "math/rotation-vector.h"

namespace tw {
namespace {

// Minimum-jerk timing s(u) and its slope, u in [0, 1].
double smooth_share(double u) { return u * u * u * (10 + u * (6 * u - 15)); }
double smooth_slope(double u) { return 30 * u * u * (1 - u) * (1 - u); }
double smooth_change(double u) { return 60 * u * (1 - u) * (1 - 2 * u); }
constexpr double smooth_peak_slope = 1.875;                  // s'(1/2)
constexpr double smooth_peak_change = 5.773502691896258;     // s'' at (1 - 1/sqrt 3)/2
constexpr double smooth_least_change = 0.21132486540518713;  // and the other side of 1/2: s''' = 0
constexpr double smooth_peak_third = 60;                     // s'''(0)

// Straight line and constant axis from one keyframe to the next.
struct Segment {
  double start = 0, end = 0;
  Vec3 p0, p1;
  Quat q0;
  Vec3 turn;  // rotation vector that takes q0 to the next orientation, world axes

  double length() const { return end - start; }
};

class Keyframes final : public Trajectory {
 public:
  Keyframes(std::vector<Segment> segments, Pose first, Pose last, bool smooth)
      : segments_(std::move(segments)),
        first_(std::move(first)),
        last_(std::move(last)),
        smooth_(smooth) {}

  Pose pose(double time) const override {
    const Segment* s = segment_at(time);
    if (!s) return before(time) ? first_ : last_;
    const double share = share_at(*s, time);
    return {s->p0 + share * (s->p1 - s->p0), rotation_by(share * s->turn) * s->q0};
  }

  Twist twist(double time) const override {
    const Segment* s = segment_at(time);
    if (!s) return {};
    const double rate = slope_at(*s, time) / s->length();
    return {rate * (s->p1 - s->p0), rate * s->turn};
  }

  Twist twist_rates(double time) const override {
    const Segment* s = segment_at(time);
    if (!s || !smooth_) return {};
    const double rate =
        smooth_change((time - s->start) / s->length()) / (s->length() * s->length());
    return {rate * (s->p1 - s->p0), rate * s->turn};
  }

  double next_corner(double from, double to) const override {
    if (smooth_) return never;
    for (const Segment& s : segments_)
      for (const double time : {s.start, s.end})
        if (time > from) return time <= to ? time : never;
    return never;
  }

  MotionRates most_rates(double from, double to) const override {
    MotionRates most;
    for (const Segment& s : segments_) {
      if (!(s.end >= from && s.start <= to)) continue;
      const double way = (s.p1 - s.p0).norm(), turn = s.turn.norm(), rate = 1 / s.length();
      const auto raise = [&](double& turning, double& moving, double share) {
        turning = std::max(turning, share * turn);
        moving = std::max(moving, share * way);
      };
      raise(most.turn, most.speed, (smooth_ ? smooth_peak_slope : 1) * rate);
      if (!smooth_) continue;
      raise(most.turn_change, most.acceleration, smooth_peak_change * rate * rate);
      raise(most.turn_jerk, most.jerk, smooth_peak_third * rate * rate * rate);
    }
    return most;
  }

  MotionBounds bounds(double from, double to) const override {
    MotionBounds bounds;
    bounds.path = path(from, to);
    bounds.speed = most(from, to, [](const Segment& s) { return (s.p1 - s.p0).norm(); });
    bounds.turn = most(from, to, [](const Segment& s) { return s.turn.norm(); });
    add_changes(from, to, bounds);
    return bounds;
  }

 private:
  bool before(double time) const { return segments_.empty() || time < segments_.front().start; }

  // The segment with start <= time < end; null where the body rests.
  const Segment* segment_at(double time) const {
    const auto next = std::upper_bound(segments_.begin(), segments_.end(), time,
                                       [](double t, const Segment& s) { return t < s.end; });
    return next != segments_.end() && time >= next->start ? &*next : nullptr;
  }
  double share_at(const Segment& s, double time) const {
    const double u = (time - s.start) / s.length();
    return smooth_ ? smooth_share(u) : u;
  }
  double slope_at(const Segment& s, double time) const {
    return smooth_ ? smooth_slope((time - s.start) / s.length()) : 1;
  }
  Aabb path(double from, double to) const {
    // every coordinate is monotone within a segment
    Aabb box;
    box.add(pose(from).p);
    box.add(pose(to).p);
    for (const Segment& s : segments_)
      if (s.end > from && s.start < to) {
        if (s.start > from) box.add(s.p0);
        if (s.end < to) box.add(s.p1);
      }
    return box;
  }
  // As far as the velocity does not jump.
  void add_changes(double from, double to, MotionBounds& bounds) const {
    const auto next = std::upper_bound(segments_.begin(), segments_.end(), from,
                                       [](double t, const Segment& s) { return t < s.end; });
    bounds.acceleration.add(Vec3(Vec3::Zero()));
    if (next == segments_.end() || from < next->start) {
      bounds.valid_until = next == segments_.end() ? to : std::min(to, next->start);
      return;
    }
    const Segment& s = *next;
    bounds.valid_until = std::min(to, s.end);
    if (!smooth_) return;
    const double rate = 1 / s.length(), square = rate * rate * (1 + 1e-12);
    const double first = (from - s.start) * rate, last = (bounds.valid_until - s.start) * rate;
    for (const double u : {first, last, smooth_least_change, 1 - smooth_least_change}) {
      if (u < first || u > last) continue;
      const double change = square * smooth_change(u);
      bounds.acceleration.add(Vec3(change * (s.p1 - s.p0)));
      bounds.turn_change = std::max(bounds.turn_change, std::abs(change) * s.turn.norm());
    }
  }
  template <class Length>
  double most(double from, double to, Length length) const {
    double speed = 0;
    for (const Segment& s : segments_)
      if (s.end >= from && s.start <= to) speed = std::max(speed, length(s) / s.length());
    return speed * (smooth_ ? smooth_peak_slope : 1) * (1 + 1e-12);
  }

  std::vector<Segment> segments_;
  Pose first_, last_;
  bool smooth_;
};

Quat unit_orientation(const Quat& q, const std::string& where) {
  TW_REQUIRE(
      is_finite(q) && q.squaredNorm() > 0,
      "orientation of " + where + " is zero or not finite; expected a quaternion #(w x y z)");
  return q.normalized();
}

// A smooth motion is up to twice as fast as its mean.
void require_speed(const Segment& s, std::size_t i) {
  const double speed = 2 * (s.p1 - s.p0).norm() / s.length();
  const double angular_speed = 2 * s.turn.norm() / s.length();
  TW_REQUIRE(speed <= speed_limit && angular_speed <= greatest_angular_speed,
             "keyframes " + std::to_string(i) + " and " + std::to_string(i + 1) + " are " +
                 show(s.length()) + " s apart; expected a motion of at most " +
                 show(0.5 * speed_limit) + " m/s and " + show(0.5 * greatest_angular_speed) +
                 " rad/s");
}

}  // namespace

TrajectoryPtr make_keyframes(std::vector<Keyframe> keyframes, bool smooth) {
  TW_REQUIRE(!keyframes.empty(), "keyframes: the list is empty; expected at least one keyframe");

  // poses with every orientation filled in
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Keyframe& k = keyframes[i];
    const std::string where = "keyframe " + std::to_string(i);
    TW_REQUIRE(std::isfinite(k.time), "time of " + where + " is " + show(k.time) +
                                          "; expected a finite number of seconds");
    TW_REQUIRE(std::abs(k.time) <= greatest_time, "time of " + where + " is " + show(k.time) +
                                                      " s; expected at most " +
                                                      show(greatest_time) + " s");
    TW_REQUIRE(i == 0 || k.time > keyframes[i - 1].time,
               "time of " + where + " is " + show(k.time) +
                   "; expected a time after that of the "
                   "keyframe before it (" +
                   show(keyframes[i == 0 ? 0 : i - 1].time) + ")");
    TW_REQUIRE(is_finite(k.position), "position of " + where + " is not finite");
    TW_REQUIRE(k.position.cwiseAbs().maxCoeff() <= farthest,
               "position of " + where + " has a coordinate of " +
                   show(k.position.cwiseAbs().maxCoeff()) + " m; expected at most " +
                   show(farthest) + " m");
    Quat q = Quat::Identity();
    if (i > 0) q = poses.back().q;
    if (k.orientation) q = unit_orientation(*k.orientation, where);
    poses.push_back({k.position, q});
  }

  std::vector<Segment> segments;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    segments.push_back({keyframes[i].time, keyframes[i + 1].time, poses[i].p, poses[i + 1].p,
                        poses[i].q, turn_between(poses[i].q, poses[i + 1].q)});
    require_speed(segments.back(), i);
  }
  return std::make_shared<Keyframes>(std::move(segments), poses.front(), poses.back(), smooth);
}

}  // namespace tw
