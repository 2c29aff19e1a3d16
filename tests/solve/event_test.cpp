// SPDX-License-Identifier: MIT
// Switches, and what they set off, against closed forms.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::message_of;
using testing::row_values;
using testing::run_of;
using testing::shipped_blocks_and;

BlockLibrary library_with_sign() {
  return shipped_blocks_and("sgn",
                            "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"sign(in)\"\n");
}

// --- location
// -------------------------------------------------------------------------------------------------------

constexpr const char* kBall = R"toml([outputs]
x = {}
v = {}
impacts = {}
[parameters]
e = { default = 0.9 }
g = { default = 10 }
height = { default = 1 }
[memories]
count = 0
[equations]
"der(x)" = "v"
"der(v)" = "-g"
impacts = "count"
[start]
x = "height"
v = 0
[[events]]
when = "x < 0 and v < 0"
set = { x = 0, v = "-e*v", count = "count + 1" }
)toml";

/// Time of impact k of a ball let fall from height h: the flights shorten by e each time.
double impact_time(int k, double h, double e, double g) {
  const double fall = std::sqrt(2 * h / g);
  double t = fall;
  for (int i = 1; i < k; ++i) t += 2 * fall * std::pow(e, i);
  return t;
}

TEST(Events, BouncingBallMeetsTheTwentiethImpact) {
  const BlockLibrary library = shipped_blocks_and("ball", kBall);
  const Compiled made("b = { type = \"ball\" }", "", library);
  const auto result = run_of(made, {.until = 8.2, .tolerance = 1e-10, .samples = 11});
  ASSERT_GE(result.events.size(), 20U);
  std::vector<double> impacts;
  for (const EventRecord& event : result.events) {
    if (event.what == "b") impacts.push_back(event.time);
  }
  ASSERT_GE(impacts.size(), 20U);
  for (int k = 1; k <= 20; ++k) {  // asked: 1e-8; the tolerance of 1e-10 a flight, over 20 flights
    EXPECT_NEAR(impacts[static_cast<std::size_t>(k) - 1], impact_time(k, 1, 0.9, 10), 1e-8) << k;
  }
}

TEST(Events, BallThatPilesUpIsEndedByName) {
  const BlockLibrary library = shipped_blocks_and("ball", kBall);
  const Compiled made("b = { type = \"ball\", e = 0.5 }", "", library);
  const std::string message = message_of<SolveError>([&] { run_of(made, {.until = 5}); });
  EXPECT_THAT(message, HasSubstr("the events of 'b' come ever faster"));
  // Σ: fall · (1 + 2e/(1 − e)) = √0.2 · 3
  EXPECT_THAT(message, HasSubstr("they pile up at t = 1.3416"));
  EXPECT_THAT(
      message,
      HasSubstr("remedy: end the run before, or tell the block what happens there: 'piling_up' beside "
                "'set' in its [[events]]"));
}

// A block that says what comes after rests there: to what is left of its bounces, 1e-5 of the run, and a
// speed of g times that, half of a flight.
TEST(Events, BallThatPilesUpGoesOverIntoWhatItsBlockSays) {
  std::string resting = kBall;
  resting.replace(resting.find("count = 0\n"), 10, "count = 0\nrests = 0\n");
  resting.replace(resting.find("\"-g\""), 4, "\"if(rests == 1, 0, -g)\"");
  const BlockLibrary library =
      shipped_blocks_and("ball", resting + "piling_up = { x = 0, v = 0, rests = 1 }\n");
  const Compiled made("b = { type = \"ball\", e = 0.5 }", "", library);
  const auto result = run_of(made, {.until = 5, .tolerance = 1e-10, .samples = 501});
  ASSERT_FALSE(result.events.empty());
  EXPECT_EQ(result.events.back().what, "b: its events pile up");
  EXPECT_NEAR(result.events.back().time, std::sqrt(0.2) * 3, 5e-5);
  EXPECT_LT(result.events.back().time, std::sqrt(0.2) * 3);
  const std::size_t last = result.trajectory.rows() - 1;
  EXPECT_EQ(result.trajectory.at(last, 1), 0);
  EXPECT_EQ(result.trajectory.at(last, 2), 0);
  for (std::size_t row = 0; row <= last; ++row) {
    if (result.trajectory.at(row, 0) > std::sqrt(0.2) * 3) {
      EXPECT_EQ(result.trajectory.at(row, 1), 0);
    }
  }
}

