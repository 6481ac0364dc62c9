// The time of what does not happen.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>

namespace tw {

inline constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace tw
