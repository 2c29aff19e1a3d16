// SPDX-License-Identifier: MIT
// Where switching surfaces are left that are slid along, or rested on.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::column_of;
using testing::Compiled;
using testing::row_values;
using testing::run_of;

// dx/dt = −sign((0.5 − t) x) reaches x = 0 at t = 0.1 and is driven to it until t = 0.5, then away: x = ±(t −
// 0.5).
TEST(Slide, IsLeftWhereBothSidesBeginToDriveAway) {
  const Compiled made(R"toml(
g = { type = "ramp", slope = -1, initial = 0.5 }
p = { type = "multiplier", in = ["g", "x"] }
c = { type = "sign", in = "-p" }
x = { type = "integrator", in = ["c"], initial = 0.1 }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 2, .samples = 41});  // one row at t = 0.5 itself
  const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t row = 0; row < t.size(); ++row) {
    const double truth = t[row] < 0.1 ? 0.1 - t[row] : std::max(t[row] - 0.5, 0.0);
    // Left where the sides drive apart by 1e-6 of what they drove together.
    EXPECT_NEAR(std::abs(x[row]), truth, 1e-6) << t[row];
  }
  ASSERT_EQ(result.warnings.size(), 1u);
  // It is told where the drive is below 1e-6 of what it was.
  double told = 0;
  ASSERT_EQ(std::sscanf(result.warnings.front().what.c_str(),
                        "'c' (in > 0) leaves the switching surface that it slides along at t = %lf s", &told),
            1);
  EXPECT_NEAR(told, 0.5, 1e-6);
  EXPECT_THAT(
      result.warnings.front().what,
      ::testing::EndsWith(" s, since both of its sides drive away from it from then on: rounding decides to "
                          "which side it goes"));
  EXPECT_EQ(result.warnings.front().remedy,
            "end the run before, or add the disturbance that decides it on the machine");
}

// dx/dt = t − 0.5 where x > 0, else 0: x falls from 0.1 to the switching surface and stays there. From t =
// 0.5 on its upper side drives away while below nothing moves: x = 0 and x = (t − 0.5)²/2 are both solutions.
TEST(Slide, IsToldOfWhereOneSideDrivesAwayAndTheOtherRests) {
  const Compiled made(R"toml(
g = { type = "ramp", slope = 1, initial = -0.5 }
s = { type = "electronic-switch", on = "g", control = "x", threshold = 0 }
x = { type = "integrator", in = ["s"], initial = 0.1 }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 2, .samples = 41});
  const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x");
  const double arrives = 0.5 - std::sqrt(0.05);
  for (std::size_t row = 0; row < t.size(); ++row) {
    const double parabola = (t[row] - 0.5) * (t[row] - 0.5) / 2;
    const double truth = t[row] < arrives ? 0.1 - 0.125 + parabola : t[row] < 0.5 ? 0 : parabola;
    // It is left where its upper side drives by 1e-6 of what it did, so 1e-6 · 0.5 s late at the most.
    EXPECT_NEAR(x[row], truth, 1e-6) << t[row];
  }
  ASSERT_EQ(result.warnings.size(), 1u);
  double told = 0;
  ASSERT_EQ(
      std::sscanf(result.warnings.front().what.c_str(),
                  "'s' (control > threshold) leaves the switching surface that it slides along at t = %lf s",
                  &told),
      1);
  EXPECT_NEAR(told, 0.5, 1e-6);
  EXPECT_THAT(
      result.warnings.front().what,
      ::testing::EndsWith(" s, since one of its sides drives away from it from then on, and on the other "
                          "nothing moves it: it could as well stay"));
  EXPECT_EQ(result.warnings.front().remedy, "give the comparison a hysteresis");
}

