// Keeps the floating-point environment of a thread across drawing.
//
// LLVM's generated code raises flags and would die of SIGFPE where traps are on; threads started
// meanwhile inherit the environment.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cfenv>

namespace tw {

// While alive: no traps, flags cleared.  At its end the environment is as before.
class FloatingPointGuard {
 public:
  FloatingPointGuard() { std::feholdexcept(&saved_); }
  ~FloatingPointGuard() { std::fesetenv(&saved_); }
  FloatingPointGuard(const FloatingPointGuard&) = delete;
  FloatingPointGuard& operator=(const FloatingPointGuard&) = delete;

 private:
  std::fenv_t saved_;
};

}  // namespace tw
