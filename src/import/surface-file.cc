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
#include <cstdint>
#include <filesystem>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "import/assimp-file.h"
#include "import/bytes.h"
#include "import/solid-pieces.h"
#include "import/texture-file.h"

namespace tw {

namespace {

constexpr float sharp = 40;  // degrees
// Of textures: pixels a side, and fewer of those beyond so many bytes in all.
constexpr int large_texture = 2048, small_texture = 512;
constexpr std::size_t many_bytes = 64 << 20;

bool is_stl(const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix == ".stl";
}

// The colour of a material, where the file says one.
std::optional<Vec3> color_of(const aiMaterial& material) {
  aiColor4D color;
  aiString name;
  material.Get(AI_MATKEY_NAME, name);
  // Assimp's own, where the file has none
  if (name == aiString(AI_DEFAULT_MATERIAL_NAME)) return std::nullopt;
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) return std::nullopt;
  return Vec3(color.r, color.g, color.b).cwiseMax(0).cwiseMin(1);
}

// The surface of a scene, gathered from its meshes.
class Gathering {
 public:
  Gathering(const std::string& file, const aiScene& scene, const Mat3& place)
      : file_(file), scene_(scene), place_(place) {}

  void add(const aiMesh& mesh);

  SurfaceMesh surface;
  // of textures: what is wrong, and what is expected
  std::vector<std::pair<std::string, std::string>> faults;

 private:
  // Its number and that of the coordinates in it; -1: none.
  std::pair<std::int32_t, unsigned> texture_of(const aiMaterial& material);
  std::int32_t load_texture(const std::string& name);

  const std::string& file_;
  const aiScene& scene_;
  const Mat3& place_;
  std::map<std::string, std::int32_t> textures_;
};

std::int32_t Gathering::load_texture(const std::string& name) {
  const std::string what = "the texture " + name;
  std::size_t so_far = 0;
  for (const Texture& texture : surface.textures) so_far += texture.rgba.size();
  const int largest = so_far < many_bytes ? large_texture : small_texture;
  try {
    if (const aiTexture* inside = scene_.GetEmbeddedTexture(name.c_str())) {
      TW_REQUIRE(inside->mHeight == 0,
                 what + " lies in the mesh as bare pixels; expected a picture");
      surface.textures.push_back(decode_texture(
          {reinterpret_cast<const std::uint8_t*>(inside->pcData), inside->mWidth}, what, largest));
    } else {
      const std::optional<std::string> found = find_texture(file_, name);
      TW_REQUIRE(found, what + " is missing; expected it where the mesh says, beside it, or in " +
                            "materials/textures/ beside its folder");
      surface.textures.push_back(read_texture(*found, largest));
    }
  } catch (const UserError& error) {
    faults.push_back(Mending::halves(error));
    return -1;
  } catch (const std::bad_alloc&) {
    faults.emplace_back(what + " needs too much memory", "one of fewer pixels");
    return -1;
  }
  return static_cast<std::int32_t>(surface.textures.size()) - 1;
}

std::pair<std::int32_t, unsigned> Gathering::texture_of(const aiMaterial& material) {
  aiString name;
  unsigned coordinates = 0;
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name, nullptr, &coordinates) !=
      aiReturn_SUCCESS)
    return {-1, 0};
  const auto [found, fresh] = textures_.emplace(name.C_Str(), -1);
  if (fresh) found->second = load_texture(name.C_Str());
  return {found->second, coordinates};
}

void Gathering::add(const aiMesh& mesh) {
  if (!mesh.HasFaces() || !mesh.HasNormals()) return;
  const aiMaterial& material = *scene_.mMaterials[mesh.mMaterialIndex];
  auto [texture, coordinates] = texture_of(material);
  if (!mesh.HasTextureCoords(coordinates)) texture = -1;
  const bool mirrored = place_.determinant() < 0;
  const Mat3 turn = place_.inverse().transpose();  // of normals, but for their length
  const std::optional<Vec3> color =
      texture >= 0 ? std::optional<Vec3>(Vec3::Ones()) : color_of(material);
  surface.colored = surface.colored || color || mesh.HasVertexColors(0);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D &p = mesh.mVertices[v], &n = mesh.mNormals[v];
    const Vec3 normal = turn * Vec3(n.x, n.y, n.z);
    const double length = normal.norm();
    SurfaceMesh::Vertex vertex;
    vertex.position = (place_ * Vec3(p.x, p.y, p.z)).cast<float>();
    vertex.normal =
        (length > 0 && std::isfinite(length) ? Vec3(normal / length) : Vec3(Vec3::UnitZ()))
            .cast<float>();
    Vec3 own = color.value_or(Vec3(Vec3::Constant(0.8)));
    if (mesh.HasVertexColors(0)) {
      const aiColor4D& c = mesh.mColors[0][v];
      own = Vec3(c.r, c.g, c.b).cwiseMax(0).cwiseMin(1);
    }
    vertex.color = own.cast<float>();
    if (texture >= 0) {
      // Assimp counts from below
      const aiVector3D& at = mesh.mTextureCoords[coordinates][v];
      if (std::isfinite(at.x) && std::isfinite(at.y)) vertex.place = {at.x, 1 - at.y};
    }
    surface.vertices.push_back(vertex);
  }
  const auto before = static_cast<std::uint32_t>(surface.indices.size());
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::uint32_t corner[3];
    for (unsigned k = 0; k < 3; ++k) corner[k] = first + face.mIndices[k];
    if (mirrored) std::swap(corner[1], corner[2]);
    surface.indices.insert(surface.indices.end(), corner, corner + 3);
  }
  const auto count = static_cast<std::uint32_t>(surface.indices.size()) - before;
  if (count > 0) surface.patches.push_back({before, count, texture});
}

