// SPDX-License-Identifier: MIT
// The integrator in its modes of operation.
#include <cmath>

#include <fmt/format.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::expect_form_where;
using testing::kIntegrated;
using testing::kRounding;
using testing::run_of;

/// Initial condition, operate, hold for a second each, twice.
constexpr const char* kTimeline = R"(
[timeline]
phases = [{ mode = "initial", for = 1 }, { mode = "operate", for = 1 }, { mode = "hold", for = 1 }]
cycles = 2
)";

double phase_of(double t) {
  return t > 3 ? t - 3 : t;
}

TEST(IntegratorModes, ItTakesItsInitialValueIntegratesAndHolds) {
  const Compiled made(R"(c = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["c"], initial = 0.2 }
inverted = { type = "integrator", in = ["c"], rate = -2 })",
                      kTimeline);
  const auto result = run_of(made, {.until = 6, .samples = 62});
  const auto ramp = [](double t) { return std::clamp(phase_of(t) - 1, 0.0, 1.0); };
  expect_form(result, "x", kRounding, [&](double t) { return 0.2 + 0.5 * ramp(t); });
  expect_form(result, "inverted", kRounding, [&](double t) { return -ramp(t); });
}

TEST(IntegratorModes, InHoldItDriftsAndLeaks) {
  const Compiled made(R"(c = { type = "constant", value = 0.5 }
drifts = { type = "integrator", in = ["c"], drift = 0.1, offset = 0.01 }
leaks = { type = "integrator", in = ["c", "-c"], initial = 0.6, leakage = 2 })",
                      kTimeline);
  const auto result = run_of(made, {.until = 6, .samples = 62});
  expect_form(result, "drifts", kRounding, [](double t) {  // the offset at the input only while that is there
    const double phase = phase_of(t);
    return 0.51 * std::clamp(phase - 1, 0.0, 1.0) + 0.1 * std::clamp(phase - 1, 0.0, 2.0);
  });
  expect_form(result, "leaks", kIntegrated,
              [](double t) { return 0.6 * std::exp(-2 * std::max(phase_of(t) - 1, 0.0)); });
}

TEST(IntegratorModes, ItsCapacitorIsChargedFromWhereItWas) {
  const Compiled made(R"(c = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["c"], initial = 0.8, charging = 0.25 })",
                      kTimeline);
  const double first = 0.8 * (1 - std::exp(-4.0)), second = 0.8 + (first + 0.5 - 0.8) * std::exp(-4.0);
  expect_form(run_of(made, {.until = 6, .samples = 62}), "x", kIntegrated, [&](double t) {
    const double from = t > 3 ? first + 0.5 : 0, to = t > 3 ? second : first;
    const double phase = phase_of(t);
    if (phase < 1) return 0.8 + (from - 0.8) * std::exp(-4 * phase);
    return to + 0.5 * std::min(phase - 1, 1.0);
  });
}

// Real amplifiers do the same within e = −out/A and the time 1/ω_t.
class InitialValueTest : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Amplifiers, InitialValueTest,
                         ::testing::Values("", "limit = 2,", "bandwidth = 1e7,"));

TEST_P(InitialValueTest, PassesFromElementToElement) {
  // All three return at the same instant, and each starts from the one before.
  const Compiled made(fmt::format(R"(c = {{ type = "constant", value = 0.5 }}
a = {{ {0} type = "integrator", in = ["c"], initial = 0.1 }}
b = {{ {0} type = "integrator", in = ["c"], start = "2*a", initial = 0.1 }}
x = {{ {0} type = "integrator", in = ["c"], start = "b" }})",
                                  GetParam()),
                      kTimeline);
  // The followers' microseconds, which begin with each cycle, are over at the first row in it.
  expect_form_where(
      run_of(made, {.until = 6, .samples = 62}), "x", kIntegrated,
      [](double t) { return 0.3 + 0.5 * std::clamp(phase_of(t) - 1, 0.0, 1.0); },
      [](double t) { return std::abs(t - 3) > 1e-3; });
}

TEST(IntegratorModes, ItFollowsAnInitialValueThatChanges) {
  const Compiled made(R"(c = { type = "constant", value = 0.5 }
u = { type = "ramp" }
x = { type = "integrator", in = ["c"], start = "u", initial = 0.1 })",
                      kTimeline);
  // It lags by the 1e-6 s of its follower.
  expect_form(run_of(made, {.until = 6, .samples = 62}), "x", 2e-6, [](double t) {
    const double cycle = t > 3 ? 3 : 0, phase = t - cycle;
    return phase < 1 ? 0.1 + t : 0.1 + cycle + 1 + 0.5 * std::min(phase - 1, 1.0);
  });
}

TEST(IntegratorModes, ARiseOfSetWorksInEveryMode) {
  const Compiled made(R"(c = { type = "constant", value = 0.5 }
p = { type = "sine-source", frequency = "1/6 Hz", phase = "-2*pi/3" }
x = { type = "integrator", in = ["c"], set = "p", initial = 0.1 })",
                      kTimeline);
  // The sine rises above 0.5 at t = 2.5, in "hold".
  expect_form(run_of(made, {.until = 3, .samples = 32}), "x", kRounding,
              [](double t) { return t > 2.5 ? 0.1 : 0.1 + 0.5 * std::clamp(t - 1, 0.0, 1.0); });
}

}  // namespace
}  // namespace oblique::test
