// The law of persistent contact: normal force and friction at one contact point.
//
//   N  = max(0, k d h (1 + b e d'))    Hunt-Crossley, hardening
//   h  = 1 + min((d/dh)^2, 100) + H s^4,  e = min(1, 10 dh/d)
// with d the depth (m, negative: apart), d' its rate, and H s^4 of second-hardening.h, which bears
// what is far above the weight.  The depth is that of the overlap, or, where what was placed
// touching starts loaded, more by the contact's offset.  Beyond 10 dh it is a spring beside a
// damper, N = h k (d + tau d') with tau = 10 dh b, and lets a depth go at d/tau at most; nor do the
// two slide or turn in each other any faster: beside friction there is
//   T = -c u,  Q = -C (w_b - w_a),  c = 101 k tau (1 - e) + H k tau (1 - dl/d),  C = c d size/2
// (the second part beyond dl), where d size/2 is the square of the half width of two balls'
// overlap.  `anchored` friction
// carries a tangential stretch xi, in the frame of the reference body, and hardens as the normal
// spring does, with the grip y, y^2 = 1 + min((d/dh)^2, 100) + (d H s^4)'
// (beyond dl that at dl):
//   F* = -y (kt xi + ct u),   F = F* cut to mu N,   xi' = (-F - y kt xi)/ct
// so that xi' = y u while the contact sticks and xi relaxes to the cone while it slides.  Its
// energy is kt xi^2/2 whatever y is: F.u + kt xi.xi' <= 0, it gives what it took, however deep it
// was when it took it, and what swings in depth under a steady pull does not creep.  `smooth`:
//   F = -mu N (2/pi) atan(|u|/v0) u/|u|,  v0 = 1e-4 m/s    (the paper's law).
// Rolling and spinning are resisted by a torque on b in the same manner, with a bend beta (a
// rotation vector, in the frame of the reference body) and the angular velocity w = w_b - w_a:
//   M* = -y (K beta + C w), M = M* with its part across n cut to rho_r N, that along n to rho_s N,
//   beta' = (-M - y K beta)/C,   K = kt (size/2)^2,   C = ct (size/2)^2
// with rho the lengths of the pair: as if the stretch held it at a lever of half the width.
//
// Source: doc/numerics/contact-law.md; K. H. Hunt, F. R. E. Crossley,
// J. Appl. Mech. 42 (1975).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>

#include "base/constants.h"
#include "dynamics/contact-parameters.h"
#include "dynamics/second-hardening.h"
#include "math/vec.h"

namespace tw {

// Of the pair; a point takes the share 1/n of k, kt and ct.
struct ContactConstants {
  double k = 0;          // N/m
  double hardening = 0;  // dh, m: depth at which the stiffness has doubled
  double b = 0;          // s/m
  double mu = 0;
  double kt = 0;  // N/m, 0.8 k
  double ct = 0;  // N s/m, sqrt(kt m)
  SecondHardening firm;
  double size = 0;   // m: the lesser thickness (dynamics/body.h)
  double depth = 0;  // d0, m: under the lighter body's own weight
  FrictionLaw law = FrictionLaw::anchored;
  double rolling = 0, spinning = 0;  // rho_r, rho_s, m

  // m^2: of kt and ct in a turn.
  double squared_lever() const { return 0.25 * size * size; }
  // m: gaps are small or large beside this.
  double gap_scale() const { return std::min(depth, answer::widest_gap_scale * size); }
};

// `mass`: of the lighter dynamic body of the pair, kg; `size`: the lesser thickness, m;
// `gravity`: its magnitude, m/s^2 (0: the standard one stands in); `unequal`: the group holds
// masses over 100:1, which makes the contact five times as stiff and harden sooner.
ContactConstants contact_constants(const ContactParameters& parameters, double mass, double size,
                                   double gravity, bool unequal);

// The law without the damper, of a point with the share `share` of the pair's springs.
double spring_force(const ContactConstants& law, double share, double depth);   // N
double spring_energy(const ContactConstants& law, double share, double depth);  // J
// The depth that presses with `force` >= 0, m.
double spring_depth(const ContactConstants& law, double share, double force);
// y: a stretch or bend holds this much harder than at the surface.
double friction_grip(const ContactConstants& law, double depth);

}  // namespace tw