// Where each flight is a tenth of the one before, the seventh is within the errors of the height: it rests
// before that.
TEST(Events, BallThatPilesUpQuicklyDoesNotFallThroughTheFloor) {
  std::string resting = kBall;
  resting.replace(resting.find("count = 0\n"), 10, "count = 0\nrests = 0\n");
  resting.replace(resting.find("\"-g\""), 4, "\"if(rests == 1, 0, -g)\"");
  const BlockLibrary library =
      shipped_blocks_and("ball", resting + "piling_up = { x = 0, v = 0, rests = 1 }\n");
  for (const double e : {0.05, 0.1, 0.25, 0.3}) {
    const Compiled made(fmt::format("b = {{ type = \"ball\", e = {} }}", e), "", library);
    for (const double tolerance : {1e-6, 1e-8}) {
      const auto result = run_of(made, {.until = 8, .tolerance = tolerance, .samples = 501});
      const std::size_t last = result.trajectory.rows() - 1;
      double least = 0;
      for (std::size_t row = 0; row <= last; ++row) least = std::min(least, result.trajectory.at(row, 1));
      EXPECT_GE(least, -1e-8) << e << ' ' << tolerance;  // an event is as exact as the height
      EXPECT_EQ(result.trajectory.at(last, 1), 0) << e << ' ' << tolerance;
    }
  }
}

TEST(Events, RelayOscillatorKeepsItsPeriodOverTwoThousandSwitchings) {
  // x'' = −sign x from x = 1, x' = 0: parabolas of which each quarter takes √2.
  const BlockLibrary library = library_with_sign();
  const Compiled made(R"(x = { type = "integrator", in = ["v"], initial = 1 }
v = { type = "integrator", in = ["-s"] }
s = { type = "sgn", in = "x" })",
                      "", library);
  const double period = 4 * std::sqrt(2.0);
  const auto result = run_of(made, {.until = 1000 * period, .tolerance = 1e-10, .samples = 1001});
  EXPECT_EQ(result.event_count, 2000);
  const auto x = row_values(result, "x");
  // x' = 0 there, so that the phase shows in x': a drift of 1e-6 of the period would be 5.7e-6.
  EXPECT_NEAR(row_values(result, "v").back(), 0, 1e-6 * period);
  EXPECT_NEAR(x.back(), 1, 1e-6);
}

TEST(Events, TwoCrossingsInsideOneStepAreFound) {
  // cos t rises above 1 − 1e-6 for 2√(2e-6) s at each turn: far shorter than a step.
  const BlockLibrary library = library_with_sign();
  const Compiled made(R"(x = { type = "integrator", in = ["y"], initial = 1 }
y = { type = "integrator", in = ["-x"] }
one = { type = "constant" }
d = { type = "summer", in = ["x", "-0.999999*one"] }
s = { type = "sgn", in = "d" }
sum = { type = "integrator", in = ["0.5*s", "0.5*one"] })",
                      "", library);
  const auto result = run_of(made, {.until = 60, .tolerance = 1e-10, .samples = 2});
  // Nine turns and the half at the start. One missed turn would be 1 width; the amplitude is good to some
  // 1e-9, of 1e-6.
  const double width = 2 * std::acos(0.999999);
  EXPECT_NEAR(row_values(result, "sum").back(), 9.5 * width, 0.1 * width);
}

TEST(Events, ACheckIntervalFindsWhatASmoothStepHides) {
  // A pulse of 1 ms in an argument that is smooth to the solver: it depends on time alone and enters nothing.
  const std::string block = R"([outputs]
out = {}
[parameters]
check = { default = inf, unit = "s" }
[memories]
seen = 0
[equations]
out = "seen"
)";
  const std::string event =
      "[[events]]\nwhen = \"exp(-((time - 0.537)/0.001)^2) > 0.5\"\nset = { seen = \"seen + 1\" }\n";
  const BlockLibrary library = shipped_blocks_and("watch", "check_interval = \"check\"\n" + block + event);
  const std::string rest = "x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n";
  const Compiled careful("w = { type = \"watch\", check = 0.0005 }\n" + rest, "", library);
  EXPECT_EQ(row_values(run_of(careful, {.until = 1, .samples = 3}), "w").back(), 1);
}

TEST(Events, KnownTimesAreMetExactly) {
  const BlockLibrary library = shipped_blocks_and("pulses", R"([outputs]
out = {}
[memories]
next = 0.1
high = 0
[equations]
out = "high"
[[events]]
when = "time >= next"
set = { next = "next + 0.1", high = "1 - high" }
)");
  const Compiled made("p = { type = \"pulses\" }\nx = { type = \"integrator\", in = [\"p\"] }", "", library);
  const auto result = run_of(made, {.until = 10.05, .samples = 11});
  EXPECT_NEAR(row_values(result, "x").back(), 5, 1e-12);  // half of the time, to rounding
  long served = 0;
  for (const EventRecord& event : result.events) served += event.what == "p" ? 1 : 0;
  EXPECT_EQ(served, 100);
  EXPECT_NEAR(result.events[0].time, 0.1, 1e-15);
}

// --- simultaneous and secondary events
// ------------------------------------------------------------------------------

