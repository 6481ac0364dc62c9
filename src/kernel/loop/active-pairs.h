// The table of active pairs: their records, and which of them each body has.
//
// Invariants (validate_pairs): a record in use stands in both its bodies' lists, at the places that
// it names; nobody has two records with the same other body.
// Cost: all O(1), but finding a pair, which walks the shorter of two lists.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "detect/active-pair.h"
#include "dynamics/ids.h"

namespace tw {

class ActivePairs {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  // Withdraws the events of records that are dropped.
  explicit ActivePairs(EventQueue& queue) : queue_(queue) {}

  Pair& operator[](std::uint32_t index) { return records_[index]; }
  const Pair& operator[](std::uint32_t index) const { return records_[index]; }
  // All records, unused ones too.
  const std::vector<Pair>& records() const { return records_; }
  std::size_t size() const { return records_.size(); }
  // How many are in use.
  std::size_t live() const { return live_; }
  // The records of a body, in no order.
  const std::vector<std::uint32_t>& of(BodyId body) const { return by_body_[body]; }
  // `none` if the two have no record.
  std::uint32_t find(BodyId a, BodyId b) const;

  // A body has come: it may have pairs.
  void make_room_for(BodyId body) {
    if (by_body_.size() <= body) by_body_.resize(body + 1);
  }
  // A fresh record of two that have none, free of impacts before `from`.
  std::uint32_t make(BodyId a, BodyId b, const Key& from);
  void drop(std::uint32_t index);
  void drop_all_of(BodyId body);
  void drop_all();

 private:
  EventQueue& queue_;
  std::vector<Pair> records_;
  std::vector<std::uint32_t> unused_;
  std::vector<std::vector<std::uint32_t>> by_body_;
  std::size_t live_ = 0;
};

}  // namespace tw
