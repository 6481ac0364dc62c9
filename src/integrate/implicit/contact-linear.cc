// Derivatives of four contacts' forces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/contact-linear.h"

#include "base/constants.h"

namespace tw {

namespace {

struct LaneChange {
  LaneVec x, th, v, w;
};

TW_LANES LaneChange gather(const ContactPack& pack, const BodyChange* changes,
                           const int (&slot)[lane_count]) {
  const BodyChange* c[lane_count];
  for (int i = 0; i < lane_count; ++i) c[i] = &changes[slot[i]];
  if (pack.uniform)
    return {broadcast(c[0]->x), broadcast(c[0]->th), broadcast(c[0]->v), broadcast(c[0]->w)};
  return {gather_vec(c[0]->x, c[1]->x, c[2]->x, c[3]->x),
          gather_vec(c[0]->th, c[1]->th, c[2]->th, c[3]->th),
          gather_vec(c[0]->v, c[1]->v, c[2]->v, c[3]->v),
          gather_vec(c[0]->w, c[1]->w, c[2]->w, c[3]->w)};
}

// Nn y = (1 - n n^T - l l^T) y/|arm|
TW_LANES LaneVec turn_normal(const ContactPack& pack, const PackLinear& o, const LaneVec& y) {
  LaneVec part = y - dot(o.n, y) * o.n;
  if (pack.feature == ContactFeature::line) part = part - dot(o.l, y) * o.l;
  return o.inverse_length * part;
}

// derivative of the atan law: F = -mu N A(u), A = (2/pi) atan(|u|/v0) u/|u|
void set_smooth(const ContactPack& pack, const PackState& s, PackLinear& o) {
  o.drag = lanes(1);
  o.bend = -s.vr;
  o.q = lanes(0);
  o.c0 = s.scale;
  const Lanes y = s.target_length * lanes(1 / answer::smooth_speed);
  // along u: -mu N (2/pi)/(v0 (1 + y^2))
  const Lanes along = lanes(-2 / (pi * answer::smooth_speed)) * pack.mu * s.N / (lanes(1) + y * y);
  o.c1 = along - s.scale;
  o.m = select(s.N > lanes(0), (lanes(1) / max(s.N, lanes(1e-300))) * s.F,
               LaneVec{lanes(0), lanes(0), lanes(0)});
  o.sticking = LaneMask{};
  o.tau = lanes(0);
  o.inverse_ct = lanes(0);
  o.harder = o.relaxing = {lanes(0), lanes(0), lanes(0)};
}

// `tightening` = y'/y, 1/m
void set_anchored(const ContactPack& pack, const PackState& s, Lanes tightening, PackLinear& o) {
  const Lanes zero = lanes(0);
  o.drag = -s.ct;
  o.bend = s.kt * s.s + s.ct * s.vr;
  o.q = s.scale;
  o.sticking = ~s.slipping;
  o.c0 = s.scale;
  o.c1 = s.slipping ? -s.scale : zero;
  o.m = (s.slipping ? pack.mu : zero) * o.e;
  o.inverse_ct = lanes(1) / pack.ct;
  o.tau = s.kt * o.inverse_ct;
  // what slips pulls no harder along e, whatever F* does
  o.harder = (s.slipping ? zero : tightening) * s.target;
  o.relaxing = (tightening * s.kt) * s.s;
}

// T = -c u with c = c1 (1 - r1/r): dc/dd = (c1 - c)/d
TW_LANES void set_drag(const ContactPack& pack, const PackState& s, PackLinear& o) {
  o.deep = s.deep;
  if (!s.deep) return;
  const Lanes ratio = s.depth * pack.inverse_hardening, hardest = lanes(answer::hardest_ratio);
  Lanes by_depth = (s.drag - s.firm_drag) * hardest / ((ratio - hardest) * s.depth);
  // the other part: c = c2 (1 - dl/d)
  const Lanes depth = s.depth * pack.inverse_limit, zero = lanes(0), one = lanes(1);
  by_depth += s.firm_drag > zero ? s.firm_drag / ((depth - one) * s.depth) : zero;
  o.damper = s.drag;
  o.pull = s.drag * s.vr;
  const Lanes slope = s.drag > zero ? by_depth : zero;
  o.more_drag = slope * s.u;
  o.turn_damper = s.turn_drag;
  o.more_turn = (pack.half_size * (s.drag + s.depth * slope)) * o.dw;
}

// dN, by dp and dv'
TW_LANES Lanes normal_change(const PackLinear& o, const LaneVec& dp, const LaneVec& dv) {
  return dot(o.g, dp) - o.kb * dot(o.n, dv);
}

// raw dF of given dN, dn' and dv'
template <bool flat>
TW_LANES LaneVec friction_change(const PackLinear& o, Lanes dN, const LaneVec& dn,
                                 const LaneVec& dv) {
  LaneVec target = o.drag * (dv - dot(o.n, dv) * o.n);
  if constexpr (!flat) target = target + o.vbend * dn + dot(o.bend, dn) * o.n;
  return dN * o.m + o.c0 * target + (o.c1 * dot(o.e, target)) * o.e;
}

// dT of given dp, dn' and dv'
template <bool flat>
TW_LANES LaneVec drag_change(const PackLinear& o, const LaneVec& dp, const LaneVec& dn,
                             const LaneVec& dv) {
  LaneVec result = dot(o.n, dp) * o.more_drag - o.damper * (dv - dot(o.n, dv) * o.n);
  if constexpr (!flat) result = result + dot(o.n, o.pull) * dn + dot(o.pull, dn) * o.n;
  return result;
}

// W y
TW_LANES LaneVec stretched(const PackLinear& o, const LaneVec& y) {
  return o.m1 * (y - dot(o.n, y) * o.n) + (o.m2 * dot(o.t, y)) * o.t;
}

// What a change does to the load, the depth and the normal.
struct NormalChange {
  Lanes load, deeper;
  LaneVec normal;
};

// Of what resists turns.
template <bool flat, bool grounded, bool forces>
TW_LANES void change_resistance(const PackLinear& o, const LaneChange& a, const LaneChange& b,
                                const PackSides* sides, const NormalChange& by, PackChange& out) {
  const ResistanceLinear& r = o.resistance;
  LaneVec dw = b.w;
  if constexpr (!grounded) dw = dw - a.w - cross(a.th, o.dw);
  LaneVec torque = by.load * r.m + by.deeper * r.harder + change_by_turn(r, dw);
  if constexpr (!flat) torque = torque + change_by_normal(r, by.normal);
  out.bending = torque + by.deeper * r.relaxing;
  if constexpr (forces) {
    torque = torque + bent(r, out.bending - r.c * sides->bend);
    if constexpr (!grounded) torque = torque + cross(a.th, r.torque);
    out.torque = o.deep ? out.torque + torque : torque;
  }
}

// `grounded`: body a does not change; `sides`: null where neither forces nor torques are wanted
template <ContactFeature feature, bool grounded, bool forces>
void change(const ContactPack& pack, const PackLinear& o, const BodyChange* changes,
            const PackSides* sides, PackChange& out) {
  constexpr bool flat = is_flat(feature);
  // relative displacement in a's frame
  const LaneChange b = gather(pack, changes, pack.b);
  LaneChange a;
  if constexpr (!grounded) a = gather(pack, changes, pack.a);
  LaneVec dx = b.x;
  if constexpr (!grounded) dx = dx - a.x;
  const LaneVec turned_b = cross(b.th, o.rb);
  LaneVec dp = dx + turned_b;
  if constexpr (!grounded) dp = dp - cross(a.th, o.ra);

  // normal and arms
  out.sa = dp;
  out.sb = turned_b;
  LaneVec dn, turned;
  if constexpr (rolls(feature) || runs(feature)) {
    turned = b.th;
    if constexpr (!grounded) turned = turned - a.th;
  }
  if constexpr (rolls(feature)) {
    LaneVec along = o.roll * turned;
    if constexpr (feature == ContactFeature::curved) {
      dn = o.turn * (dp + along);
      along = along - o.bulge * dn;
    }
    out.sa = out.sa + along;
    out.sb = out.sb + along;
  } else if constexpr (runs(feature)) {
    const RunningPoint& r = o.running;
    dn = (dot(r.turn_p, dp) + dot(r.turn_om, turned)) * r.ma;
    const LaneVec along = (dot(r.along_p, dp) + dot(r.along_om, turned)) * r.path;
    out.sa = out.sa + along;
    out.sb = out.sb + along;
  } else if constexpr (!flat) {
    dn = turn_normal(pack, o, dp);
  }
  if constexpr (!flat) {
    out.sa = out.sa - pack.radius_b * dn;
    out.sb = out.sb - pack.radius_b * dn;
  }
  if constexpr (!grounded) {
    out.sa = out.sa + cross(a.th, o.sa);
    out.sb = out.sb - pack.radius_b * cross(a.th, o.n);
  }

  // relative velocity in a's frame
  LaneVec dv = b.v + cross(b.w, o.sb) + cross(o.dw, out.sa) - cross(o.wb, dx);
  if constexpr (!grounded) dv = dv - a.v - cross(a.w, o.sa) + cross(o.vr, a.th);

  // force
  Lanes dN = normal_change(o, dp, dv);
  if constexpr (turns_normal(feature)) dN = dN + dot(o.h, turned);
  const Lanes deeper = -dot(o.n, dp);
  const LaneVec friction = friction_change<flat>(o, dN, dn, dv) + deeper * o.harder;
  out.stretching = friction + deeper * o.relaxing;
  if constexpr (forces) {
    out.f = dN * o.n + friction + stretched(o, out.stretching - pack.ct * sides->stretch);
    if constexpr (!flat) out.f = out.f + o.N * dn;
    if (o.deep) {
      out.f = out.f + drag_change<flat>(o, dp, dn, dv);
      out.torque = dot(o.n, dp) * o.more_turn - o.turn_damper * b.w;
      if constexpr (!grounded) out.torque = out.torque + o.turn_damper * a.w;
    }
  }
  if (pack.bend >= 0)
    change_resistance<is_flat(feature), grounded, forces>(o, a, b, sides, {dN, deeper, dn}, out);
  if constexpr (forces && !grounded) out.f = out.f + cross(a.th, o.f);
}

// The one for the kind of the pack's contacts.
template <bool forces>
void change_by_kind(const ContactPack& pack, const PackLinear& linear, const BodyChange* changes,
                    const PackSides* sides, bool grounded, PackChange& out) {
  const auto choose = [grounded](auto with_ground, auto without) {
    return grounded ? with_ground : without;
  };
  using F = ContactFeature;
  // a line and a point differ in turn_normal alone, what runs in how it does
  const auto chosen =
      pack.feature == F::plane
          ? choose(change<F::plane, true, forces>, change<F::plane, false, forces>)
      : pack.feature == F::tangent_plane
          ? choose(change<F::tangent_plane, true, forces>, change<F::tangent_plane, false, forces>)
      : pack.feature == F::curved
          ? choose(change<F::curved, true, forces>, change<F::curved, false, forces>)
      : runs(pack.feature)
          ? choose(change<F::crossing, true, forces>, change<F::crossing, false, forces>)
          : choose(change<F::point, true, forces>, change<F::point, false, forces>);
  chosen(pack, linear, changes, sides, out);
}

}  // namespace

void linearise_pack(const ContactPack& pack, const PackState& s, PackLinear& o) {
  o.idle = s.idle;
  o.n = s.n;
  if (s.idle) return;
  for (int r = 0; r < 3; ++r) o.Ra.row[r] = s.Ra.row[r];
  o.l = s.l;
  o.ra = s.ra;
  o.rb = s.rb;
  o.sa = s.sa;
  o.sb = s.sb;
  o.wb = s.wb;
  o.dw = s.wb - s.wa;
  o.vr = s.vr;
  o.f = s.f;
  o.N = s.N;
  o.inverse_length = s.inverse_length;
  o.e = (lanes(1) / max(s.target_length, lanes(1e-300))) * s.target;
  o.t = cross(o.n, o.e);

  // y'/y = (d/dh^2)/h below the cap
  const Lanes zero = lanes(0), one = lanes(1);
  const Lanes ratio = s.depth * pack.inverse_hardening, squared = ratio * ratio;
  const LaneMask hardens = squared < lanes(answer::hardening_cap);
  Lanes tightening =
      (s.depth > zero) & hardens ? ratio * pack.inverse_hardening / (s.grip * s.grip) : zero;
  if (s.firm) {
    // of H s^3 (s + 4 z/rest), z = d/dl
    const Lanes rest = lanes(1 - answer::firm_from), z = s.depth * pack.inverse_limit;
    const Lanes part = rest * max(s.firm_part, lanes(1e-100));
    const Lanes more = s.harder * (lanes(2) + lanes(3) * z / part);
    tightening += lanes(0.5) * more / (s.grip * s.grip);
  }
  if (pack.law == FrictionLaw::anchored)
    set_anchored(pack, s, tightening, o);
  else
    set_smooth(pack, s, o);
  o.vbend = dot(o.n, o.bend);

  // N = K (1 - b vn): dN/dd = K'(1 - b vn), K' = k (1 + 3 ratio^2); beyond the cap K b is constant
  // and dN/dd = K' = k (1 + cap)
  // the second hardening h, which begins there: k (h + d h' (1 - b vn))
  Lanes slope = hardens ? (one + lanes(3) * squared) * (one - s.damping * s.vn)
                        : lanes(1 + answer::hardening_cap);
  if (s.firm) {
    const Lanes part = s.firm_part * s.firm_part;
    slope += pack.firmness * part * part + s.depth * s.harder * (one - s.damping * s.vn);
  }
  // whether what just touches presses already is rounding
  const LaneMask touches =
      (ratio > lanes(-answer::just_touching)) & (one - s.damping * s.vn > zero);
  const Lanes by_depth = touches ? pack.k * slope : zero;
  o.kb = s.stiffness * s.damping;
  o.g = -(by_depth * o.n);
  if (rolls(pack.feature)) o.roll = s.roll;
  if (pack.feature == ContactFeature::curved) {
    o.bulge = s.bulge;
    o.turn = s.turn;
    const LaneVec by_turn = o.turn * o.vr;
    o.g = o.g - o.kb * by_turn;
    o.h = -(o.kb * transposed_times(o.roll, by_turn));
  } else if (runs(pack.feature)) {
    o.running = s.running;
    const Lanes by_turn = o.kb * dot(o.running.ma, o.vr);
    o.g = o.g - by_turn * o.running.turn_p;
    o.h = -(by_turn * o.running.turn_om);
  } else if (!is_flat(pack.feature)) {
    o.g = o.g - o.kb * turn_normal(pack, o, o.vr);
  }
  o.m1 = o.m2 = o.h0 = o.h1 = o.h2 = zero;
  set_drag(pack, s, o);
  o.turns = s.turns;
  if (pack.bend >= 0)
    linearise_resistance(pack.resistance, s.resistance, s.n, tightening, o.resistance);
}

void set_stage_rate(const ContactPack& pack, double sigma, PackLinear& o) {
  if (o.idle) return;
  if (pack.bend >= 0) set_resistance_stage(sigma, o.resistance);
  if (pack.law != FrictionLaw::anchored) return;
  const Lanes s = lanes(sigma), zero = lanes(0), one = lanes(1);
  const Lanes slip = one / (s + o.tau * (one - o.q)), relax = one / (s + o.tau);
  o.m1 = o.sticking ? o.tau / s : zero;
  o.m2 = o.sticking ? zero : o.tau * o.q * slip;
  o.h0 = o.sticking ? one / s : relax;
  o.h1 = o.sticking ? relax - one / s : zero;
  o.h2 = o.sticking ? zero : slip - relax;
}

void change_pack(const ContactPack& pack, const PackLinear& linear, const BodyChange* changes,
                 const PackSides& sides, bool outside_changes, PackChange& out) {
  change_by_kind<true>(pack, linear, changes, &sides, pack.grounded && !outside_changes, out);
}

void change_stretches(const ContactPack& pack, const PackLinear& linear, const BodyChange* changes,
                      PackChange& out) {
  change_by_kind<false>(pack, linear, changes, nullptr, pack.grounded, out);
}

LaneVec solve_stretch(const PackLinear& o, const LaneVec& stretch_side, const LaneVec& stretching) {
  const LaneVec y = stretch_side - o.inverse_ct * stretching;
  return o.h0 * y + (o.h1 * dot(o.n, y)) * o.n + (o.h2 * dot(o.t, y)) * o.t;
}

namespace {

LaneMat columns(const LaneVec (&c)[3]) {
  return {{{c[0].x, c[1].x, c[2].x}, {c[0].y, c[1].y, c[2].y}, {c[0].z, c[1].z, c[2].z}}};
}

// df by dp and by dv', and by dom where n turns with it; stretches eliminated.  n_p, n_om: dn' by
// dp and dom.
template <ContactFeature feature>
TW_LANES void force_derivatives(const PackLinear& o, const LaneMat& n_p, const LaneMat& n_om,
                                LaneMat& by_p, LaneMat& by_v, LaneMat& by_turn) {
  constexpr bool flat = is_flat(feature);
  const Lanes zero = lanes(0), one = lanes(1);
  const LaneVec unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  // columns
  const LaneVec none = {zero, zero, zero};
  LaneVec p[3], v[3], turn[3];
  for (int i = 0; i < 3; ++i) {
    LaneVec dn = none;
    if constexpr (!flat) dn = n_p * unit[i];
    const Lanes dNp = normal_change(o, unit[i], none), dNv = normal_change(o, none, unit[i]);
    const Lanes deeper = -dot(o.n, unit[i]);
    const LaneVec Fp = friction_change<flat>(o, dNp, dn, none) + deeper * o.harder;
    const LaneVec Fv = friction_change<flat>(o, dNv, none, unit[i]);
    p[i] = dNp * o.n + Fp + stretched(o, Fp + deeper * o.relaxing);
    if constexpr (!flat) p[i] = p[i] + o.N * dn;
    v[i] = dNv * o.n + Fv + stretched(o, Fv);
    if constexpr (turns_normal(feature)) {
      const LaneVec turned = n_om * unit[i];
      const Lanes dNt = dot(o.h, unit[i]);
      const LaneVec Ft = friction_change<flat>(o, dNt, turned, none);
      turn[i] = dNt * o.n + Ft + stretched(o, Ft) + o.N * turned;
      if (o.deep) turn[i] = turn[i] + drag_change<flat>(o, none, turned, none);
    }
    if (!o.deep) continue;
    p[i] = p[i] + drag_change<flat>(o, unit[i], dn, none);
    v[i] = v[i] + drag_change<flat>(o, none, none, unit[i]);
  }
  by_p = columns(p);
  by_v = columns(v);
  if constexpr (turns_normal(feature)) by_turn = columns(turn);
}

// Nn
TW_LANES LaneMat normal_turn(const ContactPack& pack, const PackLinear& o) {
  const LaneMat project = scalar_matrix(lanes(1)) - outer(o.n, o.n);
  return o.inverse_length *
         (pack.feature == ContactFeature::line ? project - outer(o.l, o.l) : project);
}

// dM by dN, dd, dw' and dn', bends eliminated.  What n.df has of dn' alone, -f.dn', is taken off.
struct Resisting {
  LaneVec m, by_depth;
  LaneMat by_turn, by_normal;
};

template <bool flat>
TW_LANES void set_resisting(const PackLinear& o, Resisting& r) {
  const ResistanceLinear& s = o.resistance;
  const Lanes zero = lanes(0), one = lanes(1);
  const LaneVec unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  LaneVec turn[3], normal[3];
  r.m = with_bend(s, s.m);
  r.by_depth = s.harder + bent(s, s.harder + s.relaxing);
  for (int i = 0; i < 3; ++i) {
    turn[i] = with_bend(s, change_by_turn(s, unit[i]));
    if constexpr (!flat)
      normal[i] = with_bend(s, change_by_normal(s, unit[i])) + dot(o.f, unit[i]) * r.m;
  }
  r.by_turn = columns(turn);
  if constexpr (!flat) r.by_normal = columns(normal);
}

// How the normal and the point follow a displacement dp of b's material there and a turn dom of b
// against a, in a's frame.
struct PointTurns {
  LaneMat n_p, n_om;             // dn' by dp and dom
  LaneMat turn, point_om, keep;  // the point by dp, keep = 1 - turn, and by dom: -radius_b dn', and
                                 // what runs
};

template <ContactFeature feature>
TW_LANES void set_point_turns(const ContactPack& pack, const PackLinear& o, PointTurns& p) {
  p.keep = scalar_matrix(lanes(1));
  if constexpr (runs(feature)) {
    const RunningPoint& r = o.running;
    p.n_p = outer(r.ma, r.turn_p);
    p.n_om = outer(r.ma, r.turn_om);
    p.turn = outer(pack.radius_b * r.ma, r.turn_p) - outer(r.path, r.along_p);
    p.point_om = outer(r.path, r.along_om) - outer(pack.radius_b * r.ma, r.turn_om);
  } else if constexpr (turns_normal(feature)) {
    p.n_p = o.turn;
    p.n_om = o.turn * o.roll;
    p.turn = pack.radius_b * p.n_p + o.bulge * p.n_p;
    p.point_om = o.roll - o.bulge * p.n_om - pack.radius_b * p.n_om;
  } else if constexpr (rolls(feature)) {
    p.point_om = o.roll;
  } else if constexpr (!is_flat(feature)) {
    p.n_p = normal_turn(pack, o);
    p.turn = pack.radius_b * p.n_p;
  }
  if constexpr (!is_flat(feature)) p.keep = p.keep - p.turn;
}

// What of the force, as a sees it, changes by v, w and the rotation th of one of the bodies, and
// the point by th.
struct ForceTurns {
  const LaneMat &f_v, &f_w, &f_th_in_a, &dp_th;
  Lanes sign, inverse;  // 1 for b, -1 for a; 1/sigma
  bool of_a;
};

// dM by v and L, with dN = n.df + f.dn' and dd = -n.dp.
template <ContactFeature feature>
TW_LANES void set_resisting_block(const PackLinear& o, const Resisting& r, const PointTurns& point,
                                  const ForceTurns& by, const LaneBody& body, LaneMat& by_v,
                                  LaneMat& by_L) {
  const auto load_of = [&](const LaneMat& df) { return transposed_times(df, o.n); };
  const Lanes sign = by.sign;
  const LaneMat by_depth = outer(r.by_depth, -o.n);
  by_v = outer(r.m, load_of(by.f_v)) + (sign * by.inverse) * by_depth;
  LaneMat by_th = outer(r.m, load_of(by.f_th_in_a)) + by_depth * by.dp_th;
  if constexpr (!is_flat(feature)) {
    const LaneMat n_v = (sign * by.inverse) * point.n_p;
    LaneMat n_th = point.n_p * by.dp_th;
    if constexpr (turns_normal(feature)) n_th = n_th + sign * point.n_om;
    by_v = by_v + r.by_normal * n_v;
    by_th = by_th + r.by_normal * n_th;
  }
  if (by.of_a) by_th = by_th + times_cross(r.by_turn, o.dw) - cross_lanes(o.resistance.torque);
  by_L = by_th * body.P + (outer(r.m, load_of(by.f_w)) + sign * r.by_turn) * body.V;
}

// The arms of the force about a and b, by v and L.
template <ContactFeature feature>
TW_LANES void set_arms(const ContactPack& pack, const PackLinear& o, const PointTurns& point,
                       const ForceTurns& by, const LaneMat& P, LaneMat (&by_v)[2],
                       LaneMat (&by_L)[2]) {
  constexpr bool flat = is_flat(feature), moves = rolls(feature) || runs(feature);
  LaneMat sa_th, sb_th = scalar_matrix(lanes(0));
  sa_th = flat ? by.dp_th : point.keep * by.dp_th;
  if constexpr (moves) sa_th = sa_th + by.sign * point.point_om;
  if constexpr (rolls(feature) || !flat) sb_th = sa_th - by.dp_th;
  if (by.of_a) {
    sa_th = sa_th - cross_lanes(o.sa);
    sb_th = sb_th + pack.radius_b * cross_lanes(o.n);
  } else {
    sb_th = sb_th - cross_lanes(o.rb);
  }
  by_v[0] = (by.sign * by.inverse) * point.keep;
  by_v[1] = scalar_matrix(lanes(0));
  if constexpr (!flat) by_v[1] = (-by.sign * by.inverse) * point.turn;
  by_L[0] = sa_th * P;
  by_L[1] = sb_th * P;
}

template <ContactFeature feature>
void blocks(const ContactPack& pack, const PackLinear& o, double sigma, const LaneBody* body,
            PackBlocks& out) {
  constexpr bool flat = is_flat(feature), running = runs(feature), rolling = rolls(feature);
  constexpr bool turning = turns_normal(feature);
  PointTurns point;
  set_point_turns<feature>(pack, o, point);
  const auto& [n_p, n_om, turn, point_om, keep] = point;
  LaneMat fp, fv, fom;
  force_derivatives<feature>(o, n_p, n_om, fp, fv, fom);
  const Lanes inverse = lanes(1 / sigma);

  // by dp at fixed dv, dw, through dv' too: fq = fp + fv [dw]x keep
  const LaneMat fvw = times_cross(fv, o.dw);
  LaneMat fq;
  if constexpr (flat)
    fq = fp + fvw;
  else
    fq = fp + fvw * keep;
  LaneMat fq_om;
  if constexpr (rolling || running) fq_om = fvw * point_om;
  if constexpr (turning) fq_om = fom + fq_om;
  // df by v of b
  const LaneMat by_v = fv + inverse * (fq - times_cross(fv, o.wb));
  const LaneVec arm[2] = {o.ra, o.rb}, reach[2] = {o.sa, o.sb};

  const bool resists = pack.bend >= 0;
  Resisting resisting = {};
  if (resists) set_resisting<flat>(o, resisting);

  // outside bodies have no unknowns
  for (int X = pack.grounded ? 1 : 0; X < 2; ++X) {
    const Lanes sign = X == 1 ? lanes(1) : lanes(-1);
    const LaneMat &P = body[X].P, &V = body[X].V;

    // dp and df by v, and by the rotation th of X
    const LaneMat dp_th = (-sign) * cross_lanes(arm[X]);
    LaneMat f_th = (-sign) * times_cross(fq, arm[X]);
    if constexpr (running || rolling) f_th = f_th + sign * fq_om;
    if (X == 0) f_th = f_th - times_cross(fvw, o.sa) + times_cross(fv, o.vr);
    const LaneMat f_th_in_a = f_th;  // as a sees it
    if (X == 0) f_th = f_th - cross_lanes(o.f);
    const LaneMat f_w = (-sign) * times_cross(fv, reach[X]);
    const LaneMat f_v = sign * by_v;
    const LaneMat f_L = f_th * P + f_w * V;

    LaneMat s_v[2], s_L[2];
    const ForceTurns turns{f_v, f_w, f_th_in_a, dp_th, sign, inverse, X == 0};
    set_arms<feature>(pack, o, point, turns, P, s_v, s_L);
    LaneMat resist_v, resist_L;
    if (resists)
      set_resisting_block<feature>(o, resisting, point, turns, body[X], resist_v, resist_L);

    // torque s x f, force; on a with the opposite sign
    for (int Y = pack.grounded ? 1 : 0; Y < 2; ++Y) {
      const Lanes side = Y == 1 ? lanes(1) : lanes(-1);
      LaneMat(&part)[2][2] = out.part[Y][X];
      part[0][0] = side * f_v;
      part[0][1] = side * f_L;
      part[1][0] = side * (cross_times(reach[Y], f_v) - cross_times(o.f, s_v[Y]));
      part[1][1] = side * (cross_times(reach[Y], f_L) - cross_times(o.f, s_L[Y]));
      if (resists) {
        part[1][0] = part[1][0] + side * resist_v;
        part[1][1] = part[1][1] + side * resist_L;
      }
      if (!o.deep) continue;
      const LaneMat by_p = outer(o.more_turn, o.n);
      part[1][0] = part[1][0] + (side * sign * inverse) * by_p;
      part[1][1] = part[1][1] + side * (by_p * (dp_th * P) - (sign * o.turn_damper) * V);
    }
  }
}

}  // namespace

void pack_blocks(const ContactPack& pack, const PackLinear& linear, double sigma, const LaneBody& a,
                 const LaneBody& b, PackBlocks& out) {
  const LaneBody body[2] = {a, b};
  using F = ContactFeature;
  switch (pack.feature) {
    case F::plane: return blocks<F::plane>(pack, linear, sigma, body, out);
    case F::tangent_plane: return blocks<F::tangent_plane>(pack, linear, sigma, body, out);
    case F::curved: return blocks<F::curved>(pack, linear, sigma, body, out);
    case F::crossing:
    case F::rim: return blocks<F::crossing>(pack, linear, sigma, body, out);
    case F::line:
    case F::point: return blocks<F::point>(pack, linear, sigma, body, out);
  }
}

}  // namespace tw
