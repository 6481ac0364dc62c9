// Which pairs of parts of two placed shapes come near each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/part-tree.h"
#include "geometry/shape.h"

namespace tw {

// Whether the bounding balls prove a gap above the reach.
bool far_apart(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b, const Frame& frame_b,
               double reach);

// The number of a pair of parts: part_a * parts of b + part_b.
inline int pair_number(std::size_t i, std::size_t j, const Shape& b) {
  return static_cast<int>(i * b.part_count() + j);
}

// A part over the face of a polyhedron that the middle of the part is most over; world frame.
struct FaceGap {
  // m: a lower bound of their distance; -infinity where the other is no polyhedron
  double gap = -std::numeric_limits<double>::infinity();
  Vec3 normal = Vec3::Zero();  // of the face, outwards
  Vec3 foot = Vec3::Zero();    // of the middle of the part on the face's plane
};
FaceGap gap_over_face(const ConvexPart& part, const Frame& frame, const ConvexPart& other,
                      const Frame& other_frame);

// Frame B as seen from frame A.
inline Frame seen_from(const Frame& a, const Frame& b) {
  const Mat3 back = a.R.transpose();
  return {Mat3(back * b.R), Vec3(back * (b.p - a.p))};
}

// The bounds of a box as seen from a frame.
Aabb seen_from(const Frame& frame, const Aabb& box);

// The parts of a shape with a tree whose boxes come within `reach` (m) of one part, in its frame,
// of another shape, ascending; `frame` is that of the other shape as seen from the shape.
// Overwrites `out`.
void parts_near(const Shape& shape, const ConvexPart& other, const Frame& frame, double reach,
                std::vector<std::uint32_t>& out);

// The parts of a shape with a tree whose own boxes overlap the box (in its frame), ascending.
// Overwrites `out`.
void parts_in(const Shape& shape, const Aabb& box, std::vector<std::uint32_t>& out);

// The parts of a placed shape that may come into a box of the world: those of a shape without a
// tree are all named.  Ascending; overwrites `out`.
void parts_around(const Shape& shape, const Frame& frame, const Aabb& place,
                  std::vector<std::uint32_t>& out);

// Of two shapes with at least one tree: whether each part of a is looked for in the tree of b, or
// the other way round.  That of more parts is searched, and one of lazy parts before one without.
inline bool searches_second(const Shape& a, const Shape& b) {
  if (!a.tree() || !b.tree()) return b.tree() != nullptr;
  const bool lazy_a = a.has_lazy_parts(), lazy_b = b.has_lazy_parts();
  return lazy_a != lazy_b ? lazy_b : a.part_count() <= b.part_count();
}

// Calls visit(i, j) for part i of a and part j of b, for all pairs that may be within `reach` (m)
// of each other: ascending by i, then by j.
template <class Visit>
void visit_near_parts(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b,
                      double reach, Visit&& visit) {
  const auto visit_if_near = [&](std::size_t i, std::size_t j) {
    const ConvexPart &part_a = a.part(i), &part_b = b.part(j);
    if (far_apart(part_a, frame_a, part_b, frame_b, reach)) return;
    if (b.tree() && gap_over_face(part_a, frame_a, part_b, frame_b).gap > reach) return;
    if (a.tree() && gap_over_face(part_b, frame_b, part_a, frame_a).gap > reach) return;
    visit(i, j);
  };
  if (!a.tree() && !b.tree()) {
    for (std::size_t i = 0; i < a.part_count(); ++i)
      for (std::size_t j = 0; j < b.part_count(); ++j) visit_if_near(i, j);
    return;
  }
  const bool in_b = searches_second(a, b);
  const Shape& many = in_b ? b : a;
  const Shape& few = in_b ? a : b;
  const Frame frame = in_b ? seen_from(frame_b, frame_a) : seen_from(frame_a, frame_b);
  std::vector<std::uint32_t> near;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < few.part_count(); ++i) {
    if (!few.has_part(i)) continue;
    parts_near(many, few.part(i), frame, reach, near);
    for (const std::size_t j : near) pairs.emplace_back(in_b ? i : j, in_b ? j : i);
  }
  if (!in_b) std::sort(pairs.begin(), pairs.end());
  for (const auto& [i, j] : pairs) visit_if_near(i, j);
}

}  // namespace tw
