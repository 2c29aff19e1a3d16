// SPDX-License-Identifier: MIT
// The transfer lag T ẏ = −y + K u against its closed answers.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

// Ten times the tolerance of the run, 1e-10, for the errors of its steps together.
constexpr double kWithin = 1e-9;

TEST(TransferLag, AnswersAStepExponentially) {
  const Compiled made(R"toml(u = { type = "constant", value = 0.4 }
y = { type = "transfer-lag", in = "u", time_constant = "200 ms", gain = -2, initial = 0.3 }
)toml");
  const auto result = run_of(made, {.until = 2, .tolerance = 1e-10, .samples = 101});
  const auto t = row_values(result, "t"), y = row_values(result, "y");
  for (std::size_t r = 0; r < t.size(); ++r) {
    EXPECT_NEAR(y[r], -0.8 + 1.1 * std::exp(-t[r] / 0.2), kWithin) << t[r];
  }
}

TEST(TransferLag, FollowsARampWithItsTimeConstant) {
  const Compiled made(R"toml(one = { type = "constant" }
u = { type = "integrator", in = ["0.5*one"] }
y = { type = "transfer-lag", in = "u", time_constant = 0.3 }
)toml");
  const auto result = run_of(made, {.until = 2, .tolerance = 1e-10, .samples = 101});
  const auto t = row_values(result, "t"), y = row_values(result, "y");
  for (std::size_t r = 0; r < t.size(); ++r) {
    EXPECT_NEAR(y[r], 0.5 * (t[r] - 0.3 * (1 - std::exp(-t[r] / 0.3))), kWithin) << t[r];
  }
}

TEST(TransferLag, LowersAndDelaysASine) {
  const Compiled made(R"toml(u = { type = "sine-source", frequency = "2 Hz", phase = "30 deg" }
y = { type = "transfer-lag", in = "u", time_constant = 0.1 }
)toml");
  const auto result = run_of(made, {.until = 3, .tolerance = 1e-10, .samples = 301});
  const auto t = row_values(result, "t"), y = row_values(result, "y");
  constexpr double kOmega = 4 * std::numbers::pi;
  const double amplitude = 1 / std::sqrt(1 + kOmega * kOmega * 0.01);
  const double phase = std::numbers::pi / 6 - std::atan(kOmega * 0.1);
  for (std::size_t r = 0; r < t.size(); ++r) {
    const double steady = amplitude * std::sin(kOmega * t[r] + phase);
    const double exact = steady - amplitude * std::sin(phase) * std::exp(-t[r] / 0.1);
    EXPECT_NEAR(y[r], exact, kWithin) << t[r];
  }
}

TEST(TransferLag, DoesNotInvertOnAMachineThatInverts) {
  const Compiled made(R"toml(u = { type = "constant", value = 0.4 }
y = { type = "transfer-lag", in = "u", initial = 0.4 }
)toml",
                      "[machine]\ninverting = true\n");
  EXPECT_EQ(row_values(run_of(made, {.samples = 3}), "y").back(), 0.4);
}

}  // namespace
}  // namespace oblique::test
