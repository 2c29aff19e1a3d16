// SPDX-License-Identifier: MIT
// Sliding along event functions, and chatter, against closed forms.
#include <algorithm>
#include <cmath>

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

TEST(Slides, ARelayWithoutHysteresisSlidesAlongItsSwitchingSurface) {
  // x' = −sign x + 0.5 cos t reaches 0 and stays: Filippov's solution has sign x = 0.5 cos t there.
  const Compiled made(R"(one = { type = "constant" }
phase = { type = "integrator", in = ["one"] }
c = { type = "cosine", in = "phase" }
s = { type = "sign", in = "x" }
x = { type = "integrator", in = ["-s", "0.5*c"], initial = 1 })");
  const auto result = run_of(made, {.until = 6, .samples = 61});
  const auto t = row_values(result, "t"), x = row_values(result, "x"), s = row_values(result, "s");
  for (std::size_t r = 20; r < t.size(); ++r) {
    EXPECT_NEAR(x[r], 0, 1e-9) << t[r];  // entered to 1e-13, held to rounding of the drift
    EXPECT_NEAR(s[r], 0.5 * std::cos(t[r]), 1e-7)
        << t[r];  // the tolerance of the phase, and a difference quotient
  }
  ASSERT_FALSE(result.events.empty());
  bool reported = false;
  for (const EventRecord& event : result.events) reported = reported || event.what == "s: stays at in = 0";
  EXPECT_TRUE(reported);
}

TEST(Slides, AnEventFunctionThatStartsAtItsTurningPointGoesWhereItBends) {
  // x = ±t²/2: its sign is known at once, though neither x nor x' shows it.
  for (const double side : {1.0, -1.0}) {
    const Compiled made(fmt::format(R"(one = {{ type = "constant", value = {} }}
v = {{ type = "integrator", in = ["one"] }}
x = {{ type = "integrator", in = ["v"] }}
s = {{ type = "sign", in = "x" }}
sum = {{ type = "integrator", in = ["s"] }})",
                                    side));
    const auto result = run_of(made, {.until = 1, .samples = 2});
    EXPECT_NEAR(row_values(result, "sum").back(), side,
                1e-12);  // to rounding; found late, it would lack 1e-6
    EXPECT_EQ(result.event_count, 0);
  }
}

TEST(Slides, TwoSwitchesSlideAtOnce) {
  // Each comes to its switching surface at its own time and stays; what both do together is the sum.
  const Compiled made(R"(x = { type = "integrator", in = ["-sx"], initial = 1 }
sx = { type = "sign", in = "x" }
y = { type = "integrator", in = ["-sy", "0.5*one"], initial = 1 }
sy = { type = "sign", in = "y" }
one = { type = "constant" }
z = { type = "integrator", in = ["sx", "sy"] })");
  const auto result = run_of(made, {.until = 3, .samples = 4});
  EXPECT_NEAR(row_values(result, "x").back(), 0, 1e-9);  // the switch is met to rounding, and held
  EXPECT_NEAR(row_values(result, "y").back(), 0, 1e-9);
  EXPECT_NEAR(row_values(result, "sx").back(), 0, 1e-9);
  EXPECT_NEAR(row_values(result, "sy").back(), 0.5, 1e-9);
  // y falls for 2 s. 1 + 2 + 0.5·1
  EXPECT_NEAR(row_values(result, "z").back(), 3.5, 1e-7);  // some tolerances
}

TEST(Slides, CoupledSlidesShareTheirEquation) {
  // Two masses rub on each other and one on the ground: at rest the contacts carry α and β with
  // f = 2 β − α and α = 0.3 (a dry chain, by hand).
  const Compiled made(R"(one = { type = "constant" }
d = { type = "summer", in = ["v1", "-v2"] }
s1 = { type = "sign", in = "d" }
s2 = { type = "sign", in = "v2" }
v1 = { type = "integrator", in = ["0.3*one", "-s1"], initial = 0.2 }
v2 = { type = "integrator", in = ["s1", "-2*s2"], initial = 0.1 })");
  const auto result = run_of(made, {.until = 4, .samples = 5});
  EXPECT_NEAR(row_values(result, "v1").back(), 0, 1e-8);  // some tolerances
  EXPECT_NEAR(row_values(result, "v2").back(), 0, 1e-8);
  EXPECT_NEAR(row_values(result, "s1").back(), 0.3, 1e-7);
  EXPECT_NEAR(row_values(result, "s2").back(), 0.15, 1e-7);
}

