// Counts of living C++ objects that the binding owns, and of calls from C++ into Guile.
//
// Objects whose lifetime crosses the border to Guile derive from Live<kind>; a test that makes
// thousands of errors compares the counts before and after.  Counters are atomic because Guile may
// finalize objects in a thread of its own.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace tw {

enum class LiveKind {
  world,
  shape,
  visual,
  motion,
  slots,
  callback,
  view,
  error,
  border_call,
  recorder,
  checkpoint
};
inline constexpr int live_kinds = 11;
inline constexpr std::array<const char*, live_kinds> live_names{
    "worlds", "shapes", "visuals", "motions",   "slots",      "callbacks",
    "views",  "errors", "calls",   "recorders", "checkpoints"};

inline std::array<std::atomic<std::int64_t>, live_kinds> live_counts{};

template <LiveKind kind>
class Live {
 public:
  Live() { ++count(); }
  Live(const Live&) { ++count(); }
  Live& operator=(const Live&) = default;
  ~Live() { --count(); }

 private:
  static std::atomic<std::int64_t>& count() { return live_counts[static_cast<std::size_t>(kind)]; }
};

// Calls from C++ into Guile since the program's start.
inline std::atomic<std::int64_t> guile_calls{0};

}  // namespace tw
