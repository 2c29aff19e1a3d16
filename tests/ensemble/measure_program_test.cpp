// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/measure_program.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace oblique::ensemble {
namespace {

using std::numbers::pi;

std::size_t column_of(const std::string& name) {
  if (name == "x") return 1;
  if (name == "y") return 2;
  if (name == "exact(B.x)") return 3;
  throw text::ExpressionError{0, "there is no output or signal '" + name + "'", {}, "known: x, y"};
}

/// Rows of x(t), y(t) from 0 to `end`.
template <class X, class Y>
SampledRun sampled(double end, int rows, X x, Y y) {
  std::vector<std::vector<double>> columns(4);
  for (int k = 0; k < rows; ++k) {
    const double t = end * k / (rows - 1);
    columns[0].push_back(t);
    columns[1].push_back(x(t));
    columns[2].push_back(y(t));
    columns[3].push_back(x(t) - 1);
  }
  return SampledRun(std::move(columns));
}

double measure(const std::string& text, const SampledRun& run) {
  return MeasureProgram(text, true, {}, column_of).value(run, {0.25, 0.125});
}

// 101 rows over a second, 16 and 32 a period: through six points a sine is interpolated to
// (225/64)/6!·(ωh)⁶ = 2e-5 of its height.
TEST(Measure, FindsExtremesBetweenRows) {
  const double w = 2 * pi * 6.3;
  const auto run = sampled(
      1, 101, [&](double t) { return 3 * std::sin(w * t); }, [&](double t) { return std::cos(w / 2 * t); });
  EXPECT_NEAR(measure("max(x)", run), 3, 6e-5);
  EXPECT_NEAR(measure("min(x)", run), -3, 6e-5);
  EXPECT_NEAR(measure("max(abs(x))", run), 3, 6e-5);
  EXPECT_NEAR(measure("min(abs(x))", run), 0, 6e-5);                     // at a crossing, between rows
  EXPECT_NEAR(measure("max(x*y)", run), 3 * 4 / std::sqrt(27.0), 6e-5);  // sin 2φ·cos φ = 4/√27 at the most
  EXPECT_NEAR(measure("max(max(x, y)) - max(x)", run), 0, 1e-12);
  EXPECT_EQ(measure("max(x)", sampled(
                                  1, 11, [](double t) { return t; }, [](double) { return 0; })),
            1);
}

// A peak of height 1 at a row, and one of height 1.003 between two rows of which each is below 1, and that
// are nearly alike. Through six points it is interpolated to (225/64)/6!·120·(1/7)⁶ = 5e-6 of its height.
TEST(Measure, FindsAPeakBetweenTwoRowsThatAreNearlyAlike) {
  const auto peak = [](double t) { return std::exp(-t * t / (0.07 * 0.07)); };
  for (const double at : {0.7049, 0.7051}) {
    const auto run = sampled(
        1, 101, [&](double t) { return peak(t - 0.3) + 1.003 * peak(t - at); }, [](double) { return 0; });
    ASSERT_LT(run.column(1)[70], 1);
    ASSERT_LT(run.column(1)[71], 1);
    EXPECT_NEAR(measure("max(x)", run), 1.003, 2e-5);
  }
}

// A peak between two rows just before the end of a run: the row behind it is lower than one long before, and
// the last row hardly lower than that. In rows from the last but one it is that of s³/3 − s²/20 − 3s/10, at
// s = −1/2; a polynomial of that degree is interpolated to rounding.
TEST(Measure, FindsAPeakJustBeforeTheEnd) {
  const int rows = 21;
  const auto peak = [&](double t) {
    const double s = t * (rows - 1) - (rows - 2);
    if (s < -4.5) return std::abs(s + 15) < 0.5 ? 0.05 : -10;
    return s * s * s / 3 - s * s / 20 - 3 * s / 10;
  };
  const auto run = sampled(1, rows, peak, [&](double t) { return -peak(t); });
  EXPECT_NEAR(measure("max(x)", run), 23.0 / 240, 1e-12);
  EXPECT_NEAR(measure("min(y)", run), -23.0 / 240, 1e-12);
}

TEST(Measure, OvershootsNothingWhereTheRunJumps) {
  const auto step = [](double t) { return t < 0.303 ? -1.0 : 1.0; };
  const auto run = sampled(1, 101, step, [](double t) { return std::abs(t - 0.505); });
  EXPECT_EQ(measure("max(x)", run), 1);
  EXPECT_EQ(measure("min(x)", run), -1);
  EXPECT_NEAR(measure("min(y)", run), 0.005, 1e-15);              // at the row beside the kink
  EXPECT_NEAR(measure("integral(x)", run), 0.697 - 0.303, 0.01);  // a row's width of the jump of 2, halved
  EXPECT_NEAR(measure("time(x > 0)", run), 0.303, 0.01);
}

TEST(Measure, IntegratesAndAverages) {
  const auto run = sampled(
      2, 41, [](double t) { return std::exp(-t); }, [](double t) { return std::sin(2 * pi * t); });
  // six points, (h = 0.05)⁶·max|f⁗⁗|·h/100 a row
  EXPECT_NEAR(measure("integral(x)", run), 1 - std::exp(-2), 1e-10);
  EXPECT_NEAR(measure("mean(x)", run), (1 - std::exp(-2)) / 2, 1e-10);
  EXPECT_NEAR(measure("rms(x)", run), std::sqrt((1 - std::exp(-4)) / 4), 1e-9);
  EXPECT_NEAR(measure("rms(y)", run), std::sqrt(0.5), 1e-5);
  EXPECT_NEAR(measure("integral(time)", run), 2, 1e-14);
  EXPECT_NEAR(measure("mean(3)", run), 3, 1e-14);
}

// Half as many rows err 2⁶ as much: at least four orders are promised.
TEST(Measure, IntegratesWithTheOrderThatIsStated) {
  const auto error = [](int rows) {
    const auto run = sampled(
        3, rows, [](double t) { return std::sin(3 * t) * std::exp(-t); }, [](double) { return 0; });
    // ∫ sin(3t)e⁻ᵗ = [−e⁻ᵗ(sin 3t + 3 cos 3t)/10]
    const double truth = (3 - std::exp(-3.0) * (std::sin(9.0) + 3 * std::cos(9.0))) / 10;
    return std::abs(measure("integral(x)", run) - truth);
  };
  EXPECT_GT(std::log2(error(61) / error(121)), 4);
}

TEST(Measure, FindsTheFirstTime) {
  const auto run = sampled(
      3, 301, [](double t) { return 1 - std::exp(-t); }, [](double t) { return std::sin(5 * t); });
  EXPECT_NEAR(measure("time(x > 0.5)", run), std::log(2), 1e-10);
  EXPECT_NEAR(measure("time(0.5 <= x)", run), std::log(2), 1e-10);
  EXPECT_NEAR(measure("time(x > 0.5 and y < 0)", run), std::log(2), 1e-10);  // sin(5 log 2) < 0
  EXPECT_NEAR(measure("time(x > 0.8 and y < 0)", run), 3 * pi / 5, 1e-8);
  EXPECT_EQ(measure("time(y >= 0)", run), 0);
  EXPECT_TRUE(std::isnan(measure("time(x > 1)", run)));
  EXPECT_NEAR(measure("time(not (x < 0.5))", run), std::log(2), 1e-10);
}

// The condition holds between two rows only: a peak passes the bar by 1e-4 of its height.
TEST(Measure, FindsATimeBetweenTwoRows) {
  const double w = 2 * pi * 2.37, bar = 1 - 1e-4;
  const auto run = sampled(
      0.2, 21, [&](double t) { return std::sin(w * t); }, [](double) { return 0; });
  double row_peak = -1;
  for (const double x : run.column(1)) row_peak = std::max(row_peak, x);
  ASSERT_LT(row_peak, bar);
  EXPECT_NEAR(measure("time(x > 0.9999)", run), std::asin(bar) / w, 1e-6);
}

// From 2 to 3 in steps of 1/10.
TEST(Measure, TakesAConditionForOneWhereItHolds) {
  const auto run = sampled(
      1, 11, [](double t) { return 2 + t; }, [](double) { return 4; });
  for (const char* const condition : {"x >= 2.5", "x > 2.5", "x <= 2.5", "x < 2.5", "x == 2", "x != 2",
                                      "x > 2.5 and y > 3", "x > 2.5 or y < 3", "not (x > 2.5)"}) {
    EXPECT_EQ(measure("max(" + std::string(condition) + ")", run), 1) << condition;
    EXPECT_EQ(measure("min(" + std::string(condition) + ")", run), 0) << condition;
  }
}

TEST(Measure, CombinesNumbers) {
  const auto run = sampled(
      1, 11, [](double t) { return 2 + t; }, [](double t) { return 4 - t; });
  EXPECT_NEAR(measure("end(x)/max(y)", run), 0.75, 1e-14);
  EXPECT_NEAR(measure("start(x) + 2 * end(y)", run), 8, 1e-14);
  EXPECT_NEAR(measure("max(end(x), end(y), 1)", run), 3, 1e-14);
  EXPECT_NEAR(measure("abs(end(x) - 4*pi)", run), 4 * pi - 3, 1e-14);
  EXPECT_EQ(measure("error() + rms_error ( )", run), 0.375);
  EXPECT_NEAR(measure("max(abs(x - exact( B.x )))", run), 1, 1e-14);
}

// An output may be called anything: the whole argument is its name first, and an expression only where there
// is no such output.
TEST(Measure, TakesAnOutputByItsName) {
  const auto run = sampled(
      1, 11, [](double t) { return 2 + t; }, [](double t) { return 4 - t; });
  const std::vector<std::string> names = {"x-y", "2*x", "time", "pi", "d(x)/dt", "x dot", "a,b"};
  const auto second = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end() ? std::size_t{2} : column_of(name);
  };
  for (const std::string& name : names)
    EXPECT_EQ(MeasureProgram("end(" + name + ")", false, names, second).value(run, {}), 3) << name;
  EXPECT_EQ(MeasureProgram("max(x-y) - end(x - y)", false, names, second).value(run, {}), 4);
  EXPECT_EQ(MeasureProgram("end(time + 1)", false, names, second).value(run, {}), 2);
  EXPECT_THROW(MeasureProgram("time(x-y)", false, names, second), text::ExpressionError);
}

