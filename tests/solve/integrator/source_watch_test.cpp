// SPDX-License-Identifier: MIT
// What sources and event functions do between the steps of a solver, against closed forms.
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/integrator/source_watch.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

// A dip of a thousandth of a second and a twentieth of what it stands on, under a state that is nearly at
// rest: a step of the solver leads far over it, and to a quarter of its size the source is smooth.
TEST(BentComparisons, AShallowDipOfTheTimeUnderAStateIsFound) {
  const Compiled made(R"toml(
u = { type = "time-function", formula = "10 - 0.5*exp(-((time - 53.3)/1e-3)^2)" }
ten = { type = "constant", value = 9.8 }
x = { type = "transfer-lag", in = "ten", time_constant = 3, initial = 9.7 }
c = { type = "comparator", in = ["x", "-u"] }
n = { type = "counter", in = "c" }
)toml");
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                            diagram::IntegrationMethod::rodas}) {
    const auto result = run_of(made, {.until = 100, .method = method});
    EXPECT_EQ(row_values(result, "n.out").back(), 1);
    // Up and down, where exp(−s²) = 0.4: s = ±√ln 2.5 = ±0.957.
    EXPECT_EQ(result.event_count, 2 + 1);  // and the count
  }
}

// sin² + cos² − 1 is zero but for rounding, which no bounds know however short the part: a million parts of a
// step were looked at for that. A pulse upon it of a thousandth of a second is found all the same.
TEST(SourcesOfTheTime, ThatCancelAreNotLookedAtWithoutEnd) {
  for (const char* const pulse : {"0", "exp(-((time - 5.04)/5e-4)^2)"}) {
    const Compiled made(fmt::format(R"toml(
u = {{ type = "time-function", formula = "sin(time)^2 + cos(time)^2 - 1 + {}" }}
x = {{ type = "integrator", in = "u" }}
over = {{ type = "comparator", in = "u" }}
)toml",
                                    pulse));
    const double area = *pulse == '0' ? 0 : 5e-4 * std::sqrt(std::numbers::pi);
    for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::rodas}) {
      // These let the sources be looked at some million times.
      const auto result = run_of(made, {.until = 10, .max_steps = 10'000, .method = method});
      EXPECT_NEAR(row_values(result, "x").back(), area, 1e-9);
    }
  }
}

// cos t to the 256th power is above a half within 0.0736 of each n π, 319 times in 1000: the first, at 0,
// from the start on, and all others by a step up and one down.
TEST(BentComparisons, APowerBySquarersOfAnOscillationIsAboveItsLevelOnceEachHalfTurn) {
  const Compiled made(R"toml(
x = { type = "integrator", in = "v", initial = 1 }
v = { type = "integrator", in = "-x" }
p2 = { type = "squarer", in = "x" }
p4 = { type = "squarer", in = "p2" }
p8 = { type = "squarer", in = "p4" }
p16 = { type = "squarer", in = "p8" }
p32 = { type = "squarer", in = "p16" }
p64 = { type = "squarer", in = "p32" }
p128 = { type = "squarer", in = "p64" }
p256 = { type = "squarer", in = "p128" }
half = { type = "constant", value = 0.5 }
c = { type = "comparator", in = ["p256", "-half"] }
)toml");
  const auto result = run_of(made, {.until = 1000});
  EXPECT_EQ(result.event_count, 1 + 2 * 318);
}

// What bounds cannot tell does not cost more than the steps themselves: x − x y/y is zero to rounding.
TEST(BentComparisons, ADifferenceOfTwoFormsOfOneSignalEndsTheSearch) {
  const Compiled made(R"toml(
x = { type = "integrator", in = "v", initial = 1 }
v = { type = "integrator", in = "-x" }
two = { type = "constant", value = 2 }
y = { type = "summer", in = ["v", "two"] }
p = { type = "multiplier", in = ["x", "y"] }
q = { type = "divider", numerator = "p", denominator = "y" }
level = { type = "constant", value = 1e-3 }
c = { type = "comparator", in = ["x", "-q", "-level"] }
)toml");
  EXPECT_EQ(run_of(made, {.until = 100}).event_count, 0);
}

