// Solids and ground from mesh files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/mesh-faces.h"
#include "geometry/shape.h"
#include "import/mending.h"

namespace tw {

struct SolidOptions {
  Vec3 scale = Vec3::Ones();  // metres in a unit of the file
  bool hulls = false;         // the hull of what is not convex is wanted all the same
  bool y_up = false;          // the file's y is up: it becomes z, and its z becomes -y
  // what is not convex is to be decomposed, into pieces of surfaces of so many triangles; 0: not
  std::size_t decompose = 0;
};

// The shape of an OBJ file (coordinates as they are written) or of any other that Assimp reads, STL
// among them: a hull, or the union of the hulls of what hangs together in it by common vertices,
// object by object in the file's order.  Parts that are flat are mended: left out.  What is
// decomposed (import/convex-pieces.h) is told, with the change of its volume; surfaces in others
// that face inwards are their cavities then, and holes are mended: closed.
//
// Errors: UserError, with the file's name, where it is missing, is no mesh, or is flat as a whole;
// and with the name of the object where one is not convex, by more than 1e-4 of its size, and
// neither hulls nor decomposition are wanted.
ShapePtr read_solid(const std::string& file, const SolidOptions& options, Mending& mending);

struct NamedShape {
  std::string name;
  ShapePtr shape;
};

// The same, object by object, with the names of the file: each the union of the hulls of what hangs
// together in it.  Of a file with a single object each part that hangs together is one.  Names that
// come twice have numbers, as in wall, wall-2.  Flat ones are mended: left out.
std::vector<NamedShape> read_objects(const std::string& file, const SolidOptions& options,
                                     Mending& mending);

// The triangles of mesh files as ground, however concave (geometry/mesh-ground.h): all objects of
// all files in one.
//
// Errors: UserError, with the file's name, where it is missing, is no mesh, or has no triangles.
class GroundReader {
 public:
  explicit GroundReader(Mending& mending) : mending_(mending) {}

  // Of the options `hulls` says nothing.  `pose`: of the file's frame in the shape's.
  void add(const std::string& file, const SolidOptions& options, const Pose& pose = {});
  // Whether each of the files is closed and as its hull, to 1e-4 of the volume.
  bool is_convex() const;
  // What is wrong with triangles is mended.
  ShapePtr shape();

 private:
  struct File {
    std::string name;
    std::size_t end;  // of its triangles
  };

  Mending& mending_;
  std::vector<File> files_;
  std::vector<Vec3> points_;
  std::vector<MeshTriangle> triangles_;
};

// Tells what was wrong with triangles; `where` begins each sentence.
void mend_triangles(const std::string& where, const MeshFaults& faults, Mending& mending);

}  // namespace tw
