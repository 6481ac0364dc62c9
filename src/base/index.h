// Numbers of things are int; vectors count in std::size_t.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>

namespace tw {

inline std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace tw
