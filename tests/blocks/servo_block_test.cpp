// SPDX-License-Identifier: MIT
// The servo amplifier's imperfections, servo-multiplier, servo-resolver. The servo amplifier itself is in
// tests/solve.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::kCosineAndSine;
using testing::kIntegrated;
using testing::kRounding;
using testing::last;
using testing::run_of;

constexpr double kTau = 1 / (2 * std::numbers::pi * 10);  // of 10 Hz [s]

TEST(ServoAmplifier, StaysWithinItsLimitAndRecoversAtOnce) {
  // r = −1 until t = 0.5, then 0.1: towards 5 until the limit of 1, and from there towards −0.5.
  const Compiled made(R"(r = { type = "step", at = 0.5, from = 0, to = -1 }
back = { type = "step", at = 1, to = 1.1 }
a = { type = "servo-amplifier", in = ["r", "back"], gain = 5, limit = 1 })");
  expect_form(run_of(made, {.until = 1.5, .samples = 1502}), "a", kIntegrated, [](double t) {
    if (t < 0.5) return 0.0;
    if (t < 1) return std::min(1.0, 5 * (1 - std::exp(-(t - 0.5) / kTau)));
    return -0.5 + 1.5 * std::exp(-(t - 1) / kTau);
  });
}

class LimitedServoTest : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Amplifiers, LimitedServoTest,
                         ::testing::Values("", "bandwidth = inf,", "gain = inf,",
                                           "gain = inf, capacitor = 1e-5,",
                                           "bandwidth = inf, capacitor = 1e-5,"));

TEST_P(LimitedServoTest, FollowsUpToItsLimit) {
  const Compiled made(
      std::string(kCosineAndSine) +
      fmt::format("a = {{ type = \"servo-amplifier\", in = [\"a\", \"-cosine\"], {} limit = 0.5 }}",
                  GetParam()));
  // Lag of 1e-5 s and static error of 1e-6; beginning and ending each run at the limit.
  expect_form(run_of(made, {.until = 4 * std::numbers::pi, .samples = 401}), "a", 2e-5,
              [](double t) { return std::clamp(std::cos(t), -0.5, 0.5); });
}

TEST(ServoAmplifier, IsSlowedDownByItsCapacitor) {
  // Open: out/r = −μ/(1 + (τ + T_c (1 + μ)) s).
  constexpr double kGain = 20, kCapacitor = 0.01, kTime = kTau + kCapacitor * (1 + kGain);
  const Compiled made(R"(r = { type = "step", at = 0.1, to = 0.04 }
a = { type = "servo-amplifier", in = ["r"], gain = 20, capacitor = 0.01 }
i = { type = "servo-amplifier", in = ["r"], gain = inf, capacitor = 0.5 })");
  const auto result = run_of(made, {.samples = 102});
  expect_form(result, "a", kIntegrated,
              [](double t) { return t < 0.1 ? 0 : -0.04 * kGain * (1 - std::exp(-(t - 0.1) / kTime)); });
  expect_form(result, "i", kIntegrated, [](double t) { return t < 0.1 ? 0 : -0.04 * (t - 0.1) / 0.5; });
}

TEST(ServoAmplifier, AddsOffsetDriftAndNoiseToItsResidual) {
  const Compiled made(R"(u = { type = "constant", value = 0.3 }
n = { type = "noise-source", rms = 0.01, bandwidth = 3, seed = 5 }
a = { type = "servo-amplifier", in = ["a", "-u"], gain = inf, offset = 0.02, drift = -0.01, noise = 0.01, noise_bandwidth = 3, seed = 5 }
sum = { type = "summer", in = ["a", "n"] })");
  expect_form(run_of(made, {.until = 2, .samples = 51}), "sum", kRounding,
              [](double t) { return 0.3 - 0.02 + 0.01 * t; });
}

