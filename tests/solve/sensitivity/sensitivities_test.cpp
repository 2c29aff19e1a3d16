// SPDX-License-Identifier: MIT
// d/dp of runs, against closed forms; and against differences of whole runs.
#include <oblique/solve/sensitivity/sensitivities.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::run_of;

oblique::solve::Run differentiated(const Compiled& made, std::vector<std::string> names, double until = 2,
                                   double tolerance = 1e-9) {
  RunOptions options;
  options.until = until;
  options.samples = 41;
  options.tolerance = tolerance;
  options.sensitivity = std::move(names);
  return solve::run(made.program, made.flat, options);
}

/// Compares a column with a function of time.
template <class Function>
void expect_column(const oblique::solve::Run& run, std::string_view name, double within,
                   const Function& truth) {
  const auto column = run.trajectory.find(name);
  ASSERT_TRUE(column) << name;
  for (std::size_t row = 0; row < run.trajectory.rows(); ++row) {
    const double t = run.trajectory.at(row, 0);
    EXPECT_NEAR(run.trajectory.at(row, *column), truth(t), within) << name << " at " << t;
  }
}

std::string refusal(const Compiled& made, const std::string& name) {
  return testing::message_of<text::Error>([&] { differentiated(made, {name}); });
}

constexpr double kTolerance = 1e-7;  // a hundred times that of the run

// x = x₀ e^(−k w t): by the coefficient, by the weight of a wire, by the start.
TEST(Sensitivities, OfADecay) {
  const Compiled made(
      "p = { type = \"potentiometer\", in = \"x\", setting = 0.5 }\n"
      "x = { type = \"integrator\", in = \"-3*p\", initial = 0.7 }\n");
  const auto run = differentiated(made, {"p.setting", "x.in[1]", "x.initial"});
  const auto x = [](double t) { return 0.7 * std::exp(-1.5 * t); };
  expect_column(run, "x", kTolerance, x);
  expect_column(run, "d(x)/d(p.setting)", kTolerance, [&](double t) { return -3 * t * x(t); });
  expect_column(run, "d(x)/d(x.in[1])", kTolerance, [&](double t) { return 0.5 * t * x(t); });
  expect_column(run, "d(x)/d(x.initial)", kTolerance, [&](double t) { return std::exp(-1.5 * t); });
  expect_column(run, "d(p)/d(p.setting)", kTolerance, [&](double t) { return x(t) - 1.5 * t * x(t); });
}

// Where the equations leave out what the parameter multiplies: 0·x, and 1·x.
TEST(Sensitivities, WhereAFactorIsZeroOrOne) {
  const Compiled made(
      "p = { type = \"potentiometer\", in = \"x\", setting = 0 }\n"
      "q = { type = \"potentiometer\", in = \"x\", setting = 1 }\n"
      "x = { type = \"integrator\", in = [\"p\"], initial = 0.7 }\n"
      "y = { type = \"integrator\", in = [\"-q\"] }\n");
  const auto run = differentiated(made, {"p.setting", "q.setting"});
  expect_column(run, "d(x)/d(p.setting)", kTolerance, [](double t) { return 0.7 * t; });
  expect_column(run, "d(y)/d(q.setting)", kTolerance, [](double t) { return -0.7 * t; });
  expect_column(run, "d(y)/d(p.setting)", kTolerance, [](double t) { return -0.35 * t * t; });
}

// x′ = −(1 + a)/(1 + b) x: both are 0, and the factor is 1 wherever they are equal. As of an integrator whose
// resistor and whose capacitor scatter.
TEST(Sensitivities, OfParametersThatCancelEachOther) {
  const Compiled made("x = { type = \"integrator\", in = \"-x\", initial = 0.7 }\n");
  const auto run = differentiated(made, {"x.tolerance", "x.capacitor_tolerance"});
  expect_column(run, "d(x)/d(x.tolerance)", kTolerance, [](double t) { return -0.7 * t * std::exp(-t); });
  expect_column(run, "d(x)/d(x.capacitor_tolerance)", kTolerance,
                [](double t) { return 0.7 * t * std::exp(-t); });
}

