// Constants of the contact law from masses, sizes and gravity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-law.h"

#include <cmath>

namespace tw {

namespace {

// static depth over size, and depth of doubled stiffness over static depth: columns of 20 stand
constexpr double depth_share = 2.5e-4, hardening_depths = 2;
// the same in groups of unequal masses: 1000 : 1 stands on nine cubes
constexpr double unequal_depth_share = 0.2 * depth_share, unequal_hardening_depths = 1;
// of the small oscillation about d0; 0.3-0.7 serve
constexpr double damping_ratio = 0.5;
constexpr double tangential_share = 0.8;
constexpr double standard_gravity = 9.81;

}  // namespace

ContactConstants contact_constants(const ContactParameters& parameters, double mass, double size,
                                   double gravity, bool unequal) {
  const double g = gravity > 0 ? gravity : standard_gravity;
  const double share = unequal ? unequal_depth_share : depth_share;
  ContactConstants c;

  // k d0 = m g: either may be given
  c.k = parameters.stiffness ? *parameters.stiffness : mass * g / (share * size);
  c.depth = mass * g / c.k;
  c.hardening = (unequal ? unequal_hardening_depths : hardening_depths) * c.depth;

  // k d0 b = 2 zeta m omega with omega^2 = k/m = g/d0
  c.b = parameters.damping ? *parameters.damping : 2 * damping_ratio / std::sqrt(g * c.depth);

  c.mu = parameters.friction;
  c.kt = tangential_share * c.k;
  // half of critical
  c.ct = std::sqrt(c.kt * mass);
  c.law = parameters.friction_law;
  return c;
}

}  // namespace tw
