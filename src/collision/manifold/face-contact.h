// A face of one polyhedron as the plane that another one lies on: the points of that contact.
//
// The incident face is clipped by the sides of the reference face (I. E. Sutherland, G. W. Hodgman,
// "Reentrant polygon clipping", Comm. ACM 17 (1974)); each corner of what is left remembers the two
// edges or sides that meet in it, which names it for as long as they do.  To these come *reach
// points*: vertices of the incident polyhedron that may come down on the face by a motion of
// `reach`.
//
// Frames: that of the reference polyhedron.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/polyhedron.h"

namespace tw {

struct FacePoint {
  Vec3 point = Vec3::Zero();  // on the incident polyhedron's surface
  double gap = 0;             // m, height over the reference plane
  std::uint64_t key = 0;      // names the point; vertices have the least keys
  int face = 0;               // of the reference
  int incident = 0;           // face of the other one
};

// Names of points, by key >> 60: a vertex of the incident body; where an edge of it, from vertex
// key >> 40 to key >> 20 (20 bits each), crosses a side of the reference face; a corner of that
// face.
inline constexpr std::uint64_t vertex_point = 0, edge_crossing = 1, face_corner = 2;

// A corner of a polygon that is being clipped.  `next` is what the polygon follows from here: its
// own edge k as k, side number j as ~j.
struct ClipCorner {
  Vec3 point;
  double height;
  int next;
};

// Keeps what lies on the inner side, up to `slack` beyond.  The polygon isn't empty.
void clip_by_side(std::vector<ClipCorner>& polygon, const Polyhedron::Side& side, int number,
                  double slack);

// Points closer than this to each other, relative to the size, are one.
inline constexpr double coincident_ratio = 1e-6;

// All points with gap <= reach, at most `most` (thin_face_points).  A vertex beside the face counts
// when it stands higher over the plane than it is beside: lower ones pass by.  Faces beside the two
// that are as parallel to the other one as these may be (patch::aligned) and come within reach lie
// on it as well: a body whose facets hardly differ rocks from one to the next.  Overwrites `out`,
// and `higher` by those that are farther than `reach`.
void face_contact(const Polyhedron& reference, int face, const Polyhedron& incident,
                  const Frame& incident_in_reference, int incident_face, double reach,
                  std::size_t most, std::vector<FacePoint>& out, std::vector<FacePoint>& higher);

// How far the point lies beside the face, by its sides, m; negative: over it.
double beside_face(const Polyhedron& p, const Polyhedron::Face& face, const Vec3& point);

// Leaves at most `most` points, ordered by key if it leaves out any: the first that is about as low
// as the lowest, then always the one that a motion of `reach` may bring farthest below those
// chosen.  What is at rest keeps its points, whatever rounding says.
void thin_face_points(std::vector<FacePoint>& points, std::size_t most, double reach);

}  // namespace tw
