// SPDX-License-Identifier: MIT
// comparator, electronic-switch, relay, track-and-store.
#include <algorithm>
#include <cmath>
#include <numbers>

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

/// How often the events of a block came.
long events_of(const solve::Run& result, std::string_view block) {
  return std::count_if(result.events.begin(), result.events.end(),
                       [&](const solve::EventRecord& event) { return event.what == block; });
}

TEST(Comparator, SwitchesOnceAtEachEndOfItsHysteresis) {
  const Compiled made(std::string(kCosineAndSine) +
                      R"(c = { type = "comparator", in = ["cosine"], hysteresis = 0.5, low = -1, high = 3 }
sum = { type = "integrator", in = ["c"] })");
  const auto result = run_of(made, {.until = 2 * std::numbers::pi, .samples = 2});
  EXPECT_EQ(events_of(result, "c"), 3);  // the start, and one at each end
  const double low = 2 * std::numbers::pi - std::acos(0.25) - std::acos(-0.25);
  EXPECT_NEAR(last(result, "sum"), 3 * (2 * std::numbers::pi - low) - low, kIntegrated);
}

TEST(Comparator, BeginsInsideItsHysteresisAsItIsTold) {
  const Compiled made(R"(u = { type = "constant", value = 0.1 }
high = { type = "comparator", in = ["u"], hysteresis = 0.5, initial = 1 }
low  = { type = "comparator", in = ["u"], hysteresis = 0.5 }
sum  = { type = "comparator", in = ["u", "2*u"], hysteresis = 0.5 })");
  const auto result = run_of(made, {.samples = 2});
  EXPECT_EQ(last(result, "high"), 1);
  EXPECT_EQ(last(result, "low"), 0);
  EXPECT_EQ(last(result, "sum"), 1);  // 0.3 is beyond 0.25
}

TEST(Comparator, MakesATriangleGeneratorWithAnIntegrator) {
  // x' = −c between −h/2 and h/2: the period is 2 h.
  const Compiled made(R"(x = { type = "integrator", in = ["-c"] }
c = { type = "comparator", in = ["x"], hysteresis = 0.4, low = -1, high = 1, initial = 1 })");
  const auto result = run_of(made, {.until = 80.1, .samples = 802});
  EXPECT_EQ(events_of(result, "c"), 200);  // at 0.2, and then every 0.4
  const auto triangle = [](double t) {
    const double phase = std::fmod(t, 0.8);
    return phase < 0.2 ? -phase : phase < 0.6 ? phase - 0.4 : 0.8 - phase;
  };
  // Straight lines: what adds up is rounding of 200 switchings, each found to 1e-13.
  expect_form(result, "x", 1e-10, triangle);
}

TEST(Comparator, SlidesWithoutHysteresis) {
  // x' = 0.3 − c holds x = 0 with the mean c = 0.3.
  const Compiled made(R"(one = { type = "constant", value = 0.3 }
x = { type = "integrator", in = ["one", "-c"], initial = 0.35 }
c = { type = "comparator", in = ["x"], low = -1, high = 1 })");
  const auto result = run_of(made, {.until = 2, .samples = 21});
  expect_form(result, "x", 1e-9, [](double t) { return std::max(0.35 - 0.7 * t, 0.0); });
  expect_form_where(
      result, "c", 1e-7, [](double t) { return t < 0.5 ? 1 : 0.3; },
      [](double t) { return std::abs(t - 0.5) > 0.01; });
}

TEST(ElectronicSwitch, PassesOneOfTwo) {
  const Compiled made(R"(u = { type = "ramp" }
a = { type = "ramp", slope = -2 }
b = { type = "constant", value = 0.7 }
s = { type = "electronic-switch", on = "a", off = "b", control = "u", threshold = 0.6 })");
  expect_form_where(
      run_of(made, {.samples = 101}), "s", kRounding, [](double t) { return t > 0.6 ? -2 * t : 0.7; },
      [](double t) { return std::abs(t - 0.6) > 1e-9; });
}

TEST(Relay, PullsInAndDropsOutAtItsLevels) {
  // u rises to 1 and falls again: closed from u = 0.6 on the way up to 0.4 on the way down.
  const Compiled made(R"(up = { type = "ramp", stop = 1 }
down = { type = "ramp", start = 1 }
u = { type = "summer", in = ["up", "-down"] }
a = { type = "constant", value = 0.2 }
b = { type = "constant", value = -0.3 }
r = { type = "relay", coil = "u", make = "a", break = "b" })");
  expect_form(run_of(made, {.until = 2, .samples = 102}), "r", kRounding,
              [](double t) { return t > 0.6 && t < 1.6 ? 0.2 : -0.3; });
}

TEST(Relay, MovesItsContactAfterItsDelayAndNotForAShortPulse) {
  const Compiled made(R"(short = { type = "pulse-train", width = 0.1, delay = 0.2 }
long = { type = "pulse-train", width = 0.4, delay = 0.2 }
one = { type = "constant" }
no = { type = "relay", coil = "short", make = "one", delay = 0.15 }
yes = { type = "relay", coil = "long", make = "one", delay = 0.15 })");
  const auto result = run_of(made, {.until = 3, .samples = 304});
  expect_form(result, "no", 0, [](double) { return 0; });
  expect_form(result, "yes", 0, [](double t) {
    const double phase = t - std::floor(t);
    return phase > 0.35 && phase < 0.75 ? 1 : 0;
  });
}

TEST(TrackAndStore, KeepsTheValueAtTheEndOfTracking) {
  const Compiled made(R"(u = { type = "ramp", slope = 0.3 }
p = { type = "pulse-train", width = 0.25, delay = 0.5 }
s = { type = "track-and-store", in = "u", track = "p", initial = -1 })");
  expect_form_where(
      run_of(made, {.until = 3, .samples = 304}), "s", kRounding,
      [](double t) {
        if (t < 0.5) return -1.0;
        const double phase = t - 0.5 - std::floor(t - 0.5);
        return 0.3 * (phase < 0.25 ? t : t - phase + 0.25);
      },
      [](double t) { return t != 0.5; });
}

TEST(TrackAndStore, InARowShiftsValuesAlong) {
  // b takes over what a has kept when the clock rises; a tracks while b keeps.
  const Compiled made(R"(u = { type = "ramp" }
p = { type = "pulse-train", delay = 1 }
n = { type = "constant" }
q = { type = "summer", in = ["n", "-p"] }
a = { type = "track-and-store", in = "u", track = "q" }
b = { type = "track-and-store", in = "a", track = "p" })");
  const auto result = run_of(made, {.until = 4, .samples = 41});
  // Between n + 0.5 and n + 1 b keeps what a had stored at n.
  expect_form_where(
      result, "b", kRounding, [](double t) { return std::floor(t); },
      [](double t) { return t > 1.01 && std::abs(t - std::round(t)) > 0.01; });
}

TEST(TrackAndStore, AcquiresWithItsTimeConstant) {
  const Compiled made(R"(one = { type = "constant" }
p = { type = "pulse-train", width = 0.3, period = 10, delay = 0.1 }
s = { type = "track-and-store", in = "one", track = "p", acquisition_time = 0.2 })");
  expect_form(run_of(made, {.samples = 101}), "s", kIntegrated,
              [](double t) { return 1 - std::exp(-(std::clamp(t, 0.1, 0.4) - 0.1) / 0.2); });
}

}  // namespace
}  // namespace oblique::test
