// SPDX-License-Identifier: MIT
// Switches, and what they set off, against closed forms.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::message_of;
using testing::row_values;
using testing::run_of;
using testing::shipped_blocks_and;

// --- location
// -------------------------------------------------------------------------------------------------------

TEST(Events, RelayOscillatorKeepsItsPeriodOverTwoThousandSwitchings) {
  // x'' = −sign x from x = 1, x' = 0: parabolas of which each quarter takes √2.
  const Compiled made(R"(x = { type = "integrator", in = ["v"], initial = 1 }
v = { type = "integrator", in = ["-s"] }
s = { type = "sign", in = "x" })");
  const double period = 4 * std::sqrt(2.0);
  const auto result = run_of(made, {.until = 1000 * period, .tolerance = 1e-10, .samples = 1001});
  EXPECT_EQ(result.event_count, 2000);
  const auto x = row_values(result, "x");
  // x' = 0 there, so that the phase shows in x': a drift of 1e-6 of the period would be 5.7e-6.
  EXPECT_NEAR(row_values(result, "v").back(), 0, 1e-6 * period);
  EXPECT_NEAR(x.back(), 1, 1e-6);
}

// Within its limits a limiter gives what it reads: the difference is exactly zero for a while, which bounds
// of the two signals do not tell. sin t is above 1/2 from π/6 to 5π/6.
TEST(Events, ADifferenceThatIsZeroForAWhileIsFollowed) {
  const Compiled made(R"toml(
x = { type = "sine-source", frequency = "1/(2*pi)" }
l = { type = "limiter", in = "x", low = -0.5, high = 0.5 }
c = { type = "comparator", in = ["x", "-l"] }
)toml");
  const auto result = run_of(made, {.until = 2.5});
  const auto t = row_values(result, "t"), c = row_values(result, "c");
  for (std::size_t k = 0; k < t.size(); ++k) EXPECT_EQ(c[k], t[k] > std::numbers::pi / 6 ? 1 : 0) << t[k];
}

// c turns over at t = ln 2 and changes no rate, so that the solver goes on with its step; but from then on
// the limiter reads t instead of −t, and meets its limit at t = 2.
TEST(Events, ATurnWithoutEffectOnTheStatesBringsAKnownOneForward) {
  const Compiled made(R"(
one = { type = "constant" }
x = { type = "transfer-lag", in = "one", time_constant = 1, initial = -1 }
c = { type = "comparator", in = "x", low = -1, high = 1 }
r = { type = "ramp", slope = 1 }
p = { type = "multiplier", in = ["c", "r"] }
l = { type = "limiter", in = "p", low = -9, high = 2 }
)");
  const auto result = run_of(made, {.until = 3, .samples = 301});
  const auto t = row_values(result, "t"), l = row_values(result, "l");
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(l[k], t[k] < std::log(2.0) ? -t[k] : std::min(t[k], 2.0), 1e-15) << t[k];  // rounding
}

// max(x, −x) and |x| turn over at one instant, within rounding one after the other: their difference is zero
// before and after, and neither it nor its negative is ever above zero.
TEST(Events, WhatBendsTogetherAtZeroStaysEqual) {
  const Compiled made(R"(
x = { type = "integrator", in = "v" }
v = { type = "integrator", in = "-x", initial = 2 }
m = { type = "maximum", in = ["x", "-x"] }
a = { type = "absolute-value", in = "x" }
c = { type = "comparator", in = ["m", "-a"] }
d = { type = "comparator", in = ["a", "-m"] }
)");
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    const auto result = run_of(made, {.until = 20, .tolerance = tolerance});
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_THAT(row_values(result, "c"), ::testing::Each(0)) << tolerance;
    EXPECT_THAT(row_values(result, "d"), ::testing::Each(0)) << tolerance;
  }
}

