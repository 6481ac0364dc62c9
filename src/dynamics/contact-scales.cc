// The scales of a contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-scales.h"

#include <algorithm>
#include <cmath>

namespace tw {
namespace {

// Where gravity is 0 this stands in for it, m/s^2.
constexpr double standard_gravity = 9.81;
// Share of sqrt(g size), and the least that is taken or may be set, m/s.
constexpr double fusion_share = 0.07, least_default_speed = 1e-4, least_fusion_speed = 1e-9;
// The heaviest may lie on any of its contacts: they are never softer than for a thousandth of it
// (the law hardens by no more), nor stiffer than for a thousand times the lighter one: a bead on a
// lorry must not stop the clock.
constexpr double unequal_masses = 100, most_unequal = 1000;

double smaller_size(const Body& a, const Body& b) { return std::min(a.least_width, b.least_width); }

double speed_from(const ContactParameters& parameters, double gravity, double size) {
  const double by_default = std::max(least_default_speed, fusion_share * std::sqrt(gravity * size));
  return std::max(least_fusion_speed, parameters.fusion_speed.value_or(by_default));
}

}  // namespace

double Scene::gravity_scale() const {
  const double g = options.gravity.norm();
  return g > 0 ? g : standard_gravity;
}

double ContactScales::bounce_time() const { return pi * std::sqrt(law.depth / gravity); }

double fusion_speed(const Scene& scene, const Body& a, const Body& b) {
  return speed_from(scene.contacts.between(a.id(), b.id()), scene.gravity_scale(),
                    smaller_size(a, b));
}

ContactScales contact_scales(const Scene& scene, const Body& a, const Body& b,
                             const MassRange& masses) {
  const ContactParameters& parameters = scene.contacts.between(a.id(), b.id());
  const double mass = !a.dynamic() ? b.mass : !b.dynamic() ? a.mass : std::min(a.mass, b.mass);
  ContactScales scales;
  scales.size = smaller_size(a, b);
  scales.gravity = scene.gravity_scale();
  scales.fusion_speed = speed_from(parameters, scales.gravity, scales.size);
  scales.law = contact_constants(
      parameters, std::clamp(masses.heaviest / most_unequal, mass, most_unequal * mass),
      scales.size, scales.gravity, masses.heaviest > unequal_masses * masses.lightest);
  return scales;
}

}  // namespace tw
