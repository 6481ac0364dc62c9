// The grain of what stands fixed: a noise that repeats itself without a seam.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl-api.h"

namespace tw {

inline constexpr int grain_side = 256;  // texels

// Rows of four bytes a texel: the value, its slopes along the row and across, all about 128, and
// 255.  The same on every machine.
std::vector<std::uint8_t> make_grain();

// As a texture with all its smaller versions, which repeats itself in both directions.
GLuint make_grain_texture(const GlApi& gl);

}  // namespace tw
