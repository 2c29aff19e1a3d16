// SPDX-License-Identifier: MIT
// The resolver, polar to rectangular, and the polar resolver, back by a servo loop.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

/// A vector whose angle is `start` + `speed` t and whose length is 0.5 + 0.4 t, there and back.
std::string there_and_back(double start, double speed, const std::string& parameters) {
  return fmt::format(R"toml(one    = {{ type = "constant" }}
angle  = {{ type = "integrator", in = ["{}*one"], initial = {} }}
length = {{ type = "integrator", in = ["0.4*one"], initial = 0.5 }}
there  = {{ type = "resolver", length = "length", angle = "angle" }}
back   = {{ type = "polar-resolver", x = "there.x", y = "there.y"{} }}
)toml",
                     speed, start, parameters);
}

TEST(Resolver, GivesTheCoordinates) {
  const auto result = run_of(Compiled(there_and_back(-3, 9, "")), {.samples = 101});
  const auto angle = row_values(result, "angle"), length = row_values(result, "length");
  const auto x = row_values(result, "there.x"), y = row_values(result, "there.y");
  for (std::size_t r = 0; r < x.size(); ++r) {
    EXPECT_NEAR(x[r], length[r] * std::cos(angle[r]), 1e-15);  // rounding
    EXPECT_NEAR(y[r], length[r] * std::sin(angle[r]), 1e-15);
  }
}

TEST(PolarResolver, FollowsAVectorThatTurnsOnAndOn) {
  constexpr double kSpeed = 2 * std::numbers::pi * 5;  // five turns
  const auto result = run_of(Compiled(there_and_back(0.2, kSpeed, "")), {.samples = 501});
  const auto angle = row_values(result, "angle"), length = row_values(result, "length");
  const auto found = row_values(result, "back.angle"), side = row_values(result, "back.length");
  for (std::size_t r = 0; r < angle.size(); ++r) {
    // Static error φ/(μ w r) and lag φ̇ τ/(μ w r), μ w = 1e7, τ = 1/(20π); 1e-8 the solver's, in 31 rad.
    const double loop = 1e7 * length[r];
    const double predicted = -angle[r] / loop - kSpeed / (20 * std::numbers::pi) / loop;
    EXPECT_NEAR(found[r] - angle[r], predicted, 0.2 * std::abs(predicted) + 5e-7) << angle[r];
    EXPECT_NEAR(side[r], length[r], 1e-11) << angle[r];  // r δφ²/2
  }
  EXPECT_GT(found.back(), 31);
}

TEST(PolarResolver, LeavesTheStaticErrorOfItsGain) {
  for (const double gain : {1e2, 1e4, 1e6}) {
    const auto result = run_of(
        Compiled(there_and_back(1.2, 0, fmt::format(", gain = {}, bandwidth = inf", gain))), {.samples = 2});
    const double angle = row_values(result, "back.angle").front();
    // 5 μ sin δ = −(1.2 + δ), where the next order is 5 μ δ³/6; the rest is rounding.
    EXPECT_NEAR(angle - 1.2, -1.2 / (5 * gain + 1), 0.01 / (gain * gain * gain) + 1e-14) << gain;
    EXPECT_NEAR(0.5 * 10 * std::sin(angle - 1.2) + angle / gain, 0, 1e-12);  // and the equation itself
  }
}

TEST(PolarResolver, FindsTheAngleWithinHalfATurnOfItsInitialOne) {
  for (const double angle : {-3.1, -1.6, 0.0, 1.5, 2.5, 3.1}) {
    for (const double initial : {0.0, 2 * std::numbers::pi}) {
      const auto result =
          run_of(Compiled(there_and_back(angle, 0, fmt::format(", initial = {}", initial))), {.samples = 2});
      EXPECT_NEAR(row_values(result, "back.angle").front(), angle + initial, 1e-5) << angle << ' ' << initial;
    }
  }
}

}  // namespace
}  // namespace oblique::test
