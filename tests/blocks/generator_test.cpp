// SPDX-License-Identifier: MIT
// The sine source and the sine-cosine generator.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <oblique/network/program/program.h>
#include "../support/runs.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

TEST(SineSource, IsASineOfTime) {
  const Compiled made(
      R"toml(s = { type = "sine-source", amplitude = 0.7, frequency = "50 Hz", phase = "90 deg" }
c = { type = "sine-source", frequency = 0, phase = "30 deg" }
)toml");
  const auto result = run_of(made, {.samples = 1001});
  const auto t = row_values(result, "t"), s = row_values(result, "s"), c = row_values(result, "c");
  for (std::size_t r = 0; r < t.size(); ++r) {
    EXPECT_NEAR(s[r], 0.7 * std::cos(100 * std::numbers::pi * t[r]), 1e-13) << t[r];  // rounding of 314 rad
    EXPECT_NEAR(c[r], 0.5, 1e-15);
  }
}

TEST(SineSource, IsIntegratedLikeAnySignal) {
  const Compiled made(R"toml(s = { type = "sine-source", frequency = "1 Hz" }
i = { type = "integrator", in = ["s"] }
)toml");
  const auto result = run_of(made, {.until = 3, .tolerance = 1e-10, .samples = 301});
  const auto t = row_values(result, "t"), i = row_values(result, "i");
  constexpr double kOmega = 2 * std::numbers::pi;
  for (std::size_t r = 0; r < t.size(); ++r) {
    EXPECT_NEAR(i[r], (1 - std::cos(kOmega * t[r])) / kOmega, 1e-9) << t[r];  // ten times the tolerance
  }
}

// The rate swings between −3 and 5 rad/s and makes the angle φ = 0.4 + t + 2 sin 2t.
constexpr const char* kSwinging = R"toml(one   = { type = "constant" }
swing = { type = "sine-source", frequency = "1/pi", phase = "90 deg" }
angle = { type = "sine-cosine-generator", in = ["0.2*one", "0.8*swing"], rate = 5, start = 0.4 }
)toml";

TEST(SineCosineGenerator, FollowsTheAngleOfAnyRate) {
  const auto result = run_of(Compiled(kSwinging), {.until = 20, .tolerance = 1e-10, .samples = 501});
  const auto t = row_values(result, "t");
  const auto c = row_values(result, "angle.cos"), s = row_values(result, "angle.sin");
  for (std::size_t r = 0; r < t.size(); ++r) {
    const double angle = 0.4 + t[r] + 2 * std::sin(2 * t[r]);
    EXPECT_NEAR(c[r], std::cos(angle), 2e-8) << t[r];  // some hundred steps of 1e-10
    EXPECT_NEAR(s[r], std::sin(angle), 2e-8) << t[r];
  }
}

/// With p = c² + s² the held amplitude obeys ṗ = hold p (1 − p), the logistic equation, at any rate of the
/// angle.
TEST(SineCosineGenerator, HoldsItsAmplitudeAsTheLogisticCurve) {
  const Compiled made(R"toml(one   = { type = "constant" }
angle = { type = "sine-cosine-generator", in = ["one"], rate = 3, hold = 0.7 }
)toml");
  network::Workspace workspace(made.program);
  std::vector<double> x = made.program.start(), derivative(2);
  for (const double p : {0.25, 0.9, 1.0, 1.2}) {
    for (const double angle : {0.0, 1.0, 4.0}) {
      x = {std::sqrt(p) * std::cos(angle), std::sqrt(p) * std::sin(angle)};
      ASSERT_TRUE(made.program.derivatives(0, x.data(), derivative.data(), workspace));
      EXPECT_NEAR(2 * (x[0] * derivative[0] + x[1] * derivative[1]), 0.7 * p * (1 - p), 1e-15)
          << p;                                                                     // rounding
      EXPECT_NEAR(x[0] * derivative[1] - x[1] * derivative[0], 3 * p, 1e-14) << p;  // φ̇ p
    }
  }
}

TEST(SineCosineGenerator, AddsItsInputsOnAMachineThatInvertsToo) {
  const Compiled made(kSwinging, "[machine]\ninverting = true\n");
  const auto result = run_of(made, {.until = 2, .samples = 3});
  EXPECT_NEAR(row_values(result, "angle.cos").back(), std::cos(2.4 + 2 * std::sin(4.0)), 1e-6);
}

}  // namespace
}  // namespace oblique::test
