// SPDX-License-Identifier: MIT
// Static tests of diagrams small enough to be worked out by hand.
#include <gtest/gtest.h>

#include <oblique/solve/solve_error.h>
#include <oblique/solve/static_test.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

const StaticReading& reading(const std::vector<StaticReading>& readings, std::string_view signal) {
  for (const StaticReading& r : readings) {
    if (r.signal == signal) return r;
  }
  throw std::out_of_range(std::string(signal));
}

// x″ = −0.5 x′ − 4 x + 1 with x(0) = 0.2, x′(0) = −0.3.
TEST(StaticTest, GivesOutputsAndInputsOfIntegrators) {
  const Compiled made(R"toml(one = { type = "constant", value = 1 }
x   = { type = "integrator", in = ["v"], initial = 0.2 }
v   = { type = "integrator", in = ["-0.5*v", "-4*x", "one"], initial = -0.3 }
xv  = { type = "multiplier", in = ["x", "v"] }
)toml");
  const auto readings = static_test(made.program, "d.toml");
  ASSERT_EQ(readings.size(), 4U);
  EXPECT_EQ(reading(readings, "x").output, 0.2);
  EXPECT_EQ(reading(readings, "x").derivative, -0.3);
  EXPECT_DOUBLE_EQ(reading(readings, "v").derivative.value(), 0.15 - 0.8 + 1);
  EXPECT_DOUBLE_EQ(reading(readings, "xv").output, -0.06);
  EXPECT_FALSE(reading(readings, "xv").derivative);
  EXPECT_FALSE(reading(readings, "x").at_rest);
}

// In initial condition a capacitor is charged, however long that takes, in groups too that do not start
// there.
TEST(StaticTest, ChargesEveryCapacitor) {
  const Compiled made(
      R"toml(one = { type = "constant" }
up = { type = "comparator", in = ["x", "-one"] }
x = { type = "integrator", in = ["-2*x"], initial = 0.5 }
y = { type = "integrator", in = ["3*one"], start = "x", initial = 0.25, charging = 0.01 }
z = { type = "integrator", in = [], start = "-x", charging = 0.01 }
)toml",
      "[timeline]\nphases = [{ mode = \"initial\", for = 0.2 }, { mode = \"operate\", for = 0.8 }]\n"
      "[groups]\ng = { blocks = [\"z\"], initial = \"up\" }\n");
  const auto readings = static_test(made.program, "d.toml");
  EXPECT_EQ(reading(readings, "y").output, 0.75);
  EXPECT_EQ(reading(readings, "y").derivative, 3);
  EXPECT_EQ(reading(readings, "z").output, -0.5);
  EXPECT_EQ(reading(readings, "x").derivative, -1);
}

TEST(StaticTest, InvertsWhereTheMachineDoes) {
  const Compiled made("one = { type = \"constant\" }\nx = { type = \"integrator\", in = [\"3*one\"] }\n",
                      "[machine]\ninverting = true\n");
  EXPECT_EQ(reading(static_test(made.program, "d.toml"), "x").derivative, -3);
}

// c² = 0.25 solved by an amplifier of gain 1000: c² + c/1000 = 0.25.
TEST(StaticTest, BringsServoLoopsToRest) {
  const Compiled made(R"toml(u  = { type = "constant", value = 0.25 }
cc = { type = "multiplier", in = ["c", "c"] }
c  = { type = "servo-amplifier", in = ["cc", "-u"], gain = 1000, initial = 1 }
i  = { type = "integrator", in = ["c"] }
)toml");
  const auto readings = static_test(made.program, "d.toml");
  const double c = (-1e-3 + std::sqrt(1e-6 + 1)) / 2;
  EXPECT_NEAR(reading(readings, "c").output, c, 1e-14);  // rounding of Newton's method
  EXPECT_TRUE(reading(readings, "c").at_rest);
  // 2π·10 Hz times the rounding of the residual times the gain.
  EXPECT_NEAR(reading(readings, "c").derivative.value(), 0, 1e-10);
  EXPECT_NEAR(reading(readings, "i").derivative.value(), c, 1e-14);
}

TEST(StaticTest, SaysWhichLoopDoesNotSettle) {
  const Compiled made(R"toml(one = { type = "constant" }
cc = { type = "multiplier", in = ["c", "c"] }
c  = { type = "servo-amplifier", in = ["cc", "one"] }
)toml");
  EXPECT_THROW(static_test(made.program, "d.toml"), SolveError);
}

}  // namespace
}  // namespace oblique::solve
