// The motion of a kinematic body by a procedure of time: sampled, never asked twice.
//
// Poses, velocities and bounds are those of one curve (motion-span.h), which is a function of the
// procedure and of a grid of absolute times: the same bits whoever asks first, and in whatever
// order.  What the kernel asks for never calls the procedure again for a span that is known.
//
// Cost: a look-up of some tens of nanoseconds, and the pieces' polynomials.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "integrate/given/motion-span.h"

namespace tw {

class SampledMotion : public Trajectory {
 public:
  explicit SampledMotion(std::unique_ptr<const MotionProcedure> procedure);

  Pose pose(double time) const override;
  Twist twist(double time) const override;
  PoseTwist at(double time) const override;
  // Acceleration and change of turning: those of the piece at `from`, and so valid to its end.
  // Where the motion fails before `to`, of what comes before.
  MotionBounds bounds(double from, double to) const override;
  Twist twist_rates(double time) const override;
  // Jumps that are more than how well pieces are fitted.
  double next_corner(double from, double to) const override;
  MotionRates most_rates(double from, double to) const override;
  // The end of the span, or where the motion fails: nothing is sampled beyond.
  double step_end(double time) const override;
  bool calls_out() const override { return true; }

 private:
  const MotionSpan& span_at(double time) const;
  // Visits the pieces that meet [from, to], as far as the motion does not fail, until visit(piece)
  // is true.
  template <class Visit>
  void visit_pieces(double from, double to, Visit&& visit) const;
  const MotionSpan& span(std::int64_t number) const;

  std::unique_ptr<const MotionProcedure> procedure_;
  // by number; pieces in all of them
  mutable std::map<std::int64_t, MotionSpan> spans_;
  mutable std::size_t pieces_ = 0;
  mutable std::int64_t last_number_ = 0;
  mutable const MotionSpan* last_ = nullptr;
};

}  // namespace tw