// x slides at zero, driven by ±1e7 units a second, and y = −2t. Beside such a rate that of x + y is small,
// yet it does not rest at −0.5 where the limiter begins: whoever shares a signal with a slide is watched.
TEST(Slides, ALimiterBesideAFastSlideLimits) {
  const Compiled made(R"(
one = { type = "constant", value = 1 }
x = { type = "integrator", in = ["0.5*one", "-s"], rate = 1e7, initial = 0.1 }
s = { type = "sign", in = "x" }
y = { type = "integrator", in = "-2*one" }
z = { type = "summer", in = ["x", "y"] }
l = { type = "limiter", in = "z", low = -0.5, high = 5 }
)");
  const auto run = run_of(made, {.until = 1});
  const auto t = row_values(run, "t"), l = row_values(run, "l");
  // the surface of a slide drifts by up to 1e-7
  for (std::size_t k = 1; k < t.size(); ++k) EXPECT_NEAR(l[k], std::max(-2 * t[k], -0.5), 1e-6) << t[k];
}

// x rises to zero and is held there: −2 x − 2 c is −2 on the one side of the surface and 0 on the other, and
// never above it. How far the states drift from the surface does not show.
TEST(Slides, WhatIsAtZeroOnTheSurfaceIsNotAboveItBesideASlide) {
  const Compiled made(R"(
x = { type = "integrator", in = ["0.3*c", "-0.5*x", "-p"], rate = 3.7, initial = -0.125 }
c = { type = "comparator", in = "-1.7*x" }
p = { type = "pulse-train", period = 0.875, width = 0.1328125, delay = 0.625, high = 0.375 }
d = { type = "comparator", in = ["-2*x", "-2*c"], high = 0.75 }
)");
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    const auto result = run_of(made, {.until = 4, .tolerance = tolerance});
    EXPECT_GT(result.event_count, 12);
    EXPECT_THAT(row_values(result, "d"), ::testing::Each(0)) << tolerance;
  }
}

// x' = 1/2 − s slides at zero with s at 1 for three quarters of the time, at −1 for one: f is 2 and 4 there,
// and g(f) 1 and 7, each on its own segment of the points. ∫ f is 2 t until t = 2, and 5/2 t from there on.
TEST(Slides, WhatASlideDoesPassesThroughFunctionGenerators) {
  const Compiled made(R"(half = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["half", "-s"], initial = 1 }
s = { type = "sign", in = "x" }
f = { type = "function-generator", in = "s", points = [[-1, 4], [0, 0], [1, 2]] }
g = { type = "function-generator", in = "f", points = [[0, 0], [2.5, 1.25], [3, 3], [3.5, 6], [4, 7], [5, 0]] }
y = { type = "integrator", in = "f" })");
  const auto result = run_of(made, {.until = 4, .samples = 5});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(row_values(result, "f").back(), 2.5, 1e-9);  // the mixture is known as the states are held
  EXPECT_NEAR(row_values(result, "g").back(), 0.75 * 1 + 0.25 * 7, 1e-9);
  EXPECT_NEAR(row_values(result, "y").back(), 9, 1e-7);  // some tolerances
}

// x' = 1/2 − s slides at zero, above it for three quarters of the time: so is every other multiple of x, and
// every comparison of one shows its part of it.
TEST(Slides, EveryComparisonOfWhatSlidesTakesItsShare) {
  const Compiled made(R"(half = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["half", "-s"], initial = 1 }
s = { type = "sign", in = "x" }
twice = { type = "comparator", in = "2*x" }
back = { type = "comparator", in = "-1.7*x" }
sum = { type = "summer", in = ["x", "0.3*x"] }
both = { type = "comparator", in = ["sum", "-0.1*x"] })");
  const auto result = run_of(made, {.until = 4, .samples = 5});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(row_values(result, "s").back(), 0.5, 1e-9);  // the mixture is known as the states are held
  EXPECT_NEAR(row_values(result, "twice").back(), 0.75, 1e-9);
  EXPECT_NEAR(row_values(result, "back").back(), 0.25, 1e-9);
  EXPECT_NEAR(row_values(result, "both").back(), 0.75, 1e-9);
}

