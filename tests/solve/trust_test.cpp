// SPDX-License-Identifier: MIT
// The estimate of a run's error beside events, timelines, saved states, chaos; smooth problems are in
// catalogue_test.cpp.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;

Run trusted(const Compiled& made, double until, RunOptions options = {}) {
  options.until = until;
  options.trust = true;
  return run(made.program, made.flat, options);
}

TEST(Trust, IsNotEstimatedUnlessAskedFor) {
  EXPECT_FALSE(testing::run_of(Compiled("x = { type = \"ramp\" }\n")).trust);
}

TEST(Trust, CountsTheDigitsThatAnErrorLeaves) {
  OutputError output;
  output.size = 20;
  EXPECT_EQ(output.digits(0), 15);
  EXPECT_EQ(output.digits(1e-30), 15);
  EXPECT_EQ(output.digits(1.9e-7), 8);
  EXPECT_EQ(output.digits(2.1e-7), 7);
  EXPECT_EQ(output.digits(3), 0);
  EXPECT_EQ(output.digits(300), 0);
}

// σ = 10, ρ = 28, β = 8/3 from (1, 1, 1). Truth: Taylor's series of high order in 60 digits
// (trust_truths.py). Errors grow as e^(0.9 t): from the tolerance to the size of the attractor in some 25 s.
TEST(Trust, FindsNoDigitAtTheEndOfChaos) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["10*y", "-10*x"], initial = 1 }
xz = { type = "multiplier", in = ["x", "z"] }
y = { type = "integrator", in = ["28*x", "-y", "-xz"], initial = 1 }
xy = { type = "multiplier", in = ["x", "y"] }
z = { type = "integrator", in = ["xy", "-2.6666666666666665*z"], initial = 1 }
)toml",
                      "[outputs]\nx = \"x\"\nz = \"z\"\nsmall = { signal = \"x\", scale = 0.001 }\n");
  RunOptions options;
  options.samples = 401;
  const oblique::solve::Run result = trusted(made, 40, options);
  const std::vector<std::pair<double, double>> truths{
#include "lorenz_truths.inc"
  };
  ASSERT_EQ(result.trust->checks.size(), 2);
  const OutputError& x = result.trust->outputs.front();
  EXPECT_EQ(x.digits(x.at_end), 0);
  ASSERT_TRUE(x.lost);
  EXPECT_EQ(result.trust->outputs.back().lost, x.lost) << "in whatever unit it is shown";
  EXPECT_GT(*x.lost, 15);
  EXPECT_LT(*x.lost, 40);
  // Where it says that digits stand, they do.
  for (const auto& [t, truth] : truths) {
    const auto row = static_cast<std::size_t>(std::lround(10 * t));
    const double error = std::abs(result.trajectory.at(row, 1) - truth);
    if (t < *x.lost) {
      EXPECT_LT(error, 0.2 * x.size) << t;  // the estimate is 0.1 of it at most
    }
    EXPECT_LT(error, 10 * x.largest) << t;
  }
  const double end = std::abs(result.trajectory.at(400, 1) - truths.back().second);
  EXPECT_GT(10 * x.at_end, end);
}

// x' = cos t switches a comparator at the zeros of sin t, the rows lie on them and between. Its output jumps
// there: the runs have the event a little sooner or later, and the row is right in both.
TEST(Trust, LeavesOutRowsBetweenTheEventsOfTwoRuns) {
  const Compiled made(R"toml(c = { type = "integrator", in = ["-x"], initial = 1 }
x = { type = "integrator", in = ["c"] }
is_above = { type = "comparator", in = "x" }
)toml",
                      "[outputs]\nx = \"x\"\nis_above = \"is_above\"\n");
  RunOptions options;
  options.samples = 42;
  const oblique::solve::Run result =
      trusted(made, 20.5 * std::numbers::pi, options);  // no event at the very end
  const Trust& trust = *result.trust;
  EXPECT_GT(trust.event_shift, 0);
  EXPECT_LT(trust.event_shift, 1e-6);
  EXPECT_FALSE(trust.events_part);
  EXPECT_EQ(trust.outputs[1].largest, 0);
  double error = 0;
  for (std::size_t row = 0; row < result.trajectory.rows(); ++row)
    error = std::max(error, std::abs(result.trajectory.at(row, 1) - std::sin(result.trajectory.at(row, 0))));
  EXPECT_GT(trust.outputs[0].largest, error / 10);
  EXPECT_LT(trust.outputs[0].largest, 100 * error);
}

