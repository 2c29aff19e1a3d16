// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/stability_report.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

/// A mode of 1 rad/s with so much damping, which an ideal machine would have undamped.
WorstMode undamped_by_design(double damping) {
  WorstMode worst;
  worst.mode.pole = {-damping, std::sqrt(1 - damping * damping)};
  worst.ideal_pole = {0, 1};
  return worst;
}

TEST(ModeVerdict, OfAnOscillatorAllowsAMillionthARadian) {
  for (const double sign : {1.0, -1.0})
    EXPECT_EQ(verdict_on(undamped_by_design(sign * 0.9e-6)), ModeVerdict::undamped) << sign;
  EXPECT_EQ(verdict_on(undamped_by_design(1.1e-6)), ModeVerdict::badly_damped);
  EXPECT_EQ(verdict_on(undamped_by_design(-1.1e-6)), ModeVerdict::grows);
}

TEST(ModeVerdict, OfAModeThatIsDampedByDesignAllowsNothing) {
  WorstMode worst = undamped_by_design(-0.5e-6);
  worst.ideal_pole = {-0.01, 1};
  EXPECT_EQ(verdict_on(worst), ModeVerdict::grows);
  worst.ideal_pole.reset();
  EXPECT_EQ(verdict_on(worst), ModeVerdict::grows);
}

// dx/dt = a x: x grows where a > 0, whatever it did at the instant before.
TEST(StabilityReport, TellsGrowthAtTimesFromGrowthThroughout) {
  const Compiled made(R"toml(one = { type = "constant" }
a = { type = "integrator", in = ["-one"], initial = 0.5 }
p = { type = "multiplier", in = ["a", "x"] }
x = { type = "integrator", in = ["p"], initial = 1 }
)toml");
  const SignalFlow flow(made.flat, made.program);
  const auto verdict_along = [&](const std::vector<double>& values_of_a) {
    std::vector<Instant> instants;
    for (const double a : values_of_a) {
      Instant& instant = instants.emplace_back(Instant{0, made.program.start()});
      for (std::size_t i = 0; i < made.program.n_states(); ++i) {
        if (made.program.states()[i].name == "a") instant.states[i] = a;
      }
    }
    return judge_stability(made.program, flow, instants).verdict;
  };
  EXPECT_EQ(verdict_along({0.5, 0.4}), StabilityVerdict::grows);
  EXPECT_EQ(verdict_along({0.5, -0.5}), StabilityVerdict::grows_at_times);
  EXPECT_EQ(verdict_along({-0.5, 0.5}), StabilityVerdict::grows_at_times);
  EXPECT_EQ(verdict_along({-0.5, -0.4}), StabilityVerdict::stable_when_frozen);
  EXPECT_EQ(verdict_along({-0.5, -0.5}), StabilityVerdict::stable);
}

// What grows by less than a billionth over the whole run stands still.
TEST(StabilityReport, TakesAPoleThatTheRunDoesNotShowForNone) {
  const auto verdict_of = [](const char* rate, double until) {
    const Compiled made(std::string("k = { type = \"constant\", value = ") + rate + R"toml( }
p = { type = "multiplier", in = ["k", "x"] }
x = { type = "integrator", in = ["p"], initial = 1 }
)toml");
    const SignalFlow flow(made.flat, made.program);
    return judge_stability(made.program, flow,
                           {Instant{0, made.program.start()}, Instant{until, made.program.start()}})
        .verdict;
  };
  EXPECT_EQ(verdict_of("0.9e-10", 10), StabilityVerdict::undamped);
  EXPECT_EQ(verdict_of("1.1e-10", 10), StabilityVerdict::grows);
  EXPECT_EQ(verdict_of("1e-10", 1000), StabilityVerdict::grows);
}

// x = 1/a has no derivative where a is 0.
TEST(StabilityReport, TellsOfAnInstantWithoutALinearisation) {
  const Compiled made(R"toml(one = { type = "constant" }
a = { type = "integrator", in = ["-one"], initial = 0 }
q = { type = "divider", numerator = "one", denominator = "a", gain = inf, bandwidth = inf }
x = { type = "integrator", in = ["-x", "q"] }
)toml");
  const SignalFlow flow(made.flat, made.program);
  std::vector<Instant> instants(2, Instant{0, made.program.start()});
  for (std::size_t i = 0; i < made.program.n_states(); ++i) {
    if (made.program.states()[i].name == "a") instants[1].states[i] = 1;
  }
  const StabilityReport report = judge_stability(made.program, flow, instants);
  EXPECT_EQ(report.instants, 1U);
  EXPECT_THAT(report.left_out,
              ::testing::ElementsAre("1 of 2 instants, at which the equations have no linearisation"));
}

TEST(StabilityReport, HasTheSameModesWithoutMargins) {
  const Compiled made(R"toml(one = { type = "constant" }
lag = { type = "integrator", in = ["c", "-lag"] }
c = { type = "servo-amplifier", in = ["lag", "c", "-one"], gain = 1e4, bandwidth = "10 Hz" }
)toml");
  const SignalFlow flow(made.flat, made.program);
  const std::vector<Instant> instants(1, Instant{0, made.program.start()});
  const StabilityReport with = judge_stability(made.program, flow, instants);
  const StabilityReport without = judge_stability(made.program, flow, instants, {}, false);
  EXPECT_EQ(with.margins.size(), 1U);
  EXPECT_TRUE(without.margins.empty());
  EXPECT_EQ(without.verdict, with.verdict);
  ASSERT_TRUE(with.servo_mode && without.servo_mode);
  EXPECT_EQ(without.servo_mode->mode.pole, with.servo_mode->mode.pole);
  EXPECT_EQ(without.slowest_servo->mode.pole, with.slowest_servo->mode.pole);
  EXPECT_EQ(without.left_out, with.left_out);
}

}  // namespace
}  // namespace oblique::solve
