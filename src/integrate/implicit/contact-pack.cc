// Geometry and force of four contacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/contact-pack.h"

#include <algorithm>
#include <numeric>

#include "base/constants.h"

namespace tw {

namespace {

// One of the bodies of each contact.
class LaneBodies {
 public:
  TW_LANES LaneBodies(const ContactPack& pack, const BodyKinematics* bodies,
                      const int (&slot)[lane_count])
      : uniform_(pack.uniform) {
    for (int i = 0; i < lane_count; ++i) body_[i] = &bodies[slot[i]];
  }
  TW_LANES LaneVec x() const {
    return of([](const BodyKinematics* b) { return b->x; });
  }
  TW_LANES LaneVec v() const {
    return of([](const BodyKinematics* b) { return b->v; });
  }
  TW_LANES LaneVec w() const {
    return of([](const BodyKinematics* b) { return b->w; });
  }
  TW_LANES LaneMat R() const {
    LaneMat R;
    for (int r = 0; r < 3; ++r)
      R.row[r] = of([r](const BodyKinematics* b) { return b->R + 3 * r; });
    return R;
  }

 private:
  template <class Get>
  TW_LANES LaneVec of(Get get) const {
    if (uniform_) return broadcast(get(body_[0]));
    return gather_vec(get(body_[0]), get(body_[1]), get(body_[2]), get(body_[3]));
  }

