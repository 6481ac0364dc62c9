// The exact derivative of contact forces, four contacts at a time, with the stretches eliminated.
//
// Write force and stretch in a's frame: they depend on the displacement p of b's core point, the
// velocity v of b against a at the contact point and the stretch alone.  For displacements (dx,
// dth) and velocity changes (dv, dw) of the two bodies, in the world frame,
//   dp  = dx_b - dx_a + dth_b x r_b - dth_a x r_a
//   dn' = Nn dp,  Nn = (1 - n n^T - l l^T)/|arm|  (0 for a plane)
//   dv' = dv_b - dv_a + dw_b x s_b - dw_a x s_a + (w_b - w_a) x (dp - radius_b dn' + dth_a x s_a)
//         - w_b x (dx_b - dx_a) + v_r x dth_a
//   dN  = g.dp - K b (n.dv'),   g = -(dN/dd) n - K b Nn v_r,   K = N/(1 + b d')
//   dF* = -y (ct (dv' - n n.dv') - (kt s + ct v_r).n dn' - n (kt s + ct v_r).dn')
//         + (y'/y) F* dd,  dd = -n.dp      (anchored)
//   dF  = m dN + (c0 + c1 e e^T) dF*,  e = F*/|F*|
//         sticking: m = 0, c0 = 1, c1 = 0;  slipping: m = mu e, c0 = q, c1 = -q, q = mu N/|F*|
//   df  = n dN + N dn' + dF + dT + dth_a x f
//   dT  = -c (dv' - n n.dv') + c v_r.n dn' + n c v_r.dn' + (dc/dd) u n.dp    (T = -c u, where deep)
// and a torque Q = -C (w_b - w_a), C = c d size/2:
//   dQ  = -C (dw_b - dw_a) + (dC/dd) (w_b - w_a) n.dp
// Where rolling and spinning are resisted the torque M adds to Q, dM by turn-resistance.h, with dN,
// dn' and dw' = dw_b - dw_a - dth_a x (w_b - w_a).
// Where the core point runs (contact-pack.h, RunningPoint), with dom = dth_b - dth_a:
//   dn' = (turn_p.dp + turn_om.dom) m_a, and (along_p.dp + along_om.dom) path adds to dp wherever
// the point of the force moves (dv', arms), but not in dN, where the turn of n does:
//   dN  = g.dp + h.dom - K b (n.dv'),  g = -(dN/dd) n - K b (m_a.v_r) turn_p,
//   h = -K b (m_a.v_r) turn_om.
// Where it rolls over the surface of an ellipsoid roll dom - bulge dn adds to dp likewise, and on
// what is curved
//   dn' = turn (dp + roll dom),  g = -(dN/dd) n - K b turn^T v_r,  h = -K b (turn roll)^T v_r.
// smooth: m = F/N, and du instead of dF* with the derivative of the atan law in c0, c1.
//
// The stretch z (world frame) has z' = -(F + y kt z)/ct; dF/dz is -y kt q t t^T when slipping, with
// t = n x e, and -y kt (1 - n n^T) when sticking.  With sigma = 1/(gamma h), tau = y kt/ct and
// dR = dF + y' kt z dd its stage equation gives
//   dz = H (r_z - dR/ct),  H = h0 + h1 n n^T + h2 t t^T, and dF becomes dF + W (dR - ct r_z),
//   W = m1 (1 - n n^T) + m2 t t^T,
//   sticking: m1 = tau/sigma, m2 = 0;  slipping: m1 = 0, m2 = tau q/(sigma + tau (1 - q)).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/implicit/contact-pack.h"

namespace tw {

// Changes of one body's pose and velocity.
struct BodyChange {
  double x[3], th[3], v[3], w[3];
};

// Wrenches, or their changes, of one body about its centre.
struct BodyWrench {
  double f[3], t[3];
};

// What derivatives of a pack need.
struct PackLinear {
  LaneMat Ra;
  LaneVec n, l, ra, rb, sa, sb, wb, dw, vr, f,
      bend;  // dw = w_b - w_a; bend = y (kt s + ct v_r), or v_r
  LaneVec e, t, m, g;
  RunningPoint running;
  LaneMat roll, bulge, turn;
  LaneVec h;
  Lanes N, kb, inverse_length, vbend;  // vbend = n.bend
  Lanes c0, c1, q, drag;               // drag = -y ct (anchored), 1 (smooth)
  LaneVec harder, relaxing;            // dF and dR - dF by dd
  Lanes inverse_ct, tau;
  LaneMask sticking;
  bool idle = false;  // as the state: then n alone is set, and all derivatives are 0
  bool deep, turns;
  ResistanceLinear resistance;  // set where the pack has bends
  Lanes damper;                 // c
  LaneVec pull, more_drag;      // c v_r, (dc/dd) u
  Lanes turn_damper;            // C
  LaneVec more_turn;            // (dC/dd) (w_b - w_a)
  Lanes m1, m2, h0, h1, h2;     // by the step
};

// Changes of the force on b, of the dR of the stretches and of the bends, both held, and of the two
// arms.
struct PackChange {
  LaneVec f, stretching, sa, sb;
  LaneVec bending;  // set where the pack has bends
  LaneVec torque;   // dQ + dM; set where it turns
};

// The derivative at a state; stretches and bends are held until set_stage_rate is called.
void linearise_pack(const ContactPack& pack, const PackState& state, PackLinear& out);
// sigma = 1/(gamma h), 1/s: eliminates the stretches and the bends.
void set_stage_rate(const ContactPack& pack, double sigma, PackLinear& linear);

// The sides r_z of the stretches and of the bends, world frame.
struct PackSides {
  LaneVec stretch = {}, bend = {};
};

// `outside_changes`: whether changes of outside bodies may
// differ from 0.
void change_pack(const ContactPack& pack, const PackLinear& linear, const BodyChange* changes,
                 const PackSides& sides, bool outside_changes, PackChange& out);
// Those of the stretches and the bends alone, with the same bits; outside bodies don't change.
void change_stretches(const ContactPack& pack, const PackLinear& linear, const BodyChange* changes,
                      PackChange& out);

// dR alone gives the stretch: H (r_z - dR/ct), world frame.
LaneVec solve_stretch(const PackLinear& linear, const LaneVec& stretch_side,
                      const LaneVec& stretching);

// 6 x 6 blocks of the derivative of the wrenches (f, torque about the centre) on body Y by (v, L)
// of body X, where the stage equations give dx = v/sigma, dth = P L, dw = V L.  Of [Y][X], a = 0
// and b = 1; only [1][1] where the pack is grounded.
struct PackBlocks {
  LaneMat part[2][2][2][2];  // [Y][X][force, torque][v, L]
};

struct LaneBody {
  LaneMat P, V;
};

void pack_blocks(const ContactPack& pack, const PackLinear& linear, double sigma, const LaneBody& a,
                 const LaneBody& b, PackBlocks& out);

}  // namespace tw
