// SPDX-License-Identifier: MIT
// Imperfections of summer, inverter, multiplier and potentiometer, and that there are none by default.
#include <cmath>
#include <numbers>
#include <ostream>

#include <fmt/format.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::kIntegrated;
using testing::kRounding;
using testing::last;
using testing::row_values;
using testing::run_of;
using testing::shipped_blocks_and;

// --- without imperfections a block is its one equation

struct Ideal {
  std::string type;
  std::string inputs;
  std::string text;  ///< of the bare block
  friend std::ostream& operator<<(std::ostream& out, const Ideal& ideal) { return out << ideal.type; }
};

const std::vector<Ideal> kIdeals{
    {"summer", "in = [\"x\", \"-2*y\"]",
     "in = { sum = true }\n[outputs]\nout = {}\n[equations]\nout = \"polarity*in\"\n"},
    {"inverter", "in = \"x\"", "in = {}\n[outputs]\nout = {}\n[equations]\nout = \"-in\"\n"},
    {"multiplier", "in = [\"x\", \"y\"]",
     "x = {}\ny = {}\n[outputs]\nout = {}\n[equations]\nout = \"x*y\"\n"},
    {"potentiometer", "in = \"x\", setting = 0.3",
     "in = {}\n[outputs]\nout = {}\n[parameters]\nsetting = {}\n[equations]\nout = \"setting*in\"\n"},
    {"integrator", "in = [\"x\", \"-2*y\"], rate = 3, initial = 0.5",
     "in = { sum = true }\n[outputs]\nout = {}\n[parameters]\nrate = {}\ninitial = "
     "{}\n[equations]\n\"der(out)\" = "
     "\"polarity*rate*in\"\n"},
    {"servo-amplifier", "in = [\"b\", \"-x\"], gain = 1e4",
     "in = { sum = true }\n[outputs]\nout = {}\n[parameters]\ngain = {}\nbandwidth = { default = 10, unit = "
     "\"Hz\" "
     "}\n[equations]\n\"der(out)\" = \"2*pi*bandwidth*(-out - gain*in)\"\n[start]\nout = { guess = 0, "
     "at_rest = true "
     "}\n"},
};

class IdealTest : public ::testing::TestWithParam<std::tuple<Ideal, bool>> {};
INSTANTIATE_TEST_SUITE_P(Blocks, IdealTest,
                         ::testing::Combine(::testing::ValuesIn(kIdeals), ::testing::Bool()));

TEST_P(IdealTest, CompilesToItsBareEquation) {
  const auto& [ideal, inverting] = GetParam();
  const diagram::BlockLibrary library = shipped_blocks_and("bare", "[inputs]\n" + ideal.text);
  const auto made = [&](const std::string& type) {
    return Compiled("b = { type = \"" + type + "\", " + ideal.inputs + " }\n" +
                        "x = { type = \"integrator\", in = [\"y\", \"0.1*b\"], initial = 1 }\n"
                        "y = { type = \"integrator\", in = [\"-x\"] }\n",
                    inverting ? "[machine]\ninverting = true\n" : "", library);
  };
  const Compiled shipped = made(ideal.type), bare = made("bare");
  EXPECT_EQ(shipped.program.n_instructions(), bare.program.n_instructions());
  EXPECT_EQ(shipped.program.n_states(), bare.program.n_states());
  EXPECT_TRUE(shipped.program.discrete_states().empty());
  EXPECT_TRUE(shipped.program.events().empty());
  EXPECT_EQ(row_values(run_of(shipped, {.samples = 21}), "b"),
            row_values(run_of(bare, {.samples = 21}), "b"));
}

// --- summer and inverter: N = 1 + Σ|weights|

TEST(RealSummer, HasTheStaticErrorsOfItsAmplifier) {
  // N = 1 + 3 + 0.5; out (1 + N/A) = 1.02 (3 a − 0.5 b) + N (offset + drift t).
  const Compiled made(R"(a = { type = "constant", value = 0.2 }
b = { type = "ramp", slope = 0.1 }
s = { type = "summer", in = ["3*a", "-0.5*b"], gain = 100, offset = 0.001, drift = 0.002, tolerance = 0.02 })");
  expect_form(run_of(made, {.samples = 11}), "s", kRounding,
              [](double t) { return (1.02 * (0.6 - 0.05 * t) + 4.5 * (0.001 + 0.002 * t)) / 1.045; });
}

