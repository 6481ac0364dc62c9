// Who is near a body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/surroundings.h"

#include "base/constants.h"
#include "collision/broad/near-parts.h"
#include "collision/seams/seams.h"
#include "integrate/trajectory.h"

#include <algorithm>

namespace tw {

namespace {

// Whether a fixed half-space, or a union with one, holds some of the box.
bool reaches(const Body& unbounded, const Aabb& box) {
  const Frame frame(unbounded.motion->pose(0));
  const Vec3 center = 0.5 * (box.lo + box.hi), half = 0.5 * box.size();
  const auto& parts = unbounded.shape_P->parts();
  return std::any_of(parts.begin(), parts.end(), [&](const ConvexPart& part) {
    if (part.kind != PartKind::half_space) return true;
    const Vec3 normal = frame.R * part.normal;
    return normal.dot(center - frame.p) - part.offset <= normal.cwiseAbs().dot(half);
  });
}

}  // namespace

NearGround Surroundings::ground_around(const Body& moving,
                                       std::initializer_list<Frame> frames) const {
  NearGround ground;
  if (moving.unbounded) return ground;
  ground.bodies.reserve(8);
  Aabb& place = ground.place;
  for (const Frame& frame : frames) place.add(moving.shape_P->bounds(frame));
  place.grow(std::max(answer::contact_margin, seam::sunk) * moving.least_width);
  const auto add = [&](BodyId id) {
    if (scene_.may_collide(moving, scene_.body(id))) ground.bodies.push_back(id);
  };
  grid_.standing_in(place, moving.id(), add);
  for (const BodyId id : unbounded_)
    if (scene_.body(id).fixed() && reaches(scene_.body(id), place)) add(id);
  std::sort(ground.bodies.begin(), ground.bodies.end());
  return ground;
}

std::vector<SeamNeighbour> Surroundings::seam_neighbours(const Body& body,
                                                         const NearGround& ground) const {
  std::vector<SeamNeighbour> result;
  if (!body.fixed()) return result;
  result.reserve(2 * ground.bodies.size());
  thread_local std::vector<std::uint32_t> near;
  for (const BodyId id : ground.bodies) {
    if (id == body.id()) continue;
    const Frame frame(scene_.body(id).motion->pose(0));
    const Shape& shape = *scene_.body(id).shape_P;
    parts_around(shape, frame, ground.place, near);
    for (const std::uint32_t i : near) result.push_back({&shape.part(i), frame});
  }
  return result;
}

}  // namespace tw