// With g = t − 0.5, dx/dt = −1 − g where −g x > 0, else −g. Before t = 0.5 both drive to x = 0, with the
// share −g; then g changes its sign, and the side below drives away: x = −(t − 0.5) − (t − 0.5)²/2. What is
// compared is nothing but a product with g there, so that a level of ε instead of 0 moves the end by the root
// of ε.
TEST(Slide, IsToldOfWhereWhatItComparesFades) {
  const Compiled made(R"toml(
one = { type = "constant" }
g = { type = "ramp", slope = 1, initial = -0.5 }
p = { type = "multiplier", in = ["-g", "x"] }
s = { type = "electronic-switch", on = "one", control = "p", threshold = 0 }
x = { type = "integrator", in = ["-s", "-g"], initial = 0.1 }
)toml");
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                            diagram::IntegrationMethod::rodas}) {
    const oblique::solve::Run result = run_of(made, {.until = 2, .samples = 21, .method = method});
    const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x");
    for (std::size_t row = 0; row < t.size(); ++row) {
      const double since = t[row] - 0.5;
      if (since < 0) continue;
      // Told of within 1e-4 of the firmest grip, g = 0.5; it moves by 1 a second, and then by up to 2.5.
      EXPECT_NEAR(x[row], -since - since * since / 2, 2.5 * 5e-5) << t[row];
    }
    ASSERT_GE(result.warnings.size(), 1u);
    EXPECT_THAT(
        result.warnings.front().what,
        ::testing::StartsWith("'s' (control > threshold) leaves the switching surface that it slides along "
                              "at t = 0."));
    EXPECT_THAT(
        result.warnings.front().what,
        ::testing::EndsWith(" s, where what it switches hardly moves what it compares any more: when it "
                            "leaves is known only roughly"));
    EXPECT_EQ(result.warnings.front().remedy,
              "end the run before, or compare what the switch moves all along");
  }
}

// dx/dt = sign(x) from x = 0 is ±t as well as 0: what comes out is a solution, and it is told that it is not
// the only one. From beside it, where it is crossed, and where it is driven to, nothing is told.
TEST(Switches, OnASwitchingSurfaceThatBothSidesLeaveAreToldOf) {
  const auto made = [](double initial, const std::string& in) {
    return Compiled(
        fmt::format("c = {{ type = \"sign\", in = \"x\" }}\none = {{ type = \"constant\" }}\n"
                    "x = {{ type = \"integrator\", in = [{}], initial = {} }}\n",
                    in, initial));
  };
  const oblique::solve::Run result = run_of(made(0, "\"c\""), {.until = 2, .samples = 3});
  EXPECT_NEAR(std::abs(row_values(result, "x").back()), 2,
              1e-9);  // a straight line, to rounding of the steps
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings.front().what,
            "'c' (in > 0) stands on its switching surface at t = 0 s, and both of its sides drive away from "
            "it: nothing "
            "decides to which side it goes");
  EXPECT_EQ(
      result.warnings.front().remedy,
      "begin a little to the side that is meant, or add the disturbance that decides it on the machine");
  EXPECT_TRUE(run_of(made(0.01, "\"c\"")).warnings.empty());
  EXPECT_TRUE(run_of(made(0, "\"c\", \"2*one\"")).warnings.empty());
  EXPECT_TRUE(run_of(made(-0.5, "\"0.5*c\", \"one\"")).warnings.empty());
  EXPECT_TRUE(run_of(made(0, "\"-c\"")).warnings.empty());
}

// Two switches lie on their switching surfaces at the start. Only that of the absolute value moves off, so
// only it may turn.
TEST(Switches, StayWhereTheyAreOnASwitchingSurfaceThatRests) {
  const std::string rest = "r = { type = \"integrator\", in = \"-r\" }\n";
  const std::string sign = "s = { type = \"sign\", in = \"r\" }\n";
  const std::string magnitude = "m = { type = \"absolute-value\", in = \"x\" }\n";
  const std::string moving = "x = { type = \"integrator\", in = [\"-0.5*s\", \"-x\"] }\n";
  for (const std::string& blocks : {rest + sign + magnitude + moving, moving + magnitude + sign + rest}) {
    const Compiled made(blocks);
    const oblique::solve::Run result = run_of(made, {.samples = 11});
    EXPECT_EQ(row_values(result, "s"), std::vector<double>(11, -1)) << blocks;
    EXPECT_NEAR(row_values(result, "x").back(), 0.5 * (1 - std::exp(-1)), 1e-7);  // ten tolerances
  }
}