// y = √x, held by an amplifier of 10 kHz and a gain of 10⁶: where it rests to rounding it moves by some 10⁻⁵
// a second.
TEST(Sensitivities, OfTheRestOfAFastAmplifier) {
  const Compiled made(
      "x = { type = \"integrator\", in = \"-x\", initial = 0.7 }\n"
      "s = { type = \"squarer\", in = \"y\" }\n"
      "y = { type = \"servo-amplifier\", in = [\"10*s\", \"-10*x\"], bandwidth = \"10 kHz\", initial = 1 "
      "}\n");
  const auto run = differentiated(made, {"x.initial"});
  constexpr double kGain = 1e-6;  // 1/(10⁷ · 2y) of the loop, and its lag of a nanosecond
  expect_column(run, "d(y)/d(x.initial)", kGain,
                [](double t) { return 0.5 * std::exp(-t / 2) / std::sqrt(0.7); });
}

// However small the parameter is beside the tolerance of the states, it is the derivative that is asked for.
TEST(Sensitivities, OfATinyParameter) {
  const Compiled made("x = { type = \"integrator\", in = \"x\", initial = 1e-12 }\n");
  const auto run = differentiated(made, {"x.initial", "x.rate"}, 3);
  expect_column(run, "d(x)/d(x.initial)", 1e-6, [](double t) { return std::exp(t); });  // of e³
}

// s = b + p s, so s = b/(1 − p), and x its integral.
TEST(Sensitivities, ThroughAnAlgebraicLoop) {
  const Compiled made(
      "b = { type = \"constant\", value = 0.3 }\n"
      "p = { type = \"potentiometer\", in = \"s\", setting = 0.25 }\n"
      "s = { type = \"summer\", in = [\"b\", \"p\"] }\n"
      "x = { type = \"integrator\", in = \"s\" }\n");
  const auto run = differentiated(made, {"p.setting", "b.value"});
  const double by_p = 0.3 / (0.75 * 0.75), by_b = 1 / 0.75;
  expect_column(run, "d(s)/d(p.setting)", 1e-12, [&](double) { return by_p; });
  expect_column(run, "d(x)/d(p.setting)", kTolerance, [&](double t) { return by_p * t; });
  expect_column(run, "d(x)/d(b.value)", kTolerance, [&](double t) { return by_b * t; });
}

// An ideal amplifier that divides: c b = a, c = a/b, nonlinear in the unknown's loop.
TEST(Sensitivities, ThroughAnIdealAmplifier) {
  const Compiled made(
      "a = { type = \"constant\", value = 0.3 }\nb = { type = \"constant\", value = 0.6 }\n"
      "m = { type = \"squarer\", in = \"c\" }\n"
      "c = { type = \"servo-amplifier\", in = [\"m\", \"-a\"], gain = inf, initial = 0.5 }\n"
      "x = { type = \"integrator\", in = \"c\" }\n");  // c = √a
  const auto run = differentiated(made, {"a.value"});
  expect_column(run, "d(c)/d(a.value)", 1e-10, [](double) { return 0.5 / std::sqrt(0.3); });
  expect_column(run, "d(x)/d(a.value)", kTolerance, [](double t) { return 0.5 / std::sqrt(0.3) * t; });
}

// c = μ b/(1 + μ) from the rest before the clock starts, and dc/dμ = b/(1 + μ)² from the first row on.
TEST(Sensitivities, OfTheRestFromWhichARunStarts) {
  const Compiled made(
      "b = { type = \"constant\", value = 0.5 }\n"
      "c = { type = \"servo-amplifier\", in = [\"c\", \"-b\"], gain = 99, bandwidth = 1000 }\n");
  const auto run = differentiated(made, {"c.gain", "b.value", "c.bandwidth"});
  expect_column(run, "d(c)/d(c.gain)", 1e-10, [](double) { return 0.5 / 1e4; });
  expect_column(run, "d(c)/d(b.value)", 1e-8, [](double) { return 0.99; });
  expect_column(run, "d(c)/d(c.bandwidth)", 1e-12, [](double) { return 0; });
}

