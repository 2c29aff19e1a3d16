// SPDX-License-Identifier: MIT
// Loops of ideal amplifiers that are singular when the run starts.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::failure_of;
using testing::row_values;
using testing::run_of;

/// Bessel's equation of order 0, x y″ + y′ + x y = 0, from x = 0, where y″ = −1/2.
constexpr double kJ0 = -0.24593576445134832, kJ1 = 0.04347274616886144;  // of 10; Abramowitz and Stegun, 9.4

void expect_bessel(const std::string& blocks, const std::string& second) {
  const auto result = run_of(Compiled(blocks), {.until = 10});
  EXPECT_NEAR(row_values(result, "y").back(), kJ0, 1e-6);  // a hundred tolerances
  EXPECT_NEAR(row_values(result, "v").back(), -kJ1, 1e-6);
  if (!second.empty()) {
    EXPECT_NEAR(row_values(result, second).front(), -0.5, 1e-9);  // the limit of two moments
  }
  EXPECT_TRUE(result.warnings.empty());
}

TEST(SingularStart, OfBesselsEquationSolvedForItsSecondDerivative) {
  for (const char* const x : {"one = { type = \"constant\" }\nx = { type = \"integrator\", in = \"one\" }\n",
                              "x = { type = \"ramp\" }\n"}) {
    expect_bessel(std::string(x) + R"toml(xa = { type = "multiplier", in = ["x", "a"] }
xy = { type = "multiplier", in = ["x", "y"] }
a = { type = "servo-amplifier", in = ["xa", "v", "xy"], gain = inf, bandwidth = inf }
v = { type = "integrator", in = "a" }
y = { type = "integrator", in = "v", initial = 1 }
)toml",
                  "a");
  }
}

TEST(SingularStart, OfBesselsEquationWithADivider) {
  expect_bessel(R"toml(x = { type = "ramp" }
q = { type = "divider", numerator = "v", denominator = "x", gain = inf, bandwidth = inf }
a = { type = "summer", in = ["-q", "-y"] }
v = { type = "integrator", in = "a" }
y = { type = "integrator", in = "v", initial = 1 }
)toml",
                "a");
}

TEST(SingularStart, OfBesselsEquationAsAMomentum) {
  expect_bessel(R"toml(one = { type = "constant" }
x = { type = "integrator", in = "one" }
xv = { type = "multiplier", in = ["x", "v"] }
v = { type = "servo-amplifier", in = ["xv", "-p"], gain = inf, bandwidth = inf }
xy = { type = "multiplier", in = ["x", "y"] }
p = { type = "integrator", in = ["-xy"] }
y = { type = "integrator", in = "v", initial = 1 }
)toml",
                "");
}

// At x = 1e-9 nothing is singular, but the decay 1/x becomes slower by powers of ten from step to step, and
// an old Jacobian would hide it.
TEST(SingularStart, NextToTheSingularityIsAsGood) {
  for (const double x : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const Compiled made(fmt::format(R"toml(one = {{ type = "constant" }}
x = {{ type = "integrator", in = "one", initial = {} }}
xa = {{ type = "multiplier", in = ["x", "a"] }}
xy = {{ type = "multiplier", in = ["x", "y"] }}
a = {{ type = "servo-amplifier", in = ["xa", "v", "xy"], gain = inf, bandwidth = inf }}
v = {{ type = "integrator", in = "a", initial = {} }}
y = {{ type = "integrator", in = "v", initial = {} }}
)toml",
                                    x, -x / 2 + x * x * x / 16, 1 - x * x / 4));
    // two terms of J0 and J1 leave x⁴/64; a hundred tolerances
    EXPECT_NEAR(row_values(run_of(made, {.until = 10 - x}), "y").back(), kJ0, 1e-6) << x;
  }
}

// θ″ + 2 θ′/ξ + θⁿ = 0 of Lane and Emden, θ″(0) = −1/3: sin ξ/ξ for n = 1, 1/√(1 + ξ²/3) for n = 5.
TEST(SingularStart, OfAStarOfLaneAndEmden) {
  const auto star = [](const std::string& power, const std::string& blocks) {
    return run_of(Compiled(R"toml(x = { type = "ramp" }
xa = { type = "multiplier", in = ["x", "a"] }
xt = { type = "multiplier", in = ["x", ")toml" +
                           power + R"toml("] }
a = { type = "servo-amplifier", in = ["xa", "2*v", "xt"], gain = inf, bandwidth = inf }
v = { type = "integrator", in = "a" }
w = { type = "integrator", in = "v", initial = 1 }
)toml" + blocks),
                  {.until = 3});
  };
  const auto first = star("w", "");
  EXPECT_NEAR(row_values(first, "w").back(), std::sin(3.0) / 3, 1e-6);  // a hundred tolerances
  EXPECT_NEAR(row_values(first, "a").front(), -1.0 / 3, 1e-9);
  const auto fifth = star("t5", R"toml(t2 = { type = "squarer", in = "w" }
t4 = { type = "squarer", in = "t2" }
t5 = { type = "multiplier", in = ["t4", "w"] }
)toml");
  EXPECT_NEAR(row_values(fifth, "w").back(), 0.5, 1e-6);
}

// x + s y = 1, s x + y = 1 from s = 1, where only x + y is determined: x = y = 1/2 by continuity.
TEST(SingularStart, OfAPairThatHasNoRankThere) {
  const auto result = run_of(Compiled(R"toml(one = { type = "constant" }
s = { type = "integrator", in = "one", initial = 1 }
sx = { type = "multiplier", in = ["s", "x"] }
sy = { type = "multiplier", in = ["s", "y"] }
x = { type = "servo-amplifier", in = ["x", "sy", "-one"], gain = inf, bandwidth = inf }
y = { type = "servo-amplifier", in = ["sx", "y", "-one"], gain = inf, bandwidth = inf }
z = { type = "integrator", in = "x" }
)toml"));
  EXPECT_NEAR(row_values(result, "x").front(), 0.5, 1e-9);
  EXPECT_NEAR(row_values(result, "z").back(), std::log(1.5), 1e-6);  // a hundred tolerances
}

TEST(SingularStart, WithoutALimitIsRefused) {
  // x q = 1 at x = 0: a pole
  const auto failure = failure_of(Compiled(R"toml(one = { type = "constant" }
x = { type = "ramp" }
q = { type = "divider", numerator = "one", denominator = "x", gain = inf, bandwidth = inf }
)toml"));
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, SolveError::Kind::singular_loop);
  EXPECT_EQ(failure->time, 0);
}

}  // namespace
}  // namespace oblique::solve
