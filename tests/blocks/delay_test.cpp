// SPDX-License-Identifier: MIT
// pade-delay-1 … 4 against Padé's formula, delay-line against the samples that it has taken.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::expect_form_where;
using testing::kIntegrated;
using testing::kRounding;
using testing::run_of;

/// Padé's approximation of order n to e^(−s): P(−s)/P(s) with P = Σ (2n − k)! n!/((2n)! k! (n − k)!) s^k.
std::complex<double> pade(int n, std::complex<double> s) {
  const auto factorial = [](int k) { return std::tgamma(k + 1); };
  std::complex<double> numerator = 0, denominator = 0, power = 1;
  for (int k = 0; k <= n; ++k) {
    const double c =
        factorial(2 * n - k) * factorial(n) / (factorial(2 * n) * factorial(k) * factorial(n - k));
    denominator += c * power;
    numerator += (k % 2 == 0 ? c : -c) * power;
    power *= s;
  }
  return numerator / denominator;
}

/// "out" delays "u" by 0.4 s.
struct PadeBlock {
  int order;
  double good;  ///< up to this ωT its documentation promises an error below 1 %
  const char* block;
};
constexpr PadeBlock kPadeBlocks[] = {
    {1, 0.5, R"(out = { type = "pade-delay-1", in = "u", delay = 0.4, initial = 0.7 })"},
    {2, 1.5, R"(out = { type = "pade-delay-2", in = "u", delay = 0.4, initial = 0.7 })"},
    {3, 2.8, R"(out = { type = "pade-delay-3", in = "u", delay = 0.4, initial = 0.7 })"},
    {4, 4.2, R"(out = { type = "pade-delay-4", in = "u", delay = 0.4, initial = 0.7 })"},
};

class PadeDelay : public ::testing::TestWithParam<PadeBlock> {};
INSTANTIATE_TEST_SUITE_P(Orders, PadeDelay, ::testing::ValuesIn(kPadeBlocks));

TEST_P(PadeDelay, DelaysASineByItsPhase) {
  // The slowest decay of order 4 is 2 · 2.1/T: what is left of the start after 10 T is below 1e-17.
  constexpr double kDelay = 0.4, kFrequency = 2 * std::numbers::pi * 0.7;
  const Compiled made(std::string("u = { type = \"sine-source\", frequency = 0.7 }\n") + GetParam().block);
  const std::complex<double> passed = pade(GetParam().order, {0, kFrequency * kDelay});
  expect_form_where(
      run_of(made, {.until = 10, .samples = 501}), "out", kIntegrated,
      [&](double t) { return std::sin(kFrequency * t + std::arg(passed)); },
      [](double t) { return t > 10 * kDelay; });
  const std::complex<double> turned = std::exp(std::complex<double>(0, -GetParam().good));
  EXPECT_LT(std::abs(pade(GetParam().order, {0, GetParam().good}) - turned), 0.0101);
}

TEST_P(PadeDelay, PassesAConstantFromTheStart) {
  const Compiled made(std::string("u = { type = \"constant\", value = 0.7 }\n") + GetParam().block);
  expect_form(run_of(made), "out", kRounding, [](double) { return 0.7; });
}

TEST(DelayLine, HandsOnItsSamples) {
  // Five stores, a sample each 0.1 s: about a pulse stands the one that was taken five pulses before.
  const Compiled made(R"(u = { type = "sine-source", frequency = 0.3 }
out = { type = "delay-line", in = "u", delay = 0.5, stages = 5, initial = -0.25 })");
  expect_form(run_of(made, {.until = 3.97, .samples = 334}), "out", kRounding, [](double t) {
    const double sampled = 0.1 * (std::floor(t / 0.1 + 0.5 + 1e-9) - 5);
    return sampled < -1e-9 ? -0.25 : std::sin(2 * std::numbers::pi * 0.3 * sampled);
  });
}

TEST(DelayLine, JoinsItsSamplesByStraightLines) {
  // A ramp, and before it the initial value: the corner falls on a pulse.
  const Compiled made(R"(u = { type = "ramp", slope = 0.5, initial = 0.2 }
out = { type = "delay-line", in = "u", delay = 0.6, stages = 24, straight = 1, initial = 0.2 })");
  expect_form(run_of(made, {.until = 3, .samples = 334}), "out", kRounding,
              [](double t) { return 0.2 + 0.5 * std::max(0.0, t - 0.6); });
}

TEST(DelayLine, LosesNoMoreOfASineThanItSays) {
  const Compiled made(R"(u = { type = "sine-source", frequency = 0.5 }
out = { type = "delay-line", in = "u", delay = 1, stages = 20, straight = 1 })");
  constexpr double kOmega = std::numbers::pi;
  expect_form_where(
      run_of(made, {.until = 5, .samples = 777}), "out", kOmega * kOmega / (8 * 20 * 20),
      [](double t) { return std::sin(kOmega * (t - 1)); }, [](double t) { return t > 1; });
}

TEST(DelayLine, TakesAFractionForTheNextWholeNumber) {
  const Compiled made(R"(u = { type = "ramp" }
out = { type = "delay-line", in = "u", delay = 0.75, stages = 2.5, straight = 1 }
one = { type = "delay-line", in = "u", delay = 0.75, stages = 1 })");
  const auto result = run_of(made, {.until = 2.93, .samples = 334});
  expect_form(result, "out", kRounding, [](double t) { return std::max(0.0, t - 0.75); });
  expect_form(result, "one", kRounding,
              [](double t) { return 0.75 * std::max(0.0, std::floor(t / 0.75 + 0.5 + 1e-9) - 1); });
}

// A step within a clock time comes out the whole delay after the pulse that has taken it, less half a one, of
// one line of twenty stores and of a row of two and of four; and an echo comes again each second (it did
// each 1.1 s).
TEST(DelayLine, InARowDelaysByAllItsStores) {
  const Compiled made(R"(u = { type = "step", at = 0.57 }
one = { type = "delay-line", in = "u", delay = 2, stages = 20 }
a = { type = "delay-line", in = "u", delay = 1, stages = 10 }
b = { type = "delay-line", in = "a", delay = 1, stages = 10 }
c = { type = "delay-line", in = "b", delay = 1, stages = 10 }
d = { type = "delay-line", in = "c", delay = 1, stages = 10 }
p = { type = "pulse-train", delay = 0.53, width = 0.34, period = 100 }
x = { type = "summer", in = ["p", "0.5*e"] }
e = { type = "delay-line", in = "x", delay = 1, stages = 10 }
)");
  const auto result = run_of(made, {.until = 5.997, .samples = 998});  // no row at an edge
  const auto step_at = [](double when) { return [=](double t) { return t > when ? 1.0 : 0.0; }; };
  expect_form(result, "one", kRounding, step_at(2.55));
  expect_form(result, "b", kRounding, step_at(2.55));
  expect_form(result, "d", kRounding, step_at(4.55));
  expect_form(result, "e", kRounding, [](double t) {
    const double since = t - 0.55;  // taken at 0.6, 0.7 and 0.8 s
    const double echo = std::floor(since);
    return echo >= 1 && since - echo < 0.3 ? std::pow(0.5, echo - 1) : 0.0;
  });
}

}  // namespace
}  // namespace oblique::test
