// Who may overlap whom: moving boxes in a spatial hash, standing ones in another.
//
// A body near the ground asks for it again and again while its own box hardly moves: so a moving
// box remembers the standing ones in a zone somewhat larger than itself until it leaves the zone.
//
// Measured: the first 4 s of the avalanche (300 rocks on 524 pieces) took 13.1 s instead of 13.8.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "collision/broad/spatial-hash.h"

namespace tw {

class BroadPhase {
 public:
  // Inserts or moves a box (dense numbers from 0).  `stands`: it will hardly ever move.
  void place(std::uint32_t id, const Aabb& box, bool stands);
  // Takes the box out; it must be there.
  void remove(std::uint32_t id);
  bool contains(std::uint32_t id) const { return moving_.contains(id) || standing_.contains(id); }
  const Aabb& box(std::uint32_t id) const {
    return moving_.contains(id) ? moving_.box(id) : standing_.box(id);
  }

  // Calls visit(other) once for each other box that overlaps (closed boxes) that of `id`.  The
  // visit must not place boxes.  Queries may go on at once.
  template <class Visit>
  void overlapping(std::uint32_t id, Visit&& visit) const {
    if (!moving_.contains(id)) {
      standing_.overlapping(id, visit);
      moving_.overlapping(standing_.box(id), visit);
      return;
    }
    moving_.overlapping(id, visit);
    if (standing_.size() == 0) return;
    const Aabb& box = moving_.box(id);
    Zone& zone = zones_[id];
    const ZoneLock lock(zone);
    if (!lock.is_held()) return standing_.overlapping(box, visit);
    set_zone(zone, box);
    visit_zone(zone, box, visit);
  }
  // The standing ones alone that overlap any box; faster where that lies around where the moving
  // box `id` was when it was last asked for.  May go on beside any query, and while moving boxes
  // are placed.
  template <class Visit>
  void standing_in(const Aabb& box, std::uint32_t id, Visit&& visit) const {
    if (standing_.size() == 0) return;
    Zone& zone = zones_[id];
    const ZoneLock lock(zone);
    if (!lock.is_held() || !holds(zone, box)) return standing_.overlapping(box, visit);
    visit_zone(zone, box, visit);
  }

  std::size_t size() const { return moving_.size() + standing_.size(); }
  // For validators.
  bool consistent() const { return moving_.consistent() && standing_.consistent(); }

 private:
  struct Neighbour {
    Aabb box;
    std::uint32_t id;
  };
  struct Zone {
    Aabb box;
    std::uint64_t version = 0;  // of the standing boxes
    std::vector<Neighbour> neighbours;
    std::atomic_flag in_use;

    Zone() = default;
    Zone(Zone&& other) noexcept
        : box(other.box), version(other.version), neighbours(std::move(other.neighbours)) {}
  };
  // Whoever finds a zone in use does without.
  class ZoneLock {
   public:
    explicit ZoneLock(Zone& zone)
        : zone_(zone.in_use.test_and_set(std::memory_order_acquire) ? nullptr : &zone) {}
    ~ZoneLock() {
      if (zone_) zone_->in_use.clear(std::memory_order_release);
    }
    ZoneLock(const ZoneLock&) = delete;
    ZoneLock& operator=(const ZoneLock&) = delete;
    bool is_held() const { return zone_; }

   private:
    Zone* zone_;
  };
  bool holds(const Zone& zone, const Aabb& box) const {
    return zone.version == version_ && zone.box.contains(box.lo) && zone.box.contains(box.hi);
  }
  void set_zone(Zone& zone, const Aabb& box) const;
  template <class Visit>
  static void visit_zone(const Zone& zone, const Aabb& box, Visit&& visit) {
    for (const Neighbour& other : zone.neighbours)
      if (other.box.overlaps(box)) visit(other.id);
  }

  SpatialHash moving_, standing_;
  std::uint64_t version_ = 1;
  mutable std::vector<Zone> zones_;  // of moving boxes
};

}  // namespace tw
