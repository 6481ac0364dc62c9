// A span of a given motion: sampled once, kept as pieces.
//
// A piece is halved until the samples that were not used to fit it agree with it: what is smooth is
// one piece of 17 samples, a kink is closed in on by halving, to a piece so short that a straight
// line misses the motion there by no more than its greatest speed times that length.  Which pieces
// come out is a function of the procedure and the span alone.
//
// Where the procedure fails, or is faster than it may be, the span ends: before the first double at
// which it fails (or before the shortest piece that is too fast), and the error is kept for whoever
// asks for that time or a later one of the span.
//
// Cost: 17 calls for a smooth span; a kink about 500 calls more, a jump of the acceleration 300.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "integrate/given/motion-piece.h"

namespace tw {

// A motion given as a pure function of time.
class MotionProcedure {
 public:
  virtual ~MotionProcedure() = default;
  // What messages call it.
  virtual std::string name() const = 0;
  // UserError where the procedure fails.
  virtual Pose pose(double time) const = 0;
  // UserError if the body was faster than it may be from one pose to another, s.
  virtual void require_speed(double from, const Pose& before, double to,
                             const Pose& after) const = 0;
  virtual double max_speed() const = 0;  // of any point of the body, m/s
  virtual double size() const = 0;       // the body's least width, m
  virtual double radius() const = 0;     // of the body about its origin, m
};

struct MotionSpan {
  std::vector<MotionPiece> pieces;  // one after the other from the span's start
  double end = 0;                   // s: of the last piece
  std::exception_ptr failure;       // what is raised from `end` on; null: the next span follows

  // The piece with start <= time < end; raises the failure.
  const MotionPiece& piece_at(double time) const;
};

// Errors: those of the procedure that are no UserError (an interrupt).
MotionSpan sample_span(const MotionProcedure& procedure, double start, double end);

}  // namespace tw
