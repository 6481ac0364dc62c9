// The parts of all bodies on the GL side: one draw call for all spheres, one per different mesh.
//
// Cost: instance data is rewritten for every frame, 64 bytes per part.  Of a mesh of many triangles
// that are seen and no more (SurfaceMesh) the coarsest version is drawn that is within a
// fifth of a pixel where the nearest of its bodies is.
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
#include "render/mesh-levels.h"
#include "render/mesh.h"

namespace tw {

class BodyDrawer {
 public:
  explicit BodyDrawer(const GlApi& gl);

  // Registers the next body; half-spaces are not drawn here.
  void add_body(const DrawBody& body, std::size_t index);

  // How many parts have a grain, as those of fixed hulls have.
  int grainy_parts() const { return grainy_parts_; }

  // Sets the instances of all bodies whose pose is finite.  `pixel`: the angle of one, rad.
  void place(std::span<const Pose> poses, const Vec3& eye, double pixel);

  // Draw with the program in use, for the vertex inputs that surface-shaders.cc names.  What is
  // closed is seen from outside only.  Textures are bound to the first unit.
  enum class Which { all, plain, textured };
  void draw_meshes(Which which) const;
  void draw_spheres() const;
  bool has_textures() const { return textured_; }

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
  // Triangles with one texture (0: none).
  struct Patch {
    GLuint texture = 0;
    std::vector<MeshLevel> levels;  // finest first
  };
  struct MeshGroup {
    GLuint vertex_array = 0, instance_buffer = 0;
    bool closed = true;
    Vec3 middle = Vec3::Zero();  // of what has levels
    double radius = 0;           // about that
    double allowed = 0;          // m, of the error of a level
    std::vector<Patch> patches;
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
  MeshGroup make_surface_group(const SurfaceMesh& surface, bool tinted);
  GLuint make_texture_of(const Texture& texture) const;
  void upload(GLuint buffer, const void* data, std::size_t size) const;

  const GlApi* gl_;
  int grainy_parts_ = 0;
  bool textured_ = false;
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