// x′ = 1 passes p, and then y′ = 2 in the place of 1: y = 2t − p from there on.
TEST(Sensitivities, JumpWhereTheRateDoes) {
  const Compiled made(
      "one = { type = \"constant\", value = 1 }\np = { type = \"constant\", value = 0.8 }\n"
      "x = { type = \"integrator\", in = \"one\" }\n"
      "k = { type = \"comparator\", in = [\"x\", \"-p\"], low = 1, high = 2 }\n"
      "y = { type = \"integrator\", in = \"k\" }\n");
  const auto run = differentiated(made, {"p.value", "one.value"}, 2.01);
  expect_column(run, "d(y)/d(p.value)", kTolerance, [](double t) { return t > 0.8 ? -1 : 0; });
  // x passes p at p/one: y = 2t − p/one
  expect_column(run, "d(y)/d(one.value)", kTolerance, [](double t) { return t > 0.8 ? 0.8 : 0; });
}

// The same where it takes weeks: how exactly the event is located is a part of the run.
TEST(Sensitivities, JumpWhereTheRateDoesInASlowRunToo) {
  const Compiled made(
      "one = { type = \"constant\", value = 1 }\np = { type = \"constant\", value = 0.8 }\n"
      "x = { type = \"integrator\", in = \"1e-6*one\" }\n"
      "k = { type = \"comparator\", in = [\"x\", \"-p\"], low = 1, high = 2 }\n"
      "y = { type = \"integrator\", in = \"1e-6*k\" }\n");
  const auto run = differentiated(made, {"p.value", "one.value"}, 2.01e6);
  expect_column(run, "d(y)/d(p.value)", kTolerance, [](double t) { return t > 0.8e6 ? -1 : 0; });
  expect_column(run, "d(y)/d(one.value)", kTolerance, [](double t) { return t > 0.8e6 ? 0.8 : 0; });
}

const char* const kSawtooth = R"toml([parameters]
rate = { default = 0.5 }
level = { default = 0.3 }
[outputs]
out = { }
[equations]
"der(out)" = "rate"
[start]
out = "0"
[[events]]
when = "out > level"
set = { out = "0" }
)toml";

// From level to 0 again and again: x = r t − n l, so ∂x/∂r = t and ∂x/∂l = −n.
TEST(Sensitivities, OfWhatAnEventSets) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("sawtooth", kSawtooth);
  const Compiled made("x = { type = \"sawtooth\" }\n", "", library);
  const auto run = differentiated(made, {"x.rate", "x.level"}, 2.01);
  const auto n = [](double t) { return std::floor(0.5 * t / 0.3); };
  expect_column(run, "x", kTolerance, [&](double t) { return 0.5 * t - n(t) * 0.3; });
  expect_column(run, "d(x)/d(x.rate)", kTolerance, [](double t) { return t; });
  expect_column(run, "d(x)/d(x.level)", kTolerance, [&](double t) { return -n(t); });
}

// A delay line takes its first sample, and sets when the next one is to come, where the run starts: the k-th
// of t comes at k D/5, and leaves after D more, less half a step of the clock. (No row lies where it jumps.)
TEST(Sensitivities, OfWhatAnEventSetsAtTheStart) {
  const Compiled made(
      "one = { type = \"constant\" }\nx = { type = \"integrator\", in = \"one\" }\n"
      "y = { type = \"delay-line\", in = \"x\", delay = 0.526, stages = 5 }\n");
  const auto run = differentiated(made, {"y.delay"});
  const double stage = 0.526 / 5;
  expect_column(run, "y", kTolerance,
                [&](double t) { return std::max(0.0, std::floor(t / stage + 0.5) - 5) * stage; });
  expect_column(run, "d(y)/d(y.delay)", kTolerance,
                [&](double t) { return std::max(0.0, std::floor(t / stage + 0.5) - 5) / 5; });
}

