// A span of a given motion.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/motion-span.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "base/error.h"
#include "math/rotation-vector.h"

namespace tw {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// How well a piece follows its samples, in the errors that are allowed.
struct Quality {
  double error = never;
  int stubborn = 0;  // so many halvings in a row did not halve the error
  // it is smooth, and from here on faster than it may be, s
  double too_fast_from = never;
  std::exception_ptr too_fast;
};

class Sampler {
 public:
  Sampler(const MotionProcedure& procedure, double start, double end)
      : procedure_(procedure), width_(procedure.size()) {
    span_.end = end;
    const double latest = std::max(std::abs(start), std::abs(end));
    shortest_ = std::max(answer::shortest_motion_piece,
                         answer::shortest_motion_spacings * epsilon * latest);
    // what the rounding of the time itself does counts as noise
    noise_ = answer::motion_noise * width_ + 4 * epsilon * latest * procedure.max_speed();
    follow(start, end, {});
  }
  MotionSpan take() { return std::move(span_); }

 private:
  // Appends the pieces of [a, b]; false: the span ends in it.
  bool follow(double a, double b, const Quality& above) {
    if (bad_ <= a) return fail(a, failure_);
    Quality quality;
    if (bad_ > b && fits(a, b, above, quality)) return true;
    // shorter pieces would pass by the rounding that is allowed for
    if (quality.too_fast)
      return (quality.too_fast_from <= a || follow(a, quality.too_fast_from, {})) &&
             fail(quality.too_fast_from, quality.too_fast);
    if (span_.pieces.size() >= guard::most_motion_pieces)
      return fail(a, std::make_exception_ptr(UserError(
                         procedure_.name() + " is so rough between " + show(a) + " s and " +
                         show(b) + " s that it cannot be followed; expected a motion that is " +
                         "smooth but for some corners")));
    if (b - a <= shortest_) return close_in(a, b);
    const double middle = 0.5 * (a + b);
    return follow(a, middle, quality) && follow(middle, b, quality);
  }

  // Each error that is raised may take long to describe: beyond one nobody asks again.
  Pose pose_at(double time) {
    try {
      return procedure_.pose(time);
    } catch (const UserError&) {
      bad_ = time;
      failure_ = std::current_exception();
      throw;
    }
  }

  // Appends one piece if its samples can be had, agree with it, and are slow enough.
  bool fits(double a, double b, const Quality& above, Quality& quality) {
    try {
      return try_to_fit(a, b, above, quality);
    } catch (const UserError&) {
      return false;
    }
  }

  bool try_to_fit(double a, double b, const Quality& above, Quality& quality) {
    std::array<Pose, motion_nodes> poses;
    const auto sample = [&](int j) {
      poses[static_cast<std::size_t>(j)] = pose_at(motion_node_time(j, a, b));
    };
    for (int j = 0; j < motion_nodes; j += 2) sample(j);
    const Quat& middle = poses[motion_nodes / 2].q;
    for (int j = 0; j < motion_nodes; j += 2)
      if (turn_between(middle, poses[static_cast<std::size_t>(j)].q).norm() > answer::motion_turn)
        return false;

    const double largest = poses[motion_nodes / 2].p.cwiseAbs().maxCoeff();
    const double allowed = answer::motion_error * width_ + 16 * epsilon * (largest + width_);
    const double noise = std::max(1.0, noise_ / allowed);
    const MotionPiece finest(a, b, poses, most_motion_degree);
    double error = 0;
    for (int j = 1; j < motion_nodes; j += 2) {
      sample(j);
      error = std::max(
          error,
          miss(finest, poses[static_cast<std::size_t>(j)], motion_node_time(j, a, b)) / allowed);
      if (!(error <= noise)) return false;
    }
    quality.error = error;
    quality.stubborn = error > 0.5 * above.error ? above.stubborn + 1 : 0;
    if (error > 1 && quality.stubborn < 2) return false;

    for (std::size_t j = 0; j + 1 < motion_nodes; ++j) {
      const int node = static_cast<int>(j);
      const double from = motion_node_time(node, a, b);
      try {
        procedure_.require_speed(from, poses[j], motion_node_time(node + 1, a, b), poses[j + 1]);
      } catch (const UserError&) {
        quality.too_fast_from = from;
        quality.too_fast = std::current_exception();
        return false;
      }
    }
    for (const int degree : {2, 4}) {
      const MotionPiece simpler(a, b, poses, degree);
      if (!agrees(simpler, poses, allowed)) continue;
      span_.pieces.push_back(simpler);
      return true;
    }
    span_.pieces.push_back(finest);
    return true;
  }

  // How far any point of the body is from where the pose has it, m.
  double miss(const MotionPiece& piece, const Pose& pose, double time) const {
    const Pose there = piece.pose(time);
    return (there.p - pose.p).norm() + turn_between(pose.q, there.q).norm() * procedure_.radius();
  }
  bool agrees(const MotionPiece& piece, const std::array<Pose, motion_nodes>& poses,
              double allowed) const {
    for (int j = 0; j < motion_nodes; ++j) {
      const double time = motion_node_time(j, piece.start(), piece.end());
      if (!(miss(piece, poses[static_cast<std::size_t>(j)], time) <= allowed)) return false;
    }
    return true;
  }

  // The shortest piece: what is in it is a kink, or where the motion fails.
  bool close_in(double a, double b) {
    Pose first, last;
    try {
      first = pose_at(a);
      if (bad_ > b) last = pose_at(b);
    } catch (const UserError&) {
      if (bad_ <= a) return fail(a, failure_);
    }
    if (bad_ <= b) return fail_between(a, first);
    try {
      procedure_.require_speed(a, first, b, last);
    } catch (const UserError&) {
      return fail(a, std::current_exception());
    }
    span_.pieces.emplace_back(a, b, first, last);
    return true;
  }

  // The procedure succeeds at a and fails soon after: up to the first double at which it fails.
  bool fail_between(double a, const Pose& first) {
    double good = a;
    Pose last = first;
    for (;;) {
      const double middle = good + 0.5 * (bad_ - good);
      if (!(good < middle && middle < bad_)) break;
      try {
        last = pose_at(middle);
        good = middle;
      } catch (const UserError&) {
      }
    }
    // a difference over a few spacings of times would be rounding
    const bool measurable = good - a > 0x1p-10 * shortest_;
    span_.pieces.emplace_back(a, bad_, first, measurable ? last : first);
    return fail(bad_, failure_);
  }

  bool fail(double when, std::exception_ptr failure) {
    span_.end = when;
    span_.failure = std::move(failure);
    return false;
  }

  const MotionProcedure& procedure_;
  double width_, shortest_ = 0, noise_ = 0;
  double bad_ = never;  // the earliest time known at which the procedure fails, and how
  std::exception_ptr failure_;
  MotionSpan span_;
};

}  // namespace

const MotionPiece& MotionSpan::piece_at(double time) const {
  if (failure && !(time < end)) std::rethrow_exception(failure);
  const auto next =
      std::upper_bound(pieces.begin(), pieces.end(), time,
                       [](double t, const MotionPiece& piece) { return t < piece.end(); });
  TW_ASSERT(next != pieces.end() && next->start() <= time,
            "a span of a motion that ends at " + show(end) + " s was asked for " + show(time));
  return *next;
}

MotionSpan sample_span(const MotionProcedure& procedure, double start, double end) {
  return Sampler(procedure, start, end).take();
}

}  // namespace tw
