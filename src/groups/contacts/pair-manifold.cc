// Where two bodies touch.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/pair-manifold.h"

#include "dynamics/contact-scales.h"

namespace tw {

PairManifold pair_manifold(const PairPlace& pair, const PairGround& ground,
                           const std::vector<StandingPlane>& planes, double reach,
                           std::vector<ManifoldPoint>& points) {
  const Body &a = pair.a, &b = pair.b;
  // faces of the ground are exact at seams
  const ReferenceChoice choice = !a.dynamic()   ? ReferenceChoice::of_a
                                 : !b.dynamic() ? ReferenceChoice::of_b
                                                : ReferenceChoice::larger;
  PairManifold found;
  found.distance =
      manifold_at_seams(*a.shape_P, pair.frame_a, ground.around_a, *b.shape_P, pair.frame_b,
                        ground.around_b, reach, lesser_thickness(a, b), points, choice);
  found.left_out = a.dynamic() != b.dynamic() && drop_low_sides(planes, pair, points);
  return found;
}

}  // namespace tw
