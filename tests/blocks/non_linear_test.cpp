// SPDX-License-Identifier: MIT
// absolute-value, limiter, dead-zone, backlash, sign, minimum, maximum against their definitions.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::expect_form_where;
using testing::kCosineAndSine;
using testing::kIntegrated;
using testing::kRounding;
using testing::last;
using testing::run_of;

/// A block "out" of the signal u, which rises from −2 to 2.
struct Characteristic {
  std::string name;
  std::string block;
  std::function<double(double u)> form;
  friend std::ostream& operator<<(std::ostream& out, const Characteristic& c) { return out << c.name; }
};

const std::vector<Characteristic> kCharacteristics{
    {"AbsoluteValue", R"(out = { type = "absolute-value", in = "u" })", [](double u) { return std::abs(u); }},
    {"Limiter", R"(out = { type = "limiter", in = "u", low = -0.7, high = 1.2 })",
     [](double u) { return std::clamp(u, -0.7, 1.2); }},
    {"LimiterOfOneSide", R"(out = { type = "limiter", in = "u", low = "-inf", high = 0.5 })",
     [](double u) { return std::min(u, 0.5); }},
    {"DeadZone", R"(out = { type = "dead-zone", in = "u", low = -0.4, high = 0.8 })",
     [](double u) { return u < -0.4  ? u + 0.4
                           : u > 0.8 ? u - 0.8
                                     : 0; }},
    {"Sign", R"(out = { type = "sign", in = "u" })", [](double u) { return u > 0 ? 1 : -1; }},
    {"Minimum", R"(v = { type = "ramp", initial = 1, slope = -0.5 }
out = { type = "minimum", in = ["u", "v"] })",
     [](double u) { return std::min(u, 1 - (u + 2) / 2); }},
    {"Maximum", R"(v = { type = "ramp", initial = 1, slope = -0.5 }
out = { type = "maximum", in = ["u", "v"] })",
     [](double u) { return std::max(u, 1 - (u + 2) / 2); }},
};

class CharacteristicTest : public ::testing::TestWithParam<Characteristic> {};
INSTANTIATE_TEST_SUITE_P(NonLinear, CharacteristicTest, ::testing::ValuesIn(kCharacteristics),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(CharacteristicTest, IsItsDefinition) {
  const Compiled made("u = { type = \"ramp\", initial = -2 }\n" + GetParam().block);
  expect_form_where(
      run_of(made, {.until = 4, .samples = 402}), "out", kRounding,
      [&](double t) { return GetParam().form(t - 2); }, [](double t) { return t != 2; });
}

TEST(AbsoluteValue, IsIntegratedAcrossItsCorners) {
  const Compiled made(std::string(kCosineAndSine) + R"(magnitude = { type = "absolute-value", in = "sine" }
sum = { type = "integrator", in = ["magnitude"] })");
  EXPECT_NEAR(last(run_of(made, {.until = 4 * std::numbers::pi, .samples = 2}), "sum"), 8, kIntegrated);
}

TEST(Limiter, CutsASineAtTheRightTimes) {
  // ∫ of sin t cut at ½ over half a period: 2 (1 − cos π/6) + (2π/3)/2.
  const Compiled made(std::string(kCosineAndSine) + R"(cut = { type = "limiter", in = "sine", high = 0.5 }
sum = { type = "integrator", in = ["cut"] })");
  const double area = 2 * (1 - std::cos(std::numbers::pi / 6)) + std::numbers::pi / 3;
  EXPECT_NEAR(last(run_of(made, {.until = std::numbers::pi, .samples = 2}), "sum"), area, kIntegrated);
}

TEST(Backlash, IsDraggedBehindARampWithItsLag) {
  // Contact after play/2 of the way; then out' = k (v (t − t0) − out).
  constexpr double kSpeed = 0.5, kPlay = 0.2, kRate = 50, kContact = kPlay / 2 / kSpeed;
  const Compiled made(R"(u = { type = "ramp", slope = 0.5 }
out = { type = "backlash", in = "u", play = 0.2, rate = 50 })");
  expect_form(run_of(made, {.samples = 101}), "out", kIntegrated, [&](double t) {
    if (t < kContact) return 0.0;
    return kSpeed * (t - kContact) - kSpeed / kRate * (1 - std::exp(-kRate * (t - kContact)));
  });
}

TEST(Backlash, RunsRoundItsLoop) {
  constexpr double kHalf = 0.2, kRate = 1e4;
  const Compiled made(std::string(kCosineAndSine) +
                      R"(out = { type = "backlash", in = "cosine", play = 0.4, rate = 1e4, initial = 0.8 })");
  // Ideal backlash, and the lag of at most 1/k that the speed of at most 1 leaves.
  expect_form(run_of(made, {.until = 2 * std::numbers::pi, .samples = 201}), "out", 1.01 / kRate,
              [&](double t) {
                const double in = std::cos(t);
                return t < std::numbers::pi ? std::min(0.8, in + kHalf) : std::max(-0.8, in - kHalf);
              });
}

}  // namespace
}  // namespace oblique::test
