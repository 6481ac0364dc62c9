// Finding and decoding textures.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/texture-file.h"

#include <stb_image.h>
#include <stb_image_resize.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "base/error.h"

namespace tw {

namespace {

constexpr int largest = 2048;  // pixels

std::size_t bytes_of(int width, int height) {
  return 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

std::optional<std::string> find_texture(const std::string& mesh_file, const std::string& name) {
  namespace fs = std::filesystem;
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  const fs::path named = slashed, folder = fs::path(mesh_file).parent_path();
  for (const fs::path& place : {folder / named, folder / named.filename(),
                                folder / ".." / "materials" / "textures" / named.filename()}) {
    std::error_code ignored;
    if (fs::is_regular_file(place, ignored)) return place.string();
  }
  return std::nullopt;
}

Texture decode_texture(std::span<const std::uint8_t> bytes, const std::string& what) {
  TW_REQUIRE(bytes.size() <= std::size_t{1} << 30, what + " is larger than a gigabyte");
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height,
                            &channels, 4),
      &stbi_image_free);
  TW_REQUIRE(pixels, what + " cannot be read: " + stbi_failure_reason() +
                         "; expected a PNG, JPEG, TGA or BMP file");
  const int larger = std::max(width, height);
  const auto fit = [&](int side) {
    if (larger <= largest) return side;
    return std::max(1, static_cast<int>(std::lround(double(side) * largest / larger)));
  };
  Texture texture{fit(width), fit(height), {}};
  if (larger <= largest) {
    texture.rgba.assign(pixels.get(), pixels.get() + bytes_of(width, height));
    return texture;
  }
  texture.rgba.resize(bytes_of(texture.width, texture.height));
  TW_REQUIRE(stbir_resize_uint8_srgb(pixels.get(), width, height, 0, texture.rgba.data(),
                                     texture.width, texture.height, 0, 4, 3, 0),
             what + " cannot be made smaller; expected one of at most 2048 pixels a side");
  return texture;
}

Texture read_texture(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  return decode_texture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
                        "the texture " + file);
}

}  // namespace tw