// With a later pulse x would begin later, and with an earlier one its begin would lie before the run.
// It takes the state with it, whose start is the parameter: the held sample of 2 e^(−t) at 0 is the start.
TEST(Sensitivities, OfAStateThatAnEventStoresAtTheStart) {
  for (const char* const initial : {"2", "0"}) {  // of 0 it stores what it held
    const Compiled made(
        fmt::format("x = {{ type = \"integrator\", in = \"-x\", initial = {} }}\n", initial) +
        "y = { type = \"delay-line\", in = \"x\", delay = 0.52, stages = 1, straight = 0 }\n");
    const auto run = differentiated(made, {"x.initial"}, 1);
    expect_column(run, "d(y)/d(x.initial)", kTolerance, [&](double t) {
      return t < 0.26 ? 0 : t < 0.78 ? 1 : std::exp(-0.52);  // in the middle between pulses; in no row
    });
  }
}

// A sampled regulator: x′ = r − x while it tracks, 0.1 s from 0.3 + k/2 on, and d, what it stored, else. Of
// r = 0 all is zero, and each event stores the value that was there; ∂x/∂r is the response to 1.
TEST(Sensitivities, OfWhatAnEventSetsToTheValueThatItHad) {
  const Compiled made(
      "r = { type = \"constant\", value = 0 }\n"
      "p = { type = \"pulse-train\", period = 0.5, width = 0.1, delay = 0.3 }\n"
      "e = { type = \"summer\", in = [\"r\", \"-x\"] }\n"
      "d = { type = \"track-and-store\", in = \"e\", track = \"p\" }\n"
      "x = { type = \"integrator\", in = \"d\" }\n");
  expect_column(differentiated(made, {"r.value"}), "d(x)/d(r.value)", kTolerance, [](double t) {
    double x = 0, stored = 0, since = 0;
    for (double begin = 0.3; begin < t; begin += 0.5) {
      x += stored * (begin - since);
      since = std::min(begin + 0.1, t);
      x = 1 - (1 - x) * std::exp(begin - since);
      stored = 1 - x;
    }
    return x + stored * (t - since);
  });
}

// x stays where it is, and from 0.5 on where an event puts it, which is there.
TEST(Sensitivities, OfAStateThatAnEventSetsToItsValue) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("put", R"toml(
[parameters]
to = { default = 0, doc = "Where it is put." }
[outputs]
x = { doc = "Its place." }
[equations]
"der(x)" = "0"
[start]
x = 0
[[events]]
when = "time > 0.52"
set = { x = "to" }
)toml");
  const Compiled made("x = { type = \"put\" }\n", "", library);
  expect_column(differentiated(made, {"x.to"}), "d(x)/d(x.to)", kTolerance,
                [](double t) { return t < 0.52 ? 0 : 1; });
}

// Where nothing is integrated that a switch acts on, the solver goes on through its turns: max(sin 2t, c) is
// c from π/4 … on, and a limiter lets nothing through beyond its limits.
TEST(Sensitivities, FollowSwitchesThatActOnOutputsAlone) {
  const Compiled made(
      "u = { type = \"time-function\", formula = \"sin(2*time)\" }\n"
      "c = { type = \"constant\", value = 0.3 }\n"
      "m = { type = \"maximum\", x = \"u\", y = \"c\" }\n"
      "x = { type = \"integrator\", in = \"-x\", initial = 2 }\n"
      "l = { type = \"limiter\", in = \"x\", low = -1, high = 1 }\n");
  const auto run = differentiated(made, {"c.value", "x.initial"}, 3);
  expect_column(run, "d(m)/d(c.value)", kTolerance, [](double t) { return std::sin(2 * t) > 0.3 ? 0 : 1; });
  expect_column(run, "d(l)/d(x.initial)", kTolerance,
                [](double t) { return 2 * std::exp(-t) > 1 ? 0 : std::exp(-t); });
}

// q + q |q| = p, solved by an ideal amplifier: dq/dp = 1/(1 + 2 |q|).
TEST(Sensitivities, ThroughAMagnitudeInALoop) {
  const Compiled made(
      "p = { type = \"constant\", value = 2 }\n"
      "m = { type = \"absolute-value\", in = \"q\" }\n"
      "w = { type = \"multiplier\", x = \"q\", y = \"m\" }\n"
      "q = { type = \"servo-amplifier\", in = [\"q\", \"w\", \"-p\"], gain = \"inf\", bandwidth = \"inf\" "
      "}\n");
  expect_column(differentiated(made, {"p.value"}), "d(q)/d(p.value)", 1e-12,  // without a state, to rounding
                [](double) { return 1.0 / 3; });
}