TEST(Slides, WhatASlideDoesPassesThroughASquarer) {
  // x' = 0.2 − u slides at x = 0 with a mean u of 0.2; u² is 1 on both sides, whatever the mean is.
  const Compiled made(R"(one = { type = "constant" }
u = { type = "sign", in = "x" }
x = { type = "integrator", in = ["-u", "0.2*one"], initial = 0.5 }
uu = { type = "squarer", in = "u" }
y = { type = "integrator", in = ["uu"] })");
  const auto result = run_of(made, {.until = 2, .samples = 3});
  EXPECT_NEAR(row_values(result, "u").back(), 0.2, 1e-9);
  EXPECT_NEAR(row_values(result, "uu").back(), 1, 1e-12);  // a mixture of ones
  EXPECT_NEAR(row_values(result, "y").back(), 2, 1e-9);
}

TEST(Slides, PositiveFeedbackMakesAHysteresisOfItsOwn) {
  // m = c/2 − x with c = sign m and x' = c: a triangle of ±0.5 with a period of 2.
  const Compiled made(R"(m = { type = "summer", in = ["-x", "0.5*c"] }
c = { type = "sign", in = "m" }
x = { type = "integrator", in = "c" })");
  const auto result = run_of(made, {.until = 9.75, .samples = 40});
  const auto t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t r = 0; r < t.size(); ++r) {
    const double phase = std::fmod(t[r] + 1.5, 2);  // from −0.5 upwards; it begins at 0, falling
    EXPECT_NEAR(x[r], phase < 1 ? phase - 0.5 : 1.5 - phase, 1e-9) << t[r];
  }
}

TEST(Slides, ASlideOnACurvedSwitchingSurfaceLeadsToTheOrigin) {
  // The double integrator in the least time (Pontryagin): from x = 1 at rest to the origin in 2 s, and there
  // it stays.
  const Compiled made(R"(av = { type = "absolute-value", in = "v" }
vv = { type = "multiplier", in = ["v", "av"] }
h = { type = "summer", in = ["-x", "-0.5*vv"] }
u = { type = "sign", in = "h" }
v = { type = "integrator", in = "u" }
x = { type = "integrator", in = "v", initial = 1 })");
  const auto result = run_of(made, {.until = 3, .samples = 31});
  const auto t = row_values(result, "t"), x = row_values(result, "x"), v = row_values(result, "v");
  for (std::size_t r = 0; r < t.size(); ++r) {
    const double left = std::max(2 - t[r], 0.0);
    EXPECT_NEAR(x[r], t[r] < 1 ? 1 - t[r] * t[r] / 2 : left * left / 2, 1e-7) << t[r];  // ten tolerances
    EXPECT_NEAR(v[r], t[r] < 1 ? -t[r] : -left, 1e-4) << t[r];  // the root of x at the end
  }
}

TEST(Slides, ASlideEndsWhereThePushBecomesTooStrong) {
  // x' = −sign x + 0.8 t: slides until t = 1.25, then x = 0.4 (t − 1.25)².
  const Compiled made(R"(one = { type = "constant" }
ramp = { type = "integrator", in = ["0.8*one"] }
s = { type = "sign", in = "x" }
x = { type = "integrator", in = ["-s", "ramp"], initial = 0.1 })");
  const auto result = run_of(made, {.until = 2.25, .samples = 4});
  EXPECT_NEAR(row_values(result, "x").back(), 0.4, 1e-7);
  EXPECT_EQ(row_values(result, "s").back(), 1);
}

// A block with a Coulomb friction of 1 under a push of (1 + ε) sin ωt sticks but for a hundredth of each
// half-wave, of which there are 32 in the run: it breaks loose where the push is 1, at θ₁ = asin(1/(1 + ε)),
// and stops where its speed ω v = (1 + ε)(cos θ₁ − cos θ) − (θ − θ₁) is zero again, at θ₂
// = 1.599079702426146. The way of a half-wave is the integral of v, here that of all. The slide ends where
// its share is 1e-6 beyond 1, which takes a hundredth of ε and of the way, at most, and by its square root in
// time much less.
TEST(Slides, AShortSlipAtThePeakOfASlowPushIsSeen) {
  constexpr double kEpsilon = 1e-4, kOmega = 1e-4, kStops = 1.599079702426146;
  const double breaks = std::asin(1 / (1 + kEpsilon)), angle = kStops - breaks;
  const double way = ((1 + kEpsilon) * (std::cos(breaks) * angle - (std::sin(kStops) - std::sin(breaks))) -
                      angle * angle / 2) /
                     (kOmega * kOmega);
  const Compiled made(R"toml(
f = { type = "sine-source", frequency = "0.0001/(2*pi)", amplitude = 1.0001 }
s = { type = "sign", in = "v" }
v = { type = "integrator", in = ["f", "-s"] }
a = { type = "absolute-value", in = "v" }
y = { type = "integrator", in = "a" }
)toml");
  EXPECT_NEAR(row_values(run_of(made, {.until = 1e6}), "y").back(), 32 * way, 3e-4 * 32 * way);
}

