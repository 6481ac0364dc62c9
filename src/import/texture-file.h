// Pictures that lie on surfaces, by stb_image: PNG, JPEG, TGA, BMP and others.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "geometry/visual.h"

namespace tw {

// The file of the texture that a mesh file names: as it says, from the folder of that; or of that
// name in this folder, or in materials/textures/ beside this folder, where robots have theirs.
std::optional<std::string> find_texture(const std::string& mesh_file, const std::string& name);

// No more than `largest` pixels wide and high: what is larger is made smaller.  What would not be
// seen at all is opaque.  Errors (UserError), by the picture's name `what`: it cannot be read, or
// has more than 8192 pixels a side.
Texture decode_texture(std::span<const std::uint8_t> bytes, const std::string& what, int largest);
Texture read_texture(const std::string& file, int largest);

}  // namespace tw
