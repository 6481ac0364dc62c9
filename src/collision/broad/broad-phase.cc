// Moving and standing boxes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/broad/broad-phase.h"

#include "base/constants.h"

namespace tw {

void BroadPhase::place(std::uint32_t id, const Aabb& box, bool stands) {
  if (!stands) {
    moving_.place(id, box);
    // queries of several bodies may go on at once: each writes to its own zone
    if (id >= zones_.size()) zones_.resize(id + 1);
    return;
  }
  standing_.place(id, box);
  ++version_;
}

void BroadPhase::remove(std::uint32_t id) {
  if (moving_.contains(id)) return moving_.remove(id);
  standing_.remove(id);
  ++version_;
}

void BroadPhase::set_zone(Zone& zone, const Aabb& box) const {
  if (holds(zone, box)) return;
  zone.version = version_;
  zone.box = box;
  zone.box.grow(cost::zone_margin * box.size().maxCoeff());
  zone.neighbours.clear();
  standing_.overlapping(zone.box, [&](std::uint32_t other) {
    zone.neighbours.push_back({standing_.box(other), other});
  });
}

}  // namespace tw
