// SPDX-License-Identifier: MIT
#include <oblique/machine/line_segments.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace oblique::machine {
namespace {

/// The value of the lines at x, by a way of its own.
double value_at(const text::PointTable& points, double x) {
  std::size_t k = 1;
  while (k + 1 < points.x.size() && points.x[k] < x) ++k;
  const double part = (x - points.x[k - 1]) / (points.x[k] - points.x[k - 1]);
  return points.y[k - 1] + part * (points.y[k] - points.y[k - 1]);
}

/// The greatest distance from the function, at many places.
double distance(const LineSegments& lines, double (*function)(double), double from, double to) {
  double most = 0;
  for (int k = 0; k <= 10'000; ++k) {
    const double x = from + (to - from) * k / 10'000;
    most = std::max(most, std::abs(value_at(lines.points, x) - function(x)));
  }
  return most;
}

// Lines that may lie anywhere: a parabola x² over [0, 1] takes n equal ones, each off by 1/(8 n²) on both
// sides.
TEST(LineSegments, ApproximateAParabolaAsWellAsSoManyCan) {
  for (const int n : {2, 5, 10}) {
    const LineSegments lines = line_segments([](double x) { return x * x; }, 0, 1, n);
    EXPECT_EQ(lines.points.x.size(), static_cast<std::size_t>(n) + 1);
    // The places of the points are those of a grid of 1/1024: a hundredth of the error at most for ten lines.
    EXPECT_NEAR(lines.error * 8 * n * n, 1, 0.05);
  }
}

// Of n lines with free points the least error is (∫√|f″| dx)²/(16 n²) for large n; ∫√cos over a quarter turn
// is 1.19814. At n = 10 the next order is some percent.
TEST(LineSegments, ApproximateACosineNearlyAsWellAsFreePointsCan) {
  const LineSegments lines = line_segments([](double x) { return std::cos(x); }, 0, std::acos(0.0), 10);
  EXPECT_NEAR(lines.error, 1.19814 * 1.19814 / 1600, 0.1 * 9e-4);
  EXPECT_NEAR(lines.error,
              distance(
                  lines, [](double x) { return std::cos(x); }, 0, std::acos(0.0)),
              1e-6);
}

TEST(LineSegments, FindWhatConsistsOfStraightLinesAsItIs) {
  const auto limiter = [](double x) { return std::min(0.3, std::max(-0.7, x)); };
  const LineSegments lines = line_segments(limiter, -1, 1, 10);
  ASSERT_EQ(lines.points.x.size(), 4U);
  EXPECT_NEAR(lines.points.x[1], -0.7, 1e-12);
  EXPECT_NEAR(lines.points.x[2], 0.3, 1e-12);
  EXPECT_LT(lines.error, 1e-12);
  EXPECT_EQ(line_segments([](double x) { return 3 - 2 * x; }, -1, 4, 10).points.x.size(), 2U);
}

TEST(LineSegments, KnowNoLinesForAJumpOrAPole) {
  EXPECT_TRUE(std::isinf(line_segments([](double x) { return x < 0.3 ? 0.0 : 1.0; }, 0, 1, 10).error));
  EXPECT_TRUE(std::isinf(line_segments([](double x) { return std::log(x); }, 0, 1, 10).error));
}

// A peak of 1e-6 of the range stands between the points of the grid, or on one alone: it is found, or missed
// by as much as it is high, and the lines go to the end in any case.
TEST(LineSegments, DoNotOverlookANarrowPeak) {
  for (const double at : {0.5, 0.62345, 0.1 + 1e-4}) {
    SCOPED_TRACE(at);
    const auto peak = [at](double x) { return std::exp(-(x - at) * (x - at) * 1e12); };
    for (const int n : {1, 3, 10}) {
      const LineSegments lines = line_segments(peak, 0, 1, n);
      EXPECT_LE(lines.points.x.size(), static_cast<std::size_t>(n) + 1);
      EXPECT_EQ(lines.points.x.back(), 1);
      EXPECT_LE(std::abs(value_at(lines.points, 0.5) - peak(0.5)), lines.error + 1e-12);
    }
  }
}

// exp(−7/x) is 5e-4 to 0.5: lines that err by as much everywhere would begin below zero. None of these does,
// and the error is at most half as much again as it could be.
TEST(LineSegments, KeepTheSignOfAFunction) {
  for (const double sign : {1.0, -1.0}) {
    const LineSegments lines = line_segments([&](double x) { return sign * std::exp(-7 / x); }, 0.92, 10, 10);
    EXPECT_NEAR(lines.low, sign > 0 ? std::exp(-7 / 0.92) : -std::exp(-0.7), 1e-12);
    EXPECT_NEAR(lines.high, sign > 0 ? std::exp(-0.7) : -std::exp(-7 / 0.92), 1e-12);
    for (const double y : lines.points.y) EXPECT_GE(sign * y, std::exp(-7 / 0.92));
    EXPECT_LT(lines.error, 1.5 * 0.0012);
  }
}

}  // namespace
}  // namespace oblique::machine