// t − 1, 2(t − 1) and −3(t − 1) cross zero at one instant, wherever rounding puts each of them: between the
// comparators there is no moment at which one has turned over and another has not.
TEST(Events, WhatCrossesTogetherTurnsTogether) {
  const Compiled made(R"(
one = { type = "constant", value = 1 }
a = { type = "integrator", in = "one", initial = -1 }
b = { type = "integrator", in = "2*one", initial = -2 }
c = { type = "integrator", in = "-3*one", initial = 3 }
ca = { type = "comparator", in = "a" }
cb = { type = "comparator", in = "b" }
cc = { type = "comparator", in = "c" }
d = { type = "summer", in = ["cb", "-ca"] }
e = { type = "summer", in = ["ca", "cc", "-0.6*one"] }
n = { type = "counter", clock = "d" }
m = { type = "counter", clock = "e" }
)");
  for (double until = 1.5; until < 8; until += 0.25) {
    const auto result = run_of(made, {.until = until});
    EXPECT_EQ(row_values(result, "n.out").back(), 0) << until;
    EXPECT_EQ(row_values(result, "m.out").back(), 0) << until;
    EXPECT_EQ(row_values(result, "ca").back(), 1) << until;
    EXPECT_EQ(row_values(result, "cb").back(), 1) << until;
    EXPECT_EQ(row_values(result, "cc").back(), 0) << until;
  }
}

// Twelve integrators that nothing couples but what feeds them rest at their limits, and leave them at one
// instant, t = 1, as the sine turns its sign.
TEST(Events, ManyThatFollowOneLeaveTheirLimitsTogether) {
  std::string blocks = "u = { type = \"sine-source\", frequency = 0.5 }\n";
  constexpr int kMany = 12;
  for (int k = 0; k < kMany; ++k)
    blocks +=
        fmt::format("x{0} = {{ type = \"integrator\", in = \"{1}*u\", limit = 1.2 }}\n", k, 3 + 0.1 * k);
  const auto result = run_of(Compiled(blocks), {.until = 2, .samples = 101});
  const auto t = row_values(result, "t");
  for (int k = 0; k < kMany; ++k) {
    const auto x = row_values(result, fmt::format("x{}", k));
    for (std::size_t row = 0; row < t.size(); ++row) {
      const double fed = (3 + 0.1 * k) / std::numbers::pi, cosine = std::cos(std::numbers::pi * t[row]);
      const double truth =
          t[row] < 1 ? std::min(1.2, fed * (1 - cosine)) : std::max(-1.2, 1.2 - fed * (1 + cosine));
      EXPECT_NEAR(x[row], truth, 1e-6) << k << " at " << t[row];  // a hundred tolerances
    }
  }
}

// Twenty-four, fed by the sine less a part of their sum, act on each other: too many to be decided
// together.
TEST(Events, TooManyThatActOnEachOtherAreRefusedByNumber) {
  std::string blocks = "s = { type = \"sine-source\", frequency = 0.5 }\n", sum = "\"s\"";
  constexpr int kMany = 24;
  for (int k = 0; k < kMany; ++k) {
    blocks += fmt::format("x{0} = {{ type = \"integrator\", in = \"3*u\", rate = {1}, limit = 1.2 }}\n", k,
                          1 + 0.1 * k);
    sum += fmt::format(", \"-0.004*x{}\"", k);
  }
  blocks += "u = { type = \"summer\", in = [" + sum + "] }\n";
  EXPECT_THAT(message_of<SolveError>([&] { run_of(Compiled(blocks), {.until = 2}); }),
              ::testing::AllOf(
                  HasSubstr(" other switches that act on each other lie on their switching points at t = "),
                  HasSubstr(" s; expected at most 10 at one instant")));
}

// y = sin 9t/cos t changes its sign at every multiple of π/9, and through its pole at π/2, where nothing is
// known of its size: what comes later is seen as ever.
TEST(Events, APoleHidesNoLaterCrossing) {
  const Compiled made(R"toml(
x = { type = "integrator", in = "-v", initial = 1 }
v = { type = "integrator", in = "x" }
u = { type = "time-function", formula = "sin(9*time)" }
y = { type = "divider", numerator = "u", denominator = "x", gain = inf, bandwidth = inf }
s = { type = "sign", in = "y" }
)toml",
                      "[outputs]\ns = { signal = \"s\" }\n");
  const auto result = run_of(made, {.until = 3});
  std::vector<double> times;
  for (const EventRecord& event : result.events) {
    if (event.what.starts_with("s:")) times.push_back(event.time);
  }
  std::vector<double> expected{std::numbers::pi / 2};
  for (int k = 1; k <= 8; ++k) expected.push_back(k * std::numbers::pi / 9);
  std::sort(expected.begin(), expected.end());
  ASSERT_EQ(times.size(), expected.size());
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_NEAR(times[k], expected[k], 1e-6) << k;
  EXPECT_EQ(row_values(result, "s").back(), -1);
}