  const BodyKinematics* body_[lane_count];
  bool uniform_;
};

TW_LANES LaneVec unit(const LaneVec& v) {
  const Lanes length = sqrt(dot(v, v));
  const Lanes inverse = length > lanes(0) ? lanes(1) / length : lanes(0);
  return inverse * v;
}

// Two lines that cross: l and lb, with D from a point of a's to one of b's.
struct Crossing {
  LaneVec lb, ma, mb;  // n x l, n x lb
  Lanes inverse_sine;  // 1/S, l x lb = S n; 0 where S is
  Lanes height;        // of b's line over a's, along n
  Lanes along;         // from that point of b's line to the one nearest to a's: lb.ma = S
};

TW_LANES Crossing cross_lines(const LaneVec& D, const LaneVec& lb, const LaneVec& side,
                              PackState& o) {
  Crossing c;
  c.lb = lb;
  const LaneVec across = cross(o.l, lb);
  const Lanes sine = sqrt(dot(across, across));
  const LaneMask somewhere = sine > lanes(0);
  const Lanes sign = dot(across, side) < lanes(0) ? lanes(-1) : lanes(1);
  c.inverse_sine = somewhere ? sign / sine : lanes(0);
  o.n = select(somewhere, c.inverse_sine * across, side);
  c.ma = cross(o.n, o.l);
  c.mb = cross(o.n, lb);
  c.height = dot(o.n, D);
  c.along = -dot(c.ma, D) * c.inverse_sine;
  return c;
}

// The point runs by (mu H - m_a.dp)/S, and n by mu m_a, mu = m_b.dom/S.
TW_LANES LaneVec set_crossing(const ContactPack& pack, const LaneVec& D, const LaneMat& Rb,
                              const LaneVec& side, PackState& o) {
  const Crossing c = cross_lines(D, Rb * pack.other_direction, side, o);
  RunningPoint& r = o.running;
  r.path = c.lb;
  r.along_p = -(c.inverse_sine * c.ma);
  r.along_om = (c.inverse_sine * c.inverse_sine * c.height) * c.mb;
  r.ma = c.ma;
  r.turn_p = {lanes(0), lanes(0), lanes(0)};
  r.turn_om = c.inverse_sine * c.mb;
  o.gap = c.height - pack.radius_a - pack.radius_b;
  return c.along * c.lb;
}

// D to the centre of a circle with the axis k: the point in the direction e, square to k, is the
// nearest where the one of its tangent t = k x e is.  Newton's method on the angle psi: the height
// of that point along m_a changes by F = R S - H n.e/S a radian.  It starts where the line's own
// point p_a is seen, which is where the two were nearest first: the normal says little of where on
// the circle that is when the line lies almost flat on its plane.  Then
//   dpsi = (H m_b.dom/S - m_a.dp)/F,  the point runs by R t dpsi, and n by
//   m_a (m_b.dom + n.e dpsi)/S.
TW_LANES LaneVec set_rim(const ContactPack& pack, const LaneVec& D, const LaneMat& Rb,
                         const LaneVec& side, PackState& o) {
  constexpr int iterations = 5;
  const LaneVec k = Rb * pack.other_direction;
  LaneVec e = -unit(D - dot(k, D) * k), t;
  Crossing c;
  Lanes inverse_rate, by_edge;
  for (int i = 0;; ++i) {
    t = cross(k, e);
    c = cross_lines(D + pack.rim * e, t, side, o);
    by_edge = c.inverse_sine * dot(o.n, e);
    const Lanes rate = pack.rim * dot(c.ma, t) - c.height * by_edge;
    inverse_rate = rate * rate > lanes(0) ? lanes(1) / rate : lanes(0);
    if (i == iterations) break;
    e = unit(e + (-dot(c.ma, D + pack.rim * e) * inverse_rate) * t);
  }
  RunningPoint& r = o.running;
  r.path = pack.rim * t;
  r.along_p = -(inverse_rate * c.ma);
  r.along_om = (c.height * c.inverse_sine * inverse_rate) * c.mb;
  r.ma = c.ma;
  r.turn_p = by_edge * r.along_p;
  r.turn_om = c.inverse_sine * c.mb + by_edge * r.along_om;
  o.gap = c.height - pack.radius_a - pack.radius_b;
  return pack.rim * e;
}

// Of an ellipsoid A its point farthest along n, from its centre, A u with u = A^T n/h, h = |A^T n|,
// and the second derivatives of h: how that point moves when n turns.  Of a circle that is level h
// is 0, and its lowest point is anywhere: the derivatives end there.
struct Farthest {
  LaneVec point;
  LaneMat curvature;  // (A A^T - A u (A u)^T)/h
};

TW_LANES Farthest farthest_along(const LaneMat& A, const LaneVec& n) {
  const LaneVec along = transposed_times(A, n);
  const Lanes h = sqrt(dot(along, along));
  const LaneMat S = {{A * A.row[0], A * A.row[1], A * A.row[2]}};
  const Lanes level = lanes(answer::level_circle) * sqrt(S.row[0].x + S.row[1].y + S.row[2].z);
  Farthest result;
  result.point = A * (lanes(1) / max(h, lanes(1e-300)) * along);
  result.curvature =
      lanes(1) / max(max(h, level), lanes(1e-300)) * (S - outer(result.point, result.point));
  return result;
}

// The lowest point of b's ellipsoid, from its centre: with H its second derivatives it runs by
// -H (n x dom).
TW_LANES LaneVec set_tangent_plane(const ContactPack& pack, const LaneMat& Rb, PackState& o) {
  o.n = o.Ra * pack.normal;
  const Farthest b = farthest_along(Rb * pack.ellipsoids->b, o.n);
  o.roll = lanes(-1) * times_cross(b.curvature, o.n);
  return -b.point;
}

// The inverse of a symmetric M across n, and across l where that isn't 0; 0 where there is none.
TW_LANES LaneMat inverse_across(const LaneMat& M, const LaneVec& n, const LaneVec& l) {
  const Lanes zero = lanes(0), one = lanes(1);
  const LaneMask lined = dot(l, l) > zero;
  const LaneMask upright = n.x * n.x > lanes(0.5);
  const LaneVec beside = {upright ? zero : one, upright ? one : zero, zero};
  const LaneVec s = select(lined, l, unit(cross(n, beside))), t = cross(n, s);
  const LaneVec Mt = M * t;
  const Lanes ss = lined ? one : dot(s, M * s), st = lined ? zero : dot(s, Mt), tt = dot(t, Mt);
  const Lanes determinant = ss * tt - st * st;
  const Lanes inverse = determinant * determinant > zero ? one / determinant : zero;
  const Lanes by_s = lined ? zero : inverse * tt;
  return outer(s, by_s * s - (inverse * st) * t) +
         outer(t, (inverse * ss) * t - (inverse * st) * s);
}

// The n of the greatest gap, n.D - h_a - h_b - radii with D from centre to centre: Newton's method,
// n turns by T E, E = D - x_a - x_b from point to point and T the inverse of H_a + H_b + n.E across
// n (H + radius of each and the gap, as two balls have the distance of their centres).  In a's
// frame E turns by dp + H_b (dom x n) - (H_a + H_b) dn and stays along n, so that
//   dn = T (dp - H_b (n x dom)),  and b's point runs by -H_b (dn + n x dom).
TW_LANES LaneVec set_curved(const ContactPack& pack, const LaneVec& D, const LaneMat& Rb,
                            const LaneVec& side, PackState& o) {
  constexpr int iterations = 5;
  const LaneMat axes_a = o.Ra * pack.ellipsoids->a, axes_b = Rb * pack.ellipsoids->b;
  const LaneVec l = o.Ra * pack.direction;
  const auto across_line = [&](const LaneVec& v) { return v - dot(l, v) * l; };
  o.n = unit(across_line(side));
  for (int i = 0;; ++i) {
    const Farthest a = farthest_along(axes_a, o.n), b = farthest_along(axes_b, o.n);
    const LaneVec E = across_line(D - a.point - b.point);
    const Lanes apart = dot(o.n, E);
    o.turn = inverse_across(a.curvature + b.curvature + scalar_matrix(apart), o.n, l);
    if (i == iterations) {
      o.gap = apart - pack.radius_a - pack.radius_b;
      o.bulge = b.curvature;
      o.roll = lanes(-1) * times_cross(b.curvature, o.n);
      return -b.point;
    }
    const LaneVec by = o.turn * E;
    const Lanes length = sqrt(dot(by, by)), most = lanes(0.5);
    o.n = unit(across_line(o.n + (length > most ? most / length : lanes(1)) * by));
  }
}

// n, gap and the signed 1/|arm| from D = P_b - P_a
template <ContactFeature feature>
TW_LANES void set_normal(const ContactPack& pack, const LaneVec& D, const LaneVec& side,
                         PackState& o) {
  if constexpr (feature == ContactFeature::plane) {
    o.n = o.Ra * pack.normal;
    o.gap = dot(o.n, D) - pack.radius_b;
    o.inverse_length = lanes(0);
    return;
  }
  o.arm = D;
  if constexpr (feature == ContactFeature::line) {
    o.l = o.Ra * pack.direction;
    o.arm = D - dot(o.l, D) * o.l;
  }
  const Lanes length = sqrt(dot(o.arm, o.arm));
  const Lanes sign = dot(o.arm, side) < lanes(0) ? lanes(-1) : lanes(1);
  const LaneMask somewhere = length > lanes(0);
  o.inverse_length = somewhere ? sign / length : lanes(0);
  o.n = select(somewhere, o.inverse_length * o.arm, side);
  o.gap = sign * length - pack.radius_a - pack.radius_b;
}

// Whether no contact of the pack presses, or touches so nearly that it could.
TW_LANES bool is_idle(const ContactPack& pack, const PackState& o) {
  const Lanes zero = lanes(0), ratio = o.depth * pack.inverse_hardening;
  return pack.bend < 0 && !any((pack.k > zero) & (ratio > lanes(-answer::just_touching)));
}

// Stretches relax, and nothing else happens.
TW_LANES void set_idle(const ContactPack& pack, const LaneVec& stretch, PackState& o) {
  const LaneVec none = {lanes(0), lanes(0), lanes(0)};
  o.damping = pack.damping;
  o.grip = lanes(1);
  o.kt = pack.kt;
  o.ct = pack.ct;
  o.N = o.stiffness = o.target_length = o.scale = o.drag = lanes(0);
  o.target = o.F = o.f = none;
  o.slipping = LaneMask{};
  o.reaches_firmness = o.firm = o.deep = o.turns = false;
  o.stretch_rate = pack.law == FrictionLaw::anchored ? (-pack.kt / pack.ct) * stretch : none;
}

// Adds H s^4 to the hardness h, s from 0 to 1 between a share of dl and dl, and (d H s^4)' to y^2,
// beyond dl that at dl.
TW_LANES void add_firmness(const ContactPack& pack, bool without, PackState& o, Lanes& hard,
                           Lanes& squared_grip) {
  const Lanes zero = lanes(0), one = lanes(1), from = lanes(answer::firm_from);
  const Lanes depth = o.depth * pack.inverse_limit;
  const LaneMask begun = (depth > from) & (pack.firmness > zero);
  o.reaches_firmness = any(begun);
  o.firm = o.reaches_firmness && !without;
  if (!o.firm) return;
  const Lanes rest = one - from, s = begun ? (min(depth, one) - from) / rest : zero;
  const Lanes cubed = pack.firmness * s * s * s;
  o.firm_part = s;
  o.harder = s < one ? lanes(4) * cubed * pack.inverse_limit / rest : zero;
  hard += cubed * s;
  squared_grip += cubed * (s + lanes(4) * min(depth, one) / rest);
}

// N = max(0, k d h (1 - b vn)), h = 1 + min((d/dh)^2, cap) + H s^4, b less beyond the cap
TW_LANES void set_normal_force(const ContactPack& pack, bool without_firmness, PackState& o) {
  const Lanes zero = lanes(0), one = lanes(1);
  const Lanes depth = o.depth, ratio = depth * pack.inverse_hardening;
  Lanes hard = one + min(ratio * ratio, lanes(answer::hardening_cap));
  Lanes squared_grip = hard;
  add_firmness(pack, without_firmness, o, hard, squared_grip);
  const Lanes ease = min(one, lanes(answer::hardest_ratio) / max(ratio, lanes(1e-300)));
  o.damping = ease * pack.damping;
  o.grip = depth > zero ? sqrt(squared_grip) : one;
  const Lanes damped = one - o.damping * o.vn;
  const LaneMask pressed = (depth > zero) & (damped > zero);
  o.stiffness = pressed ? pack.k * depth * hard : zero;
  o.N = o.stiffness * damped;
  o.N = pressed ? o.N : zero;
}

// F* = -y (kt s_t + ct u), cut to mu N
TW_LANES void set_anchored_friction(const ContactPack& pack, PackState& o) {
  const LaneVec st = o.s - dot(o.n, o.s) * o.n;
  o.kt = o.grip * pack.kt;
  o.ct = o.grip * pack.ct;
  o.target = -(o.kt * st) - o.ct * o.u;
  o.target_length = sqrt(dot(o.target, o.target));
  const Lanes limit = pack.mu * o.N;
  o.slipping = o.target_length >= limit;
  o.scale = o.slipping ? limit / max(o.target_length, lanes(1e-300)) : lanes(1);
  o.F = o.scale * o.target;
  // xi' = R_a^T (-F - y kt s)/ct
  o.stretch_rate = transposed_times(o.Ra, (lanes(-1) / pack.ct) * (o.F + o.kt * o.s));
}

// F = -mu N (2/pi) atan(|u|/v0)/|u| u
TW_LANES void set_smooth_friction(const ContactPack& pack, PackState& o) {
  o.target = o.u;
  o.target_length = sqrt(dot(o.u, o.u));
  o.slipping = LaneMask{};
  for (int i = 0; i < lane_count; ++i) {
    const double speed = o.target_length[i];
    // atan(y)/y is 1 to rounding below 1e-8
    const double per_speed = speed > 1e-8 * answer::smooth_speed
                                 ? std::atan(speed / answer::smooth_speed) / speed
                                 : 1 / answer::smooth_speed;
    o.scale[i] = -(2 / pi) * pack.mu[i] * o.N[i] * per_speed;
  }
  o.F = o.scale * o.target;
  o.stretch_rate = {lanes(0), lanes(0), lanes(0)};
}

// Beyond the cap a damper along the surfaces and of turning, too: c = k (1 + cap) tau (1 - e),
// and k H tau (1 - dl/d) more beyond dl; C = c d size/2
TW_LANES void add_drag(const ContactPack& pack, PackState& o) {
  const Lanes zero = lanes(0), one = lanes(1), hardest = lanes(answer::hardest_ratio);
  o.drag = o.firm_drag = zero;
  const Lanes ratio = o.depth * pack.inverse_hardening;
  const LaneMask beyond = ratio > hardest;
  o.deep = o.turns = any(beyond);
  if (!o.deep) return;
  const Lanes most =
      lanes(1 + answer::hardening_cap) * pack.k * pack.damping * (o.depth * hardest / ratio);
  o.drag = beyond ? most * (one - hardest / ratio) : zero;
  if (o.firm) {
    const Lanes depth = o.depth * pack.inverse_limit;
    const Lanes share = pack.firmness * lanes(1 / (1 + answer::hardening_cap));
    o.firm_drag = beyond & (depth > one) ? share * most * (one - one / depth) : zero;
    o.drag += o.firm_drag;
  }
  o.f = o.f - o.drag * o.u;
  o.turn_drag = o.drag * o.depth * pack.half_size;
  o.torque = o.turn_drag * (o.wa - o.wb);
}

TW_LANES void add_resistance(const ContactPack& pack, const LaneVec& bend, PackState& o) {
  evaluate_resistance(pack.resistance, o.Ra, o.n, o.N, o.grip, o.wb - o.wa, bend, o.resistance);
  o.torque = o.turns ? o.torque + o.resistance.torque : o.resistance.torque;
  o.turns = true;
}

template <ContactFeature feature>
void evaluate(const ContactPack& pack, const BodyKinematics* bodies, const LaneVec& stretch,
              const LaneVec& bend, const LaneVec& side, const PackWish& wish, PackState& o) {
  // core points
  const LaneBodies a(pack, bodies, pack.a), b(pack, bodies, pack.b);
  o.Ra = a.R();
  const LaneMat Rb = b.R();
  o.rb = Rb * pack.point_b;
  o.ra = b.x() - a.x() + o.rb;
  const LaneVec D = o.ra - o.Ra * pack.point_a;
  if constexpr (runs(feature)) {
    o.l = o.Ra * pack.direction;
    o.inverse_length = lanes(0);
    LaneVec along;
    if constexpr (feature == ContactFeature::rim)
      along = set_rim(pack, D, Rb, side, o);
    else
      along = set_crossing(pack, D, Rb, side, o);
    o.ra = o.ra + along;
    o.rb = o.rb + along;
  } else if constexpr (rolls(feature)) {
    LaneVec lowest;
    if constexpr (feature == ContactFeature::curved) {
      lowest = set_curved(pack, D, Rb, side, o);
    } else {
      lowest = set_tangent_plane(pack, Rb, o);
      o.gap = dot(o.n, D + lowest) - pack.radius_b;
    }
    o.ra = o.ra + lowest;
    o.rb = o.rb + lowest;
    o.inverse_length = lanes(0);
  } else {
    set_normal<feature>(pack, D, side, o);
  }

  o.depth = pack.offset - o.gap;
  o.idle = is_idle(pack, o);
  if (o.idle) set_idle(pack, stretch, o);
  if (o.idle && wish.forces_alone) return;

  // velocity at the contact point
  o.sa = o.ra - pack.radius_b * o.n;
  o.sb = o.rb - pack.radius_b * o.n;
  o.wa = a.w();
  o.wb = b.w();
  o.vr = b.v() + cross(o.wb, o.sb) - a.v() - cross(o.wa, o.sa);
  o.vn = dot(o.n, o.vr);
  o.u = o.vr - o.vn * o.n;
  o.s = o.Ra * stretch;
  if (o.idle) return;

  // force
  set_normal_force(pack, wish.without_firmness, o);
  if (pack.law == FrictionLaw::anchored)
    set_anchored_friction(pack, o);
  else
    set_smooth_friction(pack, o);
  o.f = o.N * o.n + o.F;
  add_drag(pack, o);
  if (pack.bend >= 0) add_resistance(pack, bend, o);
}

void set_lane(LaneMat& m, int lane, const Mat3& value) {
  for (int r = 0; r < 3; ++r) set_lane(m.row[r], lane, value.row(r));
}

void fill_lane(ContactPack& pack, int lane, const GroupContact& contact, int members) {
  const auto slot = [members](int body) { return body >= 0 ? body : members + ~body; };
  pack.a[lane] = slot(contact.a);
  pack.b[lane] = slot(contact.b);
  set_lane(pack.normal, lane, contact.normal);
  set_lane(pack.direction, lane, contact.direction);
  set_lane(pack.other_direction, lane, contact.other_direction);
  set_lane(pack.point_a, lane, contact.point_a);
  set_lane(pack.point_b, lane, contact.point_b);
  pack.radius_a[lane] = contact.radius_a;
  pack.radius_b[lane] = contact.radius_b;
  pack.rim[lane] = contact.rim;
  if (pack.ellipsoids) {
    set_lane(pack.ellipsoids->a, lane, contact.ellipsoids->a);
    set_lane(pack.ellipsoids->b, lane, contact.ellipsoids->b);
  }
  pack.offset[lane] = contact.offset;
  const ContactConstants& law = contact.law;
  pack.k[lane] = contact.share * law.k;
  pack.inverse_hardening[lane] = law.hardening > 0 ? 1 / law.hardening : 0;
  pack.inverse_limit[lane] = law.firm.limit > 0 ? 1 / law.firm.limit : 0;
  pack.firmness[lane] = law.firm.firmness;
  pack.damping[lane] = law.b;
  pack.half_size[lane] = 0.5 * law.size;
  const double turning = contact.share * law.squared_lever();
  const bool resists = turning * law.ct > 0;
  pack.resistance.rolling[lane] = resists ? law.rolling : 0;
  pack.resistance.spinning[lane] = resists ? law.spinning : 0;
  pack.resistance.k[lane] = resists ? turning * law.kt : 0;
  pack.resistance.c[lane] = resists ? turning * law.ct : 1;
  // without a tangential spring and damper there is no friction of the anchored kind
  const bool frictionless = law.law == FrictionLaw::anchored && !(law.ct > 0);
  pack.mu[lane] = frictionless ? 0 : law.mu;
  pack.kt[lane] = frictionless ? 0 : contact.share * law.kt;
  pack.ct[lane] = frictionless ? 1 : contact.share * law.ct;
}

bool same_pair(const GroupContact& x, const GroupContact& y) { return x.a == y.a && x.b == y.b; }

// bodies of lanes without contact: those of the first lane
void finish_pack(ContactPack& pack, int members) {
  pack.uniform = true;
  pack.grounded = true;
  for (int i = 0; i < pack.count; ++i) {
    pack.uniform &= pack.a[i] == pack.a[0] && pack.b[i] == pack.b[0];
    pack.grounded &= pack.a[i] >= members;
  }
  for (int i = pack.count; i < lane_count; ++i) {
    pack.a[i] = pack.a[0];
    pack.b[i] = pack.b[0];
  }
}

// contacts that touch nothing: without stiffness
ContactPack empty_pack() {
  ContactPack pack;
  for (int i = 0; i < lane_count; ++i) {
    pack.contact[i] = -1;
    fill_lane(pack, i, GroupContact{}, 0);
  }
  return pack;
}

}  // namespace

void evaluate_pack(const ContactPack& pack, const BodyKinematics* bodies, const LaneVec& stretch,
                   const LaneVec& bend, const LaneVec& side, PackState& out, const PackWish& wish) {
  using F = ContactFeature;
  switch (pack.feature) {
    case F::plane: return evaluate<F::plane>(pack, bodies, stretch, bend, side, wish, out);
    case F::line: return evaluate<F::line>(pack, bodies, stretch, bend, side, wish, out);
    case F::point: return evaluate<F::point>(pack, bodies, stretch, bend, side, wish, out);
    case F::crossing: return evaluate<F::crossing>(pack, bodies, stretch, bend, side, wish, out);
    case F::rim: return evaluate<F::rim>(pack, bodies, stretch, bend, side, wish, out);
    case F::tangent_plane:
      return evaluate<F::tangent_plane>(pack, bodies, stretch, bend, side, wish, out);
    case F::curved: return evaluate<F::curved>(pack, bodies, stretch, bend, side, wish, out);
  }
}

LaneVec starting_side(const ContactPack& pack, const BodyKinematics* bodies) {
  return LaneBodies(pack, bodies, pack.a).R() * pack.normal;
}

namespace {

// Of the second hardening: the integral of k H d s^4, beyond dl of k H d.
TW_LANES Lanes firm_energy(const ContactPack& pack, const PackState& state) {
  constexpr double from = answer::firm_from, rest = 1 - from;
  const Lanes zero = lanes(0), one = lanes(1), s = state.firm_part, squared = s * s;
  const Lanes depth = state.depth * pack.inverse_limit;
  const Lanes ends = lanes(rest * from / 5) + lanes(rest * rest / 6) * s;
  const Lanes within = squared * squared * s * ends;
  const Lanes beyond = lanes(0.5) * max(zero, depth * depth - one);
  const Lanes limit = s > zero ? one / pack.inverse_limit : zero;
  return pack.k * pack.firmness * limit * limit * (within + beyond);
}

}  // namespace

Lanes pack_energy(const ContactPack& pack, const PackState& state) {
  const Lanes zero = lanes(0), half = lanes(0.5), cap = lanes(answer::hardening_cap);
  // integral of k d (1 + min(r^2, cap)), r = d/dh: k d^2/2 (1 + r^2/2), beyond the cap
  // k d^2/2 (1 + cap) less what the cap cut off, k dh^2 cap^2/4
  const Lanes depth = max(state.depth, zero), ratio = depth * pack.inverse_hardening;
  const Lanes squared = ratio * ratio;
  const Lanes over = cap * cap / max(squared, cap);
  const Lanes hard = squared < cap ? half * squared : cap - half * over;
  const Lanes normal = half * pack.k * depth * depth * (lanes(1) + hard);
  Lanes all = normal;
  if (state.firm) all += firm_energy(pack, state);
  // beyond the cone a stretch pushes no harder: it relaxes by sliding and gives nothing back; as
  // deep as they are, or as hard as they press while they still get deeper
  const Lanes pressing = max(state.stiffness, state.N) / state.grip;
  if (pack.bend >= 0) all += bend_energy(pack.resistance, state.n, state.resistance.z, pressing);
  if (pack.law != FrictionLaw::anchored) return all;
  const LaneVec st = state.s - dot(state.n, state.s) * state.n;
  const Lanes cone = pack.mu * pressing;
  const Lanes tiny = lanes(1e-300);
  return all + half * min(pack.kt * dot(st, st), cone * cone / max(pack.kt, tiny));
}

ContactPacks make_contact_packs(const GroupStart& start) {
  const std::vector<GroupContact>& contacts = start.contacts;
  const int members = static_cast<int>(start.members.size());
  ContactPacks result;
  result.slots = members + static_cast<int>(start.outside.size());
  result.places.resize(contacts.size());

  // by feature and law, and what presses apart from what is open: packs of that cost little
  std::vector<int> order(contacts.size());
  std::iota(order.begin(), order.end(), 0);
  const auto kind = [&](int i) {
    const GroupContact& c = contacts[static_cast<std::size_t>(i)];
    return 4 * static_cast<int>(c.feature) + 2 * static_cast<int>(c.law.law) + !c.pressed;
  };
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return kind(i) < kind(j); });

  static const ContactPack empty = empty_pack();
  // four contacts a pack, or fewer
  result.packs.reserve(contacts.size() / 3 + 1);
  // fill pack after pack; pairs with several contacts begin one of their own
  for (std::size_t at = 0; at < order.size(); ++at) {
    const int i = order[at];
    const GroupContact& contact = contacts[static_cast<std::size_t>(i)];
    const bool new_kind = at == 0 || kind(i) != kind(order[at - 1]);
    const bool new_pair =
        at > 0 && !same_pair(contact, contacts[static_cast<std::size_t>(order[at - 1])]);
    const bool several = at + 2 < order.size() && kind(order[at + 2]) == kind(i) &&
                         same_pair(contact, contacts[static_cast<std::size_t>(order[at + 2])]);
    if (new_kind || result.packs.back().count == lane_count || (new_pair && several)) {
      ContactPack& fresh = result.packs.emplace_back(empty);
      fresh.feature = contact.feature;
      fresh.law = contact.law.law;
      // lanes without a contact hold balls
      if (rolls(fresh.feature)) {
        const LaneMat ball = scalar_matrix(lanes(1));
        fresh.ellipsoids = std::make_shared<PackEllipsoids>(PackEllipsoids{ball, ball});
      }
    }
    ContactPack& pack = result.packs.back();
    pack.contact[pack.count] = i;
    fill_lane(pack, pack.count, contact, members);
    result.places[static_cast<std::size_t>(i)] = {static_cast<int>(result.packs.size()) - 1,
                                                  pack.count++};
  }
  for (ContactPack& pack : result.packs) {
    finish_pack(pack, members);
    const ResistanceLaw& law = pack.resistance;
    if (any((law.rolling > lanes(0)) | (law.spinning > lanes(0)))) pack.bend = result.bends++;
  }
  return result;
}

}  // namespace tw
