// Who is near a body: candidates for contacts, and the ground that buries edges of its neighbours.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <initializer_list>
#include <vector>

#include "collision/broad/broad-phase.h"
#include "collision/seams/seams.h"
#include "dynamics/scene.h"

namespace tw {

// The fixed bodies around a moving one.
struct NearGround {
  std::vector<BodyId> bodies;  // ascending
  Aabb place;                  // world: what the moving one may touch is in it
};

class Surroundings {
 public:
  Surroundings(const Scene& scene, const BroadPhase& grid, const std::vector<BodyId>& unbounded)
      : scene_(scene), grid_(grid), unbounded_(unbounded) {}

  // All bodies whose boxes overlap that of a bounded body, and those that no box holds; in no
  // order.
  template <class Visit>
  void visit_near(BodyId body, Visit&& visit) const {
    grid_.overlapping(body, visit);
    for (const BodyId other : unbounded_) visit(other);
  }
  // The fixed bodies that a moving one may touch and whose boxes its own comes near, at one of the
  // frames: they bury each other's edges.  A function of the frames alone: its claim,
  // which holds it at all of its times, depends on the schedule.
  NearGround ground_around(const Body& moving, std::initializer_list<Frame> frames) const;
  // The parts of those of them that stand beside a fixed body, of shapes with trees those in the
  // place; of a body that moves there are none.
  std::vector<SeamNeighbour> seam_neighbours(const Body& body, const NearGround& ground) const;

 private:
  const Scene& scene_;
  const BroadPhase& grid_;
  const std::vector<BodyId>& unbounded_;
};

}  // namespace tw
