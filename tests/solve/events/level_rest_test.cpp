// SPDX-License-Identifier: MIT
// Comparisons of what comes to their level: of what their own turn brings to rest there, as thyristors that
// cut off the current which they compare, and of what ends there, is put on it, or taken from it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::row_values;
using testing::run_of;
using ::testing::SizeIs;

/// 0.3 di/dt = sin 2πt − i where either thyristor is on; they fire at 0.2 and 0.7 of each period.
constexpr double kLag = 0.3, kFires = 0.2;

/// In closed form, of the first half-wave from where it fires.
double half_wave(double t) {
  constexpr double kOmega = 2 * std::numbers::pi;
  const auto steady = [](double at) {
    return (std::sin(kOmega * at) - kOmega * kLag * std::cos(kOmega * at)) /
           (1 + kOmega * kLag * kOmega * kLag);
  };
  return steady(t) - steady(kFires) * std::exp(-(t - kFires) / kLag);
}

double current(double t) {
  double low = 0.5, high = kFires + 0.5;  // it ends in between
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (half_wave(middle) > 0 ? low : high) = middle;
  }
  const double half = std::floor(2 * (t - kFires)), since = t - half / 2;  // half-waves
  return half < 0 || since > low ? 0 : (static_cast<int>(half) % 2 == 0 ? 1 : -1) * half_wave(since);
}

const std::vector<std::string> kLoad{
    "u = { type = \"sine-source\" }\n",
    "d = { type = \"summer\", in = [\"u\", \"-i\"] }\n",
    "di = { type = \"multiplier\", x = \"d\", y = \"on\" }\n",
    "i = { type = \"integrator\", in = \"di\", rate = \"1/0.3\" }\n",
    "fire1 = { type = \"pulse-train\", period = 1, width = 1e-3, delay = 0.2 }\n",
    "fire2 = { type = \"pulse-train\", period = 1, width = 1e-3, delay = 0.7 }\n"};

/// The blocks in their order and in the reverse one.
std::vector<Compiled> both_orders(std::vector<std::string> blocks) {
  blocks.insert(blocks.end(), kLoad.begin(), kLoad.end());
  std::vector<Compiled> made;
  for (int k = 0; k < 2; ++k) {
    std::string text;
    for (const std::string& block : blocks) text += block;
    made.emplace_back(text);
    std::reverse(blocks.begin(), blocks.end());
  }
  return made;
}

void expect_current(const solve::Run& run, bool both_ways = true) {
  const std::vector<double> t = row_values(run, "t"), i = row_values(run, "i");
  // The errors of the steps, and of the times at which it fires, add up to some ten tolerances of 1e-8.
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(i[k], both_ways ? current(t[k]) : std::max(current(t[k]), 0.0), 1e-6) << t[k];
}

const std::vector<std::string> kLatches{
    "on1 = { type = \"flip-flop\", set = \"fire1\", reset = \"dead1\" }\n",
    "on2 = { type = \"flip-flop\", set = \"fire2\", reset = \"dead2\" }\n",
    "on = { type = \"summer\", in = [\"on1.out\", \"on2.out\"] }\n",
    "dead1 = { type = \"comparator\", in = \"-i\" }\n", "dead2 = { type = \"comparator\", in = \"i\" }\n"};

// Neither comparison holds while the current rests at zero, and each thyristor fires anew. That which ended
// the half-wave, and would hold by the least offset, is that of the other one.
TEST(LevelRest, LetsLatchesFireThatTheirOwnTurnsHaveReset) {
  for (const Compiled& made : both_orders(kLatches)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run);
    EXPECT_THAT(run.warnings, IsEmpty());
  }
}

// One thyristor alone fires anew too. On a machine the least offset would hold it in reset, which is told.
TEST(LevelRest, IsToldOfWhereALatchReadsIt) {
  const std::vector<std::string> blocks{
      "on1 = { type = \"flip-flop\", set = \"fire1\", reset = \"dead1\" }\n",
      "on = { type = \"summer\", in = [\"on1.out\"] }\n", "dead1 = { type = \"comparator\", in = \"-i\" }\n"};
  for (const Compiled& made : both_orders(blocks)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run, false);
    ASSERT_THAT(run.warnings, SizeIs(1));
    EXPECT_THAT(
        run.warnings.front().what,
        HasSubstr("'dead1' (in > 0) rests at its level from t = 0.666564441 s on, where its own turn has "
                  "stopped what it compares, and at t = 1.2 s what follows depends on it"));
    EXPECT_THAT(run.warnings.front().remedy.words(), HasSubstr("give the comparison a hysteresis"));
  }
}

