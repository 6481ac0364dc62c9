// Scheme primitives: the contacts at present.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_contacts)

TW_PRIMITIVE(contacts, "%contacts", (SCM world),
             "Return (((A B) point normal gap force friction slipping?) ...).") {
  require_outside_callbacks("contacts");
  const World& w = to_world(world);
  SCM list = SCM_EOL;
  for (const ContactReading& c : w.survey_contacts(w.time()).contacts) {
    const SCM bodies = scm_list_2(from_body(world, c.body1), from_body(world, c.body2));
    list = scm_cons(scm_list_n(bodies, from_vec3(c.point), from_vec3(c.normal),
                               scm_from_double(c.gap), scm_from_double(c.force),
                               from_vec3(c.friction), scm_from_bool(c.slipping), SCM_UNDEFINED),
                    list);
  }
  return scm_reverse(list);
}

}  // namespace tw
