// Frictional impact at one point: Chatterjee and Ruina's algebraic law.
//
// Source: A. Chatterjee, A. Ruina, "A new algebraic rigid-body collision law based on impulse space
// considerations", J. Appl. Mech. 65 (1998), with tangential restitution e_t = 0.
//
// Symbols (world frame): n unit normal from body a to body b; u = v_b - v_a, the relative velocity
// of the contact points, so u.n < 0 when approaching; P the impulse on b (-P on a); K the inverse
// inertia of the contact, u' = u + K P.
//   P_I  = -(u.n)/(n.K n) n        stops the approach without friction
//   P_II = -K^-1 u                 stops all relative motion (K^+ where joints leave K singular)
//   P    = (1+e) P_I + (P_II - P_I)              if that lies in the friction cone, else
//   P    = (1+e) P_I + kappa (P_II - P_I)        with kappa such that P lies on it:
//   kappa = mu (1+e) n.P_I / (|P_II - (n.P_II) n| - mu n.(P_II - P_I))
// Energy never grows, the cone is never violated, and the approach always ends.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

// One body's share of K for an impulse at offset r (m, world) from its centre of mass:
// K = 1/m - [r]x I^-1 [r]x.  `inverse_inertia` in the world frame.
inline Mat3 contact_compliance(double inverse_mass, const Mat3& inverse_inertia, const Vec3& r) {
  const Mat3 rx = cross_matrix(r);
  return inverse_mass * Mat3::Identity() - rx * inverse_inertia * rx;
}

// The impulse on b, N s; zero unless u.n < 0.  K is positive semi-definite; zero, too, where n.K n
// vanishes: no impulse along n moves the points.
Vec3 impact_impulse(const Mat3& K, const Vec3& n, const Vec3& u, double restitution,
                    double friction);

}  // namespace tw
