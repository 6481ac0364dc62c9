// Torque-free rotation of a rigid body in closed form.
//
// The turn phi.  In Euler angles about n and the axis a, phi = psi + chi with
//   psi' = L (n_b^2/I_b + n_c^2/I_c) / (n_b^2 + n_c^2),   chi = arg(C cn u -+ i |B| sn u),
// the signs for I_a largest and least.  psi is an elliptic integral of the third kind: a mean rate
// times t plus the argument of theta_1(x - i y); its pole is at sc(alpha|m1) = C / (A sqrt m).
// Both arguments circulate, against each other; with what is left of the rate
//   phi = Phi t +- arg[ i theta_1(x - i y) (C cn u - i |B| sn u) ],  x, y = pi (u, alpha) / (2K),
// the last periodic and within +-pi/2, and Phi the mean of psi' in the chart about the axis c,
//   Phi = L <(n_a^2/I_a + n_b^2/I_b) / (n_a^2 + n_b^2)>,
// a complete integral all of whose terms are positive (Bulirsch's cel): nothing cancels for any
// ratio of moments.
//
// Invariants, over L^2, as sums without cancellation:
//   2E I_a - L^2 : sum n_i^2 (I_a - I_i) / I_i,   L^2 - 2E I_c : sum n_i^2 (I_i - I_c) / I_i.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/free-rotation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "math/elliptic.h"

namespace tw {
namespace {

// Moments this close (relative) are equal: 4 roundings.  A wider tolerance shows in the attitude
// (1e-12 costs 2e-12 rad in 10 s), and the tri-axial formulae need none.
constexpr double same_moment = 4.0 * std::numeric_limits<double>::epsilon();

// Components of n below this are zero: their squares, products and the complementary parameter
// stay normal numbers.  A body that spins about its middle axis would need 230 e-foldings to
// show it.
constexpr double negligible = 1e-100;

// The complementary parameter is a difference near the separatrix, known to about 1e-16 of its
// terms.  This far below, its value is arbitrary; it only must not vanish (infinite period).
constexpr double least_relative_m1 = 1e-20;

// Bounds on |w| are widened by this, so that rounding in w(t) stays inside.
constexpr double rounding_margin = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();

bool same(double a, double b) { return std::abs(a - b) <= same_moment * std::max(a, b); }

// The angle/2 of (x, y), |angle| < pi, as an unnormalised direction of length^2 2 r (r + x).
std::pair<double, double> half_angle(double x, double y) {
  return {std::sqrt(x * x + y * y) + x, y};
}

}  // namespace

struct FreeRotation::Orbit {
  Eigen::Index a = 0, b = 1, c = 2;
  double Ia, Ib, Ic;
  double order;       // sign of I_a - I_b
  double A2, B2, C2;  // squared amplitudes of n_a, n_b, n_c
  double m, m1;       // parameter and complement
  double lambda;      // du/dt over |L|

