// The scales of a contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-scales.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace tw {
namespace {

double speed_from(const ContactParameters& parameters, double gravity, double size) {
  const double by_default =
      std::max(answer::least_default_speed, answer::fusion_share * std::sqrt(gravity * size));
  return std::max(answer::least_fusion_speed, parameters.fusion_speed.value_or(by_default));
}

}  // namespace

double Scene::gravity_scale() const {
  const double g = options.gravity.norm();
  return g > 0 ? g : answer::standard_gravity;
}

double lesser_thickness(const Body& a, const Body& b) { return std::min(a.thickness, b.thickness); }

double ContactScales::bounce_time() const { return pi * std::sqrt(law.depth / gravity); }

double fusion_speed(const Scene& scene, const Body& a, const Body& b) {
  return speed_from(scene.contacts.between(a.id(), b.id()), scene.gravity_scale(),
                    lesser_thickness(a, b));
}

double borne_speed(double fusion_speed, double depth, double gravity) {
  return std::max(fusion_speed,
                  answer::fusion_share * std::sqrt(gravity * depth / answer::depth_share));
}

ContactScales contact_scales(const Scene& scene, const Body& a, const Body& b,
                             const MassRange& masses) {
  const ContactParameters& parameters = scene.contacts.between(a.id(), b.id());
  const double mass = !a.dynamic() ? b.mass : !b.dynamic() ? a.mass : std::min(a.mass, b.mass);
  ContactScales scales;
  scales.thickness = lesser_thickness(a, b);
  scales.gravity = scene.gravity_scale();
  scales.fusion_speed = speed_from(parameters, scales.gravity, scales.thickness);
  scales.law = contact_constants(
      parameters,
      std::clamp(masses.heaviest / answer::most_unequal, mass, answer::most_unequal * mass),
      scales.thickness, scales.gravity, masses.heaviest > answer::unequal_masses * masses.lightest);
  scales.borne_speed = borne_speed(scales.fusion_speed, scales.law.depth, scales.gravity);
  return scales;
}

}  // namespace tw
