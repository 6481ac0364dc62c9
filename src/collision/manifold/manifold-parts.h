// Contact manifolds of one pair of parts each: what manifold.cc puts together.
//
// Everything appends its points with gap <= reach to `out`; `pair` is the number of the pair of
// parts.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/hash.h"
#include "collision/distance/nearest-features.h"
#include "collision/distance/part-pairs.h"
#include "collision/distance/round-distance.h"
#include "collision/manifold/face-contact.h"
#include "collision/seams/seams.h"

namespace tw {

struct SeamPair;

// What meets at a point: part of its name.
enum class FeatureMode : std::uint64_t {
  ball = 1,
  half_space,
  face,
  corners,
  edge,
  vertex,
  side,
  rim,
  lying,
  standing,
  exposed_of_a,
  exposed_of_b,
  along_edges
};

// The name of a point by the numbers of what meets there.
inline std::uint64_t feature_name(int pair, FeatureMode mode,
                                  const std::array<std::uint64_t, 3>& numbers) {
  Hasher hasher;
  hasher.add(static_cast<std::uint64_t>(pair));
  hasher.add(static_cast<std::uint64_t>(mode));
  for (std::uint64_t number : numbers) hasher.add(number);
  return hasher.value();
}

// Sets `flatness` and `beyond` of the points from `from` on, where two parts lie on each other.
// `parallel`: 1 where they are, 0 where they are taken for it no longer; `steepest`: the sine of
// the slope between two points from which on they are not.  `higher` (world) are farther than the
// reach: of more than there is room for the lowest count; their order changes.
void lie_on_each_other(double parallel, double steepest, std::vector<FacePoint>& higher,
                       std::size_t from, std::vector<ManifoldPoint>& out);

// Any pair of kinds.
void part_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                   const Frame& frame_b, double reach, ReferenceChoice choice, int pair,
                   std::vector<ManifoldPoint>& out);

void polyhedra_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                        const Frame& frame_b, double reach, ReferenceChoice choice, int pair,
                        std::vector<ManifoldPoint>& out);
// The same with features that are known; `seam`: where one is, or nullptr.
void features_manifold(const CorePair& cores, const NearestFeatures& near, double reach,
                       ReferenceChoice choice, int pair, const SeamPair* seam,
                       std::vector<ManifoldPoint>& out);
// The half-space is the reference body; `reference_is_a` says which of the two it is.
void half_space_manifold(const ConvexPart& half_space, const Frame& frame_h,
                         const ConvexPart& polyhedron, const Frame& frame_p, double reach,
                         bool reference_is_a, int pair, std::vector<ManifoldPoint>& out);

// One point: the feature of the polyhedron that is nearest to the centre.
void polyhedron_sphere_manifold(const ConvexPart& polyhedron, const Frame& frame_p,
                                const ConvexPart& sphere, const Frame& frame_s, double reach,
                                bool reference_is_a, int pair, std::vector<ManifoldPoint>& out);
void spheres_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                      const Frame& frame_b, double reach, int pair,
                      std::vector<ManifoldPoint>& out);

// A frustum against any other kind but an ellipsoid; a or b is the frustum.
void frustum_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                      const Frame& frame_b, double reach, int pair,
                      std::vector<ManifoldPoint>& out);
// An ellipsoid against any kind; a or b is the ellipsoid.
void ellipsoid_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                        const Frame& frame_b, double reach, int pair,
                        std::vector<ManifoldPoint>& out);
// The same of a frustum or ellipsoid, and a polyhedron or another of these, whose axis and
// witnesses (world) are known.
void round_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                    const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                    std::vector<ManifoldPoint>& out);
void frustum_manifold_at(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                         const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                         std::vector<ManifoldPoint>& out);
void ellipsoid_manifold_at(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                           const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                           std::vector<ManifoldPoint>& out);

// Signed distance of a point (world) from a part, m.
double height_over(const SeamNeighbour& part, const Vec3& point);
// Whether that is -depth (m) or less: the point lies so deep in the part, or deeper.
bool holds(const SeamNeighbour& part, const Vec3& point, double depth);

}  // namespace tw
