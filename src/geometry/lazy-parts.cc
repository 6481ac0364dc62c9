// Parts that are made when they are first asked for.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/lazy-parts.h"

#include <utility>

#include "geometry/polyhedron.h"

namespace tw {

LazyParts::LazyParts(std::size_t count) : parts_(count) {}

LazyParts::~LazyParts() {
  for (const auto& part : parts_) delete part.load();
}

void LazyParts::set_boxes(std::span<const Aabb> boxes) {
  tree_ = std::make_unique<const PartTree>(boxes);
}

const ConvexPart& LazyParts::part(std::size_t number) const {
  std::atomic<const ConvexPart*>& place = parts_[number];
  const ConvexPart* found = place.load(std::memory_order_acquire);
  if (found) return *found;
  auto fresh = std::make_unique<const ConvexPart>(make_part(number));
  // who comes second takes what the first one made
  if (place.compare_exchange_strong(found, fresh.get(), std::memory_order_acq_rel))
    return *fresh.release();
  return *found;
}

ConvexPart part_about(const Vec3& middle, std::shared_ptr<const Polyhedron> core) {
  ConvexPart part;
  part.kind = PartKind::polyhedron;
  part.place({Mat3::Identity(), middle});
  part.bound_center = middle + core->center();
  part.bound_radius = core->radius();
  part.core = std::move(core);
  return part;
}

}  // namespace tw
