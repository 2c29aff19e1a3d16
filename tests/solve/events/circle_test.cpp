// SPDX-License-Identifier: MIT
#include <oblique/solve/events/circle.h>

#include <vector>

#include <gtest/gtest.h>

namespace oblique::solve {
namespace {

/// In which round a circle closes whose discrete state counts up to `length` and begins again, after `way`
/// rounds on the way into it; 0: in none of a thousand.
int closes_at(int way, int length, double change = 0) {
  Circle circle;
  for (int round = 1; round <= 1000; ++round) {
    const double count = round <= way ? -round : (round - way) % length;
    if (circle.closes(std::vector{count, 1.0}, std::vector{0.5 + change * round})) return round;
  }
  return 0;
}

TEST(Circle, ClosesOnceItHasBeenGoneRoundFromWhatWasKept) {
  EXPECT_EQ(closes_at(0, 1), 17);
  EXPECT_EQ(closes_at(0, 5), 21);
  EXPECT_EQ(closes_at(0, 16), 32);
  EXPECT_EQ(closes_at(0, 17), 49) << "from the 32nd round, for from the 16th it is longer";
  EXPECT_EQ(closes_at(40, 5), 69) << "the way into it ends after the 32nd";
}

TEST(Circle, DoesNotCloseWhereSomethingGoesOn) {
  EXPECT_EQ(closes_at(0, 5, 1e-15), 0);
  EXPECT_EQ(closes_at(1000, 5), 0);
}

}  // namespace
}  // namespace oblique::solve
