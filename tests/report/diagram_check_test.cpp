// SPDX-License-Identifier: MIT
#include <oblique/report/diagram_check.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/report/diagram_check_text.h>

#include "../support/compiled.h"

namespace oblique::report {
namespace {

using testing::Compiled;
using ::testing::ContainsRegex;

DiagramCheck checked(const Compiled& made) {
  return examine(made.diagram, made.flat, made.program, {});
}

// x = 0.4 cos 30t, y = 0.4 sin 30t: scaled by 2, the next step of 1-2-5, they are 0.8, and their integrators
// are fed with 2 · 0.4 · 30 = 24 machine units, which 50 times slower are less than 1, and 20 times slower
// are not. z = 0.05 t stays far behind: scaled by 10 it is fed with 0.5.
TEST(DiagramCheck, SlowsDownUntilTheFastestIntegratorIsFedWithOneUnit) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["-30*y"], initial = 0.4 }
y = { type = "integrator", in = ["30*x"] }
one = { type = "constant" }
z = { type = "integrator", in = ["0.05*one"] }
)toml",
                      "[run]\nuntil = 2\n");
  const DiagramCheck check = checked(made);
  ASSERT_TRUE(check.scaling);
  EXPECT_EQ(check.scaling->signals.at(made.signal("x")), 2);
  EXPECT_EQ(check.scaling->signals.at(made.signal("z")), 10);
  EXPECT_EQ(check.scaling->time_scale, 50);
}

// The argument of an exponential cannot be scaled, nor what it gives: e^0.9 stays beyond the machine unit.
TEST(DiagramCheck, CountsTheOverloadsThatScalingLeaves) {
  const auto overloads = [](const Compiled& made) {
    return scaled_by(checked(made), testing::shipped_blocks()).overloads;
  };
  EXPECT_EQ(overloads(Compiled(R"toml(one = { type = "constant" }
x = { type = "integrator", in = ["0.9*one"] }
e = { type = "exponential", in = "x" }
)toml")),
            1U);
  EXPECT_EQ(overloads(Compiled("x = { type = \"integrator\", in = [\"-x\"], initial = 3 }\n")), 0U);
}

// A loop of gain ½ never passes 1: it has no crossover, and any phase to lose.
TEST(DiagramCheck, TellsOfAnAmplifierWithoutACrossover) {
  const Compiled made(R"toml(u = { type = "constant", value = 0.1 }
a = { type = "servo-amplifier", in = ["a", "-u"], gain = 0.5, bandwidth = 10 }
)toml");
  EXPECT_THAT(to_text(checked(made)), ContainsRegex("\na +∞ +– +–\n"));
}

// x″ = −x on a TR-10, whose amplifiers of f = 200 kHz are late by ω/2πf, the inverter by twice that: the
// circle grows by half of the four together each radian, by 2/f a turn.
TEST(DiagramCheck, TellsByHowMuchAnOscillationGrowsByTheMachine) {
  const Compiled made(R"toml(x = { type = "integrator", in = "m", initial = 0.9 }
m = { type = "inverter", in = "u" }
u = { type = "integrator", in = "x" }
)toml",
                      "[machine]\nprofile = \"tr-10\"\ninverting = true\n[run]\nuntil = 60\n");
  EXPECT_THAT(to_text(checked(made)),
              ContainsRegex("grows, a little, by the errors of the amplifiers: \\+1.59e-06 ± 1i 1/s, by "
                            "0.001 % a turn\n"));
}

}  // namespace
}  // namespace oblique::report
