// What is seen of mesh files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/surface-file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "import/assimp-file.h"
#include "import/bytes.h"

namespace tw {

namespace {

constexpr float sharp = 40;  // degrees

bool is_stl(const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix == ".stl";
}

// The colour of a mesh, where it has one.
std::optional<Vec3> color_of(const aiMaterial& material) {
  aiColor4D color;
  aiString name;
  material.Get(AI_MATKEY_NAME, name);
  // Assimp's own, where the file has none
  if (name == aiString(AI_DEFAULT_MATERIAL_NAME)) return std::nullopt;
  if (material.GetTextureCount(aiTextureType_DIFFUSE) > 0) return Vec3(Vec3::Ones());
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) return std::nullopt;
  return Vec3(color.r, color.g, color.b).cwiseMax(0).cwiseMin(1);
}

void add_mesh(const aiMesh& mesh, const aiMaterial& material, const Mat3& place,
              SurfaceMesh& surface) {
  if (!mesh.HasFaces() || !mesh.HasNormals()) return;
  const bool mirrored = place.determinant() < 0;
  const Mat3 turn = place.inverse().transpose();  // of normals, but for their length
  const std::optional<Vec3> color = color_of(material);
  surface.colored = surface.colored || color || mesh.HasVertexColors(0);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D &p = mesh.mVertices[v], &n = mesh.mNormals[v];
    const Vec3 normal = turn * Vec3(n.x, n.y, n.z);
    const double length = normal.norm();
    SurfaceMesh::Vertex vertex;
    vertex.position = (place * Vec3(p.x, p.y, p.z)).cast<float>();
    vertex.normal =
        (length > 0 && std::isfinite(length) ? Vec3(normal / length) : Vec3(Vec3::UnitZ()))
            .cast<float>();
    Vec3 own = color.value_or(Vec3(Vec3::Constant(0.8)));
    if (mesh.HasVertexColors(0)) {
      const aiColor4D& c = mesh.mColors[0][v];
      own = Vec3(c.r, c.g, c.b).cwiseMax(0).cwiseMin(1);
    }
    vertex.color = own.cast<float>();
    surface.vertices.push_back(vertex);
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::uint32_t corner[3];
    for (unsigned k = 0; k < 3; ++k) corner[k] = first + face.mIndices[k];
    if (mirrored) std::swap(corner[1], corner[2]);
    surface.indices.insert(surface.indices.end(), corner, corner + 3);
  }
}

// Whether each edge of a triangle is, the other way round, that of another: by places, for corners
// may have several normals.
bool is_closed(const SurfaceMesh& surface) {
  using Place = std::array<float, 3>;
  std::vector<Place> places;
  for (const SurfaceMesh::Vertex& v : surface.vertices)
    places.push_back({v.position.x(), v.position.y(), v.position.z()});
  std::vector<Place> sorted = places;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto number = [&](std::uint32_t vertex) {
    return static_cast<std::uint64_t>(
        std::lower_bound(sorted.begin(), sorted.end(), places[vertex]) - sorted.begin());
  };
  std::vector<std::uint64_t> edges, reversed;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = number(surface.indices[i + k]);
      const std::uint64_t b = number(surface.indices[i + (k + 1) % 3]);
      if (a == b) continue;
      edges.push_back(a << 32 | b);
      reversed.push_back(b << 32 | a);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed;
}

// What is no closed surface is seen from behind, too.
void add_back_sides(SurfaceMesh& surface) {
  const auto count = static_cast<std::uint32_t>(surface.vertices.size());
  for (std::uint32_t v = 0; v < count; ++v) {
    SurfaceMesh::Vertex back = surface.vertices[v];
    back.normal = -back.normal;
    surface.vertices.push_back(back);
  }
  const std::size_t corners = surface.indices.size();
  for (std::size_t i = 0; i + 2 < corners; i += 3)
    for (const std::size_t k : {i, i + 2, i + 1})
      surface.indices.push_back(count + surface.indices[k]);
}

}  // namespace

std::shared_ptr<const SurfaceMesh> read_surface(const std::string& file, const Vec3& scale,
                                                bool y_up) {
  Mat3 place = scale.asDiagonal();
  if (y_up) place = place * (Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
  const auto prepare = [&](Assimp::Importer& importer) {
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, sharp);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                     aiProcess_JoinIdenticalVertices;
    if (!is_stl(file)) return steps;
    // its normals are those of its facets
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS);
    return steps | aiProcess_RemoveComponent;
  };
  const auto take = [&](const aiScene& scene) {
    SurfaceMesh surface;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
      add_mesh(*scene.mMeshes[m], *scene.mMaterials[scene.mMeshes[m]->mMaterialIndex], place,
               surface);
    if (!is_closed(surface)) add_back_sides(surface);
    ByteWriter bytes;
    std::vector<float> numbers;
    for (const SurfaceMesh::Vertex& v : surface.vertices)
      for (const Eigen::Vector3f* part : {&v.position, &v.normal, &v.color})
        numbers.insert(numbers.end(), part->data(), part->data() + 3);
    bytes.put(numbers);
    bytes.put(surface.indices);
    bytes.put(std::vector<char>(surface.colored ? 1 : 0));
    return bytes.take();
  };
  const std::vector<char> bytes = read_with_assimp(file, prepare, take);
  ByteReader reader(bytes);
  auto surface = std::make_shared<SurfaceMesh>();
  const std::vector<float> numbers = reader.get<float>();
  surface->vertices.resize(numbers.size() / 9);
  const float* next = numbers.data();
  for (SurfaceMesh::Vertex& v : surface->vertices)
    for (Eigen::Vector3f* part : {&v.position, &v.normal, &v.color}) {
      *part = Eigen::Map<const Eigen::Vector3f>(next);
      next += 3;
    }
  surface->indices = reader.get<std::uint32_t>();
  surface->colored = !reader.get<char>().empty();
  for (const SurfaceMesh::Vertex& vertex : surface->vertices) {
    const Vec3 point = vertex.position.cast<double>();
    TW_REQUIRE(is_finite(point),
               "the mesh " + file + " has a vertex that is not finite; expected numbers");
    surface->bounds.add(point);
    surface->radius = std::max(surface->radius, point.norm());
  }
  TW_REQUIRE(!surface->indices.empty(),
             "the mesh " + file + " has no triangles; expected some that can be seen");
  return surface;
}

}  // namespace tw
