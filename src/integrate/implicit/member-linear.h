// A member of a contact group in the linear systems of a step: what of its 12 numbers is eliminated
// (group-system.h).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/pose-twist.h"
#include "dynamics/wrench.h"
#include "integrate/implicit/contact-linear.h"

namespace tw {

struct MemberLinear {
  // at the step's start
  Mat3 J, W;
  Vec3 w;
  // what else acts on it, and what the member did there; set where something does
  WrenchDerivative forced;
  PoseTwist point;
  // by the step: A, P = A J and V = J + W P
  double sigma;  // 1/s
  Mat3 A, P, V;

  void set_stage_rate(double sigma);
  // What the right side of its positions says of its changes.
  void eliminate(const double* right, BodyChange& change) const;
  // What velocity and momentum were solved for, into the changes and the stage.
  void take(const double* solved, BodyChange& change, double* stage) const;
};

// Of a wrench by the change of a body.
Vec6 change_of(const WrenchDerivative& by, const BodyChange& change);

}  // namespace tw
