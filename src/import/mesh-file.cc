// Meshes from files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/mesh-file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <filesystem>

#include "base/error.h"

namespace tw {

std::vector<Vec3> mesh_points(const std::string& file) {
  std::error_code ignored;
  TW_REQUIRE(std::filesystem::is_regular_file(file, ignored),
             "the mesh " + file + " is missing; expected a file that can be read");
  Assimp::Importer importer;
  // the axes are the file's own
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene =
      importer.ReadFile(file, aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices);
  TW_REQUIRE(scene, "the mesh " + file + " cannot be read: " + importer.GetErrorString() +
                        "; expected an STL, OBJ or Collada file");
  std::vector<Vec3> points;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m)
    for (unsigned v = 0; v < scene->mMeshes[m]->mNumVertices; ++v) {
      const aiVector3D& p = scene->mMeshes[m]->mVertices[v];
      points.emplace_back(p.x, p.y, p.z);
    }
  TW_REQUIRE(points.size() >= 4, "the mesh " + file + " has " + std::to_string(points.size()) +
                                     " vertices; expected four or more, that span a volume");
  return points;
}

}  // namespace tw
