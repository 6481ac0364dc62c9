// Meshes: ground given by its surface, triangles that may enclose anything and be as concave as
// they like.
//
// Each convex polygon of the surface (geometry/mesh-faces.h) stands on a convex part of solid: what
// is beneath it down to its depth, between planes through its sides that halve the angles to its
// neighbours, so that parts side by side have their walls in common.  At sides without a neighbour
// the plane is upright; so are all where no depth is left.  Polygons beneath that have a corner in
// common have a wall between them as well.  The depth is at most twice the median width of polygons
// or that of its own, a half of what is solid there, and less where the walls come together sooner
// (a pyramid's).  So of a closed surface what is within the depth beneath is solid; an open one is
// a shell beneath its front.
//
// Frames: the shape's own, metres.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/lazy-parts.h"
#include "geometry/mesh-faces.h"

namespace tw {

class MeshGround final : public LazyParts {
 public:
  explicit MeshGround(MeshFaces faces);

  // What is drawn.
  const MeshFaces& faces() const { return faces_; }
  // Whether a side has no neighbour.
  bool is_open() const;
  // Ninety-nine parts of a hundred of the surface have so much solid beneath; infinite where none
  // met a surface beneath.
  double thickness() const { return thickness_; }

 private:
  // A wall: on the polygon's plane the polygon lies where inward.x >= offset, and as much farther
  // in as the depth times `slope` beneath.
  struct Wall {
    Vec3 inward = Vec3::UnitX();
    double offset = 0;
    double slope = 0;
  };

  const Vec3& normal(std::size_t number) const { return faces_.faces[number].normal; }
  // The corners of a polygon, on its plane.
  std::vector<Vec3> top(std::size_t number) const;
  void set_faces_at_points();
  // Those with a point in common, without itself; ascending.
  std::vector<std::uint32_t> around(std::size_t number) const;
  std::vector<Wall> walls(std::size_t number) const;
  void add_walls_at_points(std::size_t number, std::vector<Wall>& walls) const;
  // The corners of the part so far beneath its polygon; none where the walls have met.
  std::vector<Vec3> section(std::size_t number, const std::vector<Wall>& walls, double depth) const;
  double depth_until_walls_meet(std::size_t number, const std::vector<Wall>& walls,
                                double most) const;
  double depth_until_a_surface(std::size_t number, const std::vector<Wall>& walls, double most,
                               const PartTree& tops) const;
  std::vector<Vec3> bottom(std::size_t number, std::vector<Wall> walls) const;
  ConvexPart make_part(std::size_t number) const override;

  MeshFaces faces_;
  // compressed rows: the faces at point i start at first_face_[i]
  std::vector<std::uint32_t> first_face_, faces_at_;
  std::vector<double> depths_;  // m
  std::vector<bool> upright_;   // all walls: what is solid there is as good as nothing
  double thickness_ = 0;
};

}  // namespace tw
