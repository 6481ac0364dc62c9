// User slots of a state, as the kernel sees them: an immutable, shared value.
//
// The kernel copies the reference from state to state and drops it when a state is freed or rolled
// back; setting a slot makes a new value.  What is in it (Scheme values) is the business of
// script/, which implements this interface.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>

namespace tw {

class Slots {
 public:
  virtual ~Slots() = default;
  // A hash of the numeric slots, equal for equal values in every run: enters the history's hash.
  virtual std::uint64_t hash() const = 0;
};

using SlotsPtr = std::shared_ptr<const Slots>;

}  // namespace tw
