// Cash and Karp's method of order 5(4), with dense output of order 4.
//
// The method has no polynomial of its own.  The cubic with the values and slopes at the ends errs
// by O(h^4); the slope f of its point at r = 1/4, an extra stage, is met by the quartic
//   F3 = (16/3) (h k - cubic'(1/4)),  cubic'(1/4) = (9/8) F0 + (3/16) h k_0 - (5/16) h k_end.
// (At r = 1/2 r^2 (1-r)^2 has no slope.)
//
// Source: J. R. Cash, A. H. Karp, ACM Transactions on Mathematical Software 16 (1990), 201-222.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/runge-kutta.h"

namespace tw {
namespace {

constexpr double b0 = 37.0 / 378, b2 = 250.0 / 621, b3 = 125.0 / 594, b5 = 512.0 / 1771;

// clang-format off
constexpr double c[] = {0, 0.2, 0.3, 0.6, 1, 0.875, 1, 0.25};

constexpr double a[] = {
    0.2,
    3.0 / 40, 9.0 / 40,
    0.3, -0.9, 1.2,
    -11.0 / 54, 2.5, -70.0 / 27, 35.0 / 27,
    1631.0 / 55296, 175.0 / 512, 575.0 / 13824, 44275.0 / 110592, 253.0 / 4096,
    // the end
    b0, 0, b2, b3, 0, b5,
    // the cubic at r = 1/4: 5/32 F0 + 9/64 h k_0 - 3/64 h k_end
    5.0 / 32 * b0 + 9.0 / 64, 0, 5.0 / 32 * b2, 5.0 / 32 * b3, 0, 5.0 / 32 * b5, -3.0 / 64,
};

constexpr double errors[] = {
    b0 - 2825.0 / 27648, 0, b2 - 18575.0 / 48384, b3 - 13525.0 / 55296, -277.0 / 14336, b5 - 0.25,
    0,
};

constexpr double dense[] = {
    -6 * b0 - 1, 0, -6 * b2, -6 * b3, 0, -6 * b5, 5.0 / 3, 16.0 / 3,
};
// clang-format on

}  // namespace

const RungeKutta cash_karp = {"Cash-Karp 5(4)", 5, 4, 5, 0.04, 6, 1, c, a, errors, dense};

}  // namespace tw
