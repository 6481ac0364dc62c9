// Contact parameters per pair.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-parameters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/limits.h"

namespace tw {
namespace {

// 2 for the body itself, 1 for its material, 0 for everybody; -1: the side is about others.
int side_specificity(const ContactSide& side, const ContactBody& body) {
  switch (side.kind) {
    case ContactSide::Kind::body: return side.body == body.id ? 2 : -1;
    case ContactSide::Kind::material:
      return !body.material.empty() && side.material == body.material ? 1 : -1;
    case ContactSide::Kind::all: return 0;
  }
  return -1;
}

void require_range(const std::optional<double>& value, const char* keyword, double least,
                   double most, const char* expected) {
  if (!value) return;
  TW_REQUIRE(*value >= least && *value <= most && std::isfinite(*value),
             std::string("contact parameter #:") + keyword + " is " + show(*value) + "; expected " +
                 expected);
}

// Takes each value that is still open.
template <class T, class U>
void take(bool& open, const std::optional<T>& value, U& target) {
  if (!open || !value) return;
  target = *value;
  open = false;
}

}  // namespace

bool side_matches(const ContactSide& side, const ContactBody& body) {
  return side_specificity(side, body) >= 0;
}

constexpr int both_named = 3 * 2 + 2;

std::optional<int> match_specificity(const ContactSide& x, const ContactSide& y,
                                     const ContactBody& a, const ContactBody& b) {
  const auto one_way = [](const ContactSide& s, const ContactSide& t, const ContactBody& p,
                          const ContactBody& q) {
    const int i = side_specificity(s, p), j = side_specificity(t, q);
    return i < 0 || j < 0 ? -1 : 3 * std::max(i, j) + std::min(i, j);
  };
  const int best = std::max(one_way(x, y, a, b), one_way(x, y, b, a));
  if (best < 0) return std::nullopt;
  return best;
}

void ContactTable::add(const ContactSide& a, const ContactSide& b,
                       const ContactSettings& settings) {
  require_range(settings.restitution, "restitution", 0, 1, "a number from 0 to 1");
  require_range(settings.friction, "friction", 0, 1e9, "a coefficient of friction, from 0 to 1e9");
  for (const auto& [value, keyword] : {std::pair(settings.rolling_friction, "rolling-friction"),
                                       std::pair(settings.spinning_friction, "spinning-friction")})
    require_range(value, keyword, 0, greatest_length, "a length in m, from 0 to 1e12");
  require_range(settings.stiffness, "stiffness", least_stiffness, greatest_stiffness,
                "a positive number of N/m, from 1e-30 to 1e30");
  require_range(settings.damping, "damping", 0, greatest_damping,
                "a number of s/m, from 0 to 1e30");
  require_range(settings.fusion_speed, "fusion-speed", 0, speed_limit,
                "a speed in m/s, from 0 to 1e12");
  rules_.push_back({a, b, settings});
}

ContactParameters ContactTable::look_up(const ContactBody& a, const ContactBody& b) const {
  // rules that match, the most specific first, at ties the later first
  std::vector<std::pair<int, const Rule*>> found;
  for (auto rule = rules_.rbegin(); rule != rules_.rend(); ++rule)
    if (const auto s = match_specificity(rule->a, rule->b, a, b)) found.push_back({*s, &*rule});
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& x, const auto& y) { return x.first > y.first; });

  ContactParameters result;
  std::array<bool, 10> open;
  open.fill(true);
  for (const auto& [specificity, rule] : found) {
    const ContactSettings& s = rule->settings;
    take(open[0], s.restitution, result.restitution);
    take(open[1], s.friction, result.friction);
    take(open[2], s.stiffness, result.stiffness);
    take(open[3], s.damping, result.damping);
    take(open[4], s.fusion_speed, result.fusion_speed);
    take(open[5], s.friction_law, result.friction_law);
    if (open[6] && s.collide) result.collide_names_both = specificity == both_named;
    take(open[6], s.collide, result.collide);
    take(open[7], s.rolling_friction, result.rolling_friction);
    take(open[8], s.spinning_friction, result.spinning_friction);
    take(open[9], s.impact_law, result.impact_law);
  }
  return result;
}

}  // namespace tw
