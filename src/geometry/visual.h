// What is seen of a body where it is not what touches.
//
// Frames: the body's; metres.  Colours are sRGB, 0..1.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/shape.h"
#include "math/aabb.h"

namespace tw {

// Triangles, three indices each, counter-clockwise from outside; they need not enclose anything.
struct SurfaceMesh {
  struct Vertex {
    Eigen::Vector3f position, normal;  // unit
    Eigen::Vector3f color = Eigen::Vector3f::Ones();
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  bool colored = false;  // else the colours say nothing
  Aabb bounds;
  double radius = 0;  // of a ball about the origin that holds all vertices
};

// One of the two.
struct VisualPart {
  ShapePtr shape;
  std::shared_ptr<const SurfaceMesh> mesh;
  Pose pose;
  std::optional<Vec3> color;  // absent: the mesh's own, or the body's
};

using Visual = std::vector<VisualPart>;
using VisualPtr = std::shared_ptr<const Visual>;

}  // namespace tw