// Whether it is closed by its places: corners may have several normals.
bool closes_by_places(const SurfaceMesh& surface) {
  using Place = std::array<float, 3>;
  std::vector<Place> places;
  for (const SurfaceMesh::Vertex& v : surface.vertices)
    places.push_back({v.position.x(), v.position.y(), v.position.z()});
  std::vector<Place> sorted = places;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto number = [&](std::uint32_t vertex) {
    return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), places[vertex]) -
                                    sorted.begin());
  };
  std::vector<std::array<std::size_t, 3>> triangles;
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3)
    triangles.push_back({number(surface.indices[i]), number(surface.indices[i + 1]),
                         number(surface.indices[i + 2])});
  return is_closed(triangles);
}

// ---- between the processes ----

// The numbers of a vertex, one part after the other.
template <class Vertex, class Visit>
void each_part(Vertex& v, const Visit& visit) {
  visit(v.position.data(), v.position.size());
  visit(v.normal.data(), v.normal.size());
  visit(v.color.data(), v.color.size());
  visit(v.place.data(), v.place.size());
}
constexpr std::size_t numbers_of_vertex = 11;

std::vector<char> packed(const Gathering& gathered) {
  const SurfaceMesh& surface = gathered.surface;
  ByteWriter bytes;
  std::vector<float> numbers;
  for (const SurfaceMesh::Vertex& v : surface.vertices)
    each_part(v, [&](const float* part, Eigen::Index count) {
      numbers.insert(numbers.end(), part, part + count);
    });
  bytes.put(numbers);
  bytes.put(surface.indices);
  bytes.put(surface.patches);
  bytes.put(std::vector<std::uint8_t>{surface.colored, surface.closed});
  bytes.put(std::vector<std::uint64_t>{surface.textures.size(), gathered.faults.size()});
  for (const Texture& texture : surface.textures) {
    bytes.put(std::vector<int>{texture.width, texture.height});
    bytes.put(texture.rgba);
  }
  for (const auto& [wrong, expected] : gathered.faults) {
    bytes.put(wrong);
    bytes.put(expected);
  }
  return bytes.take();
}

SurfaceMesh unpacked(const std::vector<char>& bytes, const std::string& where, Mending& mending) {
  ByteReader reader(bytes);
  SurfaceMesh surface;
  const std::vector<float> numbers = reader.get<float>();
  surface.vertices.resize(numbers.size() / numbers_of_vertex);
  const float* next = numbers.data();
  for (SurfaceMesh::Vertex& v : surface.vertices)
    each_part(v, [&](float* part, Eigen::Index count) {
      std::copy_n(next, count, part);
      next += count;
    });
  surface.indices = reader.get<std::uint32_t>();
  surface.patches = reader.get<SurfaceMesh::Patch>();
  const std::vector<std::uint8_t> flags = reader.get<std::uint8_t>();
  surface.colored = flags.at(0);
  surface.closed = flags.at(1);
  const std::vector<std::uint64_t> counts = reader.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < counts.at(0); ++i) {
    const std::vector<int> size = reader.get<int>();
    surface.textures.push_back({size.at(0), size.at(1), reader.get<std::uint8_t>()});
  }
  for (std::uint64_t i = 0; i < counts.at(1); ++i) {
    const std::string wrong = reader.get_text();
    mending.mend(where, wrong, "the colour of its material is drawn", reader.get_text());
  }
  return surface;
}

}  // namespace

std::shared_ptr<const SurfaceMesh> read_surface(const std::string& file, const Vec3& scale,
                                                bool y_up, Mending& mending) {
  Mat3 place = scale.asDiagonal();
  if (y_up) place = place * (Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
  const auto prepare = [&](Assimp::Importer& importer) {
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, sharp);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                     aiProcess_TransformUVCoords | aiProcess_JoinIdenticalVertices;
    if (!is_stl(file)) return steps;
    // its normals are those of its facets
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS);
    return steps | aiProcess_RemoveComponent;
  };
  const auto take = [&](const aiScene& scene) {
    Gathering gathered(file, scene, place);
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) gathered.add(*scene.mMeshes[m]);
    gathered.surface.closed = closes_by_places(gathered.surface);
    return packed(gathered);
  };
  auto surface = std::make_shared<SurfaceMesh>(
      unpacked(read_with_assimp(file, prepare, take), "the mesh " + file + ": ", mending));
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
