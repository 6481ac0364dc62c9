// Frictional impact at one point: Stronge's energetic restitution, by integration over the impulse.
//
// Source: W. J. Stronge, "Rigid body collisions with friction", Proc. R. Soc. Lond. A 431 (1990);
// the flow of the sliding direction: V. Bhatt, J. Koechling, "Three-dimensional frictional rigid-
// body impact", J. Appl. Mech. 62 (1995).
//
// Symbols as in impact-law.h; t: across n.  The impact takes no time, and its course is followed
// over the normal impulse p:
//   du/dp = K (n + f),   f = -mu s/|s| while s = u_t slides,
//   f = -K_tt^-1 K_tn if it has stopped and |f| <= mu, else it slides on, away from rest along e,
//   (mu K_tt + g 1) e = K_tn,  |e| = 1,  g > 0 its acceleration,
// and ends when the work of the normal impulse, W = integral of u.n dp, has come back from its
// least value W_min to (1 - e^2) W_min: what restitution gives is e^2 of what compression took.
// The energy of normal and of friction's work can only fall, the cone is never violated.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

// The impulse on b, N s; zero unless u.n < 0.  K is positive semi-definite.  Where sticking
// friction would leave n.K(n + f) nothing, so that no impulse ends the approach, Chatterjee and
// Ruina's.
Vec3 stronge_impulse(const Mat3& K, const Vec3& n, const Vec3& u, double restitution,
                     double friction);

}  // namespace tw
