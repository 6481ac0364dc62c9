// Jacobi's sn, cn, dn and one shifted theta function, by theta series whose nome is at most e^-pi.
//
// Symbols: K, K' complete integrals of m and m1 = 1 - m; q = exp(-pi K'/K); x = pi u / (2K);
//   theta_j(z) = theta_j(z|q).  With v the argument of the series,
//     sn : cn : dn = theta_1(x) : theta_2(x) : theta_3(x), each times a constant, over theta_4(x).
//   The shifted function is i theta_1(x - i y), y = pi alpha / (2K), 0 <= alpha <= K'.
// For m > 1/2 the imaginary transformation z -> z/tau turns the series into hyperbolic ones in
// X = pi u / (2K') with the nome q' = exp(-pi K/K'); the larger of both cases is q = e^-pi = 0.043,
// so four terms reach rounding (q^9 = 5e-13, q^16 = 2e-22; with the factor q^-n of a shift: q^12).
// Everything is kept up to a common positive factor, so nothing overflows where K is large.
// Source: Whittaker & Watson, A Course of Modern Analysis, chapters 21 and 22 (21.51 for the
// transformation); DLMF chapter 20.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

namespace tw {

class JacobiTheta {
 public:
  // All but `turn` up to common positive factors (one for sn, cn, dn; another for re, im).
  struct Values {
    double sn, cn, dn;
    double re, im;  // i theta_1(x - i y) = factor (re + i im) e^{i turn}
    double turn;    // within +-pi/2
  };

  JacobiTheta() = default;
  // m, m1: parameter and complement, both given to full relative precision; 0 <= m < 1,
  // 1e-250 <= m1 <= 1.  alpha: the shift, in (0, K'], or infinity where m = 0.
  JacobiTheta(double m, double m1, double alpha);

  // The functions at u = 2 K x / pi; x any real number.
  Values at(double x) const { return hyperbolic_ ? hyperbolic(x) : trigonometric(x); }
  // K(m), real quarter period.
  double quarter_period() const { return k_; }

 private:
  void set_trigonometric(double alpha, double k_prime);
  void set_hyperbolic(double alpha, double k_prime);
  Values trigonometric(double x) const;
  Values hyperbolic(double x) const;

  static constexpr int terms = 4;
  double k_ = 0;
  double nome_ = 0;                       // q or q'
  double sn_ = 0, cn_ = 0, dn_ = 0;       // factors of the three series
  std::array<double, terms> shift_re_{};  // coefficients of the shifted theta_1
  std::array<double, terms> shift_im_{};
  double stretch_ = 0;  // K/K' where hyperbolic: X = stretch x
  double turn_ = 0;     // alpha/K' where hyperbolic: turn = turn_ x
  bool hyperbolic_ = false;
};

}  // namespace tw
