// What holds between two bodies: the rules that users set, looked up once for a class of pairs.
//
// Bodies that no rule names differ by their material alone: one class for each material, one for
// each body that is named.  Few classes, so what is looked up for all pairs stays small.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "dynamics/body.h"
#include "dynamics/contact-parameters.h"

namespace tw {

class ContactBook {
 public:
  // Errors: a value out of its range, with the keyword and the range.
  void add(const ContactSide& a, const ContactSide& b, const ContactSettings& settings);
  const ContactTable& rules() const { return table_; }
  // Without those that were added after the first so many.
  void take_back(std::size_t size);
  // Those rules, and no bodies yet.
  void restart(const ContactTable& rules);
  // Whether a rule with that side is about a body.
  bool names(const ContactSide& side, BodyId id) const { return side_matches(side, bodies_[id]); }
  // A body has come into the world; numbers are dense, from 0.
  void add_body(const Body& body);
  // Of two bodies that have come into the world; stays valid until the next add.  Several threads
  // may ask.
  const ContactParameters& between(BodyId a, BodyId b) const;
  // Whether some pair may have been told not to collide.
  bool may_disable() const { return may_disable_; }

 private:
  // Bodies that a rule names are classes of their own; others are one with all of their material.
  using ClassId = std::uint32_t;
  ClassId class_of(BodyId id);
  void name(const ContactSide& side);
  void forget_known();

  ContactTable table_;
  std::vector<ContactBody> bodies_;
  std::vector<ClassId> classes_;  // of each body
  std::unordered_map<std::string, ClassId> class_of_material_;
  std::unordered_set<BodyId> named_;
  bool may_disable_ = false;  // once and for all: whoever asks then looks the pair up
  const ContactParameters& look_up(std::uint64_t classes, BodyId a, BodyId b) const;
  static std::uint64_t next_serial();

  // what was looked up; each thread remembers some of it, by the serial number of the rules
  mutable std::unordered_map<std::uint64_t, ContactParameters> known_;
  mutable std::mutex mutex_;  // of known_
  std::uint64_t serial_ = next_serial();
};

}  // namespace tw