// A magnitude and a comparator turn over together each half a second; a run tells of one of the two, or of
// both.
TEST(Trust, TakesEventsOfOneComparisonForTheSame) {
  const Compiled made(R"toml(s = { type = "sine-source" }
ab = { type = "absolute-value", in = "s" }
z = { type = "integrator", in = ["ab"] }
c = { type = "comparator", in = ["s"] }
)toml",
                      "[outputs]\nz = \"z\"\nc = \"c\"\n");
  for (const double until : {19.25, 21.25, 30.25, 100.25})
    EXPECT_FALSE(trusted(made, until, {}).trust->events_part) << until;
}

// At each turn of a triangle x stands on the level of the comparator that has turned it, to a rounding:
// whether that goes back at this instant or 10⁻¹³ s later, one run tells and another one does not. Only the
// first thousand lines of the events are kept; there are 1100.
TEST(Trust, TakesWhatARoundingLeavesUntoldForNoOtherEvent) {
  const Compiled made(R"toml(one = { type = "constant" }
above = { type = "comparator", in = ["x", "-0.1*one"] }
below = { type = "comparator", in = ["-x", "-0.1*one"] }
f = { type = "flip-flop", set = "above", reset = "below" }
x = { type = "integrator", in = ["one", "-2*f.out"], initial = 0.05 }
)toml",
                      "[outputs]\nx = \"x\"\n");
  for (const double until : {20.0, 100.037}) {
    const oblique::solve::Run result = trusted(made, until, {});
    EXPECT_FALSE(result.trust->events_part) << until;
    EXPECT_LT(result.trust->event_shift, 1e-9) << until;
  }
}

// A switch that only the coarser of two runs reaches: x = sin t rises to 1, and the threshold lies 1e-7 above
// it. At a tolerance of 1e-4 x passes it in one run of the two or in none; where it does, the runs part.
TEST(Trust, TellsWhereEventsPart) {
  bool parts = false;
  for (const double threshold : {1 - 1e-9, 1 + 1e-9, 1 + 1e-8, 1 + 1e-7}) {
    const Compiled made(
        "c = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n"
        "x = { type = \"integrator\", in = [\"c\"] }\n"
        "one = { type = \"constant\" }\n"
        "is_above = { type = \"comparator\", in = [\"x\", \"-" +
            fmt::format("{:.12f}", threshold) + "*one\"] }\n",
        "[outputs]\nis_above = \"is_above\"\n");
    RunOptions options;
    options.tolerance = 1e-3;
    const oblique::solve::Run result = trusted(made, 100, options);
    const Trust& trust = *result.trust;
    if (!trust.events_part) continue;
    parts = true;
    EXPECT_GT(*trust.events_part, 1);
  }
  EXPECT_TRUE(parts);
}

