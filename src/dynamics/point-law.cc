// The law of a contact at one point.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/point-law.h"

#include <algorithm>
#include <cmath>

namespace tw {
namespace {

// Which friction there is: none of the anchored kind without a tangential spring and damper.
struct Friction {
  double mu, kt, ct;         // of the point, N/m and N s/m
  double rolling, spinning;  // m
  double K, C;               // N m/rad, N m s/rad

  Friction(const ContactConstants& law, double share)
      : mu(law.mu),
        kt(share * law.kt),
        ct(share * law.ct),
        rolling(law.rolling),
        spinning(law.spinning),
        K(kt * law.squared_lever()),
        C(ct * law.squared_lever()) {
    if (law.law == FrictionLaw::anchored && !(law.ct > 0)) mu = kt = 0;
    if (!(C > 0)) rolling = spinning = K = 0;
  }
  bool resists() const { return rolling > 0 || spinning > 0; }
};

struct Normal {
  double undamped = 0, force = 0;  // k d h, N, N
  double eased = 0;                // e b, s/m
};

Normal normal_force(const ContactConstants& law, double share, const PointMotion& at) {
  Normal n;
  const double d = at.depth;
  n.eased = law.b;
  if (d > answer::hardest_ratio * law.hardening && law.hardening > 0)
    n.eased *= answer::hardest_ratio * law.hardening / d;
  const double damped = 1 - n.eased * at.velocity.dot(at.normal);
  if (!(damped > 0)) return n;
  n.undamped = spring_force(law, share, d);
  n.force = n.undamped * damped;
  return n;
}

Vec3 across(const Vec3& n, const Vec3& v) { return v - n.dot(v) * n; }

// No longer than `most`.
Vec3 cut(const Vec3& v, double most) {
  const double length = v.norm();
  return length < most ? v : Vec3(length > 0 ? Vec3(most / length * v) : Vec3(Vec3::Zero()));
}

// c, N s/m: of the dampers along the surfaces, beyond the depth at which the spring is hardest.
double drag_of(const ContactConstants& law, double share, double depth) {
  const double hardest = answer::hardest_ratio * law.hardening;
  if (!(hardest > 0 && depth > hardest)) return 0;
  const double per_hardness = share * law.k * hardest * law.b;
  double c = (1 + answer::hardening_cap) * per_hardness * (1 - hardest / depth);
  if (law.firm.firmness > 0 && depth > law.firm.limit)
    c += law.firm.firmness * per_hardness * (1 - law.firm.limit / depth);
  return c;
}

}  // namespace

PointForce point_force(const ContactConstants& law, double share, const PointMotion& at) {
  const Friction friction(law, share);
  const Vec3& n = at.normal;
  const double y = friction_grip(law, at.depth);
  PointForce f;
  f.normal_force = normal_force(law, share, at).force;
  const Vec3 slip = across(n, at.velocity);
  if (law.law == FrictionLaw::anchored) {
    const Vec3 wanted = -y * (friction.kt * across(n, at.stretch) + friction.ct * slip);
    const double cone = friction.mu * f.normal_force;
    f.slips = wanted.norm() >= cone;
    f.friction = cut(wanted, cone);
    if (friction.ct > 0)
      f.stretch_rate = -(f.friction + y * friction.kt * at.stretch) / friction.ct;
  } else if (const double speed = slip.norm(); speed > 0) {
    f.friction = -friction.mu * f.normal_force * (2 / pi) *
                 std::atan(speed / answer::smooth_speed) / speed * slip;
  }
  const double c = drag_of(law, share, at.depth);
  f.drag = -c * slip;
  f.torque = -0.5 * law.size * at.depth * c * at.turning;
  if (friction.resists()) {
    const Vec3 wanted = -y * (friction.K * at.bend + friction.C * at.turning);
    const double most = friction.spinning * f.normal_force;
    const Vec3 held = cut(across(n, wanted), friction.rolling * f.normal_force) +
                      std::clamp(n.dot(wanted), -most, most) * n;
    f.torque += held;
    f.bend_rate = -(held + y * friction.K * at.bend) / friction.C;
  }
  return f;
}

double point_energy(const ContactConstants& law, double share, const PointMotion& at) {
  const Friction friction(law, share);
  const Normal normal = normal_force(law, share, at);
  // beyond what friction holds a stretch gives nothing back; as deep as the two are, or as hard as
  // they press while they still get deeper
  const double load = std::max(normal.undamped, normal.force) / friction_grip(law, at.depth);
  const auto held = [](double k, double length, double most) {
    return k > 0 ? 0.5 * std::min(k * length * length, most * most / k) : 0;
  };
  double energy = spring_energy(law, share, at.depth);
  if (law.law == FrictionLaw::anchored)
    energy += held(friction.kt, across(at.normal, at.stretch).norm(), friction.mu * load);
  return energy + held(friction.K, across(at.normal, at.bend).norm(), friction.rolling * load) +
         held(friction.K, at.normal.dot(at.bend), friction.spinning * load);
}

}  // namespace tw