// A limited integrator comes back as soon as its input turns over: of that nothing is uncertain. x = 1 − cos
// t up to 1 at π/2, stays until π, and then follows −cos t.
TEST(Slides, ALimitedIntegratorThatComesBackIsNotWarnedOf) {
  const Compiled made(R"toml(
f = { type = "sine-source", frequency = "1/(2*pi)" }
x = { type = "integrator", in = "f", limit = 1 }
)toml");
  const auto result = run_of(made, {.until = 4});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(row_values(result, "x").back(), -std::cos(4.0), 1e-7);  // ten tolerances
}

// A function with a jump behind a relay that slides for the time t/4 < 1 goes along on both of its sides: 3
// for the part (1 + t/4)/2 of the time, −2 for the rest. Nothing is kept, so that nothing is to be told.
TEST(Slides, AFunctionWithAJumpBehindThemIsNotWarnedOf) {
  const auto result = run_of(Compiled(R"toml(
g = { type = "ramp", slope = 0.25 }
u = { type = "sign", in = "x" }
x = { type = "integrator", in = ["g", "-u"] }
h = { type = "function-generator", in = "u", points = [[-2, -2], [0.5, -2], [0.5, 3], [2, 3]] }
y = { type = "integrator", in = "h" }
)toml"),
                             {.until = 4});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_NEAR(row_values(result, "y").back(), 3 * 3 - 2 * 1, 1e-7);
}

/// One bit of memory that conditions on `in` set and clear.
diagram::BlockLibrary library_with_bit(const std::string& set, const std::string& clear) {
  return shipped_blocks_and(
      "bit",
      "[inputs]\nin = {}\n[outputs]\nout = {}\n[memories]\nq = 0\n[equations]\nout = \"q\"\n"
      "[[events]]\nwhen = \"" +
          set + "\"\nset = { q = 1 }\n[[events]]\nwhen = \"" + clear + "\"\nset = { q = 0 }\n");
}

TEST(Slides, ADiscreteStateThatUndoesItselfChatters) {
  const diagram::BlockLibrary library = library_with_bit("in > 0", "in < 0");
  const Compiled made(R"(one = { type = "constant" }
f = { type = "bit", in = "x" }
x = { type = "integrator", in = ["0.5*one", "-f"], initial = -1 })",
                      "", library);
  const std::string message = message_of<SolveError>([&] { run_of(made, {.until = 6}); });
  EXPECT_THAT(message, HasSubstr("'f' switches without end at t = 2"));
}

