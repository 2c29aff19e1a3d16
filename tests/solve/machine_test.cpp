// SPDX-License-Identifier: MIT
// What the figures of real machines do to small circuits whose errors have a closed form (Dow 1957).
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::run_of;

constexpr double kU = 0.4;

/// The last values of a diagram's outputs on a machine.
std::vector<double> end_on(const std::string& machine, const std::string& blocks, double until = 1) {
  const Compiled made("u = { type = \"constant\", value = 0.4 }\n" + blocks,
                      "[machine]\nprofile = \"" + machine + "\"\n");
  const Trajectory trajectory = run_of(made, {.until = until, .tolerance = 1e-10}).trajectory;
  std::vector<double> values;
  for (std::size_t c = 0; c < trajectory.columns().size(); ++c)
    values.push_back(trajectory.at(trajectory.rows() - 1, c));
  return values;
}

TEST(Machine, Ec1LacksGain) {
  constexpr double kGain = 1000;
  const std::vector<double> end =
      end_on("ec-1",
             "inverted = { type = \"inverter\", in = \"u\" }\n"
             "summed = { type = \"summer\", in = [\"u\", \"0.5*u\"] }\n"
             "own = { type = \"summer\", in = \"u\", gain = 50 }\n"
             "held = { type = \"servo-amplifier\", in = [\"held\", \"-u\"] }\n"
             "[outputs]\na = \"inverted\"\nb = \"summed\"\nc = \"own\"\nd = \"held\"\n");
  // An amplifier of gain A with the noise gain N gives 1/(1 + N/A) of the ideal output.
  EXPECT_NEAR(end[1], -kU / (1 + 2 / kGain), 1e-12);
  EXPECT_NEAR(end[2], -1.5 * kU / (1 + 2.5 / kGain), 1e-12);
  EXPECT_NEAR(end[3], -kU / (1 + 2.0 / 50), 1e-12);
  EXPECT_NEAR(end[4], kU * kGain / (1 + kGain), 1e-9);  // brought to rest by Newton's method
}

// −u is integrated as out' = −(A u + out)/(A + 1).
TEST(Machine, Ec1IntegratesWithALeak) {
  constexpr double kGain = 1000;
  const std::vector<double> end =
      end_on("ec-1", "s = { type = \"integrator\", in = \"u\" }\n[outputs]\ns = \"s\"\n", 2);
  EXPECT_NEAR(end[1], -kGain * kU * -std::expm1(-2 / (kGain + 1)), 1e-9);  // 1e-10 a step, few steps
}

TEST(Machine, Tr10DriftsAndRounds) {
  const std::vector<double> end = end_on(
      "tr-10",
      "s = { type = \"integrator\", in = \"0*u\" }\np = { type = \"potentiometer\", in = \"u\", setting = "
      "0.12345 "
      "}\n"
      "m = { type = \"multiplier\", in = [\"u\", \"u\"] }\n[outputs]\ns = \"s\"\np = \"p\"\nm = \"m\"\n",
      3);
  EXPECT_NEAR(end[1], 3 * 50e-6 / 10, 1e-11);               // 50 µV/s for 3 s, of 10 V; to a millionth of it
  EXPECT_NEAR(end[2], 494.0 / 4000 * kU, 1e-15);            // 493.8 turns
  const double wave = std::sin(std::numbers::pi * 7 * kU);  // of two squarers with 7 segments
  EXPECT_NEAR(end[3], kU * kU + 0.08 / 10 * wave * wave, 1e-15);
}

// An inverter of gain-bandwidth product f is a lag of corner f/2; at rest its offset of 20 µV is doubled.
TEST(Machine, Tr10OffsetIsAmplifiedByTheNoiseGain) {
  const std::vector<double> end =
      end_on("tr-10", "i = { type = \"inverter\", in = \"u\" }\n[outputs]\ni = \"i\"\n");
  EXPECT_NEAR(end[1], -kU + 2 * 20e-6 / 10, 1e-10);
}

