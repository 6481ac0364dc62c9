// Meshes from files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/mesh-file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "base/error.h"
#include "import/assimp-file.h"
#include "import/bytes.h"

namespace tw {

namespace {

std::vector<Vec3> points_of(const std::vector<aiVector3D>& read) {
  std::vector<Vec3> points;
  for (const aiVector3D& p : read) points.emplace_back(p.x, p.y, p.z);
  return points;
}

}  // namespace

std::vector<Vec3> mesh_points(const std::string& file) {
  const auto prepare = [](Assimp::Importer&) { return unsigned{aiProcess_JoinIdenticalVertices}; };
  const auto take = [](const aiScene& scene) {
    std::vector<aiVector3D> points;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
      points.insert(points.end(), scene.mMeshes[m]->mVertices,
                    scene.mMeshes[m]->mVertices + scene.mMeshes[m]->mNumVertices);
    ByteWriter bytes;
    bytes.put(points);
    return bytes.take();
  };
  const std::vector<char> bytes = read_with_assimp(file, prepare, take);
  const std::vector<Vec3> points = points_of(ByteReader(bytes).get<aiVector3D>());
  TW_REQUIRE(points.size() >= 4, "the mesh " + file + " has " + std::to_string(points.size()) +
                                     " vertices; expected four or more, that span a volume");
  return points;
}

std::vector<NamedTriangles> mesh_triangles(const std::string& file) {
  const auto prepare = [](Assimp::Importer&) { return unsigned{aiProcess_Triangulate}; };
  const auto take = [](const aiScene& scene) {
    ByteWriter bytes;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene.mMeshes[m];
      std::vector<aiVector3D> corners;
      for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        if (mesh.mFaces[f].mNumIndices == 3)
          for (unsigned k = 0; k < 3; ++k)
            corners.push_back(mesh.mVertices[mesh.mFaces[f].mIndices[k]]);
      bytes.put(std::string(mesh.mName.C_Str()));
      bytes.put(corners);
    }
    return bytes.take();
  };
  const std::vector<char> bytes = read_with_assimp(file, prepare, take);
  std::vector<NamedTriangles> parts;
  for (ByteReader reader(bytes); !reader.at_end();) {
    NamedTriangles part;
    part.name = reader.get_text();
    part.corners = points_of(reader.get<aiVector3D>());
    if (!part.corners.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace tw
