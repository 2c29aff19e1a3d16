// SPDX-License-Identifier: MIT
// diode, junction-diode, diode-segment, diode-amplifier, logarithmic-amplifier against their definitions, by
// themselves and in the feedback of open amplifiers.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <ostream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <oblique/diagram/diagram.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using ::testing::HasSubstr;
using testing::kIntegrated;
using testing::kRounding;
using testing::last;
using testing::row_values;
using testing::run_of;

constexpr const char* kRise = "u = { type = \"ramp\", initial = -2 }\n";  // from −2 to 2 in 4 s

/// A block "out" of the signal u, which rises from −2 to 2, in straight lines.
struct Characteristic {
  std::string name;
  std::string block;
  std::function<double(double u)> form;
  friend std::ostream& operator<<(std::ostream& out, const Characteristic& c) { return out << c.name; }
};

const std::vector<Characteristic> kCharacteristics{
    {"IdealDiode", R"(out = { type = "diode", in = "u" })", [](double u) { return u > 0 ? u : 0; }},
    {"DiodeWithItsDrop", R"(out = { type = "diode", in = "u", drop = 0.3, resistance = 0.5 })",
     [](double u) { return u > 0.3 ? 2 * (u - 0.3) : 0; }},
    {"ZenerDiode", R"(out = { type = "diode", in = "u", drop = 0.1, breakdown = 0.8, resistance = 0.25 })",
     [](double u) { return u > 0.1    ? 4 * (u - 0.1)
                           : u < -0.8 ? 4 * (u + 0.8)
                                      : 0; }},
    {"SegmentAbove", R"(out = { type = "diode-segment", in = "u", at = 0.5, slope = -3 })",
     [](double u) { return u > 0.5 ? -3 * (u - 0.5) : 0; }},
    {"SegmentBelow", R"(out = { type = "diode-segment", in = "u", at = -0.5, slope = 2, side = -1 })",
     [](double u) { return u < -0.5 ? 2 * (u + 0.5) : 0; }},
    {"BoundedSummer", R"(out = { type = "diode-amplifier", in = ["2*u"], low = -0.7, high = 1.2 })",
     [](double u) { return std::clamp(-2 * u, -0.7, 1.2); }},
    {"Rectifier", R"(out = { type = "diode-amplifier", in = ["u"], low = "-inf", high = 0 })",
     [](double u) { return u > 0 ? -u : 0; }},
    // Beyond the levels the diode is a second resistor of 0.5: two thirds of the current go through it.
    {"SoftBounds",
     R"(out = { type = "diode-amplifier", in = ["u"], low = -0.5, high = 1, resistance = 0.5 })",
     [](double u) {
       if (-u > 1) return 1 + (-u - 1) / 3;
       return -u < -0.5 ? -0.5 + (-u + 0.5) / 3 : -u;
     }},
    {"Comparator", R"(out = { type = "diode-amplifier", in = ["u"], feedback = 0, low = -0.6, high = 0.9 })",
     [](double u) { return u > 0 ? -0.6 : 0.9; }},
    {"ComparatorOfFiniteGain",
     R"(out = { type = "diode-amplifier", in = ["u"], feedback = 0, gain = 50, low = -0.6, high = 0.9 })",
     [](double u) { return std::clamp(-50 * u, -0.6, 0.9); }},
    {"AmplifierAtItsLimit", R"(out = { type = "diode-amplifier", in = ["u"], high = "inf", limit = 1.5 })",
     [](double u) { return std::clamp(-u, -1.0, 1.5); }},
};

