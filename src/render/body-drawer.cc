// Meshes, instances and draw calls of bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/body-drawer.h"

#include "geometry/height-field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace tw {

namespace {

// Ground and rocks have one, made things haven't: all parts of a body or none.
bool has_grain(const DrawBody& body) {
  const auto& parts = body.shape->parts();
  return body.fixed && std::any_of(parts.begin(), parts.end(), [](const ConvexPart& part) {
           return part.kind == PartKind::polyhedron && !part.is_box;
         });
}

constexpr double level_error = 0.2;  // pixels: a coarser version may be so far off

// What stands fixed is dull; 0.1 tells the light (picture-shaders.cc) that it has a grain, too.
float gloss_of(bool fixed, bool grain) { return !fixed ? 0.5f : grain ? 0.1f : 0.04f; }

const void* offset_pointer(std::size_t offset) { return reinterpret_cast<const void*>(offset); }

// Declares the vertex input `location` as `count` floats of the bound buffer.
void declare_input(const GlApi& gl, GLuint location, GLint count, std::size_t stride,
                   std::size_t offset, GLuint divisor) {
  gl.EnableVertexAttribArray(location);
  gl.VertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                         offset_pointer(offset));
  gl.VertexAttribDivisor(location, divisor);
}

template <class T>
GLuint make_buffer(const GlApi& gl, GLenum kind, const T& data, std::size_t count) {
  GLuint buffer = 0;
  gl.GenBuffers(1, &buffer);
  gl.BindBuffer(kind, buffer);
  gl.BufferData(kind, static_cast<GLsizeiptr>(count * sizeof data[0]), data.data(), GL_STATIC_DRAW);
  return buffer;
}

}  // namespace

BodyDrawer::BodyDrawer(const GlApi& gl) : gl_(&gl) {
  static const std::array<float, 8> corners = {-1, -1, 1, -1, -1, 1, 1, 1};
  gl.GenVertexArrays(1, &ball_vertex_array_);
  gl.BindVertexArray(ball_vertex_array_);
  make_buffer(gl, GL_ARRAY_BUFFER, corners, corners.size());
  declare_input(gl, 0, 2, 2 * sizeof(float), 0, 0);
  gl.GenBuffers(1, &ball_buffer_);
  gl.BindBuffer(GL_ARRAY_BUFFER, ball_buffer_);
  declare_input(gl, 1, 4, sizeof(BallInstance), offsetof(BallInstance, ball), 1);
  declare_input(gl, 2, 4, sizeof(BallInstance), offsetof(BallInstance, color), 1);
}

void BodyDrawer::add_visual(const DrawBody& body, std::size_t index) {
  visuals_.push_back(body.visual);
  for (const VisualPart& part : *body.visual) {
    const Vec3 own = part.color.value_or(body.color.value_or(default_color(index, body.fixed)));
    Part record;
    record.body = index;
    record.color << linear_color(own).cast<float>(), gloss_of(body.fixed, false);
    if (part.mesh) {
      if (part.mesh->colored && !part.color) record.color.head<3>().setOnes();
      record.placement = Frame(part.pose);
      const bool tinted = part.mesh->colored && !part.color;
      const auto [found, fresh] =
          group_index_.emplace(MeshKey(part.mesh.get(), tinted, 0, 0), groups_.size());
      if (fresh) groups_.push_back(make_surface_group(*part.mesh, tinted));
      groups_[found->second].parts.push_back(record);
      continue;
    }
    for (const ConvexPart& piece : part.shape->parts()) {
      record.placement = Frame(part.pose) * piece.placement();
      add_part(piece, body, record);
    }
  }
}

void BodyDrawer::add_body(const DrawBody& body, std::size_t index) {
  if (!body.visible) return;
  if (body.visual) return add_visual(body, index);
  if (!body.shape) return;
  shapes_.push_back(body.shape);
  const Vec3 color = linear_color(body.color.value_or(default_color(index, body.fixed)));
  Part record;
  record.body = index;
  if (body.shape->height_field()) {
    // its own colours, if it has some, go before that of the body
    const Vec3 shown = body.shape->height_field()->has_colors() ? Vec3(Vec3::Ones()) : color;
    record.color << shown.cast<float>(), gloss_of(body.fixed, body.fixed);
    return add_height_field(body, record);
  }
  if (body.shape->mesh()) {
    record.color << color.cast<float>(), gloss_of(body.fixed, body.fixed);
    return add_mesh_ground(body, record);
  }
  const bool grain = has_grain(body);
  record.color << color.cast<float>(), gloss_of(body.fixed, grain);
  for (const ConvexPart& part : body.shape->parts()) {
    record.placement = part.placement();
    if (grain) ++grainy_parts_;
    add_part(part, body, record);
  }
}