// A reset that is not read while the gate fires: what the comparison does at rest is all the same.
TEST(LevelRest, IsNotToldOfWhereNothingDependsOnIt) {
  std::vector<std::string> blocks{kLatches[2], kLatches[3], kLatches[4]};
  for (const std::string n : {"1", "2"}) {
    blocks.push_back("on" + n + " = { type = \"flip-flop\", set = \"fire" + n + "\", reset = \"blocked" + n +
                     "\" }\n");
    blocks.push_back("free" + n + " = { type = \"comparator\", in = [\"0.5*one\", \"-fire" + n + "\"] }\n");
    blocks.push_back("blocked" + n + " = { type = \"minimum\", x = \"dead" + n + "\", y = \"free" + n +
                     "\" }\n");
  }
  blocks.emplace_back("one = { type = \"constant\" }\n");
  for (const Compiled& made : both_orders(blocks)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run);
    EXPECT_THAT(run.warnings, IsEmpty());
  }
}

// The same by comparisons alone: each thyristor conducts while its current flows or it fires. On either side
// of zero the current goes on through it; at zero neither conducts, and it stops there, which is told.
TEST(LevelRest, StopsWhatNeitherOfTwoComparisonsCarriesOn) {
  const std::vector<std::string> blocks{"flows1 = { type = \"comparator\", in = \"i\" }\n",
                                        "flows2 = { type = \"comparator\", in = \"-i\" }\n",
                                        "on1 = { type = \"maximum\", x = \"flows1\", y = \"fire1\" }\n",
                                        "on2 = { type = \"maximum\", x = \"flows2\", y = \"fire2\" }\n",
                                        "on = { type = \"maximum\", x = \"on1\", y = \"on2\" }\n"};
  for (const Compiled& made : both_orders(blocks)) {
    const solve::Run run = run_of(made, {.until = 4, .samples = 401});
    expect_current(run);
    ASSERT_THAT(run.warnings, SizeIs(1));
    EXPECT_THAT(run.warnings.front().what, HasSubstr(" (in > 0) stops at its level at t = "));
    EXPECT_THAT(run.warnings.front().what, HasSubstr("the least offset lets it go on"));
  }
}

// A relay of three positions: z = cos t less its part within ±1/2 is exactly zero while that is, and then
// neither z > 0 nor −z > 0 holds, from whichever side it came.
TEST(Level, WhatRestsAtItsLevelIsNotAboveIt) {
  const Compiled made(R"(
x = { type = "integrator", in = "-y", initial = 1 }
y = { type = "integrator", in = "x" }
z = { type = "dead-zone", in = "x", low = -0.5, high = 0.5 }
c = { type = "comparator", in = "z" }
d = { type = "comparator", in = "-z" }
)");
  const auto result = run_of(made, {.until = 13});
  const auto t = row_values(result, "t"), c = row_values(result, "c"), d = row_values(result, "d");
  EXPECT_THAT(result.warnings, ::testing::IsEmpty());
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_EQ(c[k], std::cos(t[k]) > 0.5 ? 1 : 0) << t[k];
    EXPECT_EQ(d[k], std::cos(t[k]) < -0.5 ? 1 : 0) << t[k];
  }
}

// What follows the time alone comes to its level and rests there, or turns back from it. (Comparisons and
// their counters are exact.)
TEST(Level, WhatEndsOrTurnsBackAtItsLevelDoesNotHold) {
  for (const char* signal :
       {R"(r = { type = "ramp", start = 0, stop = 0.3 }
level = { type = "constant", value = 0.3 })",
        R"(r = { type = "limiter", in = "u", low = -0.3, high = 0.3 }
u = { type = "ramp", slope = 0.37 }
level = { type = "constant", value = 0.3 })",
        R"toml(r = { type = "time-function", formula = "min(time, 1)" }
level = { type = "constant", value = 1 })toml",
        R"(r = { type = "recording", data = [[0, 0], [1, 1], [2, 1], [3, 0]] }
level = { type = "constant", value = 1 })",
        R"(r = { type = "recording", data = [[0, 0], [0.7, 1], [1.4, 0], [2, 1], [3, 0]] }
level = { type = "constant", value = 1 })"}) {
    const Compiled made(std::string(signal) + R"(
c = { type = "comparator", in = ["r", "-level"] }
n = { type = "counter", clock = "c" }
x = { type = "integrator", in = "c" })");
    const auto result = run_of(made, {.until = 3});
    EXPECT_EQ(row_values(result, "n.out").back(), 0) << signal;
    EXPECT_EQ(row_values(result, "x").back(), 0) << signal;
  }
}