// x′ = −4 x − 8 c, where c is 0.4375 above zero and −0.2625 below it, and so is what it compares by the jump
// of the table: both take 0.375 = 0.2625/(0.4375 + 0.2625) of the time, also where a phase begins anew in the
// slide.
TEST(Slides, AJumpThatTakesAComparatorAlongSlidesWithIt) {
  for (const double tolerance : {1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    const Compiled made(
        "table = { type = \"function-generator\", in = \"x\", points = [[-1, 0], [0, 0], [0, 0.16], [1, "
        "0.16]] }\n"
        "c = { type = \"comparator\", in = [\"2*x\", \"table\"], low = -0.2625, high = 0.4375 }\n"
        "x = { type = \"transfer-lag\", in = \"c\", time_constant = 0.25, gain = -2, initial = 0.7 }\n",
        "[timeline]\nphases = [{ mode = \"hold\", for = 1.375 }]\ncycles = 2\n");
    const auto result = run_of(made, {.until = 4, .tolerance = tolerance, .samples = 5});
    for (const double t : {2.0, 3.0, 4.0}) {
      EXPECT_NEAR(row_values(result, "table")[static_cast<std::size_t>(t)], 0.06, 1e-7) << tolerance;
      EXPECT_NEAR(row_values(result, "x")[static_cast<std::size_t>(t)], 0, 1e-7)
          << tolerance;  // as it drifts
    }
  }
}

TEST(Slides, EventsThatSetEachOtherOffAreEndedByName) {
  const diagram::BlockLibrary library = library_with_bit("in < 0.5", "in > 0.5");
  const std::string message = message_of<SolveError>(
      [&] { run_of(Compiled("a = { type = \"bit\", in = \"a\" }", "", library), {.until = 1}); });
  EXPECT_THAT(message, HasSubstr("switches without end at t = 0"));
}

// x slides along zero, and c is high two fifths of the time: an integrator in hold for that long has the mean
// slope, but one that c puts back to its initial value at once would never leave it, which is told.
TEST(Slide, OfAModeLineIsToldOfWhereItResets) {
  for (const char* const line : {"hold", "initial"}) {
    const auto result = testing::run_of(
        testing::Compiled(R"toml(one = { type = "constant" }
c = { type = "comparator", in = "x" }
x = { type = "integrator", in = ["0.4*one", "-c"], initial = 0.3 }
y = { type = "integrator", in = ["one"] }
)toml",
                          fmt::format("[groups]\ng = {{ blocks = [\"y\"], {} = \"c\" }}\n", line)),
        {.until = 2});
    if (std::string_view(line) == "hold") {
      EXPECT_THAT(result.warnings, ::testing::IsEmpty());
      EXPECT_NEAR(testing::row_values(result, "y").back(), 0.6 * 1.5, 1e-6);
    } else {
      ASSERT_EQ(result.warnings.size(), 1U);
      EXPECT_THAT(
          result.warnings[0].what,
          ::testing::StartsWith("'group g' (c > 0.5) depends on 'c', which slides along its switching "
                                "surface from t = 0.5"));
    }
  }
}

// A motor that is held at 0.3: beyond it what a real switch makes of that is never left alone.
TEST(Slide, OfWhatSetsOffAnEventItselfIsToldOf) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("motor", R"toml(
[outputs]
v = { doc = "Speed." }
n = { doc = "It has been above." }
[memories]
k = 0
[equations]
n = "k"
"der(v)" = "sign(0.3 - v)"
[start]
v = 0
[[events]]
when = "v > 0.3"
set = { k = 1 }
)toml");
  const auto result = run_of(Compiled("m = { type = \"motor\" }", "", library), {.until = 1});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(
      result.warnings[0].what,
      "'m' (v > 0.3) slides along its switching surface from t = 0.3 s: it switches without end, which is "
      "not counted and not stored");
  EXPECT_EQ(result.warnings[0].remedy, "give the switch that slides a hysteresis");
}

// y comes to the level 0 at 0.714 s, which |x| makes, and x slides at its corner: what y is compared with
// turns over on one side at once and on the other back.
TEST(Slide, OfWhatLiesAtItsLevelOnOneSideAloneIsRefused) {
  const std::string message = message_of<SolveError>([] {
    run_of(Compiled(R"toml(one = { type = "constant" }
c = { type = "sign", in = "x" }
a = { type = "absolute-value", in = "x" }
d = { type = "comparator", in = ["a", "y"], low = -1 }
x = { type = "integrator", in = ["-c", "0.3*one"], initial = 0.5 }
y = { type = "integrator", in = ["-d"], initial = -0.2 }
)toml"),
           {.until = 2});
  });
  EXPECT_THAT(message, HasSubstr("'d' switches without end at t = 0.714"));
  EXPECT_THAT(
      message,
      HasSubstr("(in > 0, which depends on 'c', which slides along its switching surface)\n  remedy: give "
                "the switch a hysteresis"));
}

/// Two relays that hold integrators at zero against 0.3, so that each is up for 0.65 of the time, and what q
/// integrates of them.
Compiled two_held(const std::string& together) {
  return Compiled(R"toml(one = { type = "constant" }
a = { type = "integrator", in = ["-ra", "0.3*one"], initial = 0.5 }
b = { type = "integrator", in = ["-rb", "0.3*one"], initial = 0.4 }
ra = { type = "sign", in = "a" }
rb = { type = "sign", in = "b" }
)toml" + together);
}

