// Expected failures with their numbers: what is known to be wrong may become neither worse nor,
// unnoticed, better.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

namespace tw::test {

// `value` should be at most `bound`, and is `known`.  Passes as long as it is about that.
inline testing::AssertionResult is_known_fault(double value, double bound, double known) {
  constexpr double worse = 1.2, better = 0.6;
  if (!(value <= worse * known))
    return testing::AssertionFailure() << value << " is worse than what is known, " << known;
  if (value <= bound)
    return testing::AssertionFailure()
           << value << " is as it should be, at most " << bound << ": expect that from now on";
  if (value < better * known)
    return testing::AssertionFailure()
           << value << " is better than what is known, " << known << ": lower the number";
  return testing::AssertionSuccess();
}

#define EXPECT_KNOWN_FAULT(value, bound, known) \
  EXPECT_TRUE(::tw::test::is_known_fault(value, bound, known))

}  // namespace tw::test
