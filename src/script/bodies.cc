// Scheme primitives: making bodies and asking about them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/keyframes.h"
#include "script/body-def.h"
#include "script/primitive.h"
#include "script/scm-slots.h"
#include "script/states.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_bodies)

namespace {

// One property of a body: its name in messages and how it is read.
struct Property {
  const char* name;
  void (*read)(BodyDef&, SCM value, const char* name);
};

constexpr Property properties[] = {
    {"name", [](BodyDef& d, SCM v, const char* n) { d.name = to_string(v, n); }},
    {"shape",
     [](BodyDef& d, SCM v, const char* n) {
       if (scm_is_true(v)) d.shape = to_shape(v, n);
     }},
    {"visual", [](BodyDef& d, SCM v, const char* n) { d.visual = to_visual(v, n); }},
    {"density", [](BodyDef& d, SCM v, const char* n) { d.density = to_real(v, n); }},
    {"mass", [](BodyDef& d, SCM v, const char* n) { d.mass = to_real(v, n); }},
    {"inertia", [](BodyDef& d, SCM v, const char* n) { d.inertia = to_inertia(v, n); }},
    {"center-of-mass", [](BodyDef& d, SCM v, const char* n) { d.center_of_mass = to_vec3(v, n); }},
    {"position", [](BodyDef& d, SCM v, const char* n) { d.position = to_vec3(v, n); }},
    {"orientation", [](BodyDef& d, SCM v, const char* n) { d.orientation = to_quat(v, n); }},
    {"velocity", [](BodyDef& d, SCM v, const char* n) { d.velocity = to_vec3(v, n); }},
    {"angular-velocity",
     [](BodyDef& d, SCM v, const char* n) { d.angular_velocity = to_vec3(v, n); }},
    {"fixed?", [](BodyDef& d, SCM v, const char*) { d.fixed = to_bool(v); }},
    {"motion", [](BodyDef& d, SCM v, const char* n) { d.motion = to_motion(v, n); }},
    {"material", [](BodyDef& d, SCM v, const char* n) { d.material = to_symbol_name(v, n); }},
    {"color", [](BodyDef& d, SCM v, const char* n) { d.color = to_vec3(v, n); }},
    {"slots", [](BodyDef& d, SCM v, const char*) { d.slots = ScmSlots::from_alist(v); }},
    {"visible?", [](BodyDef& d, SCM v, const char*) { d.visible = to_bool(v); }},
};

void read_property(BodyDef& def, SCM name, SCM value, const char* who) {
  const std::string text = to_symbol_name(name, "the property");
  for (const Property& property : properties)
    if (text == property.name) return property.read(def, value, property.name);
  throw UserError(std::string(who) + " knows no " + text);
}

const char* kind_text(BodyKind kind) {
  switch (kind) {
    case BodyKind::fixed: return "fixed";
    case BodyKind::kinematic: return "kinematic";
    default: return "dynamic";
  }
}

}  // namespace

const BodyInfo& info_of(SCM object) {
  if (is_view(object)) return to_world(view_world(object)).body(to_view(object).body());
  if (!stands_for_body(object)) throw BadValue{"the body", object, "a body or a view of one"};
  return to_world(body_world(object)).body(body_number(object));
}

BodyDef to_body_def(SCM alist, const char* who) {
  BodyDef def;
  for (SCM rest = alist; scm_is_pair(rest); rest = SCM_CDR(rest))
    read_property(def, SCM_CAAR(rest), SCM_CDAR(rest), who);
  return def;
}

TW_PRIMITIVE(add_body, "%add-body!", (SCM world, SCM alist, SCM place),
             "Add a body with the properties of an alist; return its handle.") {
  require_outside_callbacks("add-body!");
  BodyDef def = to_body_def(alist, "add-body!");
  if (is_place(place)) def.place = to_place(place);
  const BodyId id = to_world(world).add_body(def);
  // keeps the symbols that name the slots, and a motion's procedure
  keep_with_world(world, alist);
  return from_body(world, id);
}

TW_PRIMITIVE(remove_body, "%remove-body!", (SCM world, SCM body), "Take a body out of its world.") {
  require_outside_callbacks("remove-body!");
  to_world(world).remove_body(to_body(world, body, "the body"));
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(is_removed, "%removed?", (SCM body), "Was the body removed?") {
  return scm_from_bool(!is_known(body) || info_of(body).removed);
}

TW_PRIMITIVE(world_bodies, "%world-bodies", (SCM world), "Return all bodies in order.") {
  SCM list = SCM_EOL;
  const World& w = to_world(world);
  for (std::size_t i = w.body_count(); i-- > 0;)
    if (const auto id = static_cast<BodyId>(i); !w.body(id).removed)
      list = scm_cons(from_body(world, id), list);
  return list;
}

TW_PRIMITIVE(find_body, "%find-body", (SCM world, SCM name),
             "Return the body of that name, or #f.") {
  const auto id = to_world(world).find_body(to_string(name, "the name"));
  return id ? from_body(world, *id) : SCM_BOOL_F;
}

TW_PRIMITIVE(body_name, "%body-name", (SCM body), "Return the name of a body or view.") {
  if (stands_for_body(body)) return body_name_of(body);
  return from_string(info_of(body).name);
}

TW_PRIMITIVE(body_mass, "%body-mass", (SCM body), "Return the mass in kg.") {
  if (!is_multibody(body)) return scm_from_double(info_of(body).mass);
  double sum = 0;
  for (const BodyId link : to_own_multibody(body).links)
    sum += to_world(body_world(body)).body(link).mass;
  return scm_from_double(sum);
}

TW_PRIMITIVE(body_kind, "%body-kind", (SCM body), "Return dynamic, fixed or kinematic.") {
  return scm_from_utf8_symbol(kind_text(info_of(body).kind));
}

TW_PRIMITIVE(view_body, "%view-body", (SCM view), "Return the handle of a view's body.") {
  if (is_body(view)) return view;
  if (!is_view(view)) throw BadValue{"the view", view, "a view, as a callback is handed"};
  return from_body(view_world(view), to_view(view).body());
}

TW_PRIMITIVE(followed_from, "%followed-from", (SCM world, SCM body),
             "Return where a body is that a camera is to follow.") {
  const BodyId followed = to_body(world, body, "follow");
  return from_vec3(to_world(world).state(followed).position);
}

// ---- motion ----

// (time position orientation-or-#f)
static Keyframe to_keyframe(SCM value) {
  constexpr const char* expected = "keyframes (time position) or (time position orientation)";
  const long length = scm_ilength(value);
  if (length != 2 && length != 3) throw BadValue{"keyframe", value, expected};
  Keyframe key;
  key.time = to_finite(SCM_CAR(value), "the time of a keyframe");
  key.position = to_vec3(SCM_CADR(value), "the position of a keyframe");
  if (length == 3 && scm_is_true(SCM_CADDR(value)))
    key.orientation = to_quat(SCM_CADDR(value), "the orientation of a keyframe");
  return key;
}

TW_PRIMITIVE(keyframes, "%keyframes", (SCM list, SCM smooth), "Return a motion by keyframes.") {
  if (scm_ilength(list) < 1)
    throw BadValue{"keyframes", list, "a list of keyframes (time position [orientation])"};
  std::vector<Keyframe> keys;
  for (; scm_is_pair(list); list = SCM_CDR(list)) keys.push_back(to_keyframe(SCM_CAR(list)));
  return from_motion(make_keyframes(std::move(keys), to_bool(smooth)));
}

}  // namespace tw