// Of a product nothing says with which share of the time both are up: that is told. As independent they give
// 0.3², to the tolerance from where both slide.
TEST(Slides, ThatActTogetherOtherwiseThanEachAreTold) {
  const auto result = run_of(two_held(R"toml(p = { type = "multiplier", in = ["ra", "rb"] }
q = { type = "integrator", in = "p" }
)toml"),
                             {.until = 4, .extra_times = {1, 3}});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(
      result.warnings[0].what,
      "'ra' (in > 0) slides along its switching surface together with 'rb' from t = 0.714285714 s on, and "
      "what follows depends on how the turns of the one fall in with those of the other: they are taken as "
      "independent");
  EXPECT_EQ(result.warnings[0].remedy,
            "give the comparisons a hysteresis, so that the diagram says when they turn over");
  const auto q = testing::column_of(result.extra, "q");
  EXPECT_NEAR(q[1] - q[0], 2 * 0.09, 1e-6);
}

TEST(Slides, ThatAreAddedAreNoneOfThese) {
  const auto result =
      run_of(two_held("q = { type = \"integrator\", in = [\"ra\", \"rb\"] }\n"), {.until = 4});
  EXPECT_THAT(result.warnings, ::testing::IsEmpty());
}

// The counter reads the second relay, and the first has nothing to do with it.
TEST(Slides, AreNamedWhereSomethingDependsOnThem) {
  const auto result = run_of(two_held("n = { type = \"counter\", clock = \"rb\" }\n"), {.until = 2});
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_THAT(result.warnings[0].what, HasSubstr("depends on 'rb', which slides"));
}

// Two coupled relays, and a clock that sets an integrator 20 times beside them: what slides is entered and
// left as often as without it.
TEST(Slides, GoOnBesideEventsThatDoNotConcernThem) {
  const std::string slides = R"toml(f1 = { type = "time-function", formula = "1.2*sin(time)" }
f2 = { type = "time-function", formula = "cos(1.3*time)" }
x = { type = "integrator", in = ["-2*x", "-0.5*y", "f1", "-0.5*sx"], initial = 0.5 }
y = { type = "integrator", in = ["-0.5*x", "-1.5*y", "f2", "-0.5*sy"], initial = -0.3 }
sx = { type = "sign", in = "x" }
sy = { type = "sign", in = "y" }
)toml";
  const std::string clock = R"toml(s = { type = "pulse-train", period = 0.3, width = 0.15, delay = 0.0581395 }
q = { type = "integrator", in = "s", set = "s" }
)toml";
  const auto turns_of = [](const oblique::solve::Run& result) {
    return std::count_if(result.events.begin(), result.events.end(), [](const EventRecord& event) {
      return event.what.starts_with("sx") || event.what.starts_with("sy");
    });
  };
  const auto alone = run_of(Compiled(slides), {.until = 6}),
             beside = run_of(Compiled(slides + clock), {.until = 6});
  EXPECT_GT(turns_of(alone), 4);
  EXPECT_EQ(turns_of(alone), turns_of(beside));
  EXPECT_GT(beside.events.size(), alone.events.size() + 20);
  EXPECT_THAT(beside.warnings, ::testing::IsEmpty());
}

// What reads the comparator that slides is a second one, and a backlash beside them has a small event
// function that is looked at with its errors damped: not the slide with them. x' = −3 x + (1 above 0.5, 2
// below) comes to 0.5 after ln 2.2/3, and 1.5 on the average keeps it there. (It was read as 0.42.)
TEST(Slides, AreReadAsTheyAreBesideWhatIsFast) {
  using diagram::IntegrationMethod;
  for (const auto method : {IntegrationMethod::rodas, IntegrationMethod::bdf, IntegrationMethod::adams}) {
    const auto result = run_of(Compiled(R"toml(one = { type = "constant" }
first = { type = "comparator", low = 1, high = 0, in = ["x", "-0.5*one"] }
second = { type = "comparator", low = 1, high = 2, in = ["first", "-0.1*one"] }
x = { type = "integrator", initial = 0.7, in = ["-3*x", "second"] }
p = { type = "pulse-train", period = 0.5, width = 0.05, delay = 0.1 }
y = { type = "backlash", play = 0.2, rate = 1000, in = "p" }
)toml"),
                               {.samples = 101, .method = method});
    const auto x = row_values(result, "x");
    const double arrives = std::log(11.0 / 5) / 3;
    for (std::size_t r = 0; r < x.size(); ++r) {
      const double t = 0.01 * static_cast<double>(r);
      const double truth = t < arrives ? 1.0 / 3 + (0.7 - 1.0 / 3) * std::exp(-3 * t) : 0.5;
      EXPECT_NEAR(x[r], truth, 1e-6) << t;  // a hundred tolerances
    }
  }
}

