// Rolling and spinning friction of four contacts: a torque that sticks by a bend of its own, as
// sliding friction does by a stretch.
//
// World frame, for the torque M on b against a, with w = w_b - w_a, the bend z, P = 1 - n n^T and
//   g = y (K z + C w),   T = -P g,   t = -n.g:
//   M = q T + s n,   q = min(1, rho_r N/|T|),   s = t cut to +-rho_s N,   z' = -(M + y K z)/C.
// It rolls where q < 1 and spins where |t| is beyond; else it is held.  By the power of both,
//   M.w + (K |z|^2/2)' = -(|M + y K z|^2 + M.(T + t n - M))/(y C) <= 0
// whatever y does, no torque ever gives what it did not take.
//
// Derivatives in a's frame, for dN, dd, dw' and dn' there (contact-linear.h), with e = T/|T|:
//   dT  = -y C P dw' + (n.g) dn' + n (g.dn') + (y'/y) T dd,
//   dt  = -y C n.dw' - g.dn' + (y'/y) t dd
//   dM  = m dN + (c0 + c1 e e^T) dT + c2 n dt + s dn'
//         held: c0 = 1, c1 = 0, c2 = 1;  rolling: c0 = q, c1 = -q, m has rho_r e;
//         spinning: c2 = 0, m has rho_s n, with the sign of t.
// Stages eliminate the bend as they do the stretch: with sigma = 1/(gamma h), tau = y K/C, f = n x
// e and dR = dM + y' K z dd
//   dz = H (r_z - dR/C),   dM becomes dM + W (dR - C r_z),
//   H  = h0 P + h1 n n^T + h2 f f^T,   W = m0 P + m1 n n^T + m2 f f^T
//   held: h = 1/sigma and m = tau/sigma;  spinning: h1 = 1/(sigma + tau), m1 = 0;
//   rolling: along e as when spinning, along f h = 1/(sigma + tau (1 - q)), m = tau q h.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/implicit/lanes.h"

