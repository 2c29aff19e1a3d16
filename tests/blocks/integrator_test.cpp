// SPDX-License-Identifier: MIT
// Inputs, limit and imperfections of the integrator.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

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
using testing::row_values;
using testing::run_of;

TEST(Integrator, TakesItsInitialValueFromAnotherElement) {
  const Compiled made(R"(c = { type = "constant", value = 0.4 }
a = { type = "integrator", in = ["c"], initial = 0.3 }
double = { type = "summer", in = ["2*a"] }
b = { type = "integrator", in = ["c"], start = "double", initial = 0.1 })");
  expect_form(run_of(made, {.samples = 11}), "b", kRounding, [](double t) { return 0.7 + 0.4 * t; });
}

TEST(Integrator, IsSetByARisingEdge) {
  const Compiled made(R"(one = { type = "constant" }
p = { type = "pulse-train", delay = 0.25 }
s = { type = "constant", value = -0.2 }
x = { type = "integrator", in = ["one"], set = "p", start = "s", initial = 0.3 })");
  expect_form(run_of(made, {.until = 3, .samples = 32}), "x", 1e-12,
              [](double t) { return t < 0.25 ? 0.1 + t : 0.1 + t - 0.25 - std::floor(t - 0.25); });
}

class LimitedIntegratorTest : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Amplifiers, LimitedIntegratorTest,
                         ::testing::Values("", "gain = 1e9,", "bandwidth = 1e6,"));

TEST_P(LimitedIntegratorTest, StaysWithinItsLimitAndRecoversAtOnce) {
  const Compiled made(
      std::string(kCosineAndSine) +
      fmt::format("x = {{ type = \"integrator\", in = [\"cosine\"], {} limit = 0.5 }}", GetParam()));
  // ∫ cos t from 0: at 0.5 from π/6 to π/2, at −0.5 from π to 3π/2, and so on.
  expect_form(run_of(made, {.until = 6 * std::numbers::pi, .samples = 601}), "x", kIntegrated, [](double t) {
    if (t < std::numbers::pi / 2) return std::min(0.5, std::sin(t));
    const double phase = std::fmod(t, 2 * std::numbers::pi);
    const bool falls = phase > std::numbers::pi / 2 && phase < 3 * std::numbers::pi / 2;
    return falls ? std::max(-0.5, std::sin(phase) - 0.5) : std::min(0.5, std::sin(phase) + 0.5);
  });
}

TEST(Integrator, WithoutALimitSwitchesNothing) {
  for (const char* const amplifier : {"", "gain = 1000,", "offset = 1e-3,", "bandwidth = 1e4,"}) {
    const Compiled made(
        fmt::format("x = {{ type = \"integrator\", in = \"-y\", {0} initial = 0.5 }}\n"
                    "y = {{ type = \"integrator\", in = \"x\", {0} initial = 0 }}\n",
                    amplifier));
    EXPECT_EQ(run_of(made, {.until = 10}).event_count, 0) << amplifier;
  }
}

TEST(Integrator, StartsWithinItsLimit) {
  const Compiled made(R"(c = { type = "constant", value = -1 }
x = { type = "integrator", in = ["c"], initial = 3, limit = 1.5 })");
  expect_form(run_of(made, {.samples = 11}), "x", kRounding, [](double t) { return 1.5 - t; });
}

TEST(RealIntegrator, LeaksThroughItsFiniteGain) {
  // out' (1 + 1/A) = k (w − W out/A): with A = 50, W = 4 and k = 2 towards A w/W.
  const Compiled made(R"(c = { type = "constant", value = 0.01 }
x = { type = "integrator", in = ["4*c"], rate = 2, gain = 50 })");
  expect_form(run_of(made, {.until = 10, .samples = 51}), "x", kIntegrated,
              [](double t) { return 50 * 0.04 / 4 * (1 - std::exp(-2 * 4 / 50.0 / (1 + 1 / 50.0) * t)); });
}

TEST(RealIntegrator, HasTolerancesDriftLeakageAndOffset) {
  const Compiled made(R"(c = { type = "constant", value = 0.1 }
tolerant = { type = "integrator", in = ["c"], rate = 10, tolerance = 0.01, capacitor_tolerance = -0.02 }
drifting = { type = "integrator", in = ["c"], rate = 10, drift = 0.05 }
offset   = { type = "integrator", in = ["c", "-c"], rate = 10, offset = 0.003 }
leaking  = { type = "integrator", in = ["c"], rate = 10, leakage = 0.5 })");
  const auto result = run_of(made, {.samples = 11});
  expect_form(result, "tolerant", kRounding, [](double t) { return 1.01 / 0.98 * t; });
  expect_form(result, "drifting", kRounding, [](double t) { return 1.05 * t; });
  expect_form(result, "offset", kRounding, [](double t) { return 10 * 2 * 0.003 * t; });
  expect_form(result, "leaking", kIntegrated, [](double t) { return 2 * (1 - std::exp(-0.5 * t)); });
}

TEST(RealIntegrator, IntegratesItsNoise) {
  const Compiled made(R"(zero = { type = "constant", value = 0 }
n = { type = "noise-source", rms = 0.05, bandwidth = 4, seed = 2 }
x = { type = "integrator", in = ["zero"], noise = 0.05, noise_bandwidth = 4, seed = 2 }
y = { type = "integrator", in = ["n"] }
d = { type = "summer", in = ["x", "-y"] })");
  const auto result = run_of(made, {.until = 5, .samples = 51});
  expect_form(result, "d", kIntegrated, [](double) { return 0; });
  EXPECT_GT(std::abs(last(result, "x")), 1e-3);
}

TEST(RealIntegrator, AnswersAStepWithItsFiniteBandwidth) {
  // Without input resistors' load (k → 0 beside ω_t) the output starts with the lag 1/ω_t behind the ramp:
  // s out (1 + s/ω_t + k/ω_t) = k in, exactly, with the gain inf.
  const Compiled made(R"(u = { type = "step", at = 0.1 }
x = { type = "integrator", in = ["u"], rate = 2, bandwidth = 5 })");
  const double w = 2 * std::numbers::pi * 5, a = w + 2;  // out = k w/a (t − (1 − e^{−a t})/a)
  expect_form(run_of(made, {.samples = 102}), "x", kIntegrated, [&](double t) {
    const double s = std::max(0.0, t - 0.1);
    return 2 * w / a * (s - (1 - std::exp(-a * s)) / a);
  });
}

TEST(RealIntegrator, OfVeryLargeBandwidthIsTheOneWithout) {
  const std::string real = "gain = 300, offset = 0.01, drift = 0.02, leakage = 0.1, tolerance = 0.03, ";
  const Compiled made(std::string(kCosineAndSine) + "a = { type = \"integrator\", in = [\"2*cosine\"], " +
                      real + "initial = 0.2 }\nb = { type = \"integrator\", in = [\"2*cosine\"], " + real +
                      "initial = 0.2, bandwidth = 1e7 }\nd = { type = \"summer\", in = [\"a\", \"-b\"] }");
  // b starts with its junction at rest: out then settles by e = offset − out/A within microseconds.
  const auto result = run_of(made, {.until = 6, .samples = 61});
  const double start = 0.2 - 0.2 / (1 + 1 / 300.0) - 0.01 / (1 + 1 / 300.0);
  EXPECT_NEAR(row_values(result, "d")[0], 0, kRounding);
  expect_form_where(
      result, "d", 1e-5, [&](double t) { return start * std::exp(-(0.1 + 2 / 300.0) / (1 + 1 / 300.0) * t); },
      [](double t) { return t > 0; });
}

}  // namespace
}  // namespace oblique::test
