// Pictures as PNG.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "render/image.h"

namespace tw {

// The bytes of a PNG file.  Compression is light: a sixth of the time of libpng's default for a
// twelfth more bytes.
std::vector<std::uint8_t> encode_png(const Image& image);

}  // namespace tw
