// SPDX-License-Identifier: MIT
// Which runs are said to leave the machine, and which are large by design.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;

std::vector<text::Diagnostic> warnings_of(const std::string& blocks, double until, bool watched = false) {
  const Compiled made(blocks);
  RunOptions options;
  options.until = until;
  options.watch_overloads = watched;
  return run(made.program, made.flat, options).warnings;
}

// x = e^(2t) passes 100 at t = ln(100)/2 = 2.3026, seen at rows of 0.005 s.
TEST(Runaway, AnExponentialSaysWhichSignalWhenAndHowFar) {
  const auto warnings = warnings_of("x = { type = \"integrator\", in = [\"2*x\"], initial = 1 }\n", 5);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(
      warnings[0].what,
      HasSubstr("the signal 'x' leaves the machine: it passes 100 machine units at t = 2.305 s and comes "
                "to 2.2e+04 at t = 5 s, still growing"));
  EXPECT_THAT(warnings[0].remedy.words(), HasSubstr("'check'"));
}

TEST(Runaway, AnOscillationThatGrowsIsSaidToo) {
  const auto warnings = warnings_of(R"toml(x = { type = "integrator", in = ["0.5*x", "9*v"], initial = 0.01 }
v = { type = "integrator", in = ["-9*x", "0.5*v"] }
)toml",
                                    30);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0].what, HasSubstr("2 signals do so in all"));
}

// An angle, a height in metres (t² and t³), a population that fills its place, a step to 230 V.
TEST(Runaway, LargeNumbersOfAProblemInItsOwnUnitsAreNot) {
  EXPECT_TRUE(warnings_of(R"toml(one = { type = "constant" }
angle = { type = "integrator", in = ["500*one"] }
speed = { type = "integrator", in = ["9.81*one"] }
height = { type = "integrator", in = ["speed"], rate = 10 }
cubic = { type = "integrator", in = ["height"], rate = 10 }
volt = { type = "step", from = 0, to = 230, at = 12 }
)toml",
                          20)
                  .empty());
  EXPECT_TRUE(warnings_of(R"toml(pp = { type = "squarer", in = "p" }
p = { type = "integrator", in = ["p", "-0.001*pp"], initial = 1 }
)toml",
                          20)
                  .empty());
}

// On a machine the unit binds.
TEST(Runaway, OnAMachineAnySignalThatFarOutsideIsSaid) {
  const std::string blocks = "c = { type = \"constant\", value = 120 }\n";
  EXPECT_TRUE(warnings_of(blocks, 1).empty());
  const auto warnings = warnings_of(blocks, 1, true);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0].what, HasSubstr("'c' leaves the machine: it passes 100 machine units at t = 0 s"));
  EXPECT_TRUE(warnings_of("c = { type = \"constant\", value = 99 }\n", 1, true).empty());
}

}  // namespace
}  // namespace oblique::solve
