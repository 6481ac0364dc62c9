// The lines that show contacts in a frame.
//
// A line's length grows with the logarithm of the force, for forces in a heap span decades:
//   0.6 r log10(1 + 9 N/W),  W the median weight and r the median radius of the dynamic bodies,
// so that a contact that carries one weight gets 0.6 radii, ten weights 1.2.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#ifdef TW_RENDER
#include <algorithm>
#include <cmath>

#include "render/contact-overlay.h"
#include "script/frame-drawer.h"

namespace tw {

namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Scale {
  double weight = 0, radius = 0;  // N, m
  std::size_t bodies = 0;         // dynamic ones

  double length(double force) const { return 0.6 * radius * std::log10(1 + 9 * force / weight); }
};

Scale scale_of(const World& world) {
  std::vector<double> masses, radii;
  for (BodyId id = 0; id < world.body_count(); ++id) {
    const BodyInfo& info = world.body(id);
    if (info.kind != BodyKind::dynamic || !info.shape) continue;
    masses.push_back(info.mass);
    radii.push_back(info.shape->radius_about_origin());
  }
  if (masses.empty()) return {};
  // where nothing weighs anything: as on the ground
  const double gravity = world.gravity().norm();
  return {median(masses) * (gravity > 0 ? gravity : 9.81), median(radii), masses.size()};
}

}  // namespace

void add_contacts(DrawFrame& frame, const World& world) {
  const ContactSurvey survey = world.survey_contacts(frame.time);
  const Scale scale = scale_of(world);
  std::size_t slipping = 0;
  for (const ContactReading& contact : survey.contacts) {
    if (!(contact.force > 0)) continue;
    slipping += contact.slipping;
    frame.contacts.push_back(
        {contact.point, contact.normal, scale.length(contact.force), contact.slipping});
  }
  const auto say = [&](const std::string& text, const Ink& ink) {
    frame.hud.emplace_back(text, ink);
  };
  say("groups " + std::to_string(survey.groups), white_ink);
  say("contacts sticking " + std::to_string(frame.contacts.size() - slipping), sticking_ink);
  say("contacts slipping " + std::to_string(slipping), slipping_ink);
  say("at rest " + std::to_string(survey.bodies_at_rest) + " of " + std::to_string(scale.bodies) +
          " bodies",
      white_ink);
}

}  // namespace tw
#endif
