// What holds between two bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-book.h"

#include <algorithm>
#include <atomic>

namespace tw {

void ContactBook::add(const ContactSide& a, const ContactSide& b, const ContactSettings& settings) {
  table_.add(a, b, settings);
  if (settings.collide && !*settings.collide) may_disable_ = true;
  forget_known();
  name(a);
  name(b);
}

void ContactBook::name(const ContactSide& side) {
  if (side.kind != ContactSide::Kind::body || !named_.insert(side.body).second) return;
  if (side.body < classes_.size()) classes_[side.body] = class_of(side.body);
}

void ContactBook::take_back(std::size_t size) {
  table_.take_back(size);
  forget_known();
}

void ContactBook::restart(const ContactTable& rules) {
  table_ = rules;
  bodies_.clear();
  classes_.clear();
  named_.clear();
  forget_known();
  table_.visit_sides([this](const ContactSide& side) { name(side); });
}

void ContactBook::forget_known() {
  known_.clear();
  serial_ = next_serial();
}

void ContactBook::add_body(const Body& body) {
  bodies_.push_back(body.contact);
  classes_.push_back(class_of(static_cast<BodyId>(classes_.size())));
}

ContactBook::ClassId ContactBook::class_of(BodyId id) {
  constexpr ClassId of_materials = ClassId{1} << 31;
  if (named_.count(id)) return id;
  const auto next = static_cast<ClassId>(of_materials + class_of_material_.size());
  return class_of_material_.try_emplace(bodies_[id].material, next).first->second;
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
  const ClassId x = std::min(classes_[a], classes_[b]), y = std::max(classes_[a], classes_[b]);
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