TEST(Measure, IsNoNumberWhereTheRunHasNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto run = sampled(
      1, 11, [&](double t) { return t > 0.45 && t < 0.55 ? nan : t; }, [](double t) { return t; });
  EXPECT_TRUE(std::isnan(measure("max(x)", run)));
  EXPECT_TRUE(std::isnan(measure("mean(x)", run)));
  EXPECT_EQ(measure("end(x)", run), 1);
  EXPECT_EQ(measure("max(y)", run), 1);
}

struct Refused {
  const char *text, *what, *remedy;
  int column;
};

TEST(Measure, IsRefusedAtItsPlace) {
  const Refused refused[]{
      {"x", "'x' has a value at every moment, and a measure is one number of a run", "", 1},
      {"2*end(x) + y", "'y' has a value at every moment, and a measure is one number of a run", "", 12},
      {"max(max(x))", "max(…) is one number of the whole run, and stands inside max(…)",
       "max(x, y) of two arguments takes the one or the other at every moment", 5},
      {"max(x - end(x))", "end(…) is one number of the whole run, and stands inside max(…)", "", 9},
      {"end(z)", "there is no output or signal 'z'", "known: x, y", 5},
      {"z", "there is no output or signal 'z'", "known: x, y", 1},
      {"3", "'3' takes nothing from the run", "", 1},
      {"meen(x)", "there is no function 'meen'", "did you mean 'mean'?", 1},
      {"end()", "end() says not of what", "", 1},
      {"end(x, y)", "end was given 2 arguments", "", 1},
      {"time(x)", "time(…) is when a condition first holds, and this is none", "", 6},
      {"end(x", "the parenthesis after end is not closed", "", 0},
      {"mean(x +)", "the expression ends too early", "", 9},
      {"error(x)", "error() is of all moving points and has no argument", "", 7},
  };
  for (const Refused& one : refused) {
    try {
      MeasureProgram(one.text, true, {}, column_of);
      ADD_FAILURE() << one.text;
    } catch (const text::ExpressionError& error) {
      if (one.column == 0) continue;
      EXPECT_EQ(error.what, one.what) << one.text;
      EXPECT_EQ(error.remedy, one.remedy) << one.text;
      EXPECT_EQ(error.column, one.column) << one.text;
    }
  }
  EXPECT_THROW(MeasureProgram("error()", false, {}, column_of), text::ExpressionError);
  EXPECT_THROW(MeasureProgram("end(exact(B.x))", false, {}, column_of), text::ExpressionError);
}

// Rows 1, 0, 1, 0: beside each of the two inner ones a line misses at the most |1 − 2·0 + 1|/8 of the
// parabola through three, two thirds of that in the mean, and of a sum of 2.
TEST(Measure, TellsWhatTheRowsMayMissOfAnIntegral) {
  const auto run = sampled(
      3, 4, [](double t) { return std::fmod(t + 1, 2); }, [](double) { return 0.0; });
  measure("mean(x)", run);
  EXPECT_NEAR(run.doubt(), 2 * 2.0 / 3 * (2.0 / 8) / 2, 1e-12);
}

}  // namespace
}  // namespace oblique::ensemble