// x″ = −x/r³ from (0.99, 0) with (0, 1), scaled: a circle. The quotients x/r³ pass zero, where their relative
// tolerance does too: what Newton's iteration leaves of them there is more than it, at every step however
// short. A hundred times the tolerance for each of the six turns.
TEST(Machine, FollowsServoLoopsThroughZero) {
  const Compiled made(R"toml(reference = { type = "constant", value = 1 }
minus_reference = { type = "constant", value = -1 }
xx = { type = "multiplier", in = ["minus_x", "minus_x"] }
yy = { type = "multiplier", in = ["minus_y", "minus_y"] }
minus_rr = { type = "summer", in = ["1.010101010101*xx", "0.99*yy"] }
r_square = { type = "multiplier", in = ["r_root", "r_root"] }
r_root = { type = "servo-amplifier", in = ["r_square", "1.010101010101*minus_rr"], gain = 1e6, bandwidth = 10, initial = 1 }
minus_r_root = { type = "inverter", in = "r_root" }
r3 = { type = "multiplier", in = ["minus_r_root", "minus_rr"] }
ax_product = { type = "multiplier", in = ["r3", "ax"] }
ax = { type = "servo-amplifier", in = ["1.010101010101*ax_product", "1.010101010101*minus_x"], gain = 1e6, bandwidth = 10 }
ay_product = { type = "multiplier", in = ["r3", "ay"] }
ay = { type = "servo-amplifier", in = ["1.010101010101*ay_product", "minus_y"], gain = 1e6, bandwidth = 10 }
u = { type = "integrator", in = "ax" }
v = { type = "integrator", in = "ay", start = "reference" }
pot_1 = { type = "potentiometer", in = "minus_reference", setting = 0.99 }
minus_x = { type = "integrator", in = "0.99*u", start = "pot_1" }
minus_y = { type = "integrator", in = "v" }
)toml",
                      "[machine]\nprofile = \"gp-6\"\ninverting = true\n[outputs]\nx = { signal = "
                      "\"minus_x\", scale = -1.0101010101010102 }\n");
  const Trajectory trajectory = run_of(made, {.until = 40}).trajectory;
  // The amplifiers' gain makes the pull weaker by some millionths, and the angle by as much times the time.
  EXPECT_NEAR(trajectory.at(trajectory.rows() - 1, 1), std::cos(40.0), 1e-4);
}

// A triangle generator, whose amplifier is to run to the limit that the diagram gives it, beside an
// integrator that has that of the machine: x goes at 0.6 a second from 0.1 to −0.6, and to 0.6 in 2 s.
TEST(Machine, LetsAnAmplifierBeginAtALimitOfTheDiagram) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["-0.5*s"], initial = 0.1 }
s = { type = "servo-amplifier", in = ["x", "-0.5*s"], initial = -1, limit = 1.2 }
)toml",
                      "[machine]\nprofile = \"tr-10\"\n");
  std::vector<double> turns;
  for (const EventRecord& event : run_of(made, {.until = 6}).events) {
    if (event.what.starts_with("s: leaves ")) turns.push_back(event.time);
  }
  ASSERT_EQ(turns.size(), 3U);
  for (std::size_t k = 0; k < turns.size(); ++k)
    EXPECT_NEAR(turns[k], 0.7 / 0.6 + 2 * static_cast<double>(k), 1e-4);  // offset, drift and gain of a TR-10
}

TEST(Machine, TellsOfAnAmplifierThatRunsToItsLimitAndHowToMeanIt) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "0.8*sin(time)" }
s = { type = "servo-amplifier", in = ["-u", "-0.5*s"], initial = -1 }
)toml",
                      "[machine]\nprofile = \"tr-10\"\n");
  try {
    run_of(made);
    FAIL();
  } catch (const SolveError& error) {
    const text::Diagnostic& told = error.diagnostics().front();
    EXPECT_TRUE(told.what.starts_with(
        "the servo loops do not come to rest before the clock starts; still moving: 's'"))
        << told.what;
    EXPECT_TRUE(told.remedy.words().ends_with(
        "If 's' is to run to its limit, as a Schmitt trigger does, give it that in the diagram: limit = 1.2"))
        << told.remedy;
  }
}

}  // namespace
}  // namespace oblique::solve