namespace tw {

struct ResistanceLaw {
  Lanes rolling, spinning;  // rho_r, rho_s, m
  Lanes k, c;               // K, N m/rad; C > 0, N m s/rad
};

struct ResistanceState {
  LaneVec z, g, torque, rate;  // torque = M; the rate of the bend in a's frame
  Lanes k, c;                  // y K, y C
  LaneVec e;
  Lanes across, along;    // n.g; s
  Lanes held_share;       // q
  LaneMask rolls, spins;  // what the limits cut
};

struct ResistanceLinear {
  LaneVec n, g, e, f, m, torque;                       // torque = M
  Lanes across, along, damping, c, inverse_c, tau, q;  // damping = y C, c = C
  LaneVec harder, relaxing;                            // dM and dR - dM by dd
  Lanes c0, c1, c2;
  LaneMask rolls, spins;
  Lanes h0, h1, h2, m0, m1, m2;  // by the step
};

// `bend`: a's frame; `w` = w_b - w_a; `grip` = y.
TW_LANES void evaluate_resistance(const ResistanceLaw& law, const LaneMat& Ra, const LaneVec& n,
                                  Lanes N, Lanes grip, const LaneVec& w, const LaneVec& bend,
                                  ResistanceState& o) {
  const Lanes one = lanes(1), tiny = lanes(1e-300);
  o.z = Ra * bend;
  o.k = grip * law.k;
  o.c = grip * law.c;
  o.g = o.k * o.z + o.c * w;
  o.across = dot(n, o.g);

  // T, cut to rho_r N
  const LaneVec target = o.across * n - o.g;
  const Lanes length = sqrt(dot(target, target)), most_roll = law.rolling * N;
  o.rolls = length >= most_roll;
  o.held_share = o.rolls ? most_roll / max(length, tiny) : one;
  o.e = (one / max(length, tiny)) * target;

  // t, cut to rho_s N
  const Lanes most_spin = law.spinning * N;
  o.along = max(-most_spin, min(most_spin, -o.across));
  o.spins = (o.across >= most_spin) | (-o.across >= most_spin);

  o.torque = o.held_share * target + o.along * n;
  // z' = R_a^T (-M - y K z)/C
  o.rate = transposed_times(Ra, (lanes(-1) / law.c) * (o.torque + o.k * o.z));
}

// The bends are held until set_resistance_stage is called.  `tightening` = y'/y, 1/m.
TW_LANES void linearise_resistance(const ResistanceLaw& law, const ResistanceState& s,
                                   const LaneVec& n, Lanes tightening, ResistanceLinear& o) {
  const Lanes zero = lanes(0), one = lanes(1);
  o.n = n;
  o.g = s.g;
  o.e = s.e;
  o.f = cross(n, s.e);
  o.torque = s.torque;
  o.across = s.across;
  o.along = s.along;
  o.damping = s.c;
  o.c = law.c;
  o.inverse_c = one / law.c;
  o.tau = s.k * o.inverse_c;
  o.q = s.held_share;
  o.rolls = s.rolls;
  o.spins = s.spins;
  o.c0 = s.held_share;
  o.c1 = s.rolls ? -s.held_share : zero;
  o.c2 = s.spins ? zero : one;
  const Lanes spin_share = s.across < zero ? law.spinning : -law.spinning;
  o.m = (s.rolls ? law.rolling : zero) * s.e + (s.spins ? spin_share : zero) * n;
  const LaneVec spun = s.across * n;
  o.harder = (s.rolls ? zero : tightening) * (spun - s.g) - (s.spins ? zero : tightening) * spun;
  o.relaxing = (tightening * s.k) * s.z;
  o.h0 = o.h1 = o.h2 = o.m0 = o.m1 = o.m2 = zero;
}

// sigma = 1/(gamma h), 1/s.
TW_LANES void set_resistance_stage(double sigma, ResistanceLinear& o) {
  const Lanes s = lanes(sigma), zero = lanes(0), one = lanes(1);
  const Lanes held = one / s, loose = one / (s + o.tau);
  const Lanes turning = one / (s + o.tau * (one - o.q));
  o.h0 = o.rolls ? loose : held;
  o.h1 = o.spins ? loose : held;
  o.h2 = o.rolls ? turning - loose : zero;
  o.m0 = o.rolls ? zero : o.tau * held;
  o.m1 = o.spins ? zero : o.tau * held;
  o.m2 = o.rolls ? o.tau * o.q * turning : zero;
}

// W r, and r + W r
TW_LANES LaneVec bent(const ResistanceLinear& o, const LaneVec& r) {
  const Lanes along = dot(o.n, r);
  return o.m0 * (r - along * o.n) + (o.m1 * along) * o.n + (o.m2 * dot(o.f, r)) * o.f;
}
TW_LANES LaneVec with_bend(const ResistanceLinear& o, const LaneVec& r) { return r + bent(o, r); }

// (c0 + c1 e e^T) y
TW_LANES LaneVec cut(const ResistanceLinear& o, const LaneVec& y) {
  return o.c0 * y + (o.c1 * dot(o.e, y)) * o.e;
}

// dM by dw' and dn', bends held
TW_LANES LaneVec change_by_turn(const ResistanceLinear& o, const LaneVec& dw) {
  const Lanes along = dot(o.n, dw);
  return -(o.damping * (cut(o, dw - along * o.n) + (o.c2 * along) * o.n));
}
TW_LANES LaneVec change_by_normal(const ResistanceLinear& o, const LaneVec& dn) {
  const Lanes by_g = dot(o.g, dn);
  return cut(o, o.across * dn + by_g * o.n) - (o.c2 * by_g) * o.n + o.along * dn;
}

// dz, world frame, of dR
TW_LANES LaneVec solve_bend(const ResistanceLinear& o, const LaneVec& side, const LaneVec& change) {
  const LaneVec y = side - o.inverse_c * change;
  const Lanes along = dot(o.n, y);
  return o.h0 * (y - along * o.n) + (o.h1 * along) * o.n + (o.h2 * dot(o.f, y)) * o.f;
}

// Energy of the bend as far as the limits hold it, J; `load`: of the normal spring over y, N.
TW_LANES Lanes bend_energy(const ResistanceLaw& law, const LaneVec& n, const LaneVec& z,
                           Lanes load) {
  const Lanes along = dot(n, z);
  const LaneVec across = z - along * n;
  const Lanes roll = law.rolling * load, spin = law.spinning * load;
  const Lanes k = max(law.k, lanes(1e-300));
  return lanes(0.5) * (min(law.k * dot(across, across), roll * roll / k) +
                       min(law.k * along * along, spin * spin / k));
}

}  // namespace tw