// A dip of some 2e-5 s is masked until the state passes a half, a fiftieth of a second before: the same step
// leads over both, and nothing but a count follows from them. The search for events may find it by itself:
// that nothing is lost on the way is seen here, that the step is looked at anew in
// ThatAreMaskedAreNotLookedAt.
TEST(BentComparisons, WhatAnotherUnmasksWithinAStepIsFound) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("own", R"toml(
[inputs]
in = {}
[outputs]
out = {}
[memories]
n = 0
[equations]
out = "n"
[[events]]
when = "in > 0.5 and 1e-10 > (in - 0.51)*(in - 0.51)"
set = { n = "n + 1" }
)toml");
  const Compiled made(R"toml(
one = { type = "constant", value = 1 }
x = { type = "transfer-lag", in = "one", time_constant = 1 }
n = { type = "own", in = "x" }
)toml",
                      "", library);
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                            diagram::IntegrationMethod::rodas}) {
    for (const double tolerance : {1e-3, 1e-6})
      EXPECT_EQ(row_values(run_of(made, {.until = 2, .tolerance = tolerance, .method = method}), "n").back(),
                1);
  }
}

/// x goes up and back within [0, 1], in half a turn.
class Excursion final : public Interpolant {
 public:
  void states_at(double t, std::span<double> states) const override {
    states[0] = std::sin(std::numbers::pi * t);
  }
  void rates_at(double t, std::span<double> rates) const override {
    rates[0] = std::numbers::pi * std::cos(std::numbers::pi * t);
  }
};

// What drives an integrator passes zero several times on the way: x³ − 3/2 x² + 0.6 x − 0.04 of x, near to it
// between 0.1 and 1. Within its limits nobody looks; beyond them, or where a slide may have it otherwise,
// that is done.
TEST(BentComparisons, ThatAreMaskedAreNotLookedAt) {
  const Compiled made(R"toml(
q = { type = "squarer", in = "x" }
c = { type = "multiplier", in = ["q", "x"] }
level = { type = "constant", value = 0.04 }
x = { type = "integrator", in = ["c", "-1.5*q", "0.6*x", "-level"], limit = 1.2 }
)toml");
  network::Workspace workspace(made.program);
  const std::string file = "d.toml";
  SourceWatch watch(made.program, workspace, SourceWatch::Shown::nothing, file);
  const Excursion solution;
  EXPECT_GT(watch.sample_times(0, 1, solution, true).size(), 4U);
  EXPECT_EQ(watch.sample_times(0, 1, solution, false).size(), 1U);
  EXPECT_FALSE(watch.acts_anew());
  for (const network::Source& source : made.program.sources()) {
    for (const network::Mask& mask : source.masks) workspace.set_discrete_state(mask.discrete_state, 1);
  }
  EXPECT_TRUE(watch.acts_anew());
  EXPECT_GT(watch.sample_times(0, 1, solution, false).size(), 4U);
}

/// x goes from 0 to 0.9 in a second, straight on.
class Way final : public Interpolant {
 public:
  void states_at(double t, std::span<double> states) const override { states[0] = 0.9 * t; }
  void rates_at(double, std::span<double> rates) const override { rates[0] = 0.9; }
};

// x² is zero at the beginning, and its bounds say that it goes no further the other way.
TEST(BentComparisons, ThatBeginAtZeroAreNotLookedAtForThat) {
  const Compiled made(R"toml(
q = { type = "squarer", in = "x" }
c = { type = "comparator", in = "q" }
x = { type = "integrator", in = "q" }
)toml");
  const network::Workspace workspace(made.program);
  const std::string file = "d.toml";
  SourceWatch watch(made.program, workspace, SourceWatch::Shown::nothing, file);
  ASSERT_TRUE(watch.active());
  EXPECT_EQ(watch.sample_times(0, 1, Way(), false).size(), 1U);
}

}  // namespace
}  // namespace oblique::solve
