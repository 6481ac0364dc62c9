// RODAS4: a Rosenbrock method with six stages, order 4, an embedded solution of order 3, L-stable,
// stiffly accurate, with dense output of order 3.
//
// For y' = f(t, y), s = 1/(gamma h), J = df/dy(t0, y0):
//   (s I - J) U_i = f(t0 + alpha_i h, y0 + sum_j<i a_ij U_j) + sum_j<i (c_ij/h) U_j + gamma_i h
//   df/dt, y1 = y0 + sum_j a_6j U_j + U_6,  error estimate U_6  (a_5j = a_6j for j < 5, a_65 = 1),
//   y(t0 + r h) = (1-r) y0 + r (y1 + (1-r) (D3 + r D4)),  D3 = sum d2_j U_j,  D4 = sum d3_j U_j.
// Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., IV.7 and VI.4.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw::rodas4 {

constexpr int stages = 6;
constexpr double gamma = 0.25;
constexpr double alpha[stages] = {0, 0.386, 0.21, 0.63, 1, 1};
constexpr double gamma_i[stages] = {0.25, -0.1043, 0.1035, -0.0362, 0, 0};

constexpr double a[stages][stages - 1] = {
    {},
    {1.544},
    {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1}};

constexpr double c[stages][stages - 1] = {
    {},
    {-5.6688},
    {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136,
     -6.058818238834054}};

constexpr double d3[stages - 1] = {10.12623508344586, -7.487995877610167, -34.80091861555747,
                                   -7.992771707568823, 1.025137723295662};
constexpr double d4[stages - 1] = {-0.6762803392801253, 6.087714651680015, 16.43084320892478,
                                   24.76722511418386, -6.594389125716872};

}  // namespace tw::rodas4