TEST(RealSummer, AnswersAStepWithTheBandwidthOverItsNoiseGain) {
  // N = 4: der(out) = ω_t/4 (… − (1 + 4/A) out), at rest before the step.
  const Compiled made(R"(a = { type = "step", at = 0.1, from = 0.1, to = 0.3 }
s = { type = "summer", in = ["-3*a"], bandwidth = 8, gain = 50, offset = 0.01 })");
  const double rate = 2 * std::numbers::pi * 8 / 4 * 1.08;
  expect_form(run_of(made, {.samples = 102}), "s", kIntegrated, [&](double t) {
    const double before = (-0.3 + 0.04) / 1.08, after = (-0.9 + 0.04) / 1.08;
    return t < 0.1 ? before : after + (before - after) * std::exp(-rate * (t - 0.1));
  });
}

TEST(RealSummer, AddsItsNoise) {
  const Compiled made(R"(a = { type = "constant", value = 0.2 }
n = { type = "noise-source", rms = 0.01, bandwidth = 5, seed = 3 }
s = { type = "summer", in = ["a"], noise = 0.01, noise_bandwidth = 5, seed = 3 }
d = { type = "summer", in = ["s", "-a", "-2*n"] })");
  expect_form(run_of(made, {.samples = 51}), "d", kRounding, [](double) { return 0; });
}

TEST(RealInverter, IsASummerOfOneInput) {
  const std::string real =
      "gain = 200, offset = 0.003, drift = 0.01, tolerance = -0.01, noise = 0.004, seed = 9";
  const Compiled made("x = { type = \"ramp\" }\n" + std::string("a = { type = \"inverter\", in = \"x\", ") +
                      real + " }\nb = { type = \"summer\", in = [\"-x\"], " + real + " }\n" +
                      "c = { type = \"inverter\", in = \"x\", bandwidth = 4, " + real +
                      " }\nd = { type = \"summer\", in = [\"-x\"], bandwidth = 4, " + real + " }\n");
  const auto result = run_of(made, {.samples = 21});
  const auto a = row_values(result, "a"), b = row_values(result, "b"), c = row_values(result, "c"),
             d = row_values(result, "d");
  for (std::size_t r = 0; r < a.size(); ++r) {
    EXPECT_NEAR(a[r], b[r], kRounding);
    EXPECT_NEAR(c[r], d[r], kRounding);
  }
}

// --- multiplier: the product of two squarers with a wave for each segment

TEST(RealMultiplier, ErrsAsItsTwoSquarers) {
  const auto square = [](double u) { return u * u - 0.004 / 2 * std::cos(2 * std::numbers::pi * 7 * u); };
  for (const double x : {-1.0, -0.37, 0.0, 0.21, 0.93}) {
    for (const double y : {-0.8, 0.0, 0.45, 1.0}) {
      const Compiled made(fmt::format(R"(x = {{ type = "constant", value = {} }}
y = {{ type = "constant", value = {} }}
m = {{ type = "multiplier", in = ["x", "y"], error = 0.004, offset = 0.002 }})",
                                      x, y));
      const double out = last(run_of(made, {.samples = 2}), "m");
      EXPECT_NEAR(out, square((x + y) / 2) - square((x - y) / 2) + 0.002, kRounding) << x << ' ' << y;
      EXPECT_LE(std::abs(out - 0.002 - x * y), 0.004);
    }
  }
}

TEST(RealMultiplier, FollowsWithItsBandwidth) {
  const Compiled made(R"(x = { type = "step", at = 0.1, from = 0.5, to = 1 }
m = { type = "multiplier", in = ["x", "x"], bandwidth = 5 })");
  expect_form(run_of(made, {.samples = 102}), "m", kIntegrated, [](double t) {
    return t < 0.1 ? 0.25 : 1 - 0.75 * std::exp(-2 * std::numbers::pi * 5 * (t - 0.1));
  });
}

// --- potentiometer

TEST(RealPotentiometer, HasTurnsToleranceAndLoad) {
  const Compiled made(R"(x = { type = "constant", value = 2 }
wound  = { type = "potentiometer", in = "x", setting = 0.3333, turns = 1000 }
false_ = { type = "potentiometer", in = "x", setting = 0.25, tolerance = 0.01 }
loaded = { type = "potentiometer", in = "x", setting = 0.5, load = 0.05 }
shunt  = { type = "potentiometer", in = "x", setting = 1, load = 0.05 })");
  const auto result = run_of(made, {.samples = 2});
  EXPECT_NEAR(last(result, "wound"), 0.666, kRounding);
  EXPECT_NEAR(last(result, "false_"), 0.505, kRounding);
  // By Ohm's law: a source of 1 V behind R/4 into R_in.
  EXPECT_NEAR(last(result, "loaded"), 1 / (1 + 0.25 * 0.05), kRounding);
  EXPECT_EQ(last(result, "shunt"), 2);
}

}  // namespace
}  // namespace oblique::test
