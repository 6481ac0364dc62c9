// Of points near others along x none that is near is left out, and all come in their order.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/near-in-x.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace tw {
namespace {

TEST(NearInX, visits_all_that_are_near_in_their_order) {
  Random random(8);
  NearInX near;
  for (const std::size_t count : {0u, 1u, 31u, 32u, 33u, 200u})
    for (const double place : {0.0, 1e6}) {
      std::vector<double> x;
      // many of them at one place, and some just as far apart as the reach
      for (std::size_t i = 0; i < count; ++i)
        x.push_back(place + 0.125 * static_cast<double>(random.below(40)) +
                    (random.real() < 0.3 ? 1e-3 * random.real() : 0));
      near.set(count, [&](std::size_t i) { return x[i]; });
      for (const double reach : {0.0, 0.125, 0.5, 100.0})
        for (const double from : x) {
          std::vector<std::uint32_t> met;
          near.visit(from, reach, [&](std::uint32_t i) { met.push_back(i); });
          EXPECT_TRUE(std::is_sorted(met.begin(), met.end()));
          for (std::uint32_t i = 0; i < count; ++i)
            if (std::abs(x[i] - from) <= reach) {
              EXPECT_TRUE(std::binary_search(met.begin(), met.end(), i)) << i << " of " << count;
            }
          if (count > NearInX::few && reach < 1) {
            EXPECT_LT(met.size(), count) << "all are near";
          }
        }
    }
}

}  // namespace
}  // namespace tw