TEST(Events, SecondaryEventsFollowAtTheSameInstant) {
  // A ripple counter of three stages: the eighth pulse sets all back at once.
  const BlockLibrary library = shipped_blocks_and("stage", R"([inputs]
clock = {}
[outputs]
out = {}
[memories]
q = 0
[equations]
out = "q"
[[events]]
when = "clock < 0.5"
at_start = false
set = { q = "1 - q" }
)");
  const Compiled made(R"(one = { type = "constant" }
phase = { type = "integrator", in = ["one"] }
wave = { type = "sine", in = "phase" }
a = { type = "stage", clock = "wave" }
b = { type = "stage", clock = "a" }
c = { type = "stage", clock = "b" }
)",
                      "", library);
  // sin falls below 0.5 at 5π/6 + 2πk: 7 times until 41, 8 until 47 (8th at 46.6).
  const auto seven = run_of(made, {.until = 41, .samples = 2});
  EXPECT_EQ(
      row_values(seven, "a").back() + 2 * row_values(seven, "b").back() + 4 * row_values(seven, "c").back(),
      7);
  const auto eight = run_of(made, {.until = 47, .samples = 2});
  EXPECT_EQ(row_values(eight, "a").back() + row_values(eight, "b").back() + row_values(eight, "c").back(), 0);
}

TEST(Events, SimultaneousEventsSeeTheValuesBefore) {
  // Two blocks exchange their values when both clocks strike.
  const BlockLibrary library = shipped_blocks_and("take", R"([inputs]
clock = {}
in = {}
[outputs]
out = {}
[parameters]
initial = {}
[memories]
q = "initial"
[equations]
out = "q"
[[events]]
when = "clock > 1"
set = { q = "in" }
)");
  const Compiled made(R"(one = { type = "constant" }
clock = { type = "integrator", in = ["one"] }
a = { type = "take", clock = "clock", in = "b", initial = 3 }
b = { type = "take", clock = "clock", in = "a", initial = 5 })",
                      "", library);
  const auto result = run_of(made, {.until = 2, .samples = 2});
  EXPECT_EQ(row_values(result, "a").back(), 5);
  EXPECT_EQ(row_values(result, "b").back(), 3);
}

// --- algebraic loops with switches
// ------------------------------------------------------------------------------------

TEST(Events, ALoopThroughALimiterIsSolvedInEachOfItsModes) {
  // l = clip(u − 2 l, ±0.2) with u = cos t: l = u/3 within ±0.6, else ±0.2.
  const BlockLibrary library = shipped_blocks_and(
      "lim", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"clip(in, -0.2, 0.2)\"\n");
  const Compiled made(R"(x = { type = "integrator", in = ["y"], initial = 1 }
y = { type = "integrator", in = ["-x"] }
d = { type = "summer", in = ["x", "-2*l"] }
l = { type = "lim", in = "d" })",
                      "", library);
  const auto result = run_of(made, {.until = 12, .samples = 121});
  const auto x = row_values(result, "x"), l = row_values(result, "l");
  for (std::size_t r = 0; r < x.size(); ++r) EXPECT_NEAR(l[r], std::clamp(x[r] / 3, -0.2, 0.2), 1e-14) << r;
}

TEST(Events, ALoopWithoutAnAgreeingModeIsRefusedByName) {
  // s = −sign s: neither position agrees with itself.
  const BlockLibrary library = library_with_sign();
  const std::string message = message_of<SolveError>([&] {
    run_of(
        Compiled("n = { type = \"inverter\", in = \"s\" }\ns = { type = \"sgn\", in = \"n\" }", "", library),
        {.until = 1});
  });
  EXPECT_THAT(message, HasSubstr("'s' switches without end at t = 0 s (no position of its switch agrees"));
}

// --- tables
// --------------------------------------------------------------------------------------------------------

TEST(Events, ATableIsFollowedAcrossItsPoints) {
  const BlockLibrary library = shipped_blocks_and("fg",
                                                  "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout "
                                                  "= \"table(in, -1, 0.5, 0, 0, 0.25, 1, 1, -1)\"\n");
  const Compiled made(R"(x = { type = "integrator", in = ["y"], initial = 1 }
y = { type = "integrator", in = ["-x"] }
x15 = { type = "summer", in = ["1.5*x"] }
f = { type = "fg", in = "x15" })",
                      "", library);
  const auto result = run_of(made, {.until = 20, .samples = 201});
  const auto u = row_values(result, "x15"), f = row_values(result, "f");
  for (std::size_t r = 0; r < u.size(); ++r) {
    const double expected = u[r] < 0 ? -0.5 * u[r] : u[r] < 0.25 ? 4 * u[r] : 1 - 2 * (u[r] - 0.25) / 0.75;
    EXPECT_NEAR(f[r], expected, 1e-12)
        << u[r];  // the segment may be the neighbour's within rounding of a corner
  }
}

}  // namespace
}  // namespace oblique
