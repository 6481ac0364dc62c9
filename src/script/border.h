// The border between C++ and Guile: how calls and errors cross it, both ways.
//
// Guile leaves a procedure by longjmp (errors, escapes, aborts to prompts), which skips C++
// destructors; C++ leaves by exceptions, which Guile does not know.  So nothing crosses directly:
//
//   call_scheme   C++ -> Scheme.  Inside a continuation barrier and a catch (guarded-call.scm);
//                 every way out that is not a return becomes a C++ exception, raised when no Guile
//                 frame is left.
//   guard         Scheme -> C++.  A C++ exception is copied to Scheme values, all C++ objects are
//                 destroyed, and only then the Scheme condition `timewarp-error` is raised.
//
// Invariants: the body given to `guard` is trivially destructible and never calls what may longjmp
// out of it (conversions in values.h throw instead).
// Cost: call_scheme adds about 0.4 us to a call, guard less than a nanosecond.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <span>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "script/live.h"

namespace tw {

// An error that a Scheme procedure raised, as text: what, where, and the scene's frames.
class SchemeError : public UserError, Live<LiveKind::error> {
 public:
  SchemeError(const std::string& message, Place place, std::string backtrace)
      : UserError(message, std::move(place)), backtrace_(std::move(backtrace)) {}
  // One line per frame of the scene, innermost first; may be empty.
  const std::string& backtrace() const { return backtrace_; }

 private:
  std::string backtrace_;
};

// A Scheme value of the wrong type or range: "NAME is VALUE; expected EXPECTED".
struct BadValue {
  std::string name;
  SCM value;
  const char* expected;
};

// Calls a Scheme procedure.  Errors: SchemeError for every non-local exit but Ctrl-C, which is
// Interrupted (kernel/world/callback.h).
SCM call_scheme(SCM procedure, std::span<SCM> arguments);

// Has the handlers of signals that wait run, ten times a second at most; throws Interrupted where
// one asks for it.
void look_for_signals();

// True while a procedure called by call_scheme runs.
bool inside_call();

// UserError if a callback or observer is running; `what` was asked for.
void require_outside_callbacks(const char* what);

// What a C++ exception becomes on its way to Scheme; holds only Scheme values.
struct PendingError {
  bool raised = false;
  SCM message = SCM_BOOL_F, name = SCM_BOOL_F, value = SCM_BOOL_F, place = SCM_BOOL_F,
      backtrace = SCM_BOOL_F;
};

PendingError run_catching(SCM (*body)(void*), void* data, SCM* result) noexcept;
[[noreturn]] void raise_pending(const PendingError& error);

template <class Body>
SCM guard(Body body) {
  static_assert(std::is_trivially_destructible_v<Body>);
  SCM result = SCM_UNSPECIFIED;
  const PendingError error =
      run_catching([](void* data) { return (*static_cast<Body*>(data))(); }, &body, &result);
  if (error.raised) raise_pending(error);
  return result;
}

void define_border();

}  // namespace tw
