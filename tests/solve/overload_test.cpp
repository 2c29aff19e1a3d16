// SPDX-License-Identifier: MIT
// Overloads of signals whose peaks and crossings have closed forms.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using std::numbers::pi;
using testing::Compiled;

/// x = A sin t, y = A cos t.
std::string oscillator(double amplitude) {
  return fmt::format(
      "x = {{ type = \"integrator\", in = [\"y\"] }}\n"
      "y = {{ type = \"integrator\", in = [\"-x\"], initial = {} }}\n",
      amplitude);
}

Run watched(const Compiled& made, double until, bool halt = false, double tolerance = 1e-10) {
  RunOptions options;
  options.until = until;
  options.tolerance = tolerance;
  options.samples = 3;  // the watch looks at steps, not at rows
  options.watch_overloads = true;
  options.halt_on_overload = halt;
  return run(made.program, made.flat, options);
}

TEST(Overload, OfASineHasItsPeakTimeAndDuration) {
  constexpr double kAmplitude = 1.25, kTurns = 3;
  const Compiled made(oscillator(kAmplitude));
  const auto result = watched(made, kTurns * 2 * pi);
  ASSERT_EQ(result.overloads.size(), 2U);
  // y starts outside, x leaves at asin(1/A).
  const OverloadRecord& y = result.overloads[0];
  const OverloadRecord& x = result.overloads[1];
  EXPECT_EQ(y.signal, made.signal("y"));
  EXPECT_EQ(x.signal, made.signal("x"));
  // The solver's error of 1e-10 a step over some 200 steps, divided by the derivative 0.75 at the crossing.
  const double outside = std::acos(1 / kAmplitude);
  EXPECT_EQ(y.first, 0);
  EXPECT_NEAR(x.first, std::asin(1 / kAmplitude), 1e-8);
  EXPECT_NEAR(y.duration, kTurns * 4 * outside, 1e-6);
  EXPECT_NEAR(x.duration, kTurns * 4 * outside, 1e-6);
  EXPECT_NEAR(std::abs(y.peak.value), kAmplitude, 3e-7);  // what is no new peak to the watch, and the solver
  EXPECT_NEAR(std::abs(x.peak.value), kAmplitude, 3e-7);
  // A sine is flat at its peak: where it is is known to the square root of twice that.
  EXPECT_NEAR(std::remainder(x.peak.time, pi), std::copysign(pi / 2, std::remainder(x.peak.time, pi)), 8e-4);
  EXPECT_EQ(x.suggested_scale, 0.5);
}

TEST(Overload, InsideOneStepIsFound) {
  // Coarse steps: |y| exceeds 1 by 1e-3 for 0.09 s only, which the ends of the steps do not show.
  const Compiled made(oscillator(1.001));
  const auto result = watched(made, 2.2, false, 1e-3);
  ASSERT_EQ(result.overloads.size(), 2U);
  const OverloadRecord& x = result.overloads[1];
  EXPECT_EQ(x.signal, made.signal("x"));
  EXPECT_NEAR(x.peak.value, 1.001, 5e-3);  // the solver's tolerance
  EXPECT_LT(x.duration, 0.3);
}

// 0.95 + 0.1 sin 1000t, without any state: outside for acos(1/2)/π of the time, with three rows.
TEST(Overload, OfARippleBetweenTheRowsIsFound) {
  const Compiled made("r = { type = \"time-function\", formula = \"0.95 + 0.1*sin(1000*time)\" }\n");
  const auto result = watched(made, pi / 10);
  ASSERT_EQ(result.overloads.size(), 1U);
  EXPECT_NEAR(result.overloads[0].peak.value, 1.05, 1e-3);  // to which overloads are found
  EXPECT_NEAR(result.overloads[0].first, std::asin(0.5) / 1000, 1e-9);
  EXPECT_NEAR(result.overloads[0].duration, pi / 30, 1e-3);  // of each peak of 2 ms by less than 1e-5
}

