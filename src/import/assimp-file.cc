// Files that Assimp reads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/assimp-file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <filesystem>
#include <new>

#include "base/error.h"
#include "import/bounded-process.h"

namespace tw {

std::vector<char> read_with_assimp(const std::string& file,
                                   const std::function<unsigned(Assimp::Importer&)>& prepare,
                                   const std::function<std::vector<char>(const aiScene&)>& take) {
  std::error_code ignored;
  TW_REQUIRE(std::filesystem::is_regular_file(file, ignored),
             "the mesh " + file + " is missing; expected a file that can be read");
  const std::uint64_t size = std::filesystem::file_size(file, ignored);
  const Bounds bounds{.memory = (std::uint64_t{1} << 30) + 100 * size, .seconds = 120};
  return done_within(bounds, "the mesh " + file, [&] {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    const unsigned steps = prepare(importer);
    const aiScene* scene = importer.ReadFile(file, steps | aiProcess_PreTransformVertices);
    // it catches that
    if (!scene && std::string(importer.GetErrorString()).find("bad_alloc") != std::string::npos)
      throw std::bad_alloc();
    TW_REQUIRE(scene, "the mesh " + file + " cannot be read: " + importer.GetErrorString() +
                          "; expected an STL, OBJ or Collada file");
    return take(*scene);
  });
}

}  // namespace tw
