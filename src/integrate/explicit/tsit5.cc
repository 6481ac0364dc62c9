// Tsitouras' method of order 5(4), with dense output of order 4.
//
// Source: Ch. Tsitouras, Runge-Kutta pairs of order 5(4) satisfying only the first column
// simplifying assumption, Computers & Mathematics with Applications 62 (2011), 770-775.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/runge-kutta.h"

namespace tw {
namespace {

constexpr double c[] = {0, 0.161, 0.327, 0.9, 0.9800255409045097, 1, 1};

constexpr double a32 = 0.3354806554923570;
constexpr double a42 = -6.359448489975075, a43 = 4.362295432869581;
constexpr double a52 = -11.74888356406283, a53 = 7.495539342889836, a54 = -0.09249506636175525;
constexpr double a62 = -12.92096931784711, a63 = 8.159367898576159, a64 = -0.07158497328140100,
                 a65 = -0.02826905039406838;

// clang-format off
constexpr double a[] = {
    // rows sum to c
    c[1],
    c[2] - a32, a32,
    c[3] - a42 - a43, a42, a43,
    c[4] - a52 - a53 - a54, a52, a53, a54,
    c[5] - a62 - a63 - a64 - a65, a62, a63, a64, a65,
    // the end
    0.09646076681806523, 0.01, 0.4798896504144996, 1.379008574103742, -3.290069515436081,
    2.324710524099774,
};

constexpr double errors[] = {
    0.001780011052226, 0.000816434459657, -0.007880878010262, 0.144711007173263,
    -0.582357165452555, 0.458082105929187, -1.0 / 66,
};

// F3: the fourth powers of b_i(r)
constexpr double dense[] = {
    -1.0530884977290216, 0.1017, 2.490627285651252793, -16.54810288924490272,
    47.37952196281928122, -34.87065786149660974, 2.5,
};
// clang-format on

}  // namespace

const RungeKutta tsit5 = {"Tsitouras 5(4)", 5, 4, 5, 0.04, 6, 0, c, a, errors, dense};

}  // namespace tw
