// Long computations that change nothing ask now and then whether they are to be given up.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <exception>

namespace tw {

// Thrown to stop a run at once (Ctrl-C): not an error of the scene, nothing is recorded, and the
// event is processed again when the run goes on.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

// Asked by what may be given up; throws Interrupted.  Of this thread, for as long as it lives;
// without one nothing is ever given up.
class InterruptionCheck {
 public:
  using Ask = void (*)();
  explicit InterruptionCheck(Ask ask);
  ~InterruptionCheck();
  InterruptionCheck(const InterruptionCheck&) = delete;
  InterruptionCheck& operator=(const InterruptionCheck&) = delete;

 private:
  Ask outer_;
};

void raise_if_interrupted();

// The same for who must not throw where it is: what would be thrown is thrown by this thread's next
// raise_if_interrupted().
bool is_interrupted();

}  // namespace tw