// Two real amplifiers at their limits at once: whichever comes first stays there when the other one comes,
// and when that one leaves. Between −x and y alone the limits differ, so that they come and leave one after
// the other.
TEST(Slide, KeepsTheLimitOfOneAmplifierWhileAnotherComesToItsOwn) {
  const std::string source = "u = { type = \"sine-source\", frequency = 0.2, phase = 1.5707963267948966 }\n";
  const std::string x =
      "x = { type = \"integrator\", in = [\"u\"], limit = 0.5, gain = 1e4, bandwidth = 1e4 }\n";
  const std::string y =
      "y = { type = \"integrator\", in = [\"-0.9*u\"], limit = 0.6, gain = 1e4, bandwidth = 1e4 }\n";
  for (const std::string& blocks : {source + x + y, source + y + x, y + x + source}) {
    const oblique::solve::Run result = run_of(Compiled(blocks), {.until = 4, .samples = 401});
    const std::vector<double> at_x = row_values(result, "x"), at_y = row_values(result, "y");
    double most_x = 0, most_y = 0;
    for (std::size_t row = 0; row < at_x.size(); ++row) {
      most_x = std::max(most_x, std::abs(at_x[row]));
      most_y = std::max(most_y, std::abs(at_y[row]));
    }
    // The limit is that of the capacitor, whose voltage is greater by one part in the gain; a slide may drift
    // by 1e-7.
    EXPECT_NEAR(most_x, 0.5 / (1 + 1e-4), 2e-7) << blocks;
    EXPECT_NEAR(most_y, 0.6 / (1 + 1e-4), 2e-7) << blocks;
  }
}

// x rests at 0, on the switching surface of c, where c is low; with c high the amplifier would drive it down.
// What rounding leaves of its rate decides nothing, whatever the unit of x.
TEST(Switches, StayWhereTheyAreWhereAllIsAtRest) {
  for (const double unit : {0.5, 1.0, 2.0, 4.0}) {
    const Compiled made(fmt::format(R"toml(
p = {{ type = "multiplier", x = "-2*a", y = "{0}*a" }}
x = {{ type = "integrator", in = ["0.3*p", "-0.5*a"], rate = 0.875 }}
a = {{ type = "servo-amplifier", in = ["0.3*p", "{1}*c", "x", "a"], gain = 3373.125, bandwidth = 6, initial = {2} }}
c = {{ type = "comparator", in = ["x"], high = 0.5 }}
)toml",
                                    0.3 / unit, -0.5 * unit, 0.875 * unit));
    const oblique::solve::Run result = run_of(made, {.until = 5, .samples = 11});
    for (const double x : row_values(result, "x"))
      EXPECT_NEAR(x, 0, 1e-12) << unit;  // rounding that grows e-fold
    EXPECT_EQ(row_values(result, "c"), std::vector<double>(11, 0)) << unit;
  }
}

// x slides along 0 from t = 1/6 on, where the mean of c is −1/2. A run that goes on from there slides on at
// once.
TEST(Slide, GoesOnWhereARunGoesOn) {
  const Compiled made(R"toml(
one = { type = "constant" }
x = { type = "integrator", in = ["0.5*one", "c"], initial = -0.25 }
c = { type = "sign", in = "-x" }
)toml");
  RunOptions options;
  options.until = 1;
  options.samples = 11;
  const oblique::solve::Run first = run(made.program, made.flat, options);
  options.from = first.state;
  options.from->states.front().second += 1e-9;  // by which a slide may have drifted
  options.until = 2;
  const oblique::solve::Run second = run(made.program, made.flat, options);
  for (const double mean : row_values(second, "c")) EXPECT_NEAR(mean, -0.5, 1e-6);
}

// x = t up to its limit of 0.5, is put back to 0 at t = 1, and rises again: nothing that happens on the way,
// as the turn of a sign at t = 1.2, may take it for a limited one.
TEST(Slide, IsOverWhereAnEventTakesTheStateElsewhere) {
  const oblique::solve::Run result = run_of(Compiled(R"toml(
one = { type = "constant" }
back = { type = "pulse-train", period = 10, width = 0.1, delay = 1, low = 0, high = 1 }
x = { type = "integrator", in = ["one"], set = "back", limit = 0.5 }
clock = { type = "integrator", in = ["one"], initial = -1.2 }
c = { type = "sign", in = "clock" }
)toml"),
                                            {.until = 2, .samples = 21});
  const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t row = 0; row < t.size(); ++row) {
    if (t[row] == 1) continue;                                                             // there it jumps
    EXPECT_NEAR(x[row], std::min(0.5, t[row] < 1 ? t[row] : t[row] - 1), 1e-7) << t[row];  // ten tolerances
  }
}

