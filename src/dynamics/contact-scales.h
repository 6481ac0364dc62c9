// The scales of a contact: how deep, how fast, how near is little for this very pair.
//
// All follow from the pair's own law, its thickness and gravity.  With d0 the static depth, at
// which the contact carries the lighter body (contact-law.h), and g the scale of gravity:
//   fusion speed  0.07 sqrt(g thickness) unless set: what comes down slower stays
//   borne speed   that or, if more, what it would be by default of a body whose contact is as soft
//                 by default: a spring that presses stops what comes slower, without an impulse
//   bounce time   pi sqrt(d0/g): half a period of the small oscillation about d0
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>

#include "dynamics/contact-law.h"
#include "dynamics/scene.h"

namespace tw {

// Masses of dynamic bodies that hang together, kg: what may lie on a contact decides how stiff it
// is.
struct MassRange {
  double lightest = std::numeric_limits<double>::infinity(), heaviest = 0;

  void add(const MassRange& other) {
    lightest = std::min(lightest, other.lightest);
    heaviest = std::max(heaviest, other.heaviest);
  }
  void add(double mass) { add(MassRange{mass, mass}); }
};

struct ContactScales {
  ContactConstants law;
  double thickness = 0;     // the lesser one of the two, m
  double fusion_speed = 0;  // m/s
  double borne_speed = 0;   // m/s
  double gravity = 0;       // g, m/s^2

  double bounce_time() const;  // s
};

// m: how deep contacts of the two may be goes by it.
double lesser_thickness(const Body& a, const Body& b);

// m/s: what approaches slower than this stays in contact.
double fusion_speed(const Scene& scene, const Body& a, const Body& b);

// m/s: the approach that a spring of that static depth bears (m; gravity's scale in m/s^2).
double borne_speed(double fusion_speed, double depth, double gravity);

// Of a pair among bodies of these masses.
ContactScales contact_scales(const Scene& scene, const Body& a, const Body& b,
                             const MassRange& masses);

}  // namespace tw