class DiodeCharacteristic : public ::testing::TestWithParam<Characteristic> {};
INSTANTIATE_TEST_SUITE_P(Diodes, DiodeCharacteristic, ::testing::ValuesIn(kCharacteristics),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(DiodeCharacteristic, IsItsDefinition) {
  const Compiled made(kRise + GetParam().block);
  expect_form_where(
      run_of(made, {.until = 4, .samples = 402}), "out", kRounding,
      [&](double t) { return GetParam().form(t - 2); }, [](double t) { return t != 2; });
}

TEST(DiodeSegment, AddsUpToAFunctionGenerator) {
  const Compiled made(std::string(kRise) + R"(a = { type = "diode-segment", in = "u", at = 0.5, slope = 1.5 }
b = { type = "diode-segment", in = "u", at = -1, slope = -2, side = -1 }
sum = { type = "summer", in = ["0.25*u", "a", "b"] }
f = { type = "function-generator", in = "u", points = [[-2, 1.5], [-1, -0.25], [0.5, 0.125], [2, 2.75]] })");
  const auto result = run_of(made, {.until = 4, .samples = 402});
  const auto sum = row_values(result, "sum"), f = row_values(result, "f");
  for (std::size_t r = 0; r < f.size(); ++r) EXPECT_NEAR(sum[r], f[r], kRounding);
}

TEST(DiodeAmplifier, SlidesAlongItsThresholdAsAComparator) {
  // x' = out falls at 0.5 from 1 to 0 at t = 2 and stays there.
  const Compiled made(R"(x = { type = "integrator", in = ["out"], initial = 1 }
out = { type = "diode-amplifier", in = ["x"], feedback = 0, low = -0.5, high = 0.7 })");
  expect_form(run_of(made, {.until = 4, .samples = 42}), "x", kIntegrated,
              [](double t) { return std::max(0.0, 1 - 0.5 * t); });
}

TEST(DiodeAmplifier, MakesAPreciseMagnitudeOfTwo) {
  const Compiled made(std::string(kRise) + R"(
half = { type = "diode-amplifier", in = ["u"], low = "-inf", high = 0 }
out = { type = "summer", in = ["-u", "-2*half"] })");
  expect_form(run_of(made, {.until = 4, .samples = 402}), "out", kRounding,
              [](double t) { return std::abs(t - 2); });
}

TEST(JunctionDiode, CarriesShockleysCurrent) {
  const Compiled made(std::string(kRise) +
                      R"(i = { type = "junction-diode", in = "u", saturation = 1e-3, thermal = 0.2 })");
  const auto result = run_of(made, {.until = 4, .samples = 402});
  const auto u = row_values(result, "u"), i = row_values(result, "i");
  for (std::size_t r = 0; r < u.size(); ++r) {
    const double current = 1e-3 * std::expm1(u[r] / 0.2);
    EXPECT_NEAR(i[r], current, kRounding * (1 + std::abs(current)));
  }
}

/// Saturation current, thermal voltage and resistance.
class BehindAResistor : public ::testing::TestWithParam<std::array<double, 3>> {};
INSTANTIATE_TEST_SUITE_P(JunctionDiode, BehindAResistor,
                         ::testing::Values(std::array{1e-9, 4e-3, 1.0}, std::array{1e-14, 2.6e-3, 0.01},
                                           std::array{1e-3, 0.3, 2.0}, std::array{0.5, 1.0, 1e-3},
                                           std::array{1e-12, 1e-3, 100.0}));

// The equation itself, read backwards: the voltage that the current found needs, or, where it is nearly the
// saturation current, the current at the voltage found. Three steps of Halley's method leave 1e-15 of z.
TEST_P(BehindAResistor, CarriesWhatItsJunctionPasses) {
  const auto [saturation, thermal, resistance] = GetParam();
  const Compiled made(
      kRise + fmt::format("i = {{ type = \"junction-diode\", in = \"u\", saturation = {}, thermal = {}, "
                          "resistance = {} }}",
                          saturation, thermal, resistance));
  const auto result = run_of(made, {.until = 4, .samples = 402});
  const auto u = row_values(result, "u"), i = row_values(result, "i");
  for (std::size_t r = 0; r < u.size(); ++r) {
    const double junction = u[r] - resistance * i[r];
    if (u[r] > 0) {
      EXPECT_NEAR(thermal * std::log1p(i[r] / saturation), junction, 1e-12) << u[r];
    } else {
      EXPECT_NEAR(i[r], saturation * std::expm1(junction / thermal), 1e-12 * saturation * (1 + 2 / thermal))
          << u[r];
    }
  }
}

// r = u + i(out) − i(−out) has the root out = −thermal · asinh(u/(2 saturation)); a gain of 10⁶ leaves
// out/(10⁶ ∂r/∂out), below 1e-7 where u is above 0.01.
TEST(JunctionDiode, MakesALogarithmInTheFeedbackOfAnOpenAmplifier) {
  const Compiled made(std::string(kRise) + R"(
amplifier = { type = "servo-amplifier", in = ["u", "there", "-back"], gain = 1e6, bandwidth = "inf" }
negative = { type = "inverter", in = "amplifier" }
there = { type = "junction-diode", in = "amplifier", thermal = 4e-3 }
back = { type = "junction-diode", in = "negative", thermal = 4e-3 }
shown = { type = "logarithmic-amplifier", in = ["u"], thermal = 4e-3, pair = 1 })");
  const auto result = run_of(made, {.until = 4, .samples = 402});
  const auto form = [](double t) { return -4e-3 * std::asinh((t - 2) / 2e-9); };
  expect_form(result, "shown", 1e-12, form);  // rounding of a logarithm of 10⁹
  expect_form_where(result, "amplifier", 1e-7, form, [](double t) { return std::abs(t - 2) > 0.01; });
}

TEST(LogarithmicAmplifier, GivesTheNegativeLogarithm) {
  const Compiled made(R"(u = { type = "ramp", initial = 0.001, slope = 1 }
out = { type = "logarithmic-amplifier", in = ["u", "u"], saturation = 1e-8, thermal = 2.5e-3 })");
  expect_form(run_of(made, {.until = 1, .samples = 101}), "out", kRounding,
              [](double t) { return -2.5e-3 * std::log1p(2 * (t + 0.001) / 1e-8); });
}

TEST(LogarithmicAmplifier, StandsAtItsLimitWhereTheDiodeTakesNoCurrent) {
  // Positive currents would bring it to −0.08 at most, so that a limit of 0.05 is met on both sides.
  const Compiled made(std::string(kRise) +
                      R"(out = { type = "logarithmic-amplifier", in = ["u"], thermal = 4e-3, limit = 0.05 }
both = { type = "logarithmic-amplifier", in = ["u"], thermal = 4e-3, pair = 1, limit = 0.05 })");
  const auto result = run_of(made, {.until = 4, .samples = 402});
  const auto form = [](double t) { return std::clamp(-4e-3 * std::asinh((t - 2) / 2e-9), -0.05, 0.05); };
  const auto apart = [](double t) { return std::abs(t - 2) > 1e-3; };
  expect_form_where(result, "both", 1e-12, form, apart);
  expect_form_where(
      result, "out", kRounding,
      [](double t) { return t < 2 ? 0.05 : std::max(-4e-3 * std::log1p((t - 2) / 1e-9), -0.05); }, apart);
}

TEST(LogarithmicAmplifier, EndsTheRunWhereThereIsNoLogarithm) {
  const Compiled made(R"(u = { type = "ramp", initial = 1, slope = -1 }
out = { type = "logarithmic-amplifier", in = ["u"] })");
  const auto failure = testing::failure_of(made, {.until = 2});
  ASSERT_TRUE(failure);
  EXPECT_THAT(failure->message, HasSubstr("'out'"));
  EXPECT_NEAR(failure->time, 1, 0.01);
}

TEST(Diodes, SayWhatTheirParametersMayBe) {
  const std::string message = testing::message_of<diagram::DiagramError>([] {
    Compiled(R"(u = { type = "constant", value = 1 }
a = { type = "diode", in = "u", resistance = 0, breakdown = -1 }
b = { type = "junction-diode", in = "u", saturation = 0 }
c = { type = "diode-amplifier", in = ["u"], low = 0.5 })");
  });
  EXPECT_EQ(
      message,
      "d.toml:4:46: parameter 'a.resistance' is 0; expected a number above 0 and below inf\n"
      "d.toml:4:61: parameter 'a.breakdown' is -1; expected a number above 0 [machine unit]\n"
      "d.toml:5:55: parameter 'b.saturation' is 0; expected a number above 0 and below inf [machine unit]\n"
      "d.toml:6:51: parameter 'c.low' is 0.5; expected a number at most 0 [machine unit]");
}

}  // namespace
}  // namespace oblique::test
