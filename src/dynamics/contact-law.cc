// Constants of the contact law from masses, sizes and gravity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-law.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/never.h"

namespace tw {

ContactConstants contact_constants(const ContactParameters& parameters, double mass, double size,
                                   double gravity, bool unequal) {
  const double g = gravity > 0 ? gravity : answer::standard_gravity;
  const double share = unequal ? answer::unequal_depth_share : answer::depth_share;
  ContactConstants c;
  c.size = size;

  // k d0 = m g: either may be given
  c.k = parameters.stiffness ? *parameters.stiffness : mass * g / (share * size);
  c.depth = mass * g / c.k;
  c.hardening = (unequal ? answer::unequal_hardening_depths : answer::hardening_depths) * c.depth;

  // a made stiffness has its limit at as many static depths
  c.firm = SecondHardening::of(answer::firm_share / share * c.depth, c.depth);

  // k d0 b = 2 zeta m omega with omega^2 = k/m = g/d0
  c.b =
      parameters.damping ? *parameters.damping : 2 * answer::damping_ratio / std::sqrt(g * c.depth);

  c.mu = parameters.friction;
  c.kt = answer::tangential_share * c.k;
  // half of critical
  c.ct = std::sqrt(c.kt * mass);
  c.law = parameters.friction_law;
  c.rolling = parameters.rolling_friction;
  c.spinning = parameters.spinning_friction;
  return c;
}

namespace {

// k(d)/k without the second hardening
double first_hardness(const ContactConstants& law, double depth) {
  if (!(depth > 0 && law.hardening > 0)) return 1;
  const double ratio = depth / law.hardening;
  return 1 + std::min(ratio * ratio, answer::hardening_cap);
}

// k(d)/k
double hardness(const ContactConstants& law, double depth) {
  return first_hardness(law, depth) + law.firm.hardness(depth);
}

}  // namespace

double spring_force(const ContactConstants& law, double share, double depth) {
  return depth > 0 ? share * law.k * depth * hardness(law, depth) : 0;
}

double friction_grip(const ContactConstants& law, double depth) {
  if (!(depth > 0)) return 1;
  return std::sqrt(first_hardness(law, depth) + law.firm.grip(depth));
}

double spring_energy(const ContactConstants& law, double share, double depth) {
  if (!(depth > 0)) return 0;
  const double ratio = law.hardening > 0 ? depth / law.hardening : 0, squared = ratio * ratio;
  constexpr double cap = answer::hardening_cap;
  const double hard = squared < cap ? 0.5 * squared : cap - 0.5 * cap * cap / squared;
  const double first = 0.5 * share * law.k * depth * depth * (1 + hard);
  return first + share * law.k * law.firm.energy(depth);
}

namespace {

// Where the second hardening has no part: the root of y + y^3 = x by Newton's method, from above;
// beyond the cap the law is linear.
double soft_depth(const ContactConstants& law, double linear) {
  const double x = linear / law.hardening;
  constexpr double cap = answer::hardening_cap;
  if (x * x >= cap * (1 + cap) * (1 + cap)) return linear / (1 + cap);
  double y = std::min(x, std::cbrt(x));
  for (double last = never; y < last;) {
    last = y;
    y -= (y + y * y * y - x) / (1 + 3 * y * y);
  }
  return y * law.hardening;
}

}  // namespace

double spring_depth(const ContactConstants& law, double share, double force) {
  if (!(force > 0)) return 0;
  const double linear = force / (share * law.k);
  if (!(law.hardening > 0)) return linear;
  const double soft = soft_depth(law, linear);
  if (law.firm.part(soft) == 0) return soft;
  // the force is convex up to the limit, and linear from there on: Newton's method from above
  const double limit = law.firm.limit;
  if (force >= spring_force(law, share, limit)) return linear / hardness(law, limit);
  double depth = std::min(soft, limit);
  for (double last = never; depth < last;) {
    last = depth;
    const double h = hardness(law, depth);
    depth -= (depth * h - linear) / (h + depth * law.firm.slope(depth));
  }
  return depth;
}

}  // namespace tw
