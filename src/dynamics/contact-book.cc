// What holds between two bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-book.h"

#include <algorithm>

namespace tw {

void ContactBook::add(const ContactSide& a, const ContactSide& b, const ContactSettings& settings) {
  table_.add(a, b, settings);
  if (settings.collide && !*settings.collide) may_disable_ = true;
  known_.clear();
  classes_.clear();
  class_of_material_.clear();
  classify();
}

void ContactBook::add_body(const Body& body) {
  bodies_.push_back(body.contact);
  classify();
}

void ContactBook::classify() {
  while (classes_.size() < bodies_.size()) {
    const BodyId id = static_cast<BodyId>(classes_.size());
    BodyId first = id;
    if (!table_.names_body(id))
      first = class_of_material_.try_emplace(bodies_[id].material, id).first->second;
    classes_.push_back(first);
  }
}

const ContactParameters& ContactBook::between(BodyId a, BodyId b) const {
  const BodyId x = std::min(classes_[a], classes_[b]), y = std::max(classes_[a], classes_[b]);
  const std::uint64_t id = std::uint64_t{x} << 32 | y;
  const auto known = known_.find(id);
  if (known != known_.end()) return known->second;
  return known_.emplace(id, table_.look_up(bodies_[a], bodies_[b])).first->second;
}

}  // namespace tw