TEST(Sensitivities, RefuseWhatTurnsOverJustAtTheStart) {
  const Compiled made(
      "p = { type = \"pulse-train\", period = 1, width = 0.3 }\n"
      "x = { type = \"transfer-lag\", in = \"p\", time_constant = 0.5 }\n");
  EXPECT_THAT(refusal(made, "p.delay"), HasSubstr("'if(first < 0, delay, first + n*length) > time' of block "
                                                  "'p' lies at its switching point where the run starts, "
                                                  "and with another parameter it would not"));
  EXPECT_EQ(refusal(made, "p.width"), "");
}

// |1 − w s| of a step s: from there on it lies on its corner at w = 1, and beside it on either side.
TEST(Sensitivities, RefuseWhatAnEventPutsOnACorner) {
  const Compiled made(R"(
one = { type = "constant" }
s = { type = "step", at = 0.5 }
d = { type = "summer", in = ["one", "-s"] }
m = { type = "absolute-value", in = "d" }
y = { type = "integrator", in = "m" }
)");
  EXPECT_THAT(refusal(made, "d.in[2]"), HasSubstr("not known at t = 0.5 s: 'in > 0' of block 'm' lies at its "
                                                  "switching point from there, and with another"));
  EXPECT_EQ(refusal(made, "m.in[1]"), "");
}

// Two stores on either edge of a clock whose first pulse begins the run, after a comparator at its level: it
// is high until the second store has taken that, and low from then on, so that no event has set what is
// stored as they stand now. (High by 1 it passed for logic.)
TEST(Sensitivities, RefuseWhatSeveralEventsSetAtTheStart) {
  for (const double high : {0.7, 1.0}) {
    const Compiled made(fmt::format(R"(
one = {{ type = "constant" }}
clk = {{ type = "pulse-train", period = 1, width = 0.4 }}
nclk = {{ type = "summer", in = ["one", "-clk"] }}
b = {{ type = "integrator", in = "-q" }}
c = {{ type = "comparator", in = "b", low = -1, high = {} }}
m = {{ type = "track-and-store", in = "c", track = "nclk", initial = -1 }}
q = {{ type = "track-and-store", in = "m", track = "clk", initial = -1 }}
)",
                                    high));
    EXPECT_THAT(refusal(made, "c.high"),
                HasSubstr("several events one after the other have set a discrete state"))
        << high;
  }
}

// Two events that set a number one after the other, 0, 1 and then 2, which no parameter moves.
TEST(Sensitivities, OfWhatSeveralEventsSetWithoutThem) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("twice", R"toml([inputs]
in = {}
[outputs]
out = {}
[memories]
n = 0
[equations]
out = "n*in"
[[events]]
when = "in > 0"
set = { n = "n + 1" }
[[events]]
when = "n > 0.5"
set = { n = "2*n" }
)toml");
  const Compiled made("c = { type = \"constant\", value = 3 }\nw = { type = \"twice\", in = \"c\" }\n", "",
                      library);
  expect_column(differentiated(made, {"c.value"}), "d(w)/d(c.value)", 1e-12,  // to rounding
                [](double) { return 2; });
}

