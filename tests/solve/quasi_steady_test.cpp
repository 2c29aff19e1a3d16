// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/quasi_steady.h>

#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

// a + (a − u) μ = 0 follows the ramp u to μ/(1 + μ) of it, up to its limit. There the residual drives it on,
// which one switch holds, and it never is beyond, which another one would, that an instant amplifier has not.
TEST(QuasiSteadyInstants, HaveTheSwitchesOfTheRealAmplifiers) {
  const Compiled made(R"toml(u = { type = "ramp" }
a = { type = "servo-amplifier", in = ["a", "-u"], gain = 1e3, bandwidth = 10, limit = 0.5 }
)toml");
  RunOptions options;
  options.until = 1;
  options.samples = 11;
  const auto instants = quasi_steady_instants(made.program, made.flat, options, 11);
  ASSERT_EQ(instants.size(), 11U);
  for (const Instant& instant : instants) {
    const bool limited = instant.t > 0.55;
    ASSERT_EQ(instant.states.size(), 1U);
    EXPECT_NEAR(instant.states[0], limited ? 0.5 : instant.t / 1.001, 1e-12) << instant.t;  // a few roundings
    for (std::size_t m = 0; m < instant.discrete_states.size(); ++m) {
      const std::string& name = made.program.discrete_states()[m].name;
      EXPECT_EQ(instant.discrete_states[m], name == "a: out - residual > limit" && limited ? 1 : 0)
          << name << " at " << instant.t;
    }
  }
}

}  // namespace
}  // namespace oblique::solve
