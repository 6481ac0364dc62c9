// Where one polyhedron lies on a face of another: the points of a look.
//
// As manifold/face-contact.h: the incident face clipped by the sides of the reference face, and the
// vertices that may come down on it; of one pair of faces, without what only bodies of many nearly
// parallel facets want.
//
// Frames: that of the reference polyhedron.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "collision/manifold/face-contact.h"
#include "geometry/polyhedron.h"

namespace tw {

struct FaceLook {
  std::vector<FacePoint> points;  // with gap <= reach, at most patch::most_points / 2
  double lowest = 0;              // m: the least gap of them
  bool of_vertices = false;       // all are vertices of the incident polyhedron
  double room = 0;  // m: as PartLook's, how far the lowest vertices are from the border of the face
};

// Overwrites `out`.
void look_at_face(const Polyhedron& reference, int face, const Polyhedron& incident,
                  const Frame& incident_in_reference, int incident_face, double reach,
                  FaceLook& out);

// From `start` on, the face that is most along the unit direction.
int face_along(const Polyhedron& p, const Vec3& direction, int start);

}  // namespace tw
