// What passes through the joints of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/joint-forces.h"

#include "multibody/inverse-dynamics.h"

namespace tw::multibody {

std::vector<Force> joint_forces(const Tree& tree, const Kinematics& k,
                                std::span<const Motion> accelerations,
                                std::span<const Force> wrenches) {
  std::vector<Force> through(wrenches.size());
  // what hangs on a link comes after it
  for (int i = tree.link_count(); i-- > 0;) {
    const Link& link = tree.link(i);
    const auto at = static_cast<std::size_t>(i);
    // the link as a body of its own that moves with its node
    NodeMotion body = k.node(link.node);
    const Frame frame = link_frame(tree, k, i);
    body.center = frame * link.center_of_mass - k.origin;
    body.moments = turned(frame.R, Sym3::of(link.inertia));
    body.W = wrenches[at];
    const Motion A = body.A + accelerations[static_cast<std::size_t>(link.node)];
    through[at] += net_force(link.mass, body, A);
    if (link.parent >= 0) through[static_cast<std::size_t>(link.parent)] += through[at];
  }
  return through;
}

}  // namespace tw::multibody
