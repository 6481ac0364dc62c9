// What tests of squeezing, and of forces above the weight, press on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw::test {

inline constexpr double width = 0.2;  // m

}  // namespace tw::test
