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

namespace {

const aiScene& read_scene(Assimp::Importer& importer, const std::string& file, unsigned steps) {
  std::error_code ignored;
  TW_REQUIRE(std::filesystem::is_regular_file(file, ignored),
             "the mesh " + file + " is missing; expected a file that can be read");
  // the axes are the file's own
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file, steps | aiProcess_PreTransformVertices);
  TW_REQUIRE(scene, "the mesh " + file + " cannot be read: " + importer.GetErrorString() +
                        "; expected an STL, OBJ or Collada file");
  return *scene;
}

Vec3 from(const aiVector3D& p) { return {p.x, p.y, p.z}; }

}  // namespace

std::vector<Vec3> mesh_points(const std::string& file) {
  Assimp::Importer importer;
  const aiScene& scene = read_scene(importer, file, aiProcess_JoinIdenticalVertices);
  std::vector<Vec3> points;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned v = 0; v < scene.mMeshes[m]->mNumVertices; ++v)
      points.push_back(from(scene.mMeshes[m]->mVertices[v]));
  TW_REQUIRE(points.size() >= 4, "the mesh " + file + " has " + std::to_string(points.size()) +
                                     " vertices; expected four or more, that span a volume");
  return points;
}

std::vector<NamedTriangles> mesh_triangles(const std::string& file) {
  Assimp::Importer importer;
  const aiScene& scene = read_scene(importer, file, aiProcess_Triangulate);
  std::vector<NamedTriangles> parts;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    NamedTriangles part{mesh.mName.C_Str(), {}};
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      if (mesh.mFaces[f].mNumIndices == 3)
        for (unsigned k = 0; k < 3; ++k)
          part.corners.push_back(from(mesh.mVertices[mesh.mFaces[f].mIndices[k]]));
    if (!part.corners.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace tw