void BodyDrawer::add_part(const ConvexPart& part, const DrawBody& body, Part record) {
  if (part.kind == PartKind::half_space) return;
  const bool smooth = body.smooth.value_or(part.kind != PartKind::polyhedron);
  if (part.kind == PartKind::sphere) record.placement.R *= part.radius;
  if (part.kind == PartKind::sphere && smooth) {
    balls_.push_back(record);
    return;
  }
  if (part.is_box) record.placement.R *= part.half_edges.asDiagonal();
  if (part.kind == PartKind::ellipsoid) record.placement.R *= part.semi_axes.asDiagonal();
  if (part.kind == PartKind::frustum && part.margin == 0)
    record.placement.R *= Vec3(part.radius, part.radius, part.half_length).asDiagonal();
  group_of(part, smooth).parts.push_back(record);
}

void BodyDrawer::add_height_field(const DrawBody& body, Part record) {
  const HeightField& field = *body.shape->height_field();
  const bool smooth = body.smooth.value_or(false);
  if (body.fixed) grainy_parts_ += static_cast<int>(field.part_count() / 2);
  const auto [found, fresh] = group_index_.emplace(MeshKey(&field, smooth, 0, 0), groups_.size());
  if (fresh) groups_.push_back(make_group(height_field_mesh(field, smooth)));
  groups_[found->second].parts.push_back(record);
}

void BodyDrawer::add_mesh_ground(const DrawBody& body, Part record) {
  const MeshGround& ground = *body.shape->mesh();
  const bool smooth = body.smooth.value_or(false);
  if (body.fixed) grainy_parts_ += static_cast<int>(ground.part_count());
  const auto [found, fresh] = group_index_.emplace(MeshKey(&ground, smooth, 0, 0), groups_.size());
  if (fresh) groups_.push_back(make_group(mesh_ground_mesh(ground, smooth)));
  groups_[found->second].parts.push_back(record);
}

BodyDrawer::MeshGroup& BodyDrawer::group_of(const ConvexPart& part, bool smooth) {
  static const Polyhedron unit_box = Polyhedron::box(Vec3::Ones());
  // stand for the meshes of all balls and ellipsoids, cylinders and cones
  static const char unit_ball = 0, unit_cylinder = 0, unit_cone = 0;
  const bool capsule = part.margin > 0;
  const auto key = [&]() -> const void* {
    switch (part.kind) {
      case PartKind::sphere:
      case PartKind::ellipsoid: return &unit_ball;
      case PartKind::frustum: return part.top_radius > 0 ? &unit_cylinder : &unit_cone;
      default: return part.is_box ? &unit_box : part.core.get();
    }
  };
  const auto mesh = [&] {
    switch (part.kind) {
      case PartKind::sphere:
      case PartKind::ellipsoid: return smooth ? ball_mesh() : facet_sphere_mesh();
      case PartKind::frustum:
        return capsule ? capsule_mesh(part.margin, part.half_length, smooth)
                       : frustum_mesh(part.top_radius > 0 ? 1 : 0, smooth);
      default: {
        const Polyhedron& polyhedron = part.is_box ? unit_box : *part.core;
        return smooth ? smooth_mesh(polyhedron) : facet_mesh(polyhedron);
      }
    }
  };
  // capsules of different proportions have no mesh in common
  const MeshKey name(capsule ? nullptr : key(), smooth, part.margin,
                     capsule ? part.half_length : 0);
  const auto [found, fresh] = group_index_.emplace(name, groups_.size());
  if (fresh) groups_.push_back(make_group(mesh()));
  return groups_[found->second];
}

BodyDrawer::MeshGroup BodyDrawer::make_group(const Mesh& mesh) {
  MeshGroup group;
  gl_->GenVertexArrays(1, &group.vertex_array);
  gl_->BindVertexArray(group.vertex_array);
  make_buffer(*gl_, GL_ARRAY_BUFFER, mesh.vertices, mesh.vertices.size());
  declare_input(*gl_, 0, 3, sizeof(Mesh::Vertex), offsetof(Mesh::Vertex, position), 0);
  declare_input(*gl_, 1, 3, sizeof(Mesh::Vertex), offsetof(Mesh::Vertex, normal), 0);
  declare_input(*gl_, 6, 3, sizeof(Mesh::Vertex), offsetof(Mesh::Vertex, tint), 0);
  declare_input(*gl_, 7, 2, sizeof(Mesh::Vertex), offsetof(Mesh::Vertex, place), 0);
  make_buffer(*gl_, GL_ELEMENT_ARRAY_BUFFER, mesh.indices, mesh.indices.size());
  gl_->GenBuffers(1, &group.instance_buffer);
  gl_->BindBuffer(GL_ARRAY_BUFFER, group.instance_buffer);
  // three rows and the colour, one after the other
  for (GLuint i = 0; i < 4; ++i)
    declare_input(*gl_, 2 + i, 4, sizeof(MeshInstance), 4 * sizeof(float) * i, 1);
  group.closed = mesh.closed;
  group.patches.push_back({0, {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}}});
  return group;
}