TEST(Overload, OfAPolynomialIsExact) {
  // p = (2 t)² − 2 leaves the range at −1 at t = 1/2 for the inside and at √3/2 upwards; it starts at −2.
  const Compiled made(R"toml(one = { type = "constant" }
h   = { type = "integrator", in = ["0.5*one"] }
hh  = { type = "multiplier", in = ["h", "h"] }
p   = { type = "summer", in = ["16*hh", "-2*one"] }
)toml");
  const auto result = watched(made, 1);
  ASSERT_EQ(result.overloads.size(), 1U);
  const OverloadRecord& p = result.overloads[0];
  EXPECT_EQ(p.first, 0);
  // Outside over [0, 1/2] and [√3/2, 1].
  EXPECT_NEAR(p.duration, 1.5 - std::sqrt(3) / 2, 1e-9);
  EXPECT_NEAR(std::abs(p.peak.value), 2, 1e-9);
  EXPECT_EQ(p.suggested_scale, 0.5);
}

// s = 1.5 sin 4t of the time itself, which costs the solver no step: its only peak is at π/8, somewhere
// within one that is long beside it. A parabola through neighbours 1/256 of a step of at most 1 s apart errs
// by less than their distance to the third power, 6e-8 s, and the value by half the curvature 24 times its
// square.
TEST(Overload, HasThePeakOfASignalThatBendsWithinAStep) {
  const Compiled made(R"toml(one = { type = "constant" }
h = { type = "integrator", in = ["one"] }
c = { type = "sine", in = "4*h" }
s = { type = "summer", in = ["1.5*c"] }
)toml");
  const auto result = watched(made, 0.7);
  ASSERT_EQ(result.overloads.size(), 1U);
  const OverloadRecord& s = result.overloads[0];
  EXPECT_EQ(s.signal, made.signal("s"));
  EXPECT_NEAR(s.peak.time, pi / 8, 6e-8);
  EXPECT_NEAR(s.peak.value, 1.5, 12 * 6e-8 * 6e-8 + 1e-15);
}

TEST(Overload, HaltsTheRunAtItsTime) {
  const Compiled made(oscillator(0.5) + "s = { type = \"summer\", in = [\"4*x\"] }\n");
  const auto result = watched(made, 10, true);
  EXPECT_TRUE(result.halted);
  ASSERT_EQ(result.overloads.size(), 1U);
  EXPECT_EQ(result.overloads[0].signal, made.signal("s"));
  EXPECT_NEAR(result.overloads[0].first, pi / 6, 1e-8);
  EXPECT_EQ(result.trajectory.rows(), 1U);  // rows at 0, 5 and 10: one before the overload
}

// The state is that of the halt, also where a loop reads it: x = 0.1 + t/2, and q + q³ = 2x, of which q
// leaves at 1.
TEST(Overload, HaltsTheRunInTheStateOfItsTime) {
  const Compiled made(R"toml(one = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["one"], initial = 0.1 }
b = { type = "gain", in = "x", factor = 0.25 }
qq = { type = "squarer", in = "q" }
q3 = { type = "multiplier", x = "q", y = "qq" }
q = { type = "summer", in = ["-q3", "2*x"] }
)toml");
  const auto result = watched(made, 4, true);
  ASSERT_TRUE(result.halted);
  EXPECT_NEAR(result.state.time, 1.8, 1e-9);
  ASSERT_EQ(result.state.states.size(), 1U);
  EXPECT_NEAR(result.state.states[0].second, 1, 1e-9);
  ASSERT_EQ(result.state.unknowns.size(), 1U);
  const double z = result.state.unknowns[0].second;  // one of the loop's elements: q = 1, qq = 1 or q3 = 1
  EXPECT_NEAR(z, 1, 1e-8);
}

TEST(Overload, WithoutStatesIsFoundBetweenRows) {
  const Compiled made("a = { type = \"constant\", value = 1.5 }\n");
  const auto result = watched(made, 2);
  ASSERT_EQ(result.overloads.size(), 1U);
  EXPECT_EQ(result.overloads[0].duration, 2);
  EXPECT_TRUE(watched(made, 2, true).halted);
}

TEST(Overload, NeitherFullRangeNorQuietIsOne) {
  EXPECT_TRUE(watched(Compiled(oscillator(1)), 10).overloads.empty());
  const auto unwatched = testing::run_of(Compiled(oscillator(2)));
  EXPECT_TRUE(unwatched.overloads.empty());
  EXPECT_FALSE(unwatched.halted);
}

TEST(Overload, WatchingDoesNotChangeTheRun) {
  const Compiled made(oscillator(1.25));
  const auto quiet = testing::run_of(made, {.until = 5, .tolerance = 1e-10, .samples = 3});
  EXPECT_EQ(quiet.statistics.steps, watched(made, 5).statistics.steps);
}

}  // namespace
}  // namespace oblique::solve
