// Described polyhedra written as OBJ and read again.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/mesh-text.h"

#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "geometry/polyhedron.h"
#include "import/solid-file.h"

namespace tw::fuzz {

std::string obj_text(const DescribedBody& body) {
  std::string text;
  int before = 1;  // corners are counted from 1
  for (const Solid& solid : body.solids) {
    DescribedBody alone;
    alone.solids = {solid};
    const ShapePtr shape = shape_of(alone);
    const ConvexPart& part = shape->part(0);
    TW_ASSERT(part.kind == PartKind::polyhedron, "meshes are of polyhedra");
    const Polyhedron& core = *part.core;
    text += "o part-" + std::to_string(before) + "\n";
    for (const Vec3& vertex : core.vertices()) {
      const Vec3 x = part.placement() * vertex;
      text += "v " + show(x.x()) + " " + show(x.y()) + " " + show(x.z()) + "\n";
    }
    for (const Polyhedron::Face& face : core.faces()) {
      text += "f";
      for (int i = 0; i < face.count; ++i)
        text += " " + std::to_string(before + core.corner(face.first + i));
      text += "\n";
    }
    before += static_cast<int>(core.vertices().size());
  }
  return text;
}

ShapePtr shape_from_file(const DescribedBody& body) {
  namespace fs = std::filesystem;
  std::string folder = (fs::temp_directory_path() / "fuzz-mesh-XXXXXX").string();
  TW_REQUIRE(mkdtemp(folder.data()), "cannot make the folder " + folder);
  const std::string file = folder + "/mesh.obj";
  std::ofstream(file) << obj_text(body);
  Mending mending(true);
  const ShapePtr shape = read_solid(file, {}, mending);
  fs::remove_all(folder);
  return shape;
}

}  // namespace tw::fuzz
