// The second hardening of what presses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/second-hardening.h"

#include <algorithm>

#include "base/constants.h"

namespace tw {
namespace {

constexpr double from = answer::firm_from, rest = 1 - from;

}  // namespace

SecondHardening SecondHardening::of(double limit, double sag) {
  return {limit, answer::firm_weights * sag / limit};
}

double SecondHardening::part(double depth) const {
  if (!(firmness > 0 && depth > from * limit)) return 0;
  return (std::min(depth / limit, 1.0) - from) / rest;
}

double SecondHardening::hardness(double depth) const {
  const double s = part(depth);
  return firmness * s * s * s * s;
}

double SecondHardening::slope(double depth) const { return depth > limit ? 0 : slope_there(depth); }

double SecondHardening::grip(double depth) const {
  return hardness(depth) + std::min(depth, limit) * slope_there(depth);
}

double SecondHardening::slope_there(double depth) const {
  const double s = part(depth);
  return s > 0 ? 4 * firmness * s * s * s / (rest * limit) : 0;
}

// dl^2 rest s^5 (from/5 + rest s/6), beyond the limit d^2/2 more
double SecondHardening::energy(double depth) const {
  const double s = part(depth);
  if (s == 0) return 0;
  const double beyond = std::max(0.0, depth * depth - limit * limit);
  const double within = rest * s * s * s * s * s * (from / 5 + rest / 6 * s);
  return firmness * (0.5 * beyond + limit * limit * within);
}

}  // namespace tw
