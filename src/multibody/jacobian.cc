// The geometric Jacobian of a link.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/jacobian.h"

#include <algorithm>

namespace tw::multibody {

void link_jacobian(const Tree& tree, const Kinematics& k, int link, Out J) {
  std::fill(J.begin(), J.end(), 0.0);
  const Vec3 r = link_frame(tree, k, link).p - k.origin;
  for (int d = tree.last_dof(tree.link(link).node); d >= 0; d = tree.dof_parent(d)) {
    const Motion& S = k.axis(d);
    double* const column = &J[6 * static_cast<std::size_t>(d)];
    set_vector(column, S.v + S.w.cross(r));
    set_vector(column + 3, S.w);
  }
}

}  // namespace tw::multibody
