// SPDX-License-Identifier: MIT
#include <oblique/solve/events/combinations.h>

#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::solve {
namespace {

using ::testing::ElementsAre;

/// Places at which two combinations differ, counted one by one.
int difference(Combination a, Combination b, std::size_t places) {
  int count = 0;
  for (std::size_t k = 0; k < places; ++k) count += has(a, k) != has(b, k) ? 1 : 0;
  return count;
}

TEST(Combinations, AreAllThereTheNearestFirst) {
  for (const std::size_t places : {1U, 3U, 5U}) {
    for (Combination to = 0; to < (1U << places); ++to) {
      const std::vector<Combination> order = nearest_first(to, places);
      EXPECT_EQ(std::set<Combination>(order.begin(), order.end()).size(), std::size_t{1} << places);
      EXPECT_EQ(order.size(), std::size_t{1} << places);
      EXPECT_EQ(order.front(), to);
      EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), [&](Combination a, Combination b) {
        return difference(a, to, places) < difference(b, to, places);
      })) << to;
    }
  }
}

// The same request gives the same choice: what is as near comes in the order of its number.
TEST(Combinations, AsNearComeByTheirNumber) {
  EXPECT_THAT(nearest_first(0b010, 3), ElementsAre(0b010, 0b000, 0b011, 0b110, 0b001, 0b100, 0b111, 0b101));
}

TEST(Combinations, OfNothingIsOne) {
  EXPECT_THAT(nearest_first(0, 0), ElementsAre(0U));
}

}  // namespace
}  // namespace oblique::solve