// x = 1/4 in initial condition and e^-t/4 after it: modes are settled anew in every run.
TEST(Trust, GoesThroughTimelinesAndFromSavedStates) {
  const Compiled made("x = { type = \"integrator\", in = [\"-x\"], initial = 0.25 }\n", R"toml([timeline]
phases = [{ mode = "initial", for = 1 }, { mode = "operate", for = 4 }]
[outputs]
x = "x"
)toml");
  const oblique::solve::Run whole = trusted(made, 5);
  const auto error_of = [](const oblique::solve::Run& run) {
    double error = 0;
    for (std::size_t row = 0; row < run.trajectory.rows(); ++row) {
      const double t = run.trajectory.at(row, 0);
      error = std::max(error, std::abs(run.trajectory.at(row, 1) - std::exp(-std::max(t - 1, 0.0)) / 4));
    }
    return error;
  };
  EXPECT_GT(whole.trust->outputs[0].largest, error_of(whole) / 10);
  EXPECT_LT(whole.trust->outputs[0].largest, 1e-8);
  RunOptions options;
  options.from = trusted(made, 3).state;
  const oblique::solve::Run rest = trusted(made, 5, options);
  EXPECT_LT(rest.trust->outputs[0].largest, 1e-8);
  EXPECT_EQ(rest.trust->checks.size(), 2);
}

// dx/dt = x², the comparison runs blow up sooner than the coarse one is asked to end: there is no estimate,
// and the reason is told. x = 1/(1 − t).
TEST(Trust, SaysWhyThereIsNoEstimate) {
  const Compiled made(
      "xx = { type = \"squarer\", in = \"x\" }\nx = { type = \"integrator\", in = [\"xx\"], initial = 1 }\n");
  RunOptions options;
  options.method = diagram::IntegrationMethod::rodas;
  options.max_steps = 20;  // enough for that at 1e-3; not at 1e-5, nor for CVODES
  options.tolerance = 1e-3;
  const oblique::solve::Run result = trusted(made, 0.9, options);
  EXPECT_TRUE(result.trust->checks.empty());
  EXPECT_THAT(result.trust->failure, HasSubstr("its budget of"));
}

// A decay of 10⁶/s beside one of 1/s, by BDF: Adams' formulas would take a million steps. x = (1 + t) e^−t.
TEST(Trust, HasASecondOpinionOfStiffEquations) {
  const Compiled made(R"toml(u = { type = "integrator", in = ["-u"], initial = 1 }
f = { type = "integrator", in = ["1e6*u", "-1e6*f"], initial = 1 }
x = { type = "integrator", in = ["f", "-x"], initial = 1 }
)toml");
  const oblique::solve::Run result = trusted(made, 4);
  ASSERT_EQ(result.method.method, diagram::IntegrationMethod::bdf);
  ASSERT_EQ(result.trust->checks.size(), 2);
  EXPECT_EQ(result.trust->checks[1].method, diagram::IntegrationMethod::rodas);
  double error = 0;
  const std::vector<double> t = testing::row_values(result, "t"), x = testing::row_values(result, "x");
  // with the lag of f, which is 1e-6
  for (std::size_t row = 0; row < t.size(); ++row) {
    const double k = 1e6, a = k / (k - 1);  // f = a e^−t + (1 − a) e^−kt
    const double truth = std::exp(-t[row]) * (1 + a * t[row]) +
                         (1 - a) / (1 - k) * (std::exp(-k * t[row]) - std::exp(-t[row]));
    error = std::max(error, std::abs(x[row] - truth));
  }
  const auto& estimates = result.trust->outputs;
  const auto shown = std::find_if(estimates.begin(), estimates.end(),
                                  [](const OutputError& output) { return output.name == "x"; });
  ASSERT_NE(shown, estimates.end());
  EXPECT_GT(shown->largest, 0.5 * error);
  EXPECT_LT(shown->largest, 2 * error + 1e-12);
}

// The rows of `on_sample` and the steps of `progress` belong to the run alone.
TEST(Trust, KeepsItsChecksFromThoseWhoListen) {
  const Compiled made("x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n");
  RunOptions options;
  options.samples = 11;
  int rows = 0;
  options.on_sample = [&](double, std::span<const double>, std::span<const double>) { ++rows; };
  trusted(made, 1, options);
  EXPECT_EQ(rows, 11);
}

}  // namespace
}  // namespace oblique::solve
