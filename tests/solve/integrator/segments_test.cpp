// SPDX-License-Identifier: MIT
// Where a smooth segment ends and the states go on as they went, the solver does so too.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

// A pulse train that only a counter reads turns over two thousand times: an oscillator beside it errs by what
// it errs without it, and in as many steps.
TEST(Clocks, OneThatActsOnNothingCostsNoAccuracy) {
  const std::string oscillator = R"toml(
x = { type = "integrator", in = "v", initial = 1 }
v = { type = "integrator", in = "-x" }
)toml";
  const std::string clock = R"toml(
p = { type = "pulse-train", period = 0.1, width = 0.05 }
n = { type = "counter", in = "p" }
)toml";
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::rodas}) {
    const testing::Request options{.until = 100, .tolerance = 1e-8, .method = method};
    const auto alone = run_of(Compiled(oscillator), options),
               beside = run_of(Compiled(oscillator + clock), options);
    const auto error = [](const auto& run) {
      return std::abs(row_values(run, "x").back() - std::cos(100.0));
    };
    EXPECT_EQ(row_values(beside, "n.out").back(), 1000);
    // The steps are the same, but in the first period of the clock, at whose edges the solver begins anew.
    EXPECT_LE(error(beside), 2 * error(alone));
    EXPECT_LE(beside.statistics.evaluations, 1.5 * static_cast<double>(alone.statistics.evaluations));
  }
}

// A switch lets through, from t = 5.01 on, a source that is nothing until a pulse at t = 5.04, of a
// thousandth of a second: the edge of its clock acts on nothing at first, and neither it nor the clock's
// later edges may hide the pulse.
TEST(Clocks, OneThatOpensTheWayToAPulseDoesNotHideIt) {
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::rodas}) {
    const auto result = run_of(Compiled(R"toml(
p = { type = "pulse-train", period = 0.5, width = 0.2, delay = 0.01 }
u = { type = "time-function", formula = "exp(-((time - 5.04)/5e-4)^2)" }
g = { type = "multiplier", in = ["p", "u"] }
x = { type = "integrator", in = "g" }
one = { type = "constant" }
y = { type = "transfer-lag", in = "one" }
)toml"),
                               {.until = 10, .method = method});
    EXPECT_NEAR(row_values(result, "x").back(), 5e-4 * std::sqrt(std::numbers::pi), 1e-9);
  }
}

// The same clock that acts: x follows it, and is begun anew at each edge (a square wave's integral is a
// triangle).
TEST(Clocks, OneThatActsIsNotPassedOver) {
  const Compiled made(R"toml(
p = { type = "pulse-train", period = 0.1, width = 0.05 }
half = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["p", "-half"] }
y = { type = "integrator", in = "x" }
)toml");
  const auto result = run_of(made, {.until = 10, .tolerance = 1e-6});
  // In each period x is a triangle of height 0.025 and length 0.1.
  // Begun anew at 200 edges, it errs at each by no more than the tolerance lets it.
  EXPECT_NEAR(row_values(result, "y").back(), 100 * 0.00125, 1e-7);
}

// What a straight line of the time between two edges passes is known to the rounding of the time, which times
// its slope is more than that of what is compared: where it was found it had not passed yet, and was found
// again without end. From t = 0.80083 on, the last of six samples in 0.961, the line rises from 0 to 1/2 in a
// sixth of that, and passes 0.05/2 after a twentieth.
TEST(Clocks, WhatALineBetweenTwoOfTheirEdgesPassesIsPassedOnce) {
  const Compiled made(R"toml(
u = { type = "constant", value = 0.5 }
d = { type = "delay-line", in = "u", delay = 0.961, stages = 6, straight = 1 }
c = { type = "comparator", in = ["2*d"], hysteresis = 0.1 }
x = { type = "integrator", in = ["u"] }
)toml");
  const auto result = run_of(made, {.until = 3});
  std::vector<double> turns;
  for (const EventRecord& event : result.events) {
    if (event.what.starts_with("c: ")) turns.push_back(event.time);
  }
  ASSERT_EQ(turns.size(), 1);
  EXPECT_NEAR(turns[0], 0.961 / 6 * 5.05, 1e-12);
  EXPECT_EQ(row_values(result, "c").back(), 1);
}

