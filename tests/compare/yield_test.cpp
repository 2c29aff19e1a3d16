// SPDX-License-Identifier: MIT
#include <oblique/compare/yield.h>

#include <cmath>

#include <gtest/gtest.h>

namespace oblique::compare {
namespace {

// The bounds are where the number of good ones is 1.96 standard deviations from what they would give: they
// solve (p̂ − p)² = z² p(1 − p)/n. Newcombe (Statist. Med. 17 (1998), table I) has 81 of 263 at 0.2553 …
// 0.3662, 15 of 148 at 0.0624 … 0.1605, 0 of 20 at 0 … 0.1611.
TEST(Yield, IsBetweenThePublishedBounds) {
  const Yield many = yield_of(81, 263), few = yield_of(15, 148), none = yield_of(0, 20),
              all = yield_of(20, 20);
  EXPECT_NEAR(many.low, 0.2553, 5e-5);  // as they are rounded
  EXPECT_NEAR(many.high, 0.3662, 5e-5);
  EXPECT_NEAR(few.low, 0.0624, 5e-5);
  EXPECT_NEAR(few.high, 0.1605, 5e-5);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 0.1611, 5e-5);
  EXPECT_NEAR(all.low, 1 - 0.1611, 5e-5);
  EXPECT_EQ(all.high, 1);
}

TEST(Yield, SolvesItsEquation) {
  for (const std::uint64_t good : {3U, 50U, 997U}) {
    const Yield yield = yield_of(good, 1000);
    for (const double p : {yield.low, yield.high})
      EXPECT_NEAR(std::abs(yield.part() - p) / std::sqrt(p * (1 - p) / 1000), 1.959964, 1e-6);
  }
}

}  // namespace
}  // namespace oblique::compare
