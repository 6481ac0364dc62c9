// Contacts of a group four at a time: constants, geometry and force.
//
// Symbols, for a contact of bodies a (reference) and b: P the core point of b (crossing and rim:
// the point of its line or circle that is nearest to a's; tangent plane and curved: the ellipsoid's
// farthest along -n), n the normal, l the line's direction; r_a, r_b from the centres to P; c = P -
// radius_b n where the force acts; s_a, s_b from the centres to c; v_r velocity of b against a at
// c, u its tangential part; s the stretch in the world frame; f = N n + F the force on b.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "base/constants.h"
#include "integrate/arc/group-arc.h"
#include "integrate/implicit/lanes.h"
#include "integrate/implicit/turn-resistance.h"

namespace tw {

// What contacts need to know of a body at one instant.
struct BodyKinematics {
  double x[3], R[9], v[3], w[3];  // R by rows: from the body's frame to the world
};

// Semi-axes of the ellipsoids, in the frames of a and b.
struct PackEllipsoids {
  LaneMat a, b;
};

// Four contacts with the same feature and friction law.  Lanes beyond the last contact hold one
// without stiffness between the bodies of the first.
struct ContactPack {
  ContactFeature feature = ContactFeature::plane;
  FrictionLaw law = FrictionLaw::anchored;
  int count = 0;
  bool uniform = false;                         // all of the same two bodies
  bool grounded = false;                        // all bodies a are outside
  int contact[lane_count];                      // index in GroupStart::contacts
  int a[lane_count], b[lane_count];             // body slots
  LaneVec normal, direction, point_a, point_b;  // frames of a, a, a, b
  LaneVec other_direction;                      // frame of b: crossing and rim
  std::shared_ptr<PackEllipsoids> ellipsoids;   // tangent plane and curved
  Lanes radius_a, radius_b, rim, offset;
  Lanes k, inverse_hardening, inverse_limit, firmness, damping, mu, kt, ct, half_size;
  ResistanceLaw resistance;
  int bend = -1;  // number of its row of bends; -1: it resists nothing
};

// Where in the packs a contact is.
struct ContactPlace {
  int pack = 0, lane = 0;
};

// Bodies in slots: members first, then outside bodies.
struct ContactPacks {
  std::vector<ContactPack> packs;
  std::vector<ContactPlace> places;  // by contact
  int slots = 0;
  int bends = 0;  // packs that resist rolling or spinning
};

// By feature and friction law, otherwise in the given order.
ContactPacks make_contact_packs(const GroupStart& start);

// Whether the core point of b runs along a line or circle of its.
constexpr bool runs(ContactFeature feature) {
  return feature == ContactFeature::crossing || feature == ContactFeature::rim;
}

// Whether n keeps its direction in a's frame.
constexpr bool is_flat(ContactFeature feature) {
  return feature == ContactFeature::plane || feature == ContactFeature::tangent_plane;
}

// Whether n turns when b does.
constexpr bool turns_normal(ContactFeature feature) {
  return runs(feature) || feature == ContactFeature::curved;
}

// How the core point of b runs along its line or circle, and n turns with it, when a displacement
// dp of b's material there and a turn dom of b against a happen, in a's frame:
//   the point by dp + (along_p.dp + along_om.dom) path,  n by (turn_p.dp + turn_om.dom) m_a,
// m_a = n x l: n stays square to a's line.
struct RunningPoint {
  LaneVec path, along_p, along_om, ma, turn_p, turn_om;
};

// The contacts of a pack at one instant, in the world frame.
struct PackState {
  LaneMat Ra;
  LaneVec n, l, ra, rb, sa, sb, wa, wb, vr, u, s;  // ra from the centre of a to the core point of b
  LaneVec arm;                                     // n = arm/|arm|, signed; point and line
  Lanes inverse_length;                            // 1/|arm|, with the sign of n; 0 where |arm| is
  RunningPoint running;                            // crossing and rim
  // Tangent plane and curved: the point runs by roll dom - bulge dn when b turns by dom against a
  // and n by dn; curved: n does by turn (dp + roll dom).
  LaneMat roll, bulge, turn;
  Lanes gap, depth, vn;        // depth = offset - gap
  Lanes damping;               // b at this depth
  Lanes grip;                  // y at this depth
  Lanes kt, ct;                // y kt, y ct; anchored
  Lanes N, stiffness;          // stiffness = N/(1 - b vn)
  LaneVec target;              // F* before the cut (anchored), u (smooth)
  Lanes target_length, scale;  // F = scale target
  LaneMask slipping;
  LaneVec F, stretch_rate;  // the rate in a's frame
  bool idle = false;        // all are open, and nothing resists turns: no forces, no derivatives
  // Whether any is within the second hardening, or beyond, and whether it counts.
  bool reaches_firmness = false, firm = false;
  Lanes firm_part, harder;     // s, and dh/dd of the second hardening, 1/m; set where it is firm
  bool deep = false;           // whether any is beyond the hardest ratio
  Lanes drag, firm_drag;       // c of the tangential damper there, N s/m, and what is beyond dl
  LaneVec f;                   // N n + F - drag u
  Lanes turn_drag;             // c d size/2, N m s
  bool turns = false;          // whether any torque beside that of f
  LaneVec torque;              // on b, M - turn_drag (w_b - w_a); set where it turns
  ResistanceState resistance;  // set where the pack has bends
};

struct PackWish {
  bool forces_alone = false;      // of an idle pack points and velocities may be left out
  bool without_firmness = false;  // the law without its second hardening
};

// `stretch`, `bend`: a's frame; bends count where the pack has some.  `side`: the normals at an
// earlier instant, which choose their sign (line, point).
void evaluate_pack(const ContactPack& pack, const BodyKinematics* bodies, const LaneVec& stretch,
                   const LaneVec& bend, const LaneVec& side, PackState& out,
                   const PackWish& wish = {});

// The normals that the definition of the contacts gives at the start of an arc: they choose the
// sign.
LaneVec starting_side(const ContactPack& pack, const BodyKinematics* bodies);

// Of the normal springs (without the damper) and of the stretches and bends as far as friction
// holds them, J.
Lanes pack_energy(const ContactPack& pack, const PackState& state);

}  // namespace tw
