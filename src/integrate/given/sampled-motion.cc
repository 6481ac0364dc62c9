// The motion of a kinematic body by a procedure of time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/sampled-motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/constants.h"
#include "base/error.h"

namespace tw {
namespace {

std::int64_t number_of(double time) {
  return static_cast<std::int64_t>(std::floor(time / answer::motion_span));
}

double start_of(std::int64_t number) { return static_cast<double>(number) * answer::motion_span; }

}  // namespace

SampledMotion::SampledMotion(std::unique_ptr<const MotionProcedure> procedure)
    : procedure_(std::move(procedure)) {}

const MotionSpan& SampledMotion::span(std::int64_t number) const {
  if (last_ && number == last_number_) return *last_;
  auto known = spans_.find(number);
  if (known == spans_.end()) {
    MotionSpan sampled = sample_span(*procedure_, start_of(number), start_of(number + 1));
    pieces_ += sampled.pieces.size();
    known = spans_.emplace(number, std::move(sampled)).first;
    while (pieces_ > cost::kept_motion_pieces && spans_.size() > 1) {
      const auto earliest = spans_.begin() == known ? std::next(known) : spans_.begin();
      pieces_ -= earliest->second.pieces.size();
      spans_.erase(earliest);
    }
  }
  last_number_ = number;
  last_ = &known->second;
  return *last_;
}

const MotionSpan& SampledMotion::span_at(double time) const { return span(number_of(time)); }

Pose SampledMotion::pose(double time) const { return span_at(time).piece_at(time).pose(time); }

Twist SampledMotion::twist(double time) const { return span_at(time).piece_at(time).twist(time); }

PoseTwist SampledMotion::at(double time) const { return span_at(time).piece_at(time).at(time); }

Twist SampledMotion::twist_rates(double time) const {
  return span_at(time).piece_at(time).twist_rates(time);
}

template <class Visit>
void SampledMotion::visit_pieces(double from, double to, Visit&& visit) const {
  for (double known = from; known <= to;) {
    const MotionSpan& here = span_at(known);
    if (here.failure && !(known < here.end)) return;
    const MotionPiece& piece = here.piece_at(known);
    if (visit(piece)) return;
    known = piece.end();
  }
}

MotionRates SampledMotion::most_rates(double from, double to) const {
  MotionRates most;
  visit_pieces(from, to, [&](const MotionPiece& piece) {
    piece.add_rates(from, to, most);
    return false;
  });
  return most;
}

double SampledMotion::next_corner(double from, double to) const {
  const auto jumps = [](const Vec3& before, const Vec3& after) {
    const double most = std::max(before.norm(), after.norm());
    return (after - before).norm() > answer::motion_jump * most;
  };
  double corner = never, reached = from;
  std::optional<Twist> before;
  visit_pieces(from, to, [&](const MotionPiece& piece) {
    const Twist begin = piece.twist(piece.start());
    if (before && (jumps(before->v, begin.v) || jumps(before->w, begin.w))) {
      corner = piece.start();
      return true;
    }
    before = piece.twist(piece.end());
    reached = piece.end();
    return false;
  });
  const bool fails = corner == never && from < reached && reached <= to;
  return fails ? reached : corner;
}

double SampledMotion::step_end(double time) const {
  const MotionSpan& here = span_at(time);
  here.piece_at(time);
  return here.end;
}

MotionBounds SampledMotion::bounds(double from, double to) const {
  if (!std::isfinite(from) || !std::isfinite(to)) return MotionBounds::unknown();
  MotionBounds bounds;
  const MotionPiece& first = span_at(from).piece_at(from);
  first.add_speeds(from, std::max(from, to), bounds);
  first.add_changes(from, std::max(from, to), bounds);
  double known = first.end();
  bounds.valid_until = std::min(to, known);
  while (known < to) {
    const MotionSpan& here = span_at(known);
    if (here.failure && !(known < here.end)) break;
    const MotionPiece& piece = here.piece_at(known);
    piece.add_speeds(known, to, bounds);
    known = piece.end();
  }
  return bounds;
}

}  // namespace tw