// A pulse that begins with the run, or a flip-flop that is set then, takes x at once from the level on which
// it would slide without: x' = 2 p − sign x rises by 1, falls back and stays.
TEST(Slides, MayEndWhereTheRunBegins) {
  const auto pulsed = run_of(Compiled(R"toml(p = { type = "pulse-train", width = 0.4 }
s = { type = "sign", in = "x" }
x = { type = "integrator", in = ["2*p", "-s"] }
)toml"),
                             {.until = 2, .samples = 41});
  const auto x = row_values(pulsed, "x");
  for (std::size_t r = 0; r < x.size(); ++r) {
    const double t = 0.05 * static_cast<double>(r % 20);
    EXPECT_NEAR(x[r], t <= 0.4 ? t : std::max(0.8 - t, 0.0), 1e-12) << r;  // straight lines
  }
  const auto set = run_of(Compiled(R"toml(one = { type = "constant" }
f = { type = "flip-flop", set = "one" }
s = { type = "sign", in = "x" }
x = { type = "integrator", in = ["2*f.out", "-s"] }
)toml"));
  EXPECT_NEAR(row_values(set, "x").back(), 1, 1e-12);
}

// At the level no comparison holds, and nothing moves; beyond it x' = |y| would. Settling the start went from
// the one to the other and back.
TEST(Slides, DoNotMoveWhatRestsAtItsLevelWhereTheRunBegins) {
  const auto result = run_of(Compiled(R"toml(zero = { type = "constant", value = 0 }
y = { type = "integrator", initial = 0.5, in = "-2*y" }
s = { type = "electronic-switch", on = "y", off = "zero", control = "x", threshold = 0 }
magnitude = { type = "absolute-value", in = "s" }
x = { type = "integrator", in = "magnitude" }
)toml"));
  EXPECT_THAT(row_values(result, "x"), ::testing::Each(0.0));
}

// What r compares is x below its level and x/5 above it, as r lets x through or not: at x = 0 it bends, and x
// slides there all the same, with the mean of r for which x' = −1 − 2 r is zero. (The rates of x and x/5 were
// mixed, and x left.)
TEST(Slides, StayWhereWhatIsComparedBendsByWhatFollows) {
  const auto result = run_of(Compiled(R"toml(one = { type = "constant" }
r = { type = "comparator", in = ["0.2*x", "through"], low = -1, high = 1 }
through = { type = "electronic-switch", off = "0.8*x", control = "r" }
x = { type = "integrator", in = ["-one", "-2*r"], initial = 0.5 }
i = { type = "integrator", in = "r" }
)toml"),
                             {.samples = 61});
  const auto x = row_values(result, "x"), i = row_values(result, "i"), r = row_values(result, "r");
  const double arrives = 1.0 / 6;
  for (std::size_t row = 0; row < x.size(); ++row) {
    const double t = static_cast<double>(row) / 60;
    EXPECT_NEAR(x[row], t < arrives ? 0.5 - 3 * t : 0, 1e-9) << t;  // straight lines
    EXPECT_NEAR(i[row], t < arrives ? t : arrives - (t - arrives) / 2, 1e-9) << t;
    if (t > arrives + 0.01) {
      EXPECT_NEAR(r[row], -0.5, 1e-9) << t;
    }
  }
}

// Where it jumps by what follows it is no surface to slide on: as a comparator with hysteresis it goes to and
// fro, between x = −0.5 and x = 0.5, at ∓3 and 1.
TEST(Slides, EndWhereWhatIsComparedJumpsByWhatFollows) {
  const auto result = run_of(Compiled(R"toml(one = { type = "constant" }
r = { type = "comparator", in = ["x", "back"], low = -1, high = 1 }
back = { type = "electronic-switch", on = "0.5*one", off = "-0.5*one", control = "r" }
x = { type = "integrator", in = ["-one", "-2*r"], initial = 0.5 }
)toml"),
                             {.until = 4, .samples = 401});
  const auto x = row_values(result, "x");
  for (std::size_t row = 0; row < x.size(); ++row) {
    const double phase = std::fmod(0.01 * static_cast<double>(row), 4.0 / 3);
    EXPECT_NEAR(x[row], phase < 1.0 / 3 ? 0.5 - 3 * phase : -0.5 + phase - 1.0 / 3, 1e-9) << row;
  }
  EXPECT_THAT(result.warnings, ::testing::IsEmpty());
}

}  // namespace
}  // namespace oblique::solve
