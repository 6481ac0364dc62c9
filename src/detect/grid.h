// The grid of collision checks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Checks of pairs that are not predicted exactly happen at multiples of this, s (2^-20).
inline constexpr double check_grid = 0x1p-20;

}  // namespace tw
