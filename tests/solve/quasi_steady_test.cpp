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

// An amplifier that is twice as fast above 0.3, which the instant one has no use for: a + (a − u) μ = 0.
TEST(QuasiSteadyInstants, SetTheSwitchesThatInstantAmplifiersDoNotHave) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("two-speeds", R"toml(
[inputs]
in = { sum = true }
[outputs]
out = {}
[parameters]
bandwidth = { default = 10 }
[[cases]]
when = "bandwidth == inf"
implicit = { out = "in + out/1000" }
[equations]
"der(out)" = "if(out > 0.3, 2, 1)*2*pi*bandwidth*(-out - 1000*in)"
[start]
out = { guess = "0", at_rest = true }
)toml");
  const Compiled made(R"toml(u = { type = "ramp" }
a = { type = "two-speeds", in = ["a", "-u"] }
)toml",
                      "", library);
  ASSERT_EQ(made.program.discrete_states().back().name, "a: out > 0.3");
  RunOptions options;
  options.until = 1;
  options.samples = 11;
  for (const Instant& instant : quasi_steady_instants(made.program, made.flat, options, 11)) {
    ASSERT_EQ(instant.states.size(), 1U);
    EXPECT_NEAR(instant.states[0], instant.t / 1.001, 1e-12) << instant.t;  // a few roundings
    EXPECT_EQ(instant.discrete_states.back(), instant.t > 0.3003 ? 1 : 0) << instant.t;
  }
}

}  // namespace
}  // namespace oblique::solve