// A step and a counter of it are equal from then on; a product with a step to 0 is zero, and a sum of two
// that are: also where a ramp is part of it, which has its times known.
TEST(Level, WhatJumpsToItsLevelDoesNotHold) {
  for (const char* signal : {R"(u = { type = "step", at = 1 }
k = { type = "counter", clock = "u" }
d = { type = "summer", in = ["u", "-k.out"] })",
                             R"(v = { type = "step", at = 1 }
r = { type = "ramp", slope = -0.3, start = 0, stop = 1 }
d = { type = "summer", in = ["r", "0.3*v"] })",
                             R"(u = { type = "step", at = 1, from = -1, to = 0 }
r = { type = "ramp" }
d = { type = "multiplier", x = "u", y = "r" })",
                             R"(u = { type = "step", at = 1, from = 1, to = 0 }
s = { type = "ramp", start = 5 }
d = { type = "summer", in = ["-u", "s"] })"}) {
    const Compiled made(std::string(signal) + R"(
c = { type = "comparator", in = "d" }
e = { type = "comparator", in = "-d" }
x = { type = "integrator", in = ["c"] }
y = { type = "integrator", in = ["e"] })");
    const auto result = run_of(made, {.until = 3});
    EXPECT_EQ(row_values(result, "c").back(), 0) << signal;
    EXPECT_EQ(row_values(result, "e").back(), 0) << signal;
    // None of them holds but before 1.
    EXPECT_LE(row_values(result, "x").back() + row_values(result, "y").back(), 1 + 1e-12) << signal;
  }
}

// t − 1/2 comes to zero as a step takes 0.3 from it, so that it is above zero from 0.8 on; whatever turns
// over there, or bends, is not led astray.
TEST(Level, WhatIsTakenBackAsItComesToItsLevelDoesNotTurn) {
  const Compiled made(R"(
r = { type = "ramp" }
p = { type = "step", at = 0.5 }
h = { type = "constant", value = 0.5 }
v = { type = "summer", in = ["r", "-0.3*p", "-h"] }
c = { type = "comparator", in = "v" }
n = { type = "counter", clock = "c" }
x = { type = "integrator", in = "c" }
m = { type = "absolute-value", in = "v" }
d = { type = "maximum", x = "v", y = "0*h" }
)");
  const auto result = run_of(made, {.until = 1});
  const auto t = row_values(result, "t"), v = row_values(result, "v"), m = row_values(result, "m"),
             d = row_values(result, "d");
  EXPECT_EQ(row_values(result, "n.out").back(), 1);
  EXPECT_NEAR(row_values(result, "x").back(), 0.2, 1e-12);  // rounding
  for (std::size_t row = 0; row < t.size(); ++row) {
    EXPECT_NEAR(v[row], t[row] - 0.5 - (t[row] > 0.5 ? 0.3 : 0), 1e-15) << t[row];
    EXPECT_EQ(m[row], std::abs(v[row])) << t[row];
    EXPECT_EQ(d[row], std::max(v[row], 0.0)) << t[row];
  }
}

// The first pulse comes where the run starts: 0.3 − 3 · 0.1, which is 6e-17 below zero in doubles, does not
// hold, as it does not in the second one.
TEST(Level, WhatJumpsToItsLevelWhereTheRunStartsDoesNotHold) {
  const Compiled made(R"(
s = { type = "pulse-train", period = 0.5, width = 0.25, high = 0.1 }
l = { type = "constant", value = 0.3 }
c = { type = "comparator", in = ["l", "-3*s"] }
x = { type = "integrator", in = "c" }
)");
  EXPECT_NEAR(row_values(run_of(made, {.until = 0.75}), "x").back(), 0.25, 1e-12);  // rounding
}

// A counting converter stops at the step that is equal to what it converts, on whichever side of it rounding
// puts the sum of the steps.
TEST(Level, ACounterStopsWhereItIsEqual) {
  for (int steps = 1; steps <= 20; ++steps) {
    const Compiled made(fmt::format(R"(
v = {{ type = "constant", value = {} }}
clock = {{ type = "pulse-train", period = 0.1, width = 0.05, delay = 0.1 }}
above = {{ type = "comparator", in = ["v", "-k.out"] }}
gate = {{ type = "multiplier", x = "clock", y = "above" }}
k = {{ type = "counter", clock = "gate", step = 0.05 }})",
                                    0.05 * steps));
    EXPECT_NEAR(row_values(run_of(made, {.until = 3}), "k.out").back(), 0.05 * steps, 1e-15) << steps;
  }
}

}  // namespace
}  // namespace oblique::solve
