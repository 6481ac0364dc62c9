// How a Scheme primitive is defined.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/primitive.h"

namespace tw {

void PrimitiveList::define() const {
  const SCM documentation = scm_from_utf8_symbol("documentation");
  for (const Primitive& p : list_) {
    const SCM procedure = scm_c_define_gsubr(p.name, p.arguments, 0, 0, p.function);
    scm_set_procedure_property_x(procedure, documentation, scm_from_utf8_string(p.doc));
    scm_c_export(p.name, nullptr);
  }
}

}  // namespace tw
