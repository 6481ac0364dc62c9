// Counts the living objects of a class: for tests of what is kept and what goes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>

namespace tw {

// Base of T.  The counter is atomic: objects may go in a finalizer's thread.
template <class T>
class Counted {
 public:
  static std::int64_t alive() { return count_; }

 protected:
  Counted() { ++count_; }
  Counted(const Counted&) { ++count_; }
  Counted& operator=(const Counted&) = default;
  ~Counted() { --count_; }

 private:
  static inline std::atomic<std::int64_t> count_{0};
};

}  // namespace tw