TEST(Events, TwoCrossingsInsideOneStepAreFound) {
  // cos t rises above 1 − 1e-6 for 2√(2e-6) s at each turn: far shorter than a step.
  const Compiled made(R"(x = { type = "integrator", in = ["y"], initial = 1 }
y = { type = "integrator", in = ["-x"] }
one = { type = "constant" }
d = { type = "summer", in = ["x", "-0.999999*one"] }
s = { type = "sign", in = "d" }
sum = { type = "integrator", in = ["0.5*s", "0.5*one"] })");
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
  const diagram::BlockLibrary library =
      shipped_blocks_and("watch", "check_interval = \"check\"\n" + block + event);
  const std::string rest = "x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n";
  const Compiled careful("w = { type = \"watch\", check = 0.0005 }\n" + rest, "", library);
  EXPECT_EQ(row_values(run_of(careful, {.until = 1, .samples = 3}), "w").back(), 1);
}

// What x is passes its level, which turns a switch block; that sets another integrator, at its limit, to what
// lies beyond that. x itself has not jumped: it has passed its level once, though within its errors it may
// lie on either side there. The block turned twice, and was where it had been before.
TEST(Events, AJumpElsewhereDoesNotLetWhatHasTurnedTurnAgain) {
  const diagram::BlockLibrary library = shipped_blocks_and("swap", R"toml([inputs]
in = {}
[outputs]
out = {}
[memories]
a = 1
b = -0.5
[equations]
out = "a*sin(in) + b*exp(-in^2)"
[[events]]
when = "in > 0.25"
set = { a = "b", b = "a" }
)toml");
  using diagram::IntegrationMethod;
  for (const char* const rate : {"1", "4"}) {
    const Compiled made(fmt::format(R"(q = {{ type = "swap", in = "0.3*x" }}
x = {{ type = "integrator", in = ["-1.85*q", "0.5*x"], rate = 1.25 }}
y = {{ type = "integrator", in = ["-2*q"], start = "2*x", set = "0.85*q", rate = {}, limit = 1.557578125 }}
)",
                                    rate),
                        "", library);
    for (const auto method : {IntegrationMethod::adams, IntegrationMethod::bdf, IntegrationMethod::rodas}) {
      const auto result = run_of(made, {.until = 0.8, .tolerance = 1e-7, .method = method});
      EXPECT_EQ(std::count_if(result.events.begin(), result.events.end(),
                              [](const EventRecord& event) { return event.what == "q"; }),
                1)
          << rate;
      const double in = 0.3 * row_values(result, "x").back();
      EXPECT_NEAR(row_values(result, "q").back(), std::exp(-in * in) - 0.5 * std::sin(in), 1e-12) << rate;
    }
  }
}

