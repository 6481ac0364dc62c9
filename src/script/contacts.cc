// Scheme primitives: the contacts at present, or at a view's event.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "script/primitive.h"
#include "script/states.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_contacts)

namespace {

std::vector<ContactReading> contacts_of(SCM object, const char* what) {
  if (is_view(object)) return to_view(object).contacts();
  if (!stands_for_body(object)) throw BadValue{what, object, "a body or a view of one"};
  require_outside_callbacks(what);
  const World& world = to_world(body_world(object));
  return world.contacts_of(to_own_body(object), world.time());
}

// Of a body or view, which may be one whose state nobody reads.
BodyId number_of(SCM object, const char* name) {
  if (is_view(object)) return to_view(object).body();
  if (!stands_for_body(object)) throw BadValue{name, object, "a body or a view of one"};
  return body_number(object);
}

// On the body.
Vec3 force_on(BodyId body, const ContactReading& contact) {
  const Vec3 on_second = contact.force * contact.normal + contact.friction;
  return contact.body2 == body ? on_second : Vec3(-on_second);
}

bool joins(const ContactReading& contact, BodyId body) {
  return contact.body1 == body || contact.body2 == body;
}

}  // namespace

TW_PRIMITIVE(
    contacts, "%contacts", (SCM world, SCM body),
    "Return (((A B) point normal gap force friction slipping? torque) ...) of all or one.") {
  std::vector<ContactReading> found;
  if (scm_is_true(body)) {
    found = contacts_of(body, "contacts");
    world = is_view(body) ? view_world(body) : body_world(body);
  } else {
    require_outside_callbacks("contacts without #:body");
    found = to_world(world).survey_contacts(to_world(world).time()).contacts;
  }
  SCM list = SCM_EOL;
  for (auto c = found.rbegin(); c != found.rend(); ++c) {
    const SCM bodies = scm_list_2(from_body(world, c->body1), from_body(world, c->body2));
    list = scm_cons(
        scm_list_n(bodies, from_vec3(c->point), from_vec3(c->normal), scm_from_double(c->gap),
                   scm_from_double(c->force), from_vec3(c->friction), scm_from_bool(c->slipping),
                   from_vec3(c->torque), SCM_UNDEFINED),
        list);
  }
  return list;
}

TW_PRIMITIVE(net_contact_force, "%net-contact-force", (SCM body, SCM from),
             "Return the sum of the contact forces on a body, of all or of those listed, N.") {
  const BodyId self = number_of(body, "the body");
  Vec3 sum = Vec3::Zero();
  // what is no dynamic body's own is known to those that touch it
  const bool by_others = is_view(body) && info_of(body).kind != BodyKind::dynamic;
  if (scm_is_false(from)) {
    TW_REQUIRE(!by_others,
               "net-contact-force of " + info_of(body).name +
                   ", which is not dynamic, was asked for through its view; expected #:from with "
                   "views of dynamic bodies that touch it");
    for (const ContactReading& contact : contacts_of(body, "net-contact-force"))
      sum += force_on(self, contact);
    return from_vec3(sum);
  }
  const std::vector<ContactReading> mine =
      by_others ? std::vector<ContactReading>{} : contacts_of(body, "net-contact-force");
  std::vector<BodyId> counted;
  for (const SCM other : to_elements(from, "from", "a list of bodies or views")) {
    const BodyId theirs = number_of(other, "from");
    if (theirs == self || std::find(counted.begin(), counted.end(), theirs) != counted.end())
      continue;
    counted.push_back(theirs);
    if (by_others && info_of(other).kind != BodyKind::dynamic) continue;
    for (const ContactReading& contact : by_others ? contacts_of(other, "net-contact-force") : mine)
      if (joins(contact, self) && joins(contact, theirs)) sum += force_on(self, contact);
  }
  return from_vec3(sum);
}

}  // namespace tw
