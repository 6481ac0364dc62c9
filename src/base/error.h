// Errors with causes: bugs of ours (TW_ASSERT) and mistakes of users (TW_REQUIRE).
//
// The two are different on purpose.  A failed TW_ASSERT means that an invariant of the program
// does not hold; it prints the invariant and what was known about time and bodies, then aborts.
// A failed TW_REQUIRE means that the input is wrong; it throws UserError, which the Scheme binding
// turns into a `timewarp-error` with the place of the form that caused it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace tw {

// Where something was written: file, line and column of a scene's form (1-based; line 0: unknown).
struct Place {
  std::string file;
  int line = 0;
  int column = 0;

  bool known() const { return line > 0; }
  // "FILE:LINE:COLUMN", or "" where the place is unknown.
  std::string text() const;
};

// A mistake in what the user asked for.  The message says what is wrong, the value, and what was
// expected: "radius is -1; expected a positive number of metres".
class UserError : public std::runtime_error {
 public:
  explicit UserError(const std::string& message) : std::runtime_error(message) {}
  UserError(const std::string& message, Place place)
      : std::runtime_error(message), place_(std::move(place)) {}

  // The place of the form at fault where the thrower knows better than the form being run.
  const Place& place() const { return place_; }

 private:
  Place place_;
};

// Text of a double that reads back to the same bits, as short as possible.
std::string show(double value);

[[noreturn]] void assertion_failed(const char* invariant, const char* file, int line,
                                   const std::string& details);

}  // namespace tw

// Always on, also in release builds: keep the condition cheap.
#define TW_ASSERT(condition, details)                                    \
  do {                                                                   \
    if (!(condition)) [[unlikely]]                                       \
      ::tw::assertion_failed(#condition, __FILE__, __LINE__, (details)); \
  } while (false)

// The user's error; `message` is evaluated only on failure.
#define TW_REQUIRE(condition, message) \
  do {                                 \
    if (!(condition)) [[unlikely]]     \
      throw ::tw::UserError(message);  \
  } while (false)
