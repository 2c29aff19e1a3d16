// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/ideal_amplifiers.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/report/atlas/equations.h>

#include "../../support/compiled.h"

namespace oblique::report {
namespace {

using testing::Compiled;
using ::testing::ElementsAre;

std::vector<std::string> ideal_equations(const std::string& blocks, const std::string& outputs) {
  std::vector<std::string> lines;
  for (const RecoveredEquation& equation :
       recovered_equations(with_ideal_amplifiers(Compiled(blocks, outputs).flat)))
    lines.push_back(equation.left + " = " + equation.right);
  return lines;
}

// y = √a by an amplifier that is neither fast nor exact, and x by one with a capacitor: dx/dt = −(x − y)/T.
TEST(IdealAmplifiers, SolveWhatTheyAreThereFor) {
  EXPECT_THAT(ideal_equations(R"toml(a = { type = "constant", value = 0.25 }
yy = { type = "multiplier", in = ["y", "y"] }
y = { type = "servo-amplifier", in = ["yy", "-a"], gain = 1000, bandwidth = "1 kHz", limit = 1 }
x = { type = "servo-amplifier", in = ["x", "-y"], gain = 1000, capacitor = "0.5 s", limit = 1 }
)toml",
                              "[outputs]\ny = \"y\"\nx = \"x\"\n"),
              ElementsAre("der(x) = 2*y - 2*x", "0 = y^2 - 0.25"));
}

// Each of two equations holds the other's unknown alone.
TEST(IdealAmplifiers, SolveTogether) {
  EXPECT_THAT(ideal_equations(R"toml(one = { type = "constant" }
x = { type = "servo-amplifier", in = ["2*y", "-one"], gain = 100, bandwidth = inf }
y = { type = "servo-amplifier", in = ["4*x", "-one"], gain = 100, bandwidth = inf }
)toml",
                              "[outputs]\nx = \"x\"\ny = \"y\"\n"),
              ElementsAre("0 = 2*y - 1", "0 = 4*x - 1"));
}

TEST(IdealAmplifiers, KeepTheirGainWhereNothingComesBack) {
  EXPECT_THAT(ideal_equations(R"toml(one = { type = "constant" }
x = { type = "servo-amplifier", in = "0.1*one", gain = 10, bandwidth = inf, limit = 0.5 }
y = { type = "servo-amplifier", in = ["y", "0.1*one"], gain = 10, bandwidth = inf, limit = 0.5 }
)toml",
                              "[outputs]\nx = \"x\"\ny = \"y\"\n"),
              ElementsAre("0 = 0.1*x + 0.1", "0 = y + 0.1"));
}

// As drawn by a machine: its summers saturate.
TEST(IdealAmplifiers, HaveNoLimits) {
  EXPECT_THAT(ideal_equations("x = { type = \"integrator\", in = \"x\", initial = 0.1, limit = 1 }\n",
                              "[outputs]\nx = \"x\"\n"),
              ElementsAre("der(x) = x"));
}

}  // namespace
}  // namespace oblique::report
