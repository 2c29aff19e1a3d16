// SPDX-License-Identifier: MIT
#include <oblique/text/even_point.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace oblique::text {
namespace {

double fraction(double x) {
  return x - std::floor(x);
}

// The roots in one and two dimensions are the golden ratio and the plastic number, here by Cardano's formula.
TEST(EvenPoint, StepsByThePowersOfTheRoot) {
  const double golden = (1 + std::sqrt(5)) / 2;
  const double plastic = std::cbrt((9 + std::sqrt(69)) / 18) + std::cbrt((9 - std::sqrt(69)) / 18);
  for (const int k : {1, 2, 3, 50}) {
    EXPECT_NEAR(even_point(k, 1)[0], fraction(0.5 + k / golden), 1e-12);  // of the rounding, k times
    const std::vector<double> two = even_point(k, 2);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_NEAR(two[0], fraction(0.5 + k / plastic), 1e-12);
    EXPECT_NEAR(two[1], fraction(0.5 + k / (plastic * plastic)), 1e-12);
  }
}

// Thrown blindly, a tenth of the way would get 100 ± 9.5 of 1000 points; spread, it gets them to a few.
TEST(EvenPoint, EveryPartOfEveryDimensionGetsItsShare) {
  for (const std::size_t dimensions : {1U, 2U, 3U}) {
    std::vector<int> counts(10 * dimensions, 0);
    for (int k = 1; k <= 1000; ++k) {
      const std::vector<double> point = even_point(k, dimensions);
      for (std::size_t i = 0; i < dimensions; ++i) {
        ASSERT_GE(point[i], 0);
        ASSERT_LT(point[i], 1);
        ++counts[10 * i + static_cast<std::size_t>(10 * point[i])];
      }
    }
    EXPECT_GE(*std::min_element(counts.begin(), counts.end()), 96);
    EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 104);
  }
}

}  // namespace
}  // namespace oblique::text
