// Distance of convex polyhedra by V-Clip: a walk over pairs of features to the pair whose nearest
// points lie in each other's Voronoi regions.
//
// Source: B. Mirtich, "V-Clip: Fast and Robust Polyhedral Collision Detection", ACM Transactions on
// Graphics 17(3), 1998.  Here it stands to be measured beside collision/distance/gjk.h; no part of
// the program uses it (doc/vclip.md).
//
// Legend: the region of a vertex is bounded by a plane across each of its edges (VE), that of an
// edge by two of these and by a plane along it for each of its faces (FE), that of a face by the FE
// planes of its sides.  Each plane is shared with the neighbour whose region lies beyond it.  No
// tolerance; the walk is ended after `most_steps`, which exact arithmetic never needs.
//
// Frames: features in their own body's frame, answers in A's.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/polyhedron.h"

namespace tw::bench {

// A polyhedron with the planes between its features' Voronoi regions.
class VoronoiSolid {
 public:
  // Where an edge leaves a vertex: the region of the vertex has along.x <= offset.
  struct Spoke {
    Vec3 along;
    double offset = 0;
    int edge = 0;
  };
  // The region of an edge: from_tail <= along.x <= to_head, and out[k].x <= offset[k] for the FE
  // planes of its left and right face.
  struct Edge {
    Vec3 tail, head, along;
    double from_tail = 0, to_head = 0;
    Vec3 inward[2];
    double offset[2] = {};
    int face[2] = {};
    int vertex[2] = {};
  };

  explicit VoronoiSolid(const Polyhedron& core);
  const Polyhedron& core() const { return *core_; }
  const Edge& edge(int i) const { return edges_[static_cast<std::size_t>(i)]; }
  // The spokes of vertex i are spoke(first_spoke(i)) .. before spoke(first_spoke(i + 1)).
  int first_spoke(int vertex) const { return first_spoke_[static_cast<std::size_t>(vertex)]; }
  const Spoke& spoke(int i) const { return spokes_[static_cast<std::size_t>(i)]; }

 private:
  const Polyhedron* core_;
  std::vector<Edge> edges_;
  std::vector<int> first_spoke_;
  std::vector<Spoke> spokes_;
};

enum class FeatureKind { vertex, edge, face, none };

struct Feature {
  FeatureKind kind = FeatureKind::none;
  int index = 0;
  bool operator==(const Feature&) const = default;
};

// The features a walk begins from and ends at.
struct FeaturePair {
  Feature a{FeatureKind::vertex, 0};
  Feature b{FeatureKind::vertex, 0};
};

enum class VClipEnd { apart, overlap, out_of_steps };

struct VClipAnswer {
  VClipEnd end = VClipEnd::apart;
  int steps = 0;               // pairs of features looked at
  double distance = 0;         // m; of an overlap what the walk knows: no more than 0
  Vec3 normal = Vec3::Zero();  // from A to B; of an overlap that of a face, or zero
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();
};

constexpr int most_steps = 1000;

// `pair` is where the walk begins, and gets its end.
VClipAnswer vclip(const VoronoiSolid& a, const VoronoiSolid& b, const Frame& b_in_a,
                  FeaturePair& pair);

}  // namespace tw::bench
