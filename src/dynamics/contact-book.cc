// What holds between two bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-book.h"

#include <algorithm>
#include <atomic>

namespace tw {

void ContactBook::add(const ContactSide& a, const ContactSide& b, const ContactSettings& settings) {
  table_.add(a, b, settings);
  if (settings.collide && !*settings.collide) may_disable_ = true;
  known_.clear();
  serial_ = next_serial();
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

std::uint64_t ContactBook::next_serial() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

const ContactParameters& ContactBook::look_up(std::uint64_t classes, BodyId a, BodyId b) const {
  const std::lock_guard lock(mutex_);
  const auto known = known_.find(classes);
  if (known != known_.end()) return known->second;
  return known_.emplace(classes, table_.look_up(bodies_[a], bodies_[b])).first->second;
}

const ContactParameters& ContactBook::between(BodyId a, BodyId b) const {
  const BodyId x = std::min(classes_[a], classes_[b]), y = std::max(classes_[a], classes_[b]);
  const std::uint64_t classes = std::uint64_t{x} << 32 | y;
  struct Remembered {
    std::uint64_t serial = 0, classes = 0;
    const ContactParameters* parameters = nullptr;
  };
  constexpr std::size_t places = 64;
  thread_local Remembered table[places];
  Remembered& last = table[(x * 31 + y) % places];
  if (last.serial != serial_ || last.classes != classes)
    last = {serial_, classes, &look_up(classes, a, b)};
  return *last.parameters;
}

}  // namespace tw
