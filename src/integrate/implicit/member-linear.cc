// Members of contact groups in the linear systems of a step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/member-linear.h"

#include "integrate/implicit/group-rows.h"

namespace tw {

using namespace rows;

void MemberLinear::set_stage_rate(double by) {
  sigma = by;
  Mat3 stage = -W - 0.5 * cross_matrix(w);
  stage.diagonal().array() += sigma;
  A = stage.inverse();
  P = A * J;
  V = J + W * P;
}

void MemberLinear::eliminate(const double* right, BodyChange& change) const {
  vec(change.x) = (1 / sigma) * vec(right);
  vec(change.th) = A * vec(right + 3);
  vec(change.v).setZero();
  vec(change.w) = W * vec(change.th);
}

void MemberLinear::take(const double* solved, BodyChange& change, double* stage) const {
  const Vec3 kv = vec(solved), kL = vec(solved + 3);
  vec(change.x) += (1 / sigma) * kv;
  vec(change.th) += P * kL;
  vec(change.v) = kv;
  vec(change.w) += V * kL;
  vec(stage) = vec(change.x);
  vec(stage + 3) = vec(change.th);
  vec(stage + 6) = kv;
  vec(stage + 9) = kL;
}

Vec6 change_of(const WrenchDerivative& by, const BodyChange& change) {
  Vec6 pose, twist;
  pose << vec(change.x), vec(change.th);
  twist << vec(change.v), vec(change.w);
  return by.by_pose * pose + by.by_twist * twist;
}

}  // namespace tw
