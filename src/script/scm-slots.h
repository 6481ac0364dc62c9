// User slots that hold Scheme values.
//
// Invariants: names and their order are fixed when the body is added; values are never changed in
// place, setting one makes a new ScmSlots.  A value is a copy of what was given: of numbers,
// booleans, symbols, keywords, characters, strings, bodies, and pairs and vectors of such; nothing
// else can be frozen, and is refused.  Its strings and vectors are read-only.  Pairs cannot be made
// so: who changes a pair of a slot changes it in all states that hold it, which --check finds.
// Values stand in memory that the garbage collector scans as a root and never frees by itself; the
// destructor frees it. Cost: a copy with one value set 0.1-0.2 us.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <memory>
#include <string>
#include <vector>

#include "script/live.h"
#include "timeline/slots.h"

namespace tw {

class ScmSlots : public Slots, Live<LiveKind::slots> {
 public:
  // From an association list of symbols and values.  Errors: BadValue, also for what cannot be
  // frozen.
  static SlotsPtr from_alist(SCM alist);
  ~ScmSlots() override;
  ScmSlots(const ScmSlots&) = delete;
  ScmSlots& operator=(const ScmSlots&) = delete;

  // Index of a name, or -1.
  int find(SCM name) const;
  SCM value(int index) const { return values_[index]; }
  SlotsPtr with(int index, SCM value) const;
  // Whether the other has an equal value there.
  bool has_same(int index, const ScmSlots& other) const;
  // Over the numbers, also those inside pairs and vectors; other values don't count.
  std::uint64_t hash() const override;
  // "bounces, energy": for messages.
  std::string names_text() const;
  std::size_t size() const { return names_->size(); }

 private:
  using Names = std::vector<SCM>;  // interned symbols, kept by the world's table
  explicit ScmSlots(std::shared_ptr<const Names> names);
  std::shared_ptr<const Names> names_;
  SCM* values_;
};

}  // namespace tw