TEST(Events, KnownTimesAreMetExactly) {
  const diagram::BlockLibrary library = shipped_blocks_and("pulses", R"([outputs]
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

// What a memory with two levels goes to at the start it was at before: no edge for a counter, a monostable or
// what they are behind. A pulse that begins at the start is one.
TEST(Events, BeforeTheStartAreNoEdgesThere) {
  const Compiled made(R"toml(one = { type = "constant" }
high = { type = "comparator", in = "one", hysteresis = 0.1 }
set = { type = "flip-flop", set = "one" }
pulled = { type = "relay", coil = "high", make = "set.out" }
pulse = { type = "pulse-train", period = 10 }
of_high = { type = "counter", clock = "high" }
of_set = { type = "counter", clock = "set.out" }
of_pulled = { type = "counter", clock = "pulled" }
of_pulse = { type = "counter", clock = "pulse" }
shot = { type = "monostable", trigger = "pulled", length = 0.5 }
)toml");
  const auto run = run_of(made, {.until = 1, .samples = 2});
  EXPECT_EQ(row_values(run, "pulled"), std::vector<double>(2, 1));
  for (const char* const none : {"of_high.out", "of_set.out", "of_pulled.out"})
    EXPECT_EQ(row_values(run, none), std::vector<double>(2, 0)) << none;
  EXPECT_EQ(row_values(run, "shot").front(), 0);
  EXPECT_EQ(row_values(run, "of_pulse.out"), std::vector<double>(2, 1));
}

TEST(Events, SecondaryEventsFollowAtTheSameInstant) {
  // A ripple counter of three stages: the eighth pulse sets all back at once.
  const diagram::BlockLibrary library = shipped_blocks_and("stage", R"([inputs]
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
  const diagram::BlockLibrary library = shipped_blocks_and("take", R"([inputs]
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
  const diagram::BlockLibrary library = shipped_blocks_and(
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

// c jumps from 1 to −1 or back, and a = |c| (or what is 1 above and 1/2 or less below) bends only then: in
// between the root of 0.2 + a, by an ideal amplifier, has no value.
TEST(Events, ALoopIsSolvedOnceTheSwitchesBeforeItStandWhereTheyBelong) {
  for (const char* jumping :
       {R"(c = { type = "sign", in = "u" })", R"(c = { type = "comparator", in = "u", low = -1 })",
        R"(c = { type = "pulse-train", period = 0.7, width = 0.3, low = -1 })",
        R"(c = { type = "function-generator", in = "u", points = [[-1, -1], [0, -1], [0, 1], [1, 1]] })"}) {
    for (const auto& [bending, below] : std::vector<std::pair<const char*, double>>{
             {R"(a = { type = "absolute-value", in = "c" })", 1},
             {R"(a = { type = "limiter", in = "c", low = 0.1, high = 2 })", 0.1},
             {R"(a = { type = "maximum", x = "c", y = "0*one" })", 0},
             {R"(a = { type = "function-generator", in = "c", points = [[-2, 1], [0, 0], [2, 2]] })", 0.5}}) {
      const Compiled made(std::string("u = { type = \"sine-source\", frequency = 0.669, phase = 0.4 }\n") +
                          jumping + "\n" + bending + R"(
one = { type = "constant" }
d = { type = "summer", in = ["0.2*one", "a"] }
q = { type = "square-root", in = "d", gain = "inf", bandwidth = "inf" }
x = { type = "integrator", in = "q" }
)");
      const auto result = run_of(made, {.until = 3, .samples = 101});
      EXPECT_THAT(result.warnings, ::testing::IsEmpty());
      const auto c = row_values(result, "c"), q = row_values(result, "q"), t = row_values(result, "t"),
                 u = row_values(result, "u");
      for (std::size_t row = 0; row < t.size(); ++row) {
        EXPECT_NEAR(q[row], std::sqrt(0.2 + (c[row] > 0 ? 1 : below)), 1e-12)
            << jumping << bending << t[row];  // rounding
        if (std::string_view(jumping).find("pulse") == std::string_view::npos) {
          EXPECT_EQ(c[row] > 0, u[row] > 0) << jumping << bending << t[row];
        }
      }
    }
  }
}

TEST(Events, ALoopWithoutAnAgreeingModeIsRefusedByName) {
  // s = −sign s: neither position agrees with itself.
  const std::string message = message_of<SolveError>([&] {
    run_of(Compiled("n = { type = \"inverter\", in = \"s\" }\ns = { type = \"sign\", in = \"n\" }"),
           {.until = 1});
  });
  EXPECT_THAT(message, HasSubstr("'s' switches without end at t = 0 s (no position of its switch agrees"));
}

// A comparison of what goes through a pole turns over there, and all that comes after it is found: the
// rounding of the pole, which is large, is that of a moment. y = min(−t, −1.7 n/d) at every row, where d
// passes zero each half period of 0.4 s.
TEST(Events, AreFoundAfterAPole) {
  for (const double scale : {1.0, 2.0, 4.0}) {
    const auto result = run_of(Compiled(fmt::format(R"toml(
d = {{ type = "sine-source", amplitude = {0}, frequency = 2.5, phase = 0.375 }}
n = {{ type = "sine-source", amplitude = {0}, frequency = 0.6, phase = 1 }}
q = {{ type = "divider", numerator = "n", denominator = "{1}*d", gain = inf, bandwidth = inf }}
r = {{ type = "ramp", slope = -{0} }}
y = {{ type = "minimum", x = "r", y = "-1.7*q" }}
)toml",
                                                    0.25 * scale, 1 / scale)),
                               {.until = 4, .samples = 401});
    const auto q = row_values(result, "q"), r = row_values(result, "r"), y = row_values(result, "y");
    for (std::size_t row = 0; row < y.size(); ++row)
      EXPECT_DOUBLE_EQ(y[row], std::min(r[row], -1.7 * q[row])) << row << " of scale " << scale;
  }
}

// What drives a limited lag that has come to rest within its limits is nothing but rounding, and nobody reads
// its side there: no event comes of it. (It turned over ever faster, and the run was refused.)
TEST(Events, WhatAnotherConditionMasksDoesNotTurnOver) {
  const auto result = run_of(
      Compiled(
          R"toml(p = { type = "pulse-train", period = 1.5113510035063797e-06, width = 9.60776422381998e-07, delay = 4.406887959473133e-07, high = -0.89 }
lag = { type = "transfer-lag", in = "p", time_constant = 3e-10, gain = 2, limit = 0.8 }
)toml"),
      {.until = 1e-5, .tolerance = 1e-10, .samples = 41, .method = diagram::IntegrationMethod::adams});
  for (const EventRecord& event : result.events) EXPECT_THAT(event.what, ::testing::Not(HasSubstr("drive")));
  // Seven pulses: two edges, each by a comparison and by what it sets, the limit reached, and left.
  EXPECT_LE(result.event_count, 7 * 8);
  // −1.78 is held at −0.8, or has decayed by e^(−1000) and more. Within a hundred tolerances.
  const auto p = row_values(result, "p"), lag = row_values(result, "lag");
  for (std::size_t r = 0; r < lag.size(); ++r) EXPECT_NEAR(lag[r], p[r] < 0 ? -0.8 : 0, 1e-8) << r;
}

// An integrator that a comparator of its own output puts into its initial condition goes back at once, and
// does not stay where in that mode nothing moves it: a saw tooth of 0.3, by a mode line as by `set`,
// whichever side of the level the comparator sees.
TEST(Events, WhatPutsItsOwnSignalBackTurnsOver) {
  for (const char* const comparator : {R"(c = { type = "comparator", in = ["x", "-0.3*one"] })",
                                       R"(less = { type = "comparator", in = ["0.3*one", "-x"], high = -1 }
c = { type = "summer", in = ["one", "less"] })"}) {
    const auto result = run_of(Compiled(std::string(R"toml(one = { type = "constant" }
x = { type = "integrator", in = "one" }
y = { type = "integrator", in = "x" }
)toml") + comparator + "\n",
                                        "[groups]\ng = { blocks = [\"x\"], initial = \"c\" }\n"),
                               {.until = 2, .samples = 201});
    EXPECT_THAT(result.warnings, ::testing::IsEmpty());
    const auto x = row_values(result, "x");
    for (std::size_t r = 0; r < x.size(); ++r) {
      if (r % 30 == 0) continue;  // at the jumps
      EXPECT_NEAR(x[r], 0.01 * static_cast<double>(r % 30), 1e-9) << r;
    }
    EXPECT_NEAR(row_values(result, "y").back(), 6 * 0.045 + 0.02, 1e-9);  // six teeth and two thirds
  }
}

// --- tables
// --------------------------------------------------------------------------------------------------------

TEST(Events, ATableIsFollowedAcrossItsPoints) {
  const diagram::BlockLibrary library =
      shipped_blocks_and("fg",
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

// What stands at t = 0 after its events is what an integrator starts from: a store that tracks, a comparator
// with hysteresis, a relay, a flip-flop and a pulse that begins there.
TEST(Event, AtTheStartIsWhereStatesStartFrom) {
  const auto result = testing::run_of(testing::Compiled(R"toml(one = { type = "constant" }
k = { type = "constant", value = 0.7 }
store = { type = "track-and-store", in = "k", track = "one" }
comparator = { type = "comparator", in = "k", hysteresis = 0.1, high = 0.7 }
relay = { type = "relay", coil = "one", make = "k" }
flip_flop = { type = "flip-flop", set = "k" }
pulse = { type = "pulse-train", high = 0.7, width = 0.4 }
a = { type = "integrator", in = [], start = "store" }
b = { type = "integrator", in = [], start = "comparator" }
c = { type = "integrator", in = [], start = "relay" }
d = { type = "integrator", in = [], start = "0.7*flip_flop.out" }
e = { type = "integrator", in = [], start = "pulse" }
)toml"));
  for (const char* const name : {"a", "b", "c", "d", "e"})
    EXPECT_THAT(testing::row_values(result, name), ::testing::Each(0.7)) << name;
}

// And so does what is brought to rest then: amplifiers, and what has a bandwidth. A chain of two starts, one
// through an amplifier behind the other. To the finite gain of 1e6 of the amplifiers.
TEST(Event, AtTheStartIsWhereAmplifiersHaveComeToRest) {
  const auto result = testing::run_of(testing::Compiled(R"toml(k = { type = "constant", value = 0.64 }
root = { type = "square-root", in = "k" }
quotient = { type = "divider", numerator = "k", denominator = "root" }
summer = { type = "summer", in = "-k", bandwidth = "1 MHz" }
a = { type = "integrator", in = "-a", start = "root" }
b = { type = "integrator", in = [], start = "quotient" }
c = { type = "integrator", in = [], start = "summer" }
again = { type = "square-root", in = "a" }
d = { type = "integrator", in = [], start = "again" }
)toml"));
  using ::testing::DoubleNear;
  using ::testing::Each;
  const auto a = testing::row_values(result, "a");
  EXPECT_NEAR(a.front(), 0.8, 1e-5);
  EXPECT_NEAR(a.back(), 0.8 * std::exp(-1), 1e-5);
  EXPECT_THAT(testing::row_values(result, "b"), Each(DoubleNear(0.8, 1e-5)));
  EXPECT_THAT(testing::row_values(result, "c"), Each(DoubleNear(-0.64, 1e-5)));
  EXPECT_THAT(testing::row_values(result, "d"), Each(DoubleNear(std::sqrt(0.8), 1e-5)));
}

// The initial value of x is the other way round only while the switch stands where it does not belong.
TEST(Event, ASwitchMayCutACircleOfInitialValues) {
  for (const char* const control : {"one", "-one"}) {
    const bool on = control[0] != '-';
    const auto result =
        testing::run_of(testing::Compiled(fmt::format(R"toml(one = {{ type = "constant" }}
less = {{ type = "summer", in = ["x", "-one"] }}
back = {{ type = "electronic-switch", {} = "0.25*one", {} = "less", control = "{}" }}
x = {{ type = "integrator", in = ["0*one"], start = "back" }}
)toml",
                                                      on ? "on" : "off", on ? "off" : "on", control)));
    EXPECT_THAT(testing::row_values(result, "x"), ::testing::Each(0.25)) << control;
  }
}

// A pendulum whose sine comes from a table of 3001 points: a step of Rodas5P passes many of them, one after
// the other, and none at one place. Its energy is kept.
TEST(Events, ManyInAStepAreNotOneThatRepeats) {
  constexpr int kPoints = 3001;
  std::string points;
  for (int k = 0; k < kPoints; ++k) {
    const double x = -1.2 + 2.4 * k / (kPoints - 1);
    points += fmt::format("{}[{:.17g}, {:.17g}]", k == 0 ? "" : ", ", x, std::sin(x));
  }
  const Compiled made(R"(x = { type = "integrator", in = ["v"], initial = 1 }
v = { type = "integrator", in = ["-f"] }
f = { type = "function-generator", in = "x", points = [)" +
                      points + "] }\n");
  const auto result = run_of(
      made, {.until = 3, .tolerance = 1e-6, .samples = 4, .method = diagram::IntegrationMethod::rodas});
  const std::vector<double> x = row_values(result, "x"), v = row_values(result, "v");
  // the table is off by 1e-7, the run by a hundred tolerances at most
  for (std::size_t row = 0; row < x.size(); ++row)
    EXPECT_NEAR(v[row] * v[row] / 2 - std::cos(x[row]), -std::cos(1.0), 1e-4);
}

}  // namespace
}  // namespace oblique::solve
