// Shapes of URDF files: what touches of a body, and what is seen of it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "geometry/visual.h"
#include "import/mending.h"
#include "import/urdf-file.h"

namespace tw::urdf {

// What a body is made of so far: pieces of its own link and of those that are fixed to it.
struct BodyPieces {
  struct Touching {
    const Link* link;
    const Piece* piece;
    Pose pose;          // of the piece in the body
    bool seen = false;  // instead of the <visual>s of its link, none of which can be drawn
  };
  std::vector<Touching> touching;
  Visual visual;
  std::optional<Vec3> color;

  bool empty() const { return touching.empty() && visual.empty(); }
};

struct BodyLooks {
  ShapePtr shape;    // null: nothing touches
  VisualPtr visual;  // null: nothing is seen but the shape
};

class Shapes : LineMending {
 public:
  // Meshes are looked for from `file` on and in `packages` (import/find-mesh.h).
  Shapes(const std::string& file, const std::vector<std::string>& packages, Mending& mending)
      : LineMending(file, mending), packages_(packages) {}

  // The pieces of a link that has its frame at `part` in the body.  A <visual> that cannot be drawn
  // is mended.
  void add(const Link& link, const Pose& part, BodyPieces& pieces);
  // Meshes as their hulls; of scenery that is meshes alone, one of which is not convex, the ground
  // that they are.  Errors: UserError with the line.
  BodyLooks finish(BodyPieces pieces, bool scenery);

 private:
  std::string mesh_path(const Geometry& geometry) const;
  ShapePtr shape_of(const Geometry& geometry);
  template <class Make>
  auto at_its_line(const BodyPieces::Touching& touching, const Make& make) -> decltype(make());
  ShapePtr ground_of(const std::vector<BodyPieces::Touching>& all);
  VisualPart seen_part(const Piece& visual, const Pose& pose);

  const std::vector<std::string>& packages_;
  std::map<std::string, std::vector<Vec3>> points_;  // of mesh files
  std::map<std::tuple<std::string, double, double, double>, std::shared_ptr<const SurfaceMesh>>
      surfaces_;  // by file and scale
};

}  // namespace tw::urdf
