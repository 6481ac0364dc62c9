// Contact parameters per pair: who set what for whom, looked up keyword by keyword.
//
// A rule names two sides, each a body, a material, or everybody.  For a pair and a keyword, the
// rule whose more specific side is more specific wins, then the one whose other side is; at ties
// the later call.  (body over material over all.)
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tw {

enum class FrictionLaw : unsigned char { anchored, smooth };  // of lasting contacts
enum class ImpactLaw : unsigned char { chatterjee_ruina, stronge };

// One side of a rule.
struct ContactSide {
  enum class Kind : unsigned char { all, material, body } kind = Kind::all;
  std::string material;
  std::uint32_t body = 0;
};

// What a rule sets; absent: says nothing about it.
struct ContactSettings {
  std::optional<double> restitution;                          // 0..1
  std::optional<double> friction;                             // Coulomb's mu, >= 0
  std::optional<double> rolling_friction, spinning_friction;  // m, >= 0
  std::optional<double> stiffness;                            // N/m for the pair
  std::optional<double> damping;                              // s/m, Hunt-Crossley's b
  std::optional<double> fusion_speed;                         // m/s
  std::optional<FrictionLaw> friction_law;
  std::optional<ImpactLaw> impact_law;
  std::optional<bool> collide;  // set by disable/enable-collisions!
};

// What holds for one pair.
struct ContactParameters {
  double restitution = 0.3;
  double friction = 0.5;
  double rolling_friction = 0, spinning_friction = 0;  // m
  std::optional<double> stiffness, damping, fusion_speed;
  FrictionLaw friction_law = FrictionLaw::anchored;
  ImpactLaw impact_law = ImpactLaw::chatterjee_ruina;
  bool collide = true;
  bool collide_names_both = false;  // and the rule that says so names both bodies

  bool operator==(const ContactParameters&) const = default;
};

// A body as the rules see it.
struct ContactBody {
  std::uint32_t id = 0;
  std::string material;
};

class ContactTable {
 public:
  // Errors: a value out of its range, with the keyword and the range.
  void add(const ContactSide& a, const ContactSide& b, const ContactSettings& settings);
  ContactParameters look_up(const ContactBody& a, const ContactBody& b) const;
  bool empty() const { return rules_.empty(); }
  std::size_t size() const { return rules_.size(); }
  // Without those that were added after the first so many.
  void take_back(std::size_t size) { rules_.resize(size); }
  // Calls visit(side) for both sides of each rule.
  template <class Visit>
  void visit_sides(Visit&& visit) const {
    for (const Rule& rule : rules_) visit(rule.a), visit(rule.b);
  }

 private:
  struct Rule {
    ContactSide a, b;
    ContactSettings settings;
  };
  std::vector<Rule> rules_;
};

// Whether the side is about this body.
bool side_matches(const ContactSide& side, const ContactBody& body);

// How specific a match of the pair (a, b) with the sides is, in either order; nullopt: no match.
// Greater is more specific.
std::optional<int> match_specificity(const ContactSide& x, const ContactSide& y,
                                     const ContactBody& a, const ContactBody& b);

}  // namespace tw