BodyDrawer::MeshGroup BodyDrawer::make_surface_group(const SurfaceMesh& surface, bool tinted) {
  Mesh mesh = surface_mesh(surface, tinted);
  std::vector<GLuint> textures;
  for (const Texture& texture : surface.textures) textures.push_back(make_texture_of(texture));
  std::vector<Patch> patches;
  for (const SurfaceMesh::Patch& patch : surface.patches) {
    const bool textured = patch.texture >= 0;
    textured_ = textured_ || textured;
    patches.push_back({textured ? textures.at(static_cast<std::size_t>(patch.texture)) : 0,
                       add_levels(mesh, patch)});
  }
  MeshGroup group = make_group(mesh);
  group.patches = std::move(patches);
  group.middle = surface.bounds.center();
  group.radius = 0.5 * surface.bounds.size().norm();
  return group;
}

GLuint BodyDrawer::make_texture_of(const Texture& texture) const {
  const GLuint name = make_texture(*gl_, GL_SRGB8_ALPHA8, texture.width, texture.height);
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, texture.width, texture.height, 0, GL_RGBA,
                  GL_UNSIGNED_BYTE, texture.rgba.data());
  gl_->GenerateMipmap(GL_TEXTURE_2D);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl_->TexParameteri(GL_TEXTURE_2D, axis, GL_REPEAT);
  return name;
}

void BodyDrawer::upload(GLuint buffer, const void* data, std::size_t size) const {
  gl_->BindBuffer(GL_ARRAY_BUFFER, buffer);
  gl_->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(size), data, GL_STREAM_DRAW);
}

void BodyDrawer::place(std::span<const Pose> poses, const Vec3& eye, double pixel) {
  const auto drawn = [&](const Part& part) {
    return is_finite(poses[part.body].p) && is_finite(poses[part.body].q);
  };
  ball_instances_.clear();
  for (const Part& part : balls_) {
    if (!drawn(part)) continue;
    const Vec3 center = Frame(poses[part.body]) * part.placement.p - eye;
    BallInstance instance;
    // the matrix of a sphere is a rotation times its radius
    instance.ball << center.cast<float>(), static_cast<float>(part.placement.R.col(0).norm());
    instance.color = part.color;
    ball_instances_.push_back(instance);
  }
  upload(ball_buffer_, ball_instances_.data(), ball_instances_.size() * sizeof(BallInstance));
  for (MeshGroup& group : groups_) {
    group.instances.clear();
    double nearest = std::numeric_limits<double>::infinity();
    for (const Part& part : group.parts) {
      if (!drawn(part)) continue;
      const Frame frame = Frame(poses[part.body]) * part.placement;
      nearest = std::min(nearest, (frame * group.middle - eye).norm() - group.radius);
      MeshInstance instance;
      instance.rows << frame.R.cast<float>(), (frame.p - eye).cast<float>();
      instance.color = part.color;
      group.instances.push_back(instance);
    }
    group.allowed = level_error * pixel * nearest;
    upload(group.instance_buffer, group.instances.data(),
           group.instances.size() * sizeof(MeshInstance));
  }
}

void BodyDrawer::draw_meshes(Which which) const {
  gl_->Enable(GL_CULL_FACE);
  bool culls = true;
  for (const MeshGroup& group : groups_) {
    if (group.instances.empty()) continue;
    gl_->BindVertexArray(group.vertex_array);
    if (culls != group.closed)
      group.closed ? gl_->Enable(GL_CULL_FACE) : gl_->Disable(GL_CULL_FACE);
    culls = group.closed;
    for (const Patch& patch : group.patches) {
      if (which == Which::plain && patch.texture != 0) continue;
      if (which == Which::textured) {
        if (patch.texture == 0) continue;
        gl_->BindTexture(GL_TEXTURE_2D, patch.texture);
      }
      const auto level =
          std::find_if(patch.levels.rbegin(), patch.levels.rend() - 1,
                       [&](const MeshLevel& one) { return one.error <= group.allowed; });
      gl_->DrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(level->count), GL_UNSIGNED_INT,
                                 offset_pointer(level->first * sizeof(std::uint32_t)),
                                 static_cast<GLsizei>(group.instances.size()));
    }
  }
  gl_->Disable(GL_CULL_FACE);
}

void BodyDrawer::draw_spheres() const {
  if (ball_instances_.empty()) return;
  gl_->BindVertexArray(ball_vertex_array_);
  gl_->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(ball_instances_.size()));
}

}  // namespace tw