TEST(ServoMultiplier, FollowsWithLimitedVelocity) {
  // From 0 at 0.5 1/s until the error is 0.5/K, then exponentially.
  const Compiled made(R"(x = { type = "constant", value = 0.4 }
y = { type = "constant", value = -2 }
z = { type = "ramp" }
m = { type = "servo-multiplier", x = "x", y1 = "y", y2 = "z", loop_gain = 20, velocity_limit = 0.5, aligned = 0 })");
  const auto result = run_of(made, {.until = 2, .samples = 201});
  constexpr double kGain = 20, kSpeed = 0.5, kFree = (0.4 - kSpeed / kGain) / kSpeed;
  const auto position = [](double t) {
    return t < kFree ? kSpeed * t : 0.4 - kSpeed / kGain * std::exp(-kGain * (t - kFree));
  };
  expect_form(result, "m.position", kIntegrated, position);
  expect_form(result, "m.out1", kIntegrated, [&](double t) { return -2 * position(t); });
  expect_form(result, "m.out2", kIntegrated, [&](double t) { return t * position(t); });
  expect_form(result, "m.out3", 0, [](double) { return 0; });
}

TEST(ServoMultiplier, SwingsWithItsInertia) {
  // ω₀ = √(K/T) = 100, ζ = 1/(2 √(K T)) = 0.5; the carriage starts aligned with x = 0, which then jumps.
  const Compiled made(R"(x = { type = "step", at = 0.01, to = 0.4 }
m = { type = "servo-multiplier", x = "x", y1 = "x", loop_gain = 100, time_constant = 0.01 })");
  expect_form(run_of(made, {.until = 0.1, .samples = 102}), "m.position", kIntegrated, [](double t) {
    const double s = t - 0.01, damped = 100 * std::sqrt(0.75);
    if (s < 0) return 0.0;
    return 0.4 *
           (1 - std::exp(-50 * s) * (std::cos(damped * s) + 0.5 / std::sqrt(0.75) * std::sin(damped * s)));
  });
}

TEST(ServoMultiplier, StartsAlignedAndRestsInItsDeadZone) {
  const Compiled made(R"(x = { type = "step", at = 0.5, from = 0.3, to = -0.2 }
y = { type = "constant" }
m = { type = "servo-multiplier", x = "x", y1 = "y", dead_zone = 0.04 })");
  expect_form(run_of(made, {.samples = 102}), "m.out1", kIntegrated,
              [](double t) { return t < 0.5 ? 0.3 : -0.18 + 0.48 * std::exp(-100 * (t - 0.5)); });
}

TEST(ServoResolver, TurnsWithItsLag) {
  constexpr double kGain = 100, kSpeed = 3;
  const Compiled made(R"(angle = { type = "ramp", slope = 3, initial = 1 }
r = { type = "constant", value = 0.8 }
v = { type = "servo-resolver", angle = "angle", r = "r" })");
  const auto result = run_of(made, {.until = 4, .samples = 201});
  const auto angle = [](double t) { return 1 + kSpeed * t - kSpeed / kGain * (1 - std::exp(-kGain * t)); };
  expect_form(result, "v.x", kIntegrated, [&](double t) { return 0.8 * std::cos(angle(t)); });
  expect_form(result, "v.y", kIntegrated, [&](double t) { return 0.8 * std::sin(angle(t)); });
  expect_form(result, "v.position", 10 * kIntegrated, angle);  // of 13 rad
}

TEST(ServoResolver, HasTheDriveOfTheServoMultiplier) {
  const std::string drive =
      "loop_gain = 40, time_constant = 0.02, velocity_limit = 0.6, dead_zone = 0.05, aligned = 0, initial = "
      "0.2 }\n";
  const Compiled made(std::string(kCosineAndSine) +
                      "m = { type = \"servo-multiplier\", x = \"sine\", y1 = \"cosine\", " + drive +
                      "v = { type = \"servo-resolver\", angle = \"sine\", " + drive +
                      "d = { type = \"summer\", in = [\"m.position\", \"-v.position\"] }\n");
  // Twins: the same steps and the same events for both.
  expect_form(run_of(made, {.until = 6, .samples = 61}), "d", 1e-9, [](double) { return 0; });
}

}  // namespace
}  // namespace oblique::test