  Orbit(const Vec3& moments, const Vec3& n);
  double shift() const;
  double mean_turn_rate(double quarter_period) const;
};

FreeRotation::Orbit::Orbit(const Vec3& moments, const Vec3& n) {
  // by moment, the largest first
  if (moments[a] < moments[b]) std::swap(a, b);
  if (moments[b] < moments[c]) std::swap(b, c);
  if (moments[a] < moments[b]) std::swap(a, b);
  const Vec3 weight = n.cwiseProduct(n).cwiseQuotient(moments);
  const double upper = weight[a] * (moments[a] - moments[b]);
  const double lower = weight[c] * (moments[b] - moments[c]);
  // (L^2 - 2E I_b) / L^2 = upper - lower tells the axis of circulation
  order = upper < lower ? -1.0 : 1.0;
  if (order < 0) std::swap(a, c);
  Ia = moments[a];
  Ib = moments[b];
  Ic = moments[c];
  const double ab = order * (Ia - Ib);
  const double ac = order * (Ia - Ic);
  const double bc = order * (Ib - Ic);
  const double outer = weight[b] * ab + weight[c] * ac;  // +-(2E I_a - L^2) / L^2
  const double inner = weight[a] * ac + weight[b] * bc;  // +-(L^2 - 2E I_c) / L^2
  A2 = Ia * inner / ac;
  B2 = Ib * outer / ab;
  C2 = Ic * outer / ac;
  m = bc * outer / (ab * inner);
  const double saddle = std::max(std::abs(upper - lower), least_relative_m1 * (upper + lower));
  m1 = std::min(1.0, ac * saddle / (ab * inner));
  lambda = std::sqrt(ab * inner / (Ia * Ib * Ic));
}

// alpha with sc(alpha|m1) = C / (A sqrt m), as R_F
double FreeRotation::Orbit::shift() const {
  const double am = A2 * m;
  return std::sqrt(C2) * carlson_rf(am, m, C2 + am);
}

// Phi / L, with n_a^2 : n_b^2 = A^2 (cos^2 + m1 sin^2) : B^2 sin^2
double FreeRotation::Orbit::mean_turn_rate(double quarter_period) const {
  const double ratio = B2 / A2;
  return elliptic_cel(std::sqrt(m1), m1 + ratio, 1.0 / Ia, m1 / Ia + ratio / Ib) / quarter_period;
}

FreeRotation::FreeRotation(const Vec3& moments, const Quat& q_WB, const Vec3& L_W)
    : base_(q_WB.normalized()) {
  const double momentum = scaled_norm(L_W);
  if (momentum == 0) return;
  if (same(moments.x(), moments.y()) && same(moments.y(), moments.z())) {
    set_uniform(L_W / moments.x());
    return;
  }
  const Vec3 n = (base_.conjugate() * (L_W / momentum)).normalized();
  speeds_ = momentum * moments.cwiseInverse();
  Eigen::Index axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const double across = std::max(std::abs(n[(axis + 1) % 3]), std::abs(n[(axis + 2) % 3]));
  if (across < negligible) {
    set_uniform(L_W / moments[axis]);
    return;
  }
  kind_ = Kind::triaxial;
  for (Eigen::Index i = 0; i < 3; ++i)
    if (same(moments[(i + 1) % 3], moments[(i + 2) % 3])) set_axisymmetric(n, i);
  if (kind_ == Kind::triaxial) set_triaxial(n, momentum, moments);
  set_base(q_WB);
}

void FreeRotation::set_uniform(const Vec3& w_W) {
  kind_ = Kind::uniform;
  speeds_ = w_W;
  max_angular_speed_ = scaled_norm(w_W);
  half_turn_rate_ = 0.5 * max_angular_speed_;
  // the axis of rotation
  amplitudes_ = w_W / max_angular_speed_;
}

void FreeRotation::set_axes(Eigen::Index axis, double n_axis) {
  for (std::size_t i = 0; i < 3; ++i)
    axes_[i] = static_cast<unsigned char>((static_cast<std::size_t>(axis) + i) % 3);
  side_ = n_axis < 0 ? -1 : 1;
}

// I_j = I_k = I: n_a constant, n_j + i n_k turns at (I_a - I) w_a / I, phi' constant.
void FreeRotation::set_axisymmetric(const Vec3& n, Eigen::Index a) {
  kind_ = Kind::axisymmetric;
  const Eigen::Index j = (a + 1) % 3;
  const Eigen::Index k = (a + 2) % 3;
  set_axes(a, n[a]);
  amplitudes_ = n;
  const double across2 = n[j] * n[j] + n[k] * n[k];
  // (I_a - I) w_a / I = n_a (L/I - L/I_a)
  phase_rate_ = n[a] * (speeds_[j] - speeds_[a]);
  // 2E/L + s w_a = s n_a (1 + s n_a) L/I_a + (1 - n_a^2) L/I
  const double up = std::abs(n[a]);
  half_turn_rate_ = 0.5 * (up * speeds_[a] + across2 / (1.0 + up) * speeds_[j]);
  max_angular_speed_ =
      std::hypot(std::sqrt(across2) * speeds_[j], up * speeds_[a]) * rounding_margin;
  // w precesses
  max_angular_acceleration_ =
      std::abs(phase_rate_ * speeds_[j]) * std::sqrt(across2) * rounding_margin;
}

void FreeRotation::set_triaxial(const Vec3& n, double momentum, const Vec3& moments) {
  const Orbit o(moments, n);
  set_axes(o.a, n[o.a]);
  middle_is_j_ = axes_[1] == o.b;
  order_ = o.order > 0 ? 1 : -1;
  // Euler's equations fix the sign of B: -(cyclic order of a, b, c) s (order of moments)
  const double b_side = (middle_is_j_ ? -1.0 : 1.0) * side_ * o.order;
  amplitudes_ = Vec3(side_ * std::sqrt(o.A2), b_side * std::sqrt(o.B2), std::sqrt(o.C2));

  theta_ = JacobiTheta(o.m, o.m1, o.shift());
  const double x_per_u = 0.5 * pi / theta_.quarter_period();
  phase_rate_ = momentum * o.lambda * x_per_u;
  half_turn_rate_ = 0.5 * momentum * o.mean_turn_rate(theta_.quarter_period());

  // u0 from sn, cn, dn at the start: u = sn R_F(cn^2, dn^2, 1) for cn >= 0, else 2K less that
  const double sn = n[o.b] / amplitudes_[1];
  const double cn = n[o.c] / amplitudes_[2];
  const double dn = n[o.a] / amplitudes_[0];
  const double sum = sn * sn + cn * cn;
  const double x0 = x_per_u * sn * carlson_rf(cn * cn, dn * dn * sum, sum);
  phase_ = cn < 0 ? pi - x0 : x0;

  // |w|^2 is linear in sn^2: the largest of its two ends
  const Vec3& r = amplitudes_;
  const double at_zero = std::hypot(r[0] * speeds_[o.a], r[2] * speeds_[o.c]);
  const double at_one = std::hypot(std::sqrt(o.m1) * r[0] * speeds_[o.a], r[1] * speeds_[o.b]);
  max_angular_speed_ = std::max(at_zero, at_one) * rounding_margin;
  // w_a' = L/I_a (L/I_c - L/I_b) n_b n_c and so on, each n_i within its amplitude
  const double sa = speeds_[o.a], sb = speeds_[o.b], sc = speeds_[o.c];
  max_angular_acceleration_ =
      Vec3(sa * (sc - sb) * r[1] * r[2], sb * (sa - sc) * r[2] * r[0], sc * (sb - sa) * r[0] * r[1])
          .norm() *
      rounding_margin;
}

// Q from the attitude at time 0.
void FreeRotation::set_base(const Quat& q_WB) {
  Vec3 n;
  const Quat start = local(0, n);
  base_ = (q_WB * start.conjugate()).normalized();
}

Quat FreeRotation::local(double elapsed, Vec3& n) const {
  return kind_ == Kind::triaxial ? local_triaxial(elapsed, n) : local_axisymmetric(elapsed, n);
}

// turn = cos + s e_a sin, swing = (1 + s n_a, n x s e_a); their product written out.
Quat FreeRotation::turn_and_swing(double cos_half, double sin_half, const Vec3& n) const {
  const double s = side_;
  const double up = 1.0 + s * n[axes_[0]];
  const double nj = n[axes_[1]];
  const double nk = n[axes_[2]];
  Vec3 v;
  v[axes_[0]] = s * sin_half * up;
  v[axes_[1]] = cos_half * s * nk + sin_half * nj;
  v[axes_[2]] = sin_half * nk - cos_half * s * nj;
  return Quat(cos_half * up, v.x(), v.y(), v.z());
}

Quat FreeRotation::local_axisymmetric(double elapsed, Vec3& n) const {
  const double x = phase_rate_ * elapsed;
  const double sx = std::sin(x);
  const double cx = std::cos(x);
  n[axes_[0]] = amplitudes_[axes_[0]];
  n[axes_[1]] = amplitudes_[axes_[1]] * cx - amplitudes_[axes_[2]] * sx;
  n[axes_[2]] = amplitudes_[axes_[1]] * sx + amplitudes_[axes_[2]] * cx;
  const double half = half_turn_rate_ * elapsed;
  return turn_and_swing(std::cos(half), std::sin(half), n);
}

Quat FreeRotation::local_triaxial(double elapsed, Vec3& n) const {
  const JacobiTheta::Values f = theta_.at(std::fma(phase_rate_, elapsed, phase_));
  const double na = amplitudes_[0] * f.dn;
  const double nb = amplitudes_[1] * f.sn;
  const double nc = amplitudes_[2] * f.cn;
  const double scale = 1.0 / std::sqrt(na * na + nb * nb + nc * nc);
  n[axes_[0]] = na * scale;
  n[axes_[middle_is_j_ ? 1 : 2]] = nb * scale;
  n[axes_[middle_is_j_ ? 2 : 1]] = nc * scale;
  // i theta_1 (C cn - i |B| sn); its argument is below pi/2
  const double size_b = std::abs(amplitudes_[1]) * f.sn;
  const double re = f.re * nc + f.im * size_b;
  const double im = f.im * nc - f.re * size_b;
  const auto [hx, hy] = half_angle(re, order_ * im);
  const double half = half_turn_rate_ * elapsed + 0.5 * order_ * f.turn;
  const double ch = std::cos(half);
  const double sh = std::sin(half);
  return turn_and_swing(ch * hx - sh * hy, sh * hx + ch * hy, n);
}

Quat FreeRotation::attitude(double elapsed) const {
  if (kind_ == Kind::rest) return base_;
  if (kind_ == Kind::uniform) {
    const double half = half_turn_rate_ * elapsed;
    const Vec3 v = std::sin(half) * amplitudes_;
    return (Quat(std::cos(half), v.x(), v.y(), v.z()) * base_).normalized();
  }
  Vec3 n;
  return (base_ * local(elapsed, n)).normalized();
}

void FreeRotation::evaluate(double elapsed, Quat& q_WB, Vec3& w_W) const {
  if (kind_ == Kind::rest || kind_ == Kind::uniform) {
    q_WB = attitude(elapsed);
    w_W = speeds_;
    return;
  }
  Vec3 n;
  q_WB = (base_ * local(elapsed, n)).normalized();
  w_W = q_WB * speeds_.cwiseProduct(n);
}

}  // namespace tw
