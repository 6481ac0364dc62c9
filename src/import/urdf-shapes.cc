// Shapes of URDF files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf-shapes.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "import/find-mesh.h"
#include "import/mesh-file.h"
#include "import/solid-file.h"
#include "import/surface-file.h"

namespace tw::urdf {

std::string Shapes::mesh_path(const Geometry& geometry) const {
  return find_mesh(geometry.file, file_, packages_);
}

ShapePtr Shapes::shape_of(const Geometry& geometry) {
  switch (geometry.kind) {
    case GeometryKind::sphere: return make_sphere(geometry.radius);
    case GeometryKind::box: return make_box(geometry.size);
    case GeometryKind::cylinder: return make_cylinder(geometry.radius, geometry.length);
    case GeometryKind::capsule: return make_capsule(geometry.radius, geometry.length);
    case GeometryKind::plane: return make_half_space(geometry.size.normalized(), 0);
    case GeometryKind::mesh: break;
  }
  const std::string path = mesh_path(geometry);
  auto found = points_.find(path);
  if (found == points_.end()) found = points_.emplace(path, mesh_points(path)).first;
  std::vector<Vec3> points = found->second;
  for (Vec3& p : points) p = p.cwiseProduct(geometry.size);
  return make_hull(points);
}

// What is wrong with a mesh or a shape has the line of its element.
template <class Make>
auto Shapes::at_its_line(const BodyPieces::Touching& touching, const Make& make)
    -> decltype(make()) {
  const Geometry& geometry = touching.piece->geometry;
  try {
    return make();
  } catch (const UserError& error) {
    const bool mesh = geometry.kind == GeometryKind::mesh;
    const std::string of = " of the link " + touching.link->name + ": ";
    if (mesh && mesh_path(geometry) == geometry.file &&
        geometry.file.find("://") != std::string::npos)
      fail(geometry.line,
           "<mesh>" + of + "the mesh " + geometry.file +
               " is missing; expected the package in a folder above the file, or in one of "
               "#:package-path");
    fail(geometry.line, (mesh ? "<mesh>" : "a shape") + of + error.what());
  }
}

void Shapes::add(const Link& link, const Pose& part, BodyPieces& pieces) {
  const std::size_t seen_before = pieces.visual.size();
  for (const Piece& visual : link.visuals) {
    if (visual.color && !pieces.color) pieces.color = visual.color;
    try {
      pieces.visual.push_back(seen_part(visual, part * visual.origin));
    } catch (const UserError& error) {
      mending_.mend(at(visual.geometry.line), "<visual> of the link " + link.name + ": ", error,
                    "it is not drawn");
    }
  }
  const bool seen = !link.visuals.empty() && pieces.visual.size() == seen_before;
  for (const Piece& collision : link.collisions)
    pieces.touching.push_back({&link, &collision, part * collision.origin, seen});
}

VisualPart Shapes::seen_part(const Piece& visual, const Pose& pose) {
  VisualPart seen;
  const Geometry& geometry = visual.geometry;
  TW_REQUIRE(geometry.kind != GeometryKind::plane,
             "a <plane> is drawn where it is a <collision> alone; expected another shape");
  seen.pose = pose;
  seen.color = visual.color;
  if (geometry.kind != GeometryKind::mesh) {
    seen.shape = shape_of(geometry);
    return seen;
  }
  const std::string path = mesh_path(geometry);
  const auto key = std::tuple(path, geometry.size.x(), geometry.size.y(), geometry.size.z());
  auto found = surfaces_.find(key);
  if (found == surfaces_.end())
    found = surfaces_.emplace(key, read_surface(path, geometry.size, false, mending_)).first;
  seen.mesh = found->second;
  return seen;
}

// Null: it is no ground.
ShapePtr Shapes::ground_of(const std::vector<BodyPieces::Touching>& all) {
  if (all.empty()) return nullptr;
  GroundReader ground(mending_);
  for (const BodyPieces::Touching& touching : all) {
    const Geometry& geometry = touching.piece->geometry;
    if (geometry.kind != GeometryKind::mesh) return nullptr;
    at_its_line(touching,
                [&] { ground.add(mesh_path(geometry), {.scale = geometry.size}, touching.pose); });
  }
  if (ground.is_convex()) return nullptr;
  return at_its_line(all.front(), [&] { return ground.shape(); });
}

BodyLooks Shapes::finish(BodyPieces pieces, bool scenery) {
  BodyLooks looks;
  Visual visual = std::move(pieces.visual);
  if (scenery) looks.shape = ground_of(pieces.touching);
  if (looks.shape) {
    for (const BodyPieces::Touching& touching : pieces.touching)
      if (touching.seen && !visual.empty())
        visual.push_back(
            at_its_line(touching, [&] { return seen_part(*touching.piece, touching.pose); }));
  } else {
    std::vector<ShapePtr> shapes;
    for (const BodyPieces::Touching& touching : pieces.touching) {
      shapes.push_back(at_its_line(touching, [&] {
        return place_shape(shape_of(touching.piece->geometry), touching.pose);
      }));
      if (touching.seen) visual.push_back({shapes.back(), nullptr, Pose{}, std::nullopt});
    }
    if (!shapes.empty()) looks.shape = shapes.size() == 1 ? shapes.front() : make_union(shapes);
  }
  if (!visual.empty()) looks.visual = std::make_shared<const Visual>(std::move(visual));
  return looks;
}

}  // namespace tw::urdf
