// Triangles of convex parts, ready for the renderer.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/height-field.h"
#include "geometry/mesh-ground.h"
#include "geometry/polyhedron.h"
#include "geometry/visual.h"

namespace tw {

// Corners and their unit normals; three indices per triangle, counter-clockwise from outside.
struct Mesh {
  struct Vertex {
    Eigen::Vector3f position, normal;
    Eigen::Vector3f tint = Eigen::Vector3f::Ones();   // times the body's colour, linear
    Eigen::Vector2f place = Eigen::Vector2f::Zero();  // in a texture
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  bool closed = true;  // else it is seen from behind, too
};

// Flat faces: every face has corners of its own, with the face's normal.
Mesh facet_mesh(const Polyhedron& polyhedron);
// Rounded looks: a vertex's normal is the mean of its faces' normals, weighted by their angles.
Mesh smooth_mesh(const Polyhedron& polyhedron);
// The ground with its rim and its underside.  Smooth: the normals of what the heights are samples
// of.  Tints are the ground's colours, where it has some.
Mesh height_field_mesh(const HeightField& field, bool smooth);
// The surface of a mesh.  Smooth: the mean of the normals of the faces at a point.
Mesh mesh_ground_mesh(const MeshGround& ground, bool smooth);
// Tints are the surface's own colours, where it has some and they are wanted.
Mesh surface_mesh(const SurfaceMesh& surface, bool tinted);
// A sphere of radius 1 as 320 flat triangles: an icosahedron split twice.
Mesh facet_sphere_mesh();
// What follows is turned about z in 48 facets or, smooth, round.
// A sphere of radius 1, smooth.
Mesh ball_mesh();
// From -1, with radius 1, to 1: a cylinder by a top radius of 1, a cone by one of 0.
Mesh frustum_mesh(double top_radius, bool smooth);
Mesh capsule_mesh(double radius, double half_length, bool smooth);

}  // namespace tw
