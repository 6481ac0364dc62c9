// Scheme primitives: contact parameters and which pairs collide.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/primitive.h"
#include "script/sides.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_contact)

ContactSide to_side(SCM world, SCM value, const char* name) {
  ContactSide side;
  if (is_body(value)) {
    side.kind = ContactSide::Kind::body;
    side.body = to_body(world, value, name);
  } else if (scm_is_symbol(value)) {
    side.kind = ContactSide::Kind::material;
    side.material = to_symbol_name(value, name);
  } else if (!scm_is_eq(value, SCM_BOOL_T)) {
    throw BadValue{name, value, "a body, a material (a symbol), or #t for all"};
  }
  return side;
}

std::vector<std::pair<ContactSide, ContactSide>> to_sides(SCM world, SCM a, SCM b) {
  const auto sides = [world](SCM value, const char* name) {
    if (!is_multibody(value)) return std::vector{to_side(world, value, name)};
    std::vector<ContactSide> links;
    for (const BodyId link : to_multibody(world, value, name).links) {
      ContactSide& side = links.emplace_back();
      side.kind = ContactSide::Kind::body;
      side.body = link;
    }
    return links;
  };
  std::vector<std::pair<ContactSide, ContactSide>> pairs;
  const std::vector<ContactSide> others = sides(b, "the second side");
  const bool several = is_multibody(a) || is_multibody(b);
  for (const ContactSide& one : sides(a, "the first side"))
    for (const ContactSide& other : others) {
      using enum ContactSide::Kind;
      const bool same = one.kind == body && other.kind == body && one.body == other.body;
      if (!several || !same) pairs.emplace_back(one, other);
    }
  return pairs;
}

namespace {

template <class Law>
Law to_law(SCM value, const char* name, std::initializer_list<std::pair<const char*, Law>> laws) {
  const std::string text = to_symbol_name(value, name);
  std::string known;
  for (const auto& [law_name, law] : laws) {
    if (text == law_name) return law;
    known += (known.empty() ? "" : " or ") + std::string(law_name);
  }
  throw UserError(std::string(name) + " is " + text + "; expected " + known);
}

struct Setting {
  const char* name;
  void (*read)(ContactSettings&, SCM value, const char* name);
};

constexpr Setting settings_table[] = {
    {"restitution",
     [](ContactSettings& s, SCM v, const char* n) { s.restitution = to_real(v, n); }},
    {"friction", [](ContactSettings& s, SCM v, const char* n) { s.friction = to_real(v, n); }},
    {"rolling-friction",
     [](ContactSettings& s, SCM v, const char* n) { s.rolling_friction = to_real(v, n); }},
    {"spinning-friction",
     [](ContactSettings& s, SCM v, const char* n) { s.spinning_friction = to_real(v, n); }},
    {"stiffness", [](ContactSettings& s, SCM v, const char* n) { s.stiffness = to_real(v, n); }},
    {"damping", [](ContactSettings& s, SCM v, const char* n) { s.damping = to_real(v, n); }},
    {"fusion-speed",
     [](ContactSettings& s, SCM v, const char* n) { s.fusion_speed = to_real(v, n); }},
    {"friction-law",
     [](ContactSettings& s, SCM v, const char* n) {
       s.friction_law = to_law<FrictionLaw>(
           v, n, {{"anchored", FrictionLaw::anchored}, {"smooth", FrictionLaw::smooth}});
     }},
    {"impact-law",
     [](ContactSettings& s, SCM v, const char* n) {
       s.impact_law = to_law<ImpactLaw>(
           v, n,
           {{"chatterjee-ruina", ImpactLaw::chatterjee_ruina}, {"stronge", ImpactLaw::stronge}});
     }},
    {"collide?", [](ContactSettings& s, SCM v, const char*) { s.collide = to_bool(v); }},
};

void read_setting(ContactSettings& settings, SCM name, SCM value) {
  const std::string text = to_symbol_name(name, "the setting");
  for (const Setting& setting : settings_table)
    if (text == setting.name) return setting.read(settings, value, setting.name);
  throw UserError("contact parameters have no " + text);
}

}  // namespace

TW_PRIMITIVE(set_contact, "%set-contact!", (SCM world, SCM a, SCM b, SCM alist),
             "Set contact parameters of pairs.") {
  require_outside_callbacks("set-contact-parameters!");
  ContactSettings settings;
  for (; scm_is_pair(alist); alist = SCM_CDR(alist))
    read_setting(settings, SCM_CAAR(alist), SCM_CDAR(alist));
  World& w = to_world(world);
  std::vector<std::pair<ContactSide, ContactSide>> sides = to_sides(world, a, b);
  // links that a joint joins must both be named: who means a multibody means the others
  if (settings.collide.value_or(false) && (is_multibody(a) || is_multibody(b)))
    std::erase_if(sides, [&w](const auto& pair) {
      using enum ContactSide::Kind;
      return pair.first.kind == body && pair.second.kind == body &&
             w.joined(pair.first.body, pair.second.body);
    });
  w.set_contact(sides, settings);
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(contact_parameters, "%contact-parameters", (SCM world, SCM a, SCM b),
             "Return (restitution friction collide? rolling spinning) that hold for two bodies.") {
  const ContactParameters p = to_world(world).contact_parameters(
      to_body(world, a, "the first body"), to_body(world, b, "the second body"));
  return scm_list_5(scm_from_double(p.restitution), scm_from_double(p.friction),
                    scm_from_bool(p.collide), scm_from_double(p.rolling_friction),
                    scm_from_double(p.spinning_friction));
}

}  // namespace tw
