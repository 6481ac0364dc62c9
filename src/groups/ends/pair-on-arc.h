// A pair of bodies in contact along the arc of its group: what its contacts claim, and what is so.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/contacts/pair-manifold.h"
#include "groups/group.h"

namespace tw {

class PairOnArc {
 public:
  // `end`: of the arc, s.
  PairOnArc(const Scene& scene, const Group& group, const ContactPair& pair, double end)
      : a(scene.body(pair.a())),
        b(scene.body(pair.b())),
        scales(contact_scales(scene, a, b, pair.masses)),
        scene_(scene),
        group_(group),
        pair_(pair),
        end_(end) {}

  const Body &a, &b;
  const ContactScales scales;

  double size() const { return scales.thickness; }
  const Trajectory& trajectory(const Body& body) const;
  // Which parts of the ground stand around the two between two times: seams are known from then on.
  void look_around(const Surroundings& surroundings, double from, double to);
  // The depth of the deepest point, m, as a negative gap; 0: none.  `at_seams`: ghosts left out.
  double deepest(double when, bool at_seams) const;
  // Whether it is surely no deeper than `depth`, m, as it overlaps no more along a contact's
  // normal.
  bool is_no_deeper(double depth, const ContactForce& contact, bool reference_is_a,
                    double when) const;
  // The least gap that its contacts know of, m.
  double represented(double when) const;
  // How much deeper it is than its contacts know, m.
  double unseen_depth(double when) const {
    return std::min(represented(when), 0.0) - deepest(when, true);
  }
  // Whether a contact's point runs along a line or a rim: it may be elsewhere soon, and back again.
  bool runs() const;
  // How far any surface point may have moved over the arc, m.
  double travel() const;

 private:
  double turning_speed(const Body& body, double from, double to, double turn) const;

  const Scene& scene_;
  const Group& group_;
  const ContactPair& pair_;
  const double end_;
  PairGround ground_;
};

}  // namespace tw