// At its limit of 0.5 an integrator of sin t + 0.35 stays until that falls below zero, at t = π + arcsin
// 0.35, and then goes down: from both sides, so that nothing is open there.
TEST(Slide, IsLeftInSilenceByALimitedIntegrator) {
  const Compiled made(R"toml(
f = { type = "time-function", formula = "sin(time) + 0.35" }
a = { type = "integrator", in = "f", limit = 0.5 }
b = { type = "integrator", in = "a", limit = 0.8 }
c = { type = "integrator", in = "b", limit = 1.1 }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 8, .samples = 81});
  EXPECT_THAT(result.warnings, ::testing::IsEmpty());
  const double leaves = std::numbers::pi + std::asin(0.35);
  const std::vector<double> t = row_values(result, "t"), a = row_values(result, "a");
  for (std::size_t row = 0; row < t.size(); ++row) {
    if (t[row] < leaves || t[row] > 5) continue;
    const double truth = 0.5 + std::cos(leaves) - std::cos(t[row]) + 0.35 * (t[row] - leaves);
    EXPECT_NEAR(a[row], truth, 1e-6) << t[row];
  }
}

// An integrator rests at its limit, and a comparator compares it with that very limit, or with one beside it.
TEST(Slide, IsToldOfWhereALevelIsReadAtWhichALimitHoldsSomething) {
  const auto warnings = [](const char* level) {
    std::vector<std::string> texts;
    const Compiled made(std::string("one = { type = \"constant\", value = 1 }\n"
                                    "x = { type = \"integrator\", in = \"one\", limit = 1 }\n"
                                    "c = { type = \"comparator\", in = [\"x\", \"-") +
                        level + "*one\"] }\n");
    for (const text::Diagnostic& warning : run_of(made, {.until = 3}).warnings) texts.push_back(warning.what);
    return texts;
  };
  EXPECT_THAT(warnings("1"),
              ::testing::ElementsAre("'c' (in > 0) holds from t = 1 s on, where what it compares is "
                                     "held at its very level: there the least offset decides"));
  EXPECT_THAT(warnings("0.99"), ::testing::IsEmpty());
  EXPECT_THAT(warnings("1.01"), ::testing::IsEmpty());
}

// Some that just come to their limits as what drives them turns round are not held there.
TEST(Slide, IsNotToldOfWhereALimitIsJustTouched) {
  std::string blocks =
      "v = { type = \"integrator\", in = \"-9.8696044*u\", initial = 3.141592653589793 }\n"
      "u = { type = \"integrator\", in = \"v\" }\n";
  for (const double rate : {1.9, 2.03, 2.16, 2.42, 2.55, 2.81, 2.94})
    blocks += fmt::format("x{0:.0f} = {{ type = \"integrator\", in = \"u\", rate = {1}, limit = 1.2 }}\n",
                          100 * rate, rate);
  const Compiled made(blocks);
  for (const auto method : {diagram::IntegrationMethod::automatic, diagram::IntegrationMethod::rodas})
    EXPECT_THAT(run_of(made, {.until = 6, .samples = 13, .method = method}).warnings, ::testing::IsEmpty());
}

// c = ±1 by the sign of 0.5 c − x, x = 0.1: it agrees with itself on both sides.
TEST(Switch, IsToldOfWhereItCouldStartOnItsOtherSide) {
  const std::string rest = "c = { type = \"comparator\", in = \"m\", low = -1, high = 1 }\n";
  const auto told = run_of(Compiled("x = { type = \"integrator\", in = \"c\", initial = 0.1 }\n"
                                    "m = { type = \"summer\", in = [\"-x\", \"0.5*c\"] }\n" +
                                    rest),
                           {.until = 1});
  ASSERT_EQ(told.warnings.size(), 1U);
  EXPECT_THAT(told.warnings.front().what,
              ::testing::StartsWith("the loop of the switches of 'c' has several solutions: at t = 0 s"));
  const auto one = run_of(Compiled("x = { type = \"integrator\", in = \"c\", initial = 0.6 }\n"
                                   "m = { type = \"summer\", in = [\"-x\", \"0.5*c\"] }\n" +
                                   rest),
                          {.until = 1});
  EXPECT_THAT(one.warnings, ::testing::IsEmpty());
}

// The level of a comparator hangs on its own output, by a switch: 1/3 or 2/3, and x = 0.5 lies between them.
TEST(Switch, IsToldOfWhereItCouldStartOnItsOtherSideByAnother) {
  const auto warnings = [](const std::string& initial) {
    return run_of(Compiled(
                      "lo = { type = \"constant\", value = \"1/3\" }\n"
                      "hi = { type = \"constant\", value = \"2/3\" }\n"
                      "level = { type = \"electronic-switch\", on = \"hi\", off = \"lo\", control = \"c\" }\n"
                      "c = { type = \"comparator\", in = [\"level\", \"-x\"] }\n"
                      "x = { type = \"transfer-lag\", in = \"c\", initial = " +
                      initial + " }\n"),
                  {.until = 1})
        .warnings;
  };
  ASSERT_EQ(warnings("0.5").size(), 1U);
  EXPECT_THAT(warnings("0.5").front().what, ::testing::HasSubstr("has several solutions: at t = 0 s"));
  EXPECT_THAT(warnings("0.8"), ::testing::IsEmpty());
}

