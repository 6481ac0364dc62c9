// Axis-aligned boxes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>

#include "math/vec.h"

namespace tw {

// A closed axis-aligned box; starts empty (lo > hi).
struct Aabb {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 hi = Vec3::Constant(-std::numeric_limits<double>::infinity());

  static Aabb everywhere() {
    const double infinite = std::numeric_limits<double>::infinity();
    return {Vec3::Constant(-infinite), Vec3::Constant(infinite)};
  }
  // Some of it lies infinitely far.
  bool unbounded() const { return !is_finite(lo) || !is_finite(hi); }
  bool empty() const { return !(lo.x() <= hi.x()); }
  void add(const Vec3& point) {
    lo = lo.cwiseMin(point);
    hi = hi.cwiseMax(point);
  }
  void add(const Aabb& box) {
    lo = lo.cwiseMin(box.lo);
    hi = hi.cwiseMax(box.hi);
  }
  void grow(double margin) {
    lo.array() -= margin;
    hi.array() += margin;
  }
  // True also when the boxes only touch.
  bool overlaps(const Aabb& other) const {
    return lo.x() <= other.hi.x() && other.lo.x() <= hi.x() && lo.y() <= other.hi.y() &&
           other.lo.y() <= hi.y() && lo.z() <= other.hi.z() && other.lo.z() <= hi.z();
  }
  bool contains(const Vec3& point) const {
    return lo.x() <= point.x() && point.x() <= hi.x() && lo.y() <= point.y() &&
           point.y() <= hi.y() && lo.z() <= point.z() && point.z() <= hi.z();
  }
  Vec3 size() const { return hi - lo; }
  Vec3 center() const { return 0.5 * (lo + hi); }
  // Number 0 to 7: bit 0, 1, 2 is set where it lies at hi in x, y, z.
  Vec3 corner(int number) const {
    return {(number & 1) ? hi.x() : lo.x(), (number & 2) ? hi.y() : lo.y(),
            (number & 4) ? hi.z() : lo.z()};
  }
};

}  // namespace tw
