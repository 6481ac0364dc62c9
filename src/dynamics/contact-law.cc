// Constants of the contact law from masses, sizes and gravity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-law.h"

#include <cmath>

#include "base/constants.h"

namespace tw {

ContactConstants contact_constants(const ContactParameters& parameters, double mass, double size,
                                   double gravity, bool unequal) {
  const double g = gravity > 0 ? gravity : answer::standard_gravity;
  const double share = unequal ? answer::unequal_depth_share : answer::depth_share;
  ContactConstants c;

  // k d0 = m g: either may be given
  c.k = parameters.stiffness ? *parameters.stiffness : mass * g / (share * size);
  c.depth = mass * g / c.k;
  c.hardening = (unequal ? answer::unequal_hardening_depths : answer::hardening_depths) * c.depth;

  // k d0 b = 2 zeta m omega with omega^2 = k/m = g/d0
  c.b =
      parameters.damping ? *parameters.damping : 2 * answer::damping_ratio / std::sqrt(g * c.depth);

  c.mu = parameters.friction;
  c.kt = answer::tangential_share * c.k;
  // half of critical
  c.ct = std::sqrt(c.kt * mass);
  c.law = parameters.friction_law;
  return c;
}

}  // namespace tw
