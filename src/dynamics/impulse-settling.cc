// What many impulses leave over, at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "dynamics/impulse-solver.h"
#include "math/nonnegative.h"

namespace tw {
namespace {

// Of velocities times the roots of masses: light bodies between heavy ones are seen to this share
// of the heavy ones'.
constexpr double rounding = 1e-12;

}  // namespace

// Whether what is held at these contacts moves as one rigid body, to within `differ`, m/s: else no
// velocities may exist at which nothing approaches, or only such that squirt out between two walls.
bool ImpulseSolver::held_as_one(std::span<const ImpulseContact* const> contacts,
                                double differ) const {
  const ImpulseSlot* first = nullptr;
  for (const ImpulseContact* c : contacts)
    for (const std::uint32_t index : {c->a, c->b}) {
      const ImpulseSlot& slot = slots_[index];
      if (slot.moves()) continue;
      if (!first) first = &slot;
      if ((slot.velocity_at(c->point) - first->velocity_at(c->point)).norm() > differ) return false;
    }
  return true;
}

ImpulseResult ImpulseSolver::settle(std::span<const ImpulseContact> contacts) {
  std::vector<const ImpulseContact*> used;
  for (const ImpulseContact& c : contacts)
    if (std::isfinite(c.bears) && !reaches_border(c) &&
        (slots_[c.a].moves() || slots_[c.b].moves()))
      used.push_back(&c);
  const Excess before = worst(contacts, 0);
  if (used.empty() || used.size() > guard::most_settled || !before.contact ||
      !held_as_one(used, answer::settled_share * before.speed))
    return {0, before.speed};

  // A by unit impulses on bodies at rest, scaled to a diagonal of 1
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd A(n, n);
  Eigen::VectorXd q(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    ImpulseSolver probe = *this;
    for (ImpulseSlot& slot : probe.slots_) slot.v = slot.w = Vec3::Zero();
    const ImpulseContact& struck = *used[static_cast<std::size_t>(j)];
    probe.apply(struck.a, -struck.normal, struck.point);
    probe.apply(struck.b, struck.normal, struck.point);
    for (Eigen::Index i = 0; i < n; ++i)
      A(i, j) = probe.approach(*used[static_cast<std::size_t>(i)]);
    q[j] = approach(struck) + struck.bears;
  }
  const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::VectorXd sides = scale.cwiseProduct(q);
  const double tolerance = rounding * sides.cwiseAbs().maxCoeff();

  ImpulseResult result;
  if (const auto x = solve_nonnegative(scaled, sides, tolerance))
    for (Eigen::Index i = 0; i < n; ++i) {
      const double along = scale[i] * (*x)[i];
      if (!(along > 0)) continue;
      const ImpulseContact& c = *used[static_cast<std::size_t>(i)];
      exchange(c, along * c.normal);
      ++result.impulses;
    }
  // rounding is not left over
  const Excess left = worst(contacts, answer::settled_share * before.speed);
  if (!left.contact) return result;
  result.left_over = left.speed;
  if (reaches_border(*left.contact)) result.stopped_at = left.contact;
  return result;
}

}  // namespace tw