// A ball between a floor and a ceiling that comes down, whose two comparators are compared in turn at 0 and
// 0, and a latch that flips beside it: where the one rests at its level the other has not settled yet. The
// ball goes as it does alone, to the tolerance of some twenty contacts.
TEST(SwitchingSurface, IsLeftOnceWhatIsIndependentHasSettled) {
  const std::string ball = R"toml(one = { type = "constant" }
x = { type = "integrator", in = "v", initial = 0.5 }
v = { type = "integrator", start = "nv", set = "hit", initial = 0 }
level = { type = "time-function", formula = "1 - 0.1*time" }
up = { type = "comparator", in = ["x", "-level"] }
dn = { type = "comparator", in = "-x" }
hit = { type = "maximum", in = ["up", "dn"] }
nv = { type = "electronic-switch", on = "a", off = "b", control = "up" }
a = { type = "summer", in = ["-v", "-0.2*one"] }
b0 = { type = "gain", factor = -1, in = "v" }
b = { type = "electronic-switch", on = "b0", off = "one", control = "dn" }
)toml";
  const std::string latch = R"toml(f = { type = "time-function", formula = "1.5*sin(time)" }
s = { type = "summer", in = ["2*y", "f"] }
y = { type = "limiter", in = "s" }
q = { type = "integrator", in = "y" }
)toml";
  const std::vector<double> times = {2, 5, 8};
  const auto alone = run_of(Compiled(ball), {.until = 9.5, .extra_times = times});
  const auto beside = run_of(Compiled(ball + latch), {.until = 9.5, .extra_times = times});
  const auto x = column_of(alone.extra, "x"), x_beside = column_of(beside.extra, "x");
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_NEAR(x_beside[k], x[k], 1e-6) << times[k];
}

// An amplifier at its limit, to either side, and a lag behind it by BDF: it stands at ±0.5 to the last bit,
// where Newton's method led by its own derivative of −6e5 1/s once left it beside by 3e-7, in 130 000 steps
// of nanoseconds.
TEST(Slide, OfAnAmplifierAtItsLimitStands) {
  const Compiled made(R"toml(
w = { type = "sine-source", frequency = 0.3, amplitude = 0.6 }
u = { type = "servo-amplifier", in = ["-2*w", "0.1*u"], gain = 1e4, bandwidth = 100, limit = 0.5 }
x = { type = "integrator", in = ["u", "-2*x"], initial = 0.3 }
)toml");
  const solve::Run result = run_of(made, {.until = 3, .tolerance = 1e-9, .samples = 61});
  EXPECT_EQ(result.method.method, diagram::IntegrationMethod::bdf);
  EXPECT_LT(result.statistics.steps, 2000);
  const std::vector<double> t = row_values(result, "t"), u = row_values(result, "u"),
                            x = row_values(result, "x");
  for (std::size_t row = 1; row < t.size(); ++row) {
    // u = 20 w within the limit, but for 1/gain: it is beyond it from 0.0221 s after each zero of w to as
    // long before
    const double of_half = std::fmod(t[row], 1 / 0.6);
    if (of_half < 0.03 || of_half > 1 / 0.6 - 0.03) continue;
    EXPECT_EQ(u[row], t[row] < 1 / 0.6 ? 0.5 : -0.5) << t[row];
    if (t[row] > 0.03 && t[row] < 1.6) {
      // x′ = 20 w − 2x until then, and 0.5 − 2x from then on: no row lies before
      EXPECT_NEAR(x[row] - 0.25, (x[1] - 0.25) * std::exp(-2 * (t[row] - t[1])), 1e-8) << t[row];
    }
  }
}