TEST(Sensitivities, RefuseWhatTheyDoNotKnow) {
  const Compiled made(
      "b = { type = \"constant\", value = 0.5 }\n"
      "c = { type = \"servo-amplifier\", in = [\"c\", \"-b\"], gain = inf }\n"
      "x = { type = \"integrator\", in = \"-r\", initial = 1 }\n"
      "r = { type = \"comparator\", in = \"x\", low = -0.5, high = 0.5 }\n");
  EXPECT_EQ(
      refusal(made, "c.gain"),
      "d.toml: there is no sensitivity to 'c.gain': it is infinite; expected a parameter that can change a "
      "little\n  remedy: set c.gain=1e6 makes it finite");
  EXPECT_EQ(
      refusal(made, "b.valeu"),
      "d.toml: there is no sensitivity to 'b.valeu': no block has such a parameter; expected "
      "BLOCK.PARAMETER of a block that is no composite, or BLOCK.INPUT[NUMBER] for the weight of a wire\n"
      "  remedy: did you mean 'b.value'?");
  EXPECT_THAT(refusal(made, "c.in[3]"), HasSubstr("no block has such a parameter"));
  // x comes to 0 at t = 2, and slides there.
  EXPECT_THAT(testing::message_of<SolveError>([&] { differentiated(made, {"b.value"}, 3); }),
              HasSubstr("the sensitivities are not known at t = 2 s: the solution slides along a switching "
                        "surface from there"));
}

// The angle of (cos Ωt, Ω sin Ωt), Ω = √k, goes past 180° at Ωt = π. Its own sensitivity does not jump, nor
// does that of what is the same before and behind; what integrates it is refused, and what compares it.
TEST(Sensitivities, OfAnAngleThatGoesPastHalfATurn) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("angle", R"toml([inputs]
x = { doc = "x" }
y = { doc = "y" }
[outputs]
out = { doc = "its angle" }
[equations]
out = "atan2(y, x)"
)toml");
  const std::string rotation =
      "k = { type = \"potentiometer\", in = \"c\", setting = 0.81 }\n"
      "c = { type = \"integrator\", in = \"-s\", initial = 1 }\n"
      "s = { type = \"integrator\", in = \"k\" }\n"
      "angle = { type = \"angle\", x = \"c\", y = \"s\" }\n";
  const Compiled alone(rotation, "", library);
  const auto by_k = [](double t) {
    const double omega = 0.9, c = std::cos(omega * t), s = std::sin(omega * t);
    return (s * c + omega * t) / (c * c + omega * omega * s * s) / (2 * omega);
  };
  expect_column(differentiated(alone, {"k.setting"}, 6), "d(angle)/d(k.setting)", kTolerance * 10, by_k);
  // x² of the angle does not jump either.
  const Compiled even(rotation +
                          "square = { type = \"multiplier\", x = \"angle\", y = \"angle\" }\n"
                          "sum = { type = \"integrator\", in = \"square\" }\n",
                      "", library);
  EXPECT_NO_THROW(differentiated(even, {"k.setting"}, 6));
  for (const char* follower : {"f = { type = \"integrator\", in = \"angle\" }\n",
                               "f = { type = \"comparator\", in = [\"angle\", \"-one\"] }\n"
                               "one = { type = \"constant\", value = 1 }\n"}) {
    const Compiled followed(rotation + follower, "", library);
    EXPECT_NO_THROW(differentiated(followed, {"k.setting"}, 3.4)) << follower;
    EXPECT_THAT(testing::message_of<text::Error>([&] { differentiated(followed, {"k.setting"}, 6); }),
                HasSubstr("at t = 3.49066 s: an angle goes past 180° there, where atan2 jumps by a turn"))
        << follower;
  }
}

// The solution of x′ = 40 sin x stays within π, and from an unstable rest it stays there; its sensitivity is
// e^(40 t).
TEST(Sensitivities, ThatGrowBeyondAllNumbersAreToldSo) {
  const Compiled made(
      "s = { type = \"sine\", in = \"x\" }\n"
      "x = { type = \"integrator\", in = \"40*s\", initial = 0 }\n");
  EXPECT_THAT(testing::message_of<text::Error>([&] { differentiated(made, {"x.initial"}, 20); }),
              HasSubstr(": that of 'x' has grown to "));
}

