// Names of keys, for messages.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/key.h"

#include "base/error.h"

namespace tw {

const char* kind_name(KeyKind kind) {
  switch (kind) {
    case KeyKind::birth: return "birth";
    case KeyKind::step: return "step";
    case KeyKind::early_edit: return "edit";
    case KeyKind::callback: return "callback";
    case KeyKind::group_check: return "group check";
    case KeyKind::impact: return "impact";
    case KeyKind::edit: return "edit";
  }
  return "unknown kind";
}

std::uint64_t kind_code(KeyKind kind) {
  switch (kind) {
    case KeyKind::birth: return 0;
    case KeyKind::step: return 1;
    case KeyKind::callback: return 2;
    case KeyKind::group_check: return 3;
    case KeyKind::impact: return 6;
    case KeyKind::edit: return 7;
    case KeyKind::early_edit: return 8;
  }
  return 9;
}

std::string show(const Key& key) {
  std::string id = std::to_string(key.id);
  if (key.kind == KeyKind::impact)
    id = std::to_string(key.id >> 32) + "-" + std::to_string(key.id & 0xffffffffu);
  return std::string(kind_name(key.kind)) + " " + id + " at " + show(key.time) + " s, microstep " +
         std::to_string(key.microstep);
}

}  // namespace tw
