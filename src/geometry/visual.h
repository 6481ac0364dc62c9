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

// A picture that lies on a surface: rows from the top, red, green, blue and alpha of a pixel.
struct Texture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

// Triangles, three indices each, counter-clockwise from outside; they need not enclose anything.
struct SurfaceMesh {
  struct Vertex {
    Eigen::Vector3f position, normal;  // unit
    Eigen::Vector3f color = Eigen::Vector3f::Ones();
    // in the texture, from its upper left corner to its lower right one 0..1; it repeats itself
    Eigen::Vector2f place = Eigen::Vector2f::Zero();
  };
  // Indices in a row, of triangles of one material, with one texture or none (-1).
  struct Patch {
    std::uint32_t first = 0, count = 0;
    std::int32_t texture = -1;
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Patch> patches;  // all of the indices, in order
  std::vector<Texture> textures;
  bool colored = false;  // else the colours say nothing
  bool closed = false;   // else it is seen from behind, too
  Aabb bounds;
  double radius = 0;  // of a ball about the origin that holds all vertices
};

// One of the two.
struct VisualPart {
  ShapePtr shape;
  std::shared_ptr<const SurfaceMesh> mesh;
  Pose pose;
  // instead of a mesh's own, and times a texture; absent: the mesh's own, or the body's
  std::optional<Vec3> color;
};

using Visual = std::vector<VisualPart>;
using VisualPtr = std::shared_ptr<const Visual>;

}  // namespace tw
