// The parts of all bodies on the GL side: one draw call for all spheres, one per different mesh.
//
// Cost: instance data is rewritten for every frame, 64 bytes per part.
// Frames: positions go to GL relative to the eye.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "render/draw-list.h"
#include "render/gl-program.h"
#include "render/mesh.h"

namespace tw {

class BodyDrawer {
 public:
  explicit BodyDrawer(const GlApi& gl);

  // Registers the next body; half-spaces are not drawn here.
  void add_body(const DrawBody& body, std::size_t index);

  // How many parts have a grain, as those of fixed hulls have.
  int grainy_parts() const { return grainy_parts_; }

  // Sets the instances of all bodies whose pose is finite.
  void place(std::span<const Pose> poses, const Vec3& eye);

  // Draw with the program in use, for the vertex inputs that surface-shaders.cc names.
  void draw_meshes() const;
  void draw_spheres() const;

 private:
  // One part of a visible body.
  struct Part {
    std::size_t body = 0;
    Frame placement;        // in the body; the matrix scales too
    Eigen::Vector4f color;  // linear; gloss
  };
  // x, y, z and 1 of a point to world axes: three rows; colour
  struct MeshInstance {
    Eigen::Matrix<float, 3, 4, Eigen::RowMajor> rows;
    Eigen::Vector4f color;
  };
  struct BallInstance {
    Eigen::Vector4f ball, color;
  };
  struct MeshGroup {
    GLuint vertex_array = 0, instance_buffer = 0;
    GLsizei index_count = 0;
    std::vector<Part> parts;
    std::vector<MeshInstance> instances;
  };
  // Whose mesh, smooth or not; of capsules radius and half length.  The unit shapes that scale have
  // keys of their own.
  using MeshKey = std::tuple<const void*, bool, double, double>;

  void add_visual(const DrawBody& body, std::size_t index);
  void add_part(const ConvexPart& part, const DrawBody& body, Part record);
  void add_height_field(const DrawBody& body, Part record);
  void add_mesh_ground(const DrawBody& body, Part record);
  MeshGroup& group_of(const ConvexPart& part, bool smooth);
  MeshGroup make_group(const Mesh& mesh);
  void upload(GLuint buffer, const void* data, std::size_t size) const;

  const GlApi* gl_;
  int grainy_parts_ = 0;
  std::vector<MeshGroup> groups_;
  std::map<MeshKey, std::size_t> group_index_;
  // keeps the cores alive whose addresses are keys
  std::vector<ShapePtr> shapes_;
  std::vector<VisualPtr> visuals_;
  std::vector<Part> balls_;
  std::vector<BallInstance> ball_instances_;
  GLuint ball_vertex_array_ = 0, ball_buffer_ = 0;
};

}  // namespace tw
