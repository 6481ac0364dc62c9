// Finding and decoding textures.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/texture-file.h"

#include <stb_image.h>
#include <stb_image_resize.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "base/error.h"

namespace tw {

namespace {

constexpr int most_pixels = 8192;                  // a side, that are decoded
constexpr std::uintmax_t most_bytes = 256u << 20;  // of a file

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

Texture decode_texture(std::span<const std::uint8_t> bytes, const std::string& what, int largest) {
  int width = 0, height = 0, channels = 0;
  const auto size = static_cast<int>(bytes.size());
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
    TW_REQUIRE(width <= most_pixels && height <= most_pixels,
               what + " has " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels; expected at most " + std::to_string(most_pixels) + " a side");
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), &stbi_image_free);
  TW_REQUIRE(pixels, what + " cannot be read: " + stbi_failure_reason() +
                         "; expected a PNG, JPEG, TGA or BMP file");
  const int larger = std::max(width, height);
  const auto fit = [&](int side) {
    if (larger <= largest) return side;
    return std::max(1, static_cast<int>(std::lround(double(side) * largest / larger)));
  };
  Texture texture{fit(width), fit(height), {}};
  texture.rgba.resize(bytes_of(texture.width, texture.height));
  if (larger <= largest)
    std::copy_n(pixels.get(), texture.rgba.size(), texture.rgba.begin());
  else
    TW_REQUIRE(stbir_resize_uint8_srgb(pixels.get(), width, height, 0, texture.rgba.data(),
                                       texture.width, texture.height, 0, 4, 3, 0),
               what + " cannot be made smaller; expected one of fewer pixels");
  // alpha that means nothing
  bool seen = false;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) seen = seen || texture.rgba[i] >= 128;
  for (std::size_t i = 3; i < texture.rgba.size() && !seen; i += 4) texture.rgba[i] = 255;
  return texture;
}

Texture read_texture(const std::string& file, int largest) {
  const std::string what = "the texture " + file;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  TW_REQUIRE(!error && size <= most_bytes,
             what + " cannot be read; expected a file of at most 256 MB");
  std::vector<char> bytes(static_cast<std::size_t>(size));
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  return decode_texture(
      {reinterpret_cast<const std::uint8_t*>(bytes.data()), static_cast<std::size_t>(in.gcount())},
      what, largest);
}

}  // namespace tw