// A play between gears that drives itself through a delay line comes to rest at the edge of its play: the
// sample of t = 0.78125 leads from there into the play, where nothing moves, and the step goes on beyond it.
// That the sample has come, and the play not yet been left, is no state of which the step may be read: y was
// 0.06 there between two points at zero.
TEST(Clocks, OneThatLeadsIntoADeadZoneLeavesTheStepAsItWas) {
  const Compiled made(R"toml(
u = { type = "delay-line", in = "-y", delay = 0.3125, stages = 2, straight = 0, initial = 0.75 }
y = { type = "backlash", in = "0.5*u", play = 0.25, rate = 484 }
)toml");
  using diagram::IntegrationMethod;
  RunOptions options;
  options.until = 2;
  options.tolerance = 1e-9;
  options.max_step = 0.140625;
  for (const auto method : {IntegrationMethod::bdf, IntegrationMethod::rodas}) {
    options.method = method;
    const Trajectory result = run(made.program, made.flat, options).trajectory;
    const std::vector<double> y = testing::column_of(result, "y");
    for (std::size_t row = 0; row < result.rows(); ++row) {
      // At 0.625 it has moved to zero for 484 (0.625 − 0.46875) = 76 of its time constants.
      if (!(result.at(row, 0) > 0.625)) continue;
      EXPECT_NEAR(y[row], 0, 1e-9) << result.at(row, 0);
    }
  }
}

// After a million seconds the time shows nothing shorter than 1e-10 s: pulses of a hundredth of that have
// their area, 1, all the same, by each method; the first comes at 1 000 005 s.
TEST(Clocks, APulseThatTheTimeDoesNotShowHasItsLength) {
  const Compiled made(R"toml(
p = { type = "pulse-train", period = 10, width = 1e-12, high = 1e12, delay = 1000005 }
x = { type = "integrator", in = "p" }
)toml");
  using diagram::IntegrationMethod;
  for (const auto method : {IntegrationMethod::adams, IntegrationMethod::bdf, IntegrationMethod::rodas})
    EXPECT_NEAR(row_values(run_of(made, {.until = 1000100, .method = method}), "x").back(), 10, 1e-7);
}

// Phases of a nanosecond, of which the time shows few digits late in the run, and of a picosecond, of which
// it shows none.
TEST(Phases, HaveTheirLengthLateInARun) {
  for (const std::string length : {"1e-9", "1e-12"}) {
    const Compiled made(
        "k = { type = \"constant\", value = \"1/" + length +
            "\" }\nx = { type = \"integrator\", in = \"k\" }\n",
        "[timeline]\nphases = [ { mode = \"hold\", for = 1e4 }, { mode = \"operate\", for = " + length +
            " } ]\ncycles = inf\n");
    EXPECT_NEAR(row_values(run_of(made, {.until = 205'000}), "x").back(), 20, 1e-6) << length;
  }
}

// A step of Rosenbrock's method ends where the summer b2 is beyond the limit of its machine, and the loop b0,
// of which nothing is integrated, has no solution there: it has one up to the limit, and at it.
TEST(Limits, AreFoundBeforeALoopBeyondThemHasNoSolution) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "0.62*sin(3.16*time + 3)" }
b0 = { type = "summer", in = ["1.76*b3", "0.41*b2", "1.29*b0"] }
b1 = { type = "multiplier", in = ["b2", "b0"] }
b2 = { type = "summer", in = ["-1.86*u", "1.41*b5"] }
b3 = { type = "multiplier", in = ["b1", "b0"] }
b5 = { type = "integrator", in = ["1.8*b2"], initial = 0.23 }
)toml",
                      "[machine]\nprofile = \"ec-1\"\n");
  using diagram::IntegrationMethod;
  const auto end_by = [&](IntegrationMethod method) {
    const oblique::solve::Run result =
        run_of(made, {.until = 3, .tolerance = 1e-6, .samples = 4, .method = method});
    EXPECT_EQ(row_values(result, "b2").back(), -1.2);
    return row_values(result, "b0").back();
  };
  EXPECT_NEAR(end_by(IntegrationMethod::rodas), end_by(IntegrationMethod::bdf), 1e-6);  // a loop at the limit
}

}  // namespace
}  // namespace oblique::solve
