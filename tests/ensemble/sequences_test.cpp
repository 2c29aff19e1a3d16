// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/sequences.h>

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace oblique::ensemble {
namespace {

// The first points of the program that Joe and Kuo publish with their numbers, and of every other
// implementation in the order of Gray's code.
TEST(Sobol, BeginsAsPublished) {
  const std::vector<std::vector<double>> points{{0, 0, 0},
                                                {0.5, 0.5, 0.5},
                                                {0.75, 0.25, 0.25},
                                                {0.25, 0.75, 0.75},
                                                {0.375, 0.375, 0.625},
                                                {0.875, 0.875, 0.125},
                                                {0.625, 0.125, 0.875},
                                                {0.125, 0.625, 0.375}};
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(sobol(k, d), points[k][d]) << k << ", " << d;
  }
}

TEST(Sobol, PutsOnePointInEachInterval) {
  constexpr std::uint32_t kPoints = 1024;
  for (std::size_t d = 0; d < kMostSobolDimensions; ++d) {
    std::set<int> intervals;
    for (std::uint32_t k = 0; k < kPoints; ++k) intervals.insert(static_cast<int>(sobol(k, d) * kPoints));
    EXPECT_EQ(intervals.size(), kPoints) << d;
  }
}

// Two dimensions are the first ones of a (0, 2)-sequence: every elementary rectangle of area 1/n has one
// point.
TEST(Sobol, PutsOnePointInEachRectangle) {
  for (int wide = 0; wide <= 8; ++wide) {
    std::set<std::pair<int, int>> rectangles;
    for (std::uint32_t k = 0; k < 256; ++k)
      rectangles.emplace(static_cast<int>(sobol(k, 0) * (1 << wide)),
                         static_cast<int>(sobol(k, 1) * (1 << (8 - wide))));
    EXPECT_EQ(rectangles.size(), 256U) << wide;
  }
}

/// Warnock's formula for the L2 star discrepancy.
double discrepancy(const std::vector<std::vector<double>>& points) {
  const auto n = static_cast<double>(points.size());
  const auto d = points.front().size();
  double single = 0, pairs = 0;
  for (const auto& x : points) {
    double product = 1;
    for (const double c : x) product *= (1 - c * c) / 2;
    single += product;
    for (const auto& y : points) {
      product = 1;
      for (std::size_t k = 0; k < d; ++k) product *= 1 - std::max(x[k], y[k]);
      pairs += product;
    }
  }
  return std::sqrt(std::pow(3.0, -static_cast<double>(d)) - 2 / n * single + pairs / (n * n));
}

// Of n random points the root mean square of the L2 star discrepancy is √((2⁻ᵈ − 3⁻ᵈ)/n). Of
// ten dimensions 512 points are few.
TEST(Sobol, IsMoreEvenThanChance) {
  for (const std::size_t d : {2U, 5U, 10U}) {
    std::vector<std::vector<double>> points;
    for (std::uint32_t k = 1; k <= 512; ++k) {  // without the corner, which alone weighs 1/512
      std::vector<double>& point = points.emplace_back();
      for (std::size_t c = 0; c < d; ++c) point.push_back(sobol(k, c));
    }
    const double random =
        std::sqrt((std::pow(2.0, -static_cast<double>(d)) - std::pow(3.0, -static_cast<double>(d))) / 512);
    EXPECT_LT(discrepancy(points), (d == 2 ? 0.2 : d == 5 ? 0.5 : 0.9) * random) << d;
  }
}

TEST(LatinHypercube, PutsOnePointInEachInterval) {
  const LatinHypercube cube(7, 100, 3);
  for (std::size_t d = 0; d < 3; ++d) {
    std::set<int> intervals;
    for (std::uint32_t k = 0; k < 100; ++k) {
      const double x = cube.at(k, d);
      ASSERT_GE(x, 0);
      ASSERT_LT(x, 1);
      intervals.insert(static_cast<int>(x * 100));
    }
    EXPECT_EQ(intervals.size(), 100U);
  }
}

TEST(LatinHypercube, DependsOnTheSeedAndItsAxesOnNothingElse) {
  const LatinHypercube cube(7, 1000, 2), again(7, 1000, 2), other(8, 1000, 2);
  double product = 0, place = 0;
  int alike = 0;
  for (std::uint32_t k = 0; k < 1000; ++k) {
    EXPECT_EQ(cube.at(k, 1), again.at(k, 1));
    alike += cube.at(k, 0) == other.at(k, 0) ? 1 : 0;
    product += (cube.at(k, 0) - 0.5) * (cube.at(k, 1) - 0.5);
    place += cube.at(k, 0) * 1000 - std::floor(cube.at(k, 0) * 1000);
  }
  EXPECT_EQ(alike, 0);
  // Four standard deviations of sums over 1000: of the product of two on ±½ 1/12, of one on [0, 1] 1/√12.
  EXPECT_NEAR(product / 1000, 0, 4.0 / 12 / std::sqrt(1000));
  EXPECT_NEAR(place / 1000, 0.5, 4 / std::sqrt(12 * 1000.0));
}

}  // namespace
}  // namespace oblique::ensemble