// dx/dt = 1 − 2c slides at x = 0 with c = 1/2 in the mean, until y, a lag of 0.5 s of c, comes to 0.4 at
// 0.5 ln 5 s. There e moves the level of c to 0.06, so that c is 0 and y falls: e slides at y = 0.4, with c =
// 0.4 in the mean, which lets x rise by 0.2 a second, to 0.06 in 0.3 s. From there on c slides at that level.
// Mirrored, for c holds above zero alone, and at it does not.
TEST(Slide, IsLeftWhereASwitchThatItMovesMovesItsLevelAway) {
  const char* const text = R"toml(
c = { type = "comparator", in = ["x", "-e"] }
e = { type = "electronic-switch", on = "a", off = "o", control = "y", threshold = 0.4 }
y = { type = "transfer-lag", in = "c", time_constant = 0.5 }
x = { type = "integrator", in = ["-2*c", "one"] }
o = { type = "constant", value = 0 }
a = { type = "constant", value = 0.06 }
one = { type = "constant", value = 1 }
)toml";
  const char* const mirrored = R"toml(
e = { type = "electronic-switch", on = "o", off = "a", control = "z", threshold = 0.6 }
z = { type = "transfer-lag", in = "c", time_constant = 0.5, initial = 1 }
y = { type = "summer", in = ["one", "-z"] }
c = { type = "comparator", in = ["e", "-x"] }
x = { type = "integrator", in = ["2*c", "-one"] }
o = { type = "constant", value = 0 }
a = { type = "constant", value = 0.06 }
one = { type = "constant", value = 1 }
)toml";
  using enum diagram::IntegrationMethod;
  for (const char* const diagram : {text, mirrored}) {
    for (const auto method : {adams, bdf, rodas}) {
      const Compiled made(diagram);
      const oblique::solve::Run result =
          run_of(made, {.until = 2, .tolerance = 1e-8, .samples = 101, .method = method});
      const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x"),
                                y = row_values(result, "y");
      const double moves = 0.5 * std::log(5), arrives = moves + 0.3;
      for (std::size_t row = 0; row < t.size(); ++row) {
        const double level = 0.2 * std::max(t[row] - moves, 0.0);
        EXPECT_NEAR(x[row], std::min(level, 0.06), 1e-6) << t[row];  // a slide may drift by 1e-7
        const double before = 0.5 * (1 - std::exp(-2 * t[row]));
        const double after = 0.5 - 0.1 * std::exp(-2 * std::max(t[row] - arrives, 0.0));
        EXPECT_NEAR(y[row], t[row] < moves ? before : after, 1e-6) << t[row];
      }
      EXPECT_TRUE(result.warnings.empty());
    }
  }
}

// x slides at 0.4 until a sine moves that level to 0.2, at 0.484 s: then c is up and x falls with 0.7 a
// second, to 0.2 after 0.2/0.7 s and on with 1.3 a second up. That y slides beside it and reads c changes
// nothing.
TEST(Slide, IsLeftWhereItsLevelJumpsBesideAnother) {
  const Compiled made(R"toml(
one = { type = "constant" }
high = { type = "constant", value = 0.4 }
low = { type = "constant", value = 0.2 }
u = { type = "time-function", formula = "sin(2*pi*time + 0.1)" }
e = { type = "electronic-switch", on = "high", off = "low", control = "u", threshold = 0 }
s = { type = "summer", in = ["x", "-e"] }
c = { type = "sign", in = "s" }
x = { type = "integrator", in = ["0.3*one", "-c"] }
c1 = { type = "sign", in = "y" }
y = { type = "integrator", in = ["-c1", "-0.2*c"], initial = 0.1 }
)toml");
  using enum diagram::IntegrationMethod;
  for (const auto method : {adams, bdf, rodas}) {
    const oblique::solve::Run result = run_of(made, {.until = 0.98, .samples = 50, .method = method});
    const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x"),
                              y = row_values(result, "y");
    const double down = 0.5 - 0.05 / std::numbers::pi, arrives = down + 0.2 / 0.7;
    for (std::size_t row = 0; row < t.size(); ++row) {
      const double rising = std::min(1.3 * t[row], 0.4), falling = 0.4 - 0.7 * (t[row] - down);
      // At 0.2 both drive to it, until the sine comes back at 1 − 0.05/π, behind the end.
      const double truth = t[row] < down ? rising : t[row] < arrives ? falling : 0.2;
      EXPECT_NEAR(x[row], truth, 1e-6) << t[row];  // a slide may drift by 1e-7
      if (t[row] > 0.2) {
        EXPECT_NEAR(y[row], 0, 1e-6) << t[row];
      }
    }
    EXPECT_TRUE(result.warnings.empty());
  }
}

}  // namespace
}  // namespace oblique::solve
