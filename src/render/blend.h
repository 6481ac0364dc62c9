// Blending ink into a picture.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace tw {

// sRGB: red, green, blue.
using Ink = std::array<std::uint8_t, 3>;

inline constexpr Ink white_ink{255, 255, 255}, black_ink{0, 0, 0};

// channel <- channel + coverage (ink - channel), coverage 0..255
inline void blend(std::uint8_t* channel, int ink, int coverage) {
  const int value = *channel + ((ink - *channel) * coverage + (ink > *channel ? 127 : -127)) / 255;
  *channel = static_cast<std::uint8_t>(value);
}

inline void blend(std::uint8_t* pixel, const Ink& ink, int coverage) {
  for (std::size_t i = 0; i < 3; ++i) blend(pixel + i, ink[i], coverage);
}

}  // namespace tw