// The power of a state that passes zero, and that of a magnitude of the time, have values there, but what
// they depend on has a logarithm in its derivative: it is not the solution that ends.
TEST(Sensitivities, OfWhatHasAValueAndNoDerivativeAreRefusedAsThat) {
  const char* const kPlain =
      "[outputs]\nout = { doc = \"x\" }\n[parameters]\np = { default = 2.3, unit = \"1\" }\n";
  for (const char* const equations :
       {"[equations]\nout = \"abs(time - 1)^p\"\n",
        "[equations]\n\"der(out)\" = \"-abs(out)^p*sign(out) - 0.1\"\n[start]\nout = \"0.2\"\n"}) {
    const diagram::BlockLibrary library =
        testing::shipped_blocks_and("power", "summary = \"x\"\n" + std::string(kPlain) + equations);
    const Compiled made("x = { type = \"power\" }\ni = { type = \"integrator\", in = \"x\" }\n", "", library);
    EXPECT_THAT(
        refusal(made, "x.p"),
        HasSubstr("an equation has a value there, but no derivative by a parameter or by a state that "
                  "depends on one, so that the sensitivities have none (a power of zero, or the edge of a "
                  "branch)"));
    EXPECT_TRUE(run_of(made, {.until = 2}).warnings.empty());
  }
}

// Of the shipped diagrams, by their first parameters: central differences of whole runs, which err by about
// as much as those over half the step differ from them.
TEST(Sensitivities, AgreeWithDifferencesOfRuns) {
  constexpr double kLongest = 4.9371;  // [s]: what swings for long has no differences; no row is at an event
  int compared = 0, refused = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/lessons")) {
    if (entry.path().extension() != ".toml") continue;
    diagram::Diagram diagram = diagram::read_diagram(entry.path());
    diagram.run.samples = 21;
    diagram.run.tolerance = 1e-10;
    diagram.run.until = std::min(diagram.run.until, kLongest);
    if (entry.path().stem() == "relay-oscillator") diagram.run.until = 0.0937;  // four of its periods
    const diagram::FlatDiagram flat = diagram::flatten(diagram, testing::shipped_blocks());
    if (flat.blocks.size() > 40) continue;
    int of_diagram = 0;
    for (std::size_t b = 0; b < flat.blocks.size() && of_diagram < 3; ++b) {
      const diagram::FlatBlock& block = flat.blocks[b];
      for (std::size_t k = 0; k < block.parameters.size() && of_diagram < 3; ++k) {
        const double value = block.parameters[k];
        const diagram::ParameterDefinition& parameter = block.definition->parameters[k];
        if (!std::isfinite(value) || value == 0 || parameter.points || parameter.formula) continue;
        const double h = 1e-4 * std::abs(value);
        const auto run_with = [&](double other, std::vector<std::string> names) {
          diagram::FlatDiagram changed = flat;
          changed.blocks[b].parameters[k] = other;
          RunOptions options = options_of(diagram.run);
          options.sensitivity = std::move(names);
          return solve::run(network::Program(network::assemble(changed)), changed, options).trajectory;
        };
        const std::string name = block.path + "." + parameter.name;
        ++of_diagram;
        try {
          const Trajectory run = run_with(value, {name});
          const Trajectory above = run_with(value + h, {}), below = run_with(value - h, {}),
                           nearer_above = run_with(value + h / 2, {}),
                           nearer_below = run_with(value - h / 2, {});
          ++compared;
          const std::size_t n = flat.outputs.size();
          for (std::size_t c = 1; c <= n; ++c) {
            double size = 0;
            for (std::size_t row = 0; row < run.rows(); ++row)
              size = std::max({size, std::abs(run.at(row, c)), std::abs(value * run.at(row, n + c))});
            for (std::size_t row = 0; row < run.rows(); ++row) {
              const double wide = (above.at(row, c) - below.at(row, c)) / (2 * h);
              const double narrow = (nearer_above.at(row, c) - nearer_below.at(row, c)) / h;
              const double errs = std::abs(value * (wide - narrow));
              EXPECT_NEAR(value * run.at(row, n + c), value * narrow, 2e-5 * size + 2 * errs)
                  << entry.path() << " d(" << flat.outputs[c - 1].name << ")/d(" << name
                  << ") at t = " << run.at(row, 0);
            }
          }
        } catch (const text::Error&) {
          ++refused;
        }
      }
    }
  }
  EXPECT_GT(compared, 30);
  EXPECT_LT(refused, compared);
}

}  // namespace
}  // namespace oblique::solve
