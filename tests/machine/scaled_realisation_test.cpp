// SPDX-License-Identifier: MIT
// Any diagram in a machine's elements and scale: it gives what it gave, and every signal stays on the
// machine.
#include <oblique/machine/scaled_realisation.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_writer.h>
#include <oblique/machine/realise.h>
#include <oblique/solve/run.h>

#include "machine_runs.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::desk_machine;
using testing::expect_machine_elements;
using testing::greatest_signal;
using ::testing::HasSubstr;
using testing::inverting_machine;
using testing::parsed;
using testing::shipped_blocks;
using testing::trajectory_of;

// Integrators, open amplifiers and function generators have a range of their own, which they use.
TEST(ScaledRealisation, UsesNineTenthsOfTheMachineUnit) {
  const diagram::Diagram diagram = parsed(R"toml(
[run]
until = 10
[blocks]
one = { type = "constant", value = 1 }
v   = { type = "integrator", in = ["-0.3*v", "-7*x", "20*one"] }
x   = { type = "integrator", in = ["v"], initial = 40 }
)toml");
  const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine());
  ASSERT_EQ(made.scales.size(), 2U);
  for (const SignalScale& scale : made.scales) {
    EXPECT_GT(scale.largest, 0.9) << scale.signal;
    EXPECT_LE(scale.largest, 1 + 1e-6) << scale.signal;
  }
  // x″ + 0.3 x′ + 7 x = 20 from 40 at rest: x stays below its start, so that its unit is 40 V and not less.
  EXPECT_NEAR(made.scales[1].unit, 40, 1e-9);
  EXPECT_LT(testing::difference(diagram, made.diagram), 1e-7);
}

// 40 of the diagram's machine units become one: what an output shows is a number of the problem then.
TEST(ScaledRealisation, CallsNoMachineUnitWhatIsNone) {
  const auto unit_of = [](const std::string& initial) {
    return realise_scaled(
               parsed("[run]\nuntil = 1\n[blocks]\nx = { type = \"integrator\", in = \"-x\", initial = " +
                      initial + " }\n[outputs]\nx = \"x\"\n"),
               shipped_blocks(), desk_machine())
        .diagram.outputs.at(0)
        .unit;
  };
  EXPECT_EQ(unit_of("40"), "1");
  EXPECT_EQ(unit_of("1"), "machine unit");  // it stays one
}

// out = a sin(2π f t + φ) is known in closed form; 5 turns at a tolerance of 1e-8 a step.
TEST(ScaledRealisation, MakesASineSourceOfTwoIntegrators) {
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 0.5
[blocks]
source = { type = "sine-source", amplitude = 30, frequency = "10 Hz", phase = "30 deg" }
)toml"),
                                                shipped_blocks(), desk_machine());
  EXPECT_THAT(diagram::write_diagram(made.diagram), ::testing::Not(HasSubstr("sine-source")));
  EXPECT_EQ(made.scales.size(), 2U);
  const solve::Trajectory run = trajectory_of(made.diagram);
  const auto source = run.find("source");
  ASSERT_TRUE(source);
  for (std::size_t r = 0; r < run.rows(); r += 50) {
    const double t = run.at(r, 0) / made.time;
    EXPECT_NEAR(run.at(r, *source), 30 * std::sin(20 * std::numbers::pi * t + std::numbers::pi / 6), 1e-4);
  }
}

/// A machine with one time factor.
diagram::MachineProfile machine_of_rate(double rate) {
  diagram::MachineProfile machine = inverting_machine();
  machine.rates = {rate};
  return machine;
}

// x′ = −λ x: an input of ×10 at k0 = 1/s carries 10 1/s at the most, and a tenth at ×1 is enough.
TEST(ScaledRealisation, SlowsAndHastensTimeAsTheIntegratorsAsk) {
  const auto decay = [](const char* rate) {
    return parsed(std::string("[run]\nuntil = \"2/") + rate +
                  "\"\n[blocks]\nx = { type = \"integrator\", in = [\"-" + rate +
                  "*x\"], initial = 1 }\n[outputs]\nx = \"x\"\n[expect]\n\"x at 1/" + rate +
                  "\" = { value = 0.36787944117144233, within = 1e-7 }\n");
  };
  const std::vector<std::pair<const char*, double>> times = {
      {"3000", 500}, {"10", 1}, {"2", 1}, {"0.1", 1}, {"0.003", 0.02}};
  for (const auto& [rate, time] : times) {
    const ScaledRealisation made = realise_scaled(decay(rate), shipped_blocks(), machine_of_rate(1));
    EXPECT_EQ(made.time, time) << rate;
    EXPECT_NEAR(made.diagram.run.until, time * 2 / std::stod(rate), 1e-9 * made.diagram.run.until);
    // What was expected at 1/λ is expected, and is there, at the same moment of the machine.
    ASSERT_EQ(made.diagram.expectations.size(), 1U);
    EXPECT_NEAR(made.diagram.expectations[0].time, time / std::stod(rate), 1e-9 * made.diagram.run.until);
    const solve::Trajectory run = trajectory_of(made.diagram);
    EXPECT_NEAR(run.at(run.rows() / 2, 1), std::exp(-1), 1e-7);
  }
  // Of time factors that are not published 1/s is taken for one, unless all is slower than a hundredth of it.
  diagram::MachineProfile unknown = inverting_machine();
  unknown.rates.clear();
  for (const auto& [rate, time] :
       {std::pair("3000", 1.0), {"2", 1.0}, {"0.02", 1.0}, {"0.003", 0.02}, {"2e-5", 2e-4}}) {
    const ScaledRealisation made = realise_scaled(decay(rate), shipped_blocks(), unknown);
    EXPECT_EQ(made.time, time) << rate;
    const std::string written = diagram::write_diagram(made.diagram);
    EXPECT_EQ(written.find("rate = "), rate[0] == '3' ? written.find("rate = 1000") : std::string::npos)
        << written;
  }
  ScalingOptions asked;
  asked.time = 25;
  EXPECT_EQ(realise_scaled(decay("2"), shipped_blocks(), machine_of_rate(1), asked).time, 25);
}

struct ElementCase {
  const char* name;
  const char* block;     ///< the block `y`, fed with `u` and `v`
  double within = 1e-7;  ///< of the block itself
};

class ElementCircuit : public ::testing::TestWithParam<ElementCase> {};
INSTANTIATE_TEST_SUITE_P(
    ScaledRealisation, ElementCircuit,
    ::testing::Values(
        ElementCase{
            "switch",
            R"(y = { type = "electronic-switch", on = "u", off = "3*v", control = "u", threshold = 0.7 })"},
        ElementCase{"sign", R"(y = { type = "sign", in = "u" })"},
        ElementCase{"maximum", R"(y = { type = "maximum", x = "u", y = "2*v" })"},
        ElementCase{"minimum", R"(y = { type = "minimum", x = "u", y = "2*v" })"},
        ElementCase{
            "lag", R"(y = { type = "transfer-lag", in = "u", time_constant = 0.3, gain = 4, initial = -1 })"},
        ElementCase{"limiter", R"(y = { type = "limiter", in = "u", low = -0.4, high = 1.3 })"},
        ElementCase{"dead_zone", R"(y = { type = "dead-zone", in = "u", low = -0.4, high = 1.3 })"},
        ElementCase{"magnitude", R"(y = { type = "absolute-value", in = "u" })"},
        ElementCase{"ramp", R"(y = { type = "ramp", slope = 3, start = 0.5, stop = 2.5, initial = -2 })"},
        ElementCase{"step", R"(y = { type = "step", at = 1.234, from = -2, to = 7 })"},
        ElementCase{"hysteresis",
                    R"(y = { type = "comparator", in = ["u", "-v"], hysteresis = 0.5, low = -3, high = 5 })"},
        ElementCase{
            "relay",
            R"(y = { type = "relay", coil = "u", make = "3*v", break = "u", pull_in = 0.9, drop_out = -0.3 })"},
        ElementCase{
            "relay_with_a_delay",
            R"(y = { type = "relay", coil = "u", make = "3*v", break = "u", pull_in = 0.9, drop_out = -0.3, delay = 0.15 })"},
        ElementCase{"flip_flop", R"(hot = { type = "comparator", in = ["u", "-1.5*one"] }
late = { type = "comparator", in = ["v"] }
y_of = { type = "flip-flop", set = "hot", reset = "late" }
y = { type = "summer", in = ["5*y_of.out", "y_of.inverse"] })"},
        ElementCase{"flip_flop_of_signals",
                    R"(y_of = { type = "flip-flop", set = "u", reset = "-u", initial = 1 }
y = { type = "summer", in = ["5*y_of.out", "y_of.inverse"] })"},
        ElementCase{
            "pulses",
            R"(y = { type = "pulse-train", period = 0.7, width = 0.2, delay = 1.6, low = -2, high = 7 })"},
        ElementCase{"backlash",
                    R"(y = { type = "backlash", in = "u", play = 0.6, rate = 50, initial = -0.3 })"},
        ElementCase{
            "multiplexer",
            R"(y = { type = "multiplexer", in0 = "u", in1 = "-2*v", in3 = "one", address = "0.9*u", step = 0.4 })"},
        ElementCase{"demultiplexer",
                    R"(y_of = { type = "demultiplexer", in = "3*v", address = "u", step = 0.4 }
y = { type = "summer", in = ["y_of.out0", "2*y_of.out1", "-4*y_of.out2", "8*y_of.out7"] })"},
        ElementCase{"counter", R"(up = { type = "comparator", in = "u" }
slow = { type = "counter", clock = "fast.carry", step = 3 }
fast = { type = "counter", clock = "up", modulus = 2, step = 0.5 }
y = { type = "summer", in = ["slow.out", "fast.out", "0.1*fast.carry"] })"},
        ElementCase{"preset_counter", R"(up = { type = "comparator", in = "u" }
late = { type = "comparator", in = "v", low = -1 }
y_of = { type = "preset-counter", clock = "up", preset = 3, step = 7, reload = 1, enable = "late" }
y = { type = "summer", in = ["y_of.out", "5*y_of.zero"] })"},
        ElementCase{"jk_flip_flop", R"(up = { type = "comparator", in = "u" }
late = { type = "comparator", in = "v" }
half = { type = "jk-flip-flop", clock = "up" }
y_of = { type = "jk-flip-flop", clock = "half.inverse", k = "late", initial = 1 }
y = { type = "multiplier", in = ["u", "y_of.out"] })"},
        ElementCase{"monostable", R"(up = { type = "comparator", in = "u" }
y = { type = "monostable", trigger = "up", length = 0.4, low = -2, high = 5 })"},
        ElementCase{"digital_potentiometer", R"(up = { type = "comparator", in = "u" }
y_of = { type = "digital-potentiometer", in = "5*v", up = "up", initial = 0.2, step = 0.3 }
y = { type = "summer", in = ["y_of.out", "3*y_of.setting"] })"},
        ElementCase{"noise",
                    R"(y = { type = "noise-source", rms = 3, bandwidth = 0.8, mean = -1, seed = 7 })"},
        ElementCase{"delay_line",
                    R"(y = { type = "delay-line", in = "3*v", delay = 0.71, stages = 7, initial = -3 })"},
        ElementCase{"straight_delay_line",
                    R"(y = { type = "delay-line", in = "0.3*u", delay = 0.7, stages = 12, straight = 1 })"},
        // 200 lines over a turn: (∫√|cos| dx)²/(16·200²) = 3.6e-5 over four quarters, times r = 2
        ElementCase{"resolver", R"(y_of = { type = "resolver", length = "u", angle = "2*v" }
y = { type = "summer", in = ["y_of.x", "y_of.y"] })",
                    1e-4},
        ElementCase{"servo_multiplier", R"(y_of = { type = "servo-multiplier", x = "u", y1 = "3*v", y2 = "u" }
y = { type = "summer", in = ["y_of.out1", "y_of.out2", "-5*y_of.position"] })"},
        ElementCase{
            "slow_servo_multiplier",
            R"(y_of = { type = "servo-multiplier", x = "u", y1 = "3*v", y3 = "one", loop_gain = 20, time_constant = 0.05, velocity_limit = 4, dead_zone = 0.3, aligned = 0, initial = -0.8 }
y = { type = "summer", in = ["y_of.out1", "10*y_of.out3"] })"},
        // as the resolver, with r = 1 and 2
        ElementCase{
            "servo_resolver",
            R"(y_of = { type = "servo-resolver", angle = "2*v", loop_gain = 20, velocity_limit = 0.7, aligned = 0, initial = -1 }
fast = { type = "servo-resolver", angle = "2*v", r = "u", loop_gain = 50, time_constant = 0.01, dead_zone = 0.1 }
y = { type = "summer", in = ["y_of.x", "fast.x", "fast.y"] })",
            1e-4},
        ElementCase{"time", R"toml(y = { type = "time-function", formula = "sin(time)", scale = 4 })toml",
                    4e-5}),
    [](const auto& tested) { return std::string(tested.param.name); });

// Each block stands in a diagram that takes it through all it can do, and further than 1.
TEST_P(ElementCircuit, DoesWhatItsBlockDoes) {
  const diagram::Diagram diagram = parsed(fmt::format(R"toml(
[run]
until = 5
[blocks]
u = {{ type = "integrator", in = ["3*w"], initial = 0.1 }}
w = {{ type = "integrator", in = ["-3*u"], initial = 2 }}
one = {{ type = "constant", value = 1 }}
v = {{ type = "integrator", in = ["0.4*one"], initial = -1 }}
{}
[outputs]
y = "y"
)toml",
                                                      GetParam().block));
  ScalingOptions options;
  options.segments = 200;
  const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine(), options);
  expect_machine_elements(made.diagram, false);
  EXPECT_LE(greatest_signal(made.diagram), 1 + 1e-5);
  const solve::Trajectory one = trajectory_of(diagram), other = trajectory_of(made.diagram);
  double size = 0;
  for (std::size_t r = 0; r < one.rows(); ++r) size = std::max(size, std::abs(one.at(r, 1)));
  std::size_t off = 0;
  for (std::size_t r = 0; r < one.rows(); ++r) {
    if (std::abs(one.at(r, 1) - other.at(r, 1)) > GetParam().within * size) ++off;
  }
  // A row may lie just where something switches.
  EXPECT_LE(off, GetParam().within > 1e-7 ? 0U : 1U) << diagram::write_diagram(made.diagram);
}

// x′ = 4 u − 3 x + 2 in whatever convention: what leaks is an input that somebody can patch.
TEST(ScaledRealisation, WiresWhatLeaksAndDrifts) {
  const std::string text = R"toml(
[run]
until = 2
[blocks]
u = { type = "integrator", in = ["-u"], initial = 3 }
x = { type = "integrator", in = ["2*u"], rate = 2, leakage = 3, drift = 2, initial = 1 }
[outputs]
x = "x"
)toml";
  const diagram::Diagram diagram = parsed(text);
  const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine());
  const std::string written = diagram::write_diagram(made.diagram);
  EXPECT_EQ(written.find("leakage"), std::string::npos) << written;
  EXPECT_EQ(written.find("drift"), std::string::npos) << written;
  EXPECT_LT(testing::difference(diagram, made.diagram), 1e-7);
  EXPECT_EQ(testing::message_of<RealiseError>([&] {
              realise_scaled(parsed(text + "[timeline]\nphases = [{ mode = \"operate\", for = 1 }, { mode = "
                                           "\"hold\", for = 1 }]\n"),
                             shipped_blocks(), desk_machine());
            }),
            "test.toml:7:1: integrator 'x' leaks or drifts while it holds too; expected what can be wired\n"
            "  remedy: take 'leakage' and 'drift' out, and feed it with what they stand for");
}

// What was published of a moment was published of the diagram's time, as what is expected.
TEST(ScaledRealisation, MovesPublishedMomentsWithTheTime) {
  ScalingOptions options;
  options.time = 5;
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 2
[blocks]
x = { type = "integrator", in = ["-x"], initial = 1 }
[outputs]
x = "x"
[expect]
"x at 1" = { value = "exp(-1)", within = 1e-6 }
"x period" = { value = "300 ms", within = "20 ms" }
[published]
author = "A"
title = "T"
year = 1960
[[published.value]]
name = "x"
at = 1
value = 0.37
within = 0.01
)toml"),
                                                shipped_blocks(), desk_machine(), options);
  ASSERT_TRUE(made.diagram.published);
  EXPECT_EQ(made.diagram.published->values.at(0).expected.time, 5);
  EXPECT_EQ(made.diagram.expectations.at(0).time, 5);
  EXPECT_EQ(made.diagram.expectations.at(1).value, 1.5);
  EXPECT_EQ(made.diagram.expectations.at(1).within, 0.1);
}

// The small difference of two large signals is not blown up: no input is weighted more than ×10.
TEST(ScaledRealisation, LeavesASmallDifferenceSmall) {
  const diagram::Diagram diagram = parsed(R"toml(
[run]
until = 3
[blocks]
a    = { type = "integrator", in = ["b"], initial = 1 }
b    = { type = "integrator", in = ["-a"] }
c    = { type = "integrator", in = ["1.001*b"], initial = 1 }
rest = { type = "summer", in = ["c", "-a"] }
twice = { type = "multiplier", in = ["rest", "a"] }
)toml");
  const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine());
  const auto rest = std::find_if(made.scales.begin(), made.scales.end(), [](const SignalScale& scale) {
    return scale.signal.find("rest") != std::string::npos;
  });
  ASSERT_NE(rest, made.scales.end());
  EXPECT_GE(rest->unit, 0.09);  // 1 machine unit of it; of a its unit is 1, and c goes a little beyond
  EXPECT_LT(rest->largest, 0.1);
  EXPECT_LT(testing::difference(diagram, made.diagram), 1e-7);
}

/// 1 machine unit of each integrator, in the units of the problem, by name.
std::map<std::string, double> units_of(const ScaledRealisation& made) {
  std::map<std::string, double> units;
  for (const SignalScale& scale : made.scales) {
    const bool negative = scale.signal.starts_with("minus_");
    units[negative ? scale.signal.substr(6) : scale.signal] = scale.unit;
  }
  return units;
}

// Published programmes give their scale by their coefficients. B. Ulmann, Analog Paradigm application note 1,
// Roessler: x' = -0.8 y - 2.3 z, y' = 1.25 x + 0.2 y, z' = 0.005 + 15 z (x - 0.3796), which is x/15, y/12,
// z/34.5. Note 2, Lorenz, ten times slower: x' = 1.8 y - x, y' = 1.5556 x - 2.68 x z - 0.1 y, z' = 1.5 x y -
// 0.2667 z, which is x/20, y/36, z/48. Ours use as much of the range (to the two digits of a factor) or more;
// by more than twice they would not be scales of the same attractor.
TEST(ScaledRealisation, UsesMoreOfTheRangeThanPublishedScalings) {
  const auto units = [](const char* blocks, double until) {
    diagram::Diagram diagram = parsed(std::string("[blocks]\none = { type = \"constant\" }\n") + blocks);
    diagram.run.until = until;
    return units_of(realise_scaled(diagram, shipped_blocks(), desk_machine()));
  };
  const auto expect = [](const std::map<std::string, double>& ours,
                         const std::map<std::string, double>& theirs) {
    for (const auto& [name, unit] : theirs) {
      EXPECT_LE(ours.at(name), 1.02 * unit) << name;
      EXPECT_GE(ours.at(name), 0.5 * unit) << name;
    }
  };
  expect(units(R"toml(
x  = { type = "integrator", in = ["-y", "-z"], initial = 1 }
y  = { type = "integrator", in = ["x", "0.2*y"], initial = 1 }
z  = { type = "integrator", in = ["0.2*one", "xz", "-5.7*z"] }
xz = { type = "multiplier", in = ["x", "z"] }
)toml",
               300),
         {{"x", 15}, {"y", 12}, {"z", 34.5}});
  expect(units(R"toml(
x  = { type = "integrator", in = ["10*y", "-10*x"], initial = -6.7 }
y  = { type = "integrator", in = ["28*x", "-xz", "-y"], initial = -10.6 }
z  = { type = "integrator", in = ["xy", "-8/3*z"], initial = 17.2 }
xy = { type = "multiplier", in = ["x", "y"] }
xz = { type = "multiplier", in = ["x", "z"] }
)toml",
               60),
         {{"x", 20}, {"y", 36}, {"z", 48}});
}

// The rule of textbooks for a mass on a spring, x'' + 2 D w x' + w^2 x = 0 from x0 at rest: |x| <= x0, |x'| <
// w x0, and the undamped one reaches both.
TEST(ScaledRealisation, ScalesASpringAsTextbooksDo) {
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 4
[blocks]
v = { type = "integrator", in = ["-25*x"] }
x = { type = "integrator", in = ["v"], initial = 0.08 }
)toml"),
                                                shipped_blocks(), desk_machine());
  const auto units = units_of(made);
  EXPECT_NEAR(units.at("x"), 0.08, 0.08 * 0.05);  // 12 is the two-digit factor below 12.5
  EXPECT_NEAR(units.at("v"), 0.4, 1e-12);
}

TEST(ScaledRealisation, NamesEveryBlockThatTheMachineHasNot) {
  diagram::BlockLibrary library = shipped_blocks();
  for (const auto& [name, formula] : {std::pair("distance", "sqrt(x^2 + y^2)"), {"angle", "atan2(y, x)"}})
    library.add(diagram::parse_block(
        fmt::format("format = \"oblique-block/1\"\ntitle = \"{}\"\n[inputs]\nx = {{}}\ny = {{}}\n[outputs]\n"
                    "out = {{}}\n[equations]\nout = \"{}\"\n",
                    name, formula),
        std::string(name) + ".toml", name));
  const std::string remedy =
      ", and no circuit of its elements for it; expected amplifiers, potentiometers, multipliers, "
      "comparators, and "
      "functions of one signal\n"
      "  remedy: build it of these";
  EXPECT_EQ(testing::message_of<RealiseError>([&] {
              realise_scaled(parsed(R"toml([blocks]
one = { type = "constant" }
x = { type = "integrator", in = ["one"] }
a = { type = "distance", x = "x", y = "one" }
b = { type = "distance", x = "x", y = "one" }
n = { type = "angle", x = "x", y = "one" }
)toml"),
                             library, desk_machine());
            }),
            "test.toml:5:1: the machine Machine has no distance, which 'a', 'b' are" + remedy +
                "\ntest.toml:7:1: the machine Machine has no angle, which 'n' is" + remedy);
}

// The clock of a counter keeps its level, 0.5, in every scale: what it is fed with could not be brought onto
// the machine.
TEST(ScaledRealisation, NamesAControlThatNoScaleBringsOntoTheMachine) {
  const std::string remedy =
      "; expected a level of 0 or 1, as a comparator gives it\n  remedy: put a comparator before it";
  EXPECT_EQ(
      testing::message_of<RealiseError>([] {
        realise_scaled(parsed(R"toml([blocks]
x = { type = "integrator", in = ["y"], initial = 3 }
y = { type = "integrator", in = ["-x"] }
xy = { type = "multiplier", in = ["x", "y"] }
n = { type = "counter", clock = "x" }
m = { type = "counter", clock = "xy" }
)toml"),
                       shipped_blocks(), desk_machine());
      }),
      "test.toml:6:1: 'clock' of 'n' is compared with a level that no scale moves, and 'x', which it is fed "
      "with, goes to 3 machine units" +
          remedy +
          "\ntest.toml:7:1: 'clock' of 'm' is compared with a level that no scale moves, and 'xy', which it "
          "is fed with, is a product, whose scale is that of its factors" +
          remedy);
}

// What sets an integrator has its own level, and none of its scale: 0.009 becomes nearly a machine unit.
TEST(ScaledRealisation, ScalesAnIntegratorThatIsSetAsAnyOther) {
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 3
[blocks]
one = { type = "constant" }
far = { type = "comparator", in = ["x", "-0.009*one"] }
x = { type = "integrator", in = ["0.01*one"], set = "far", start = "-0.005*one" }
)toml"),
                                                shipped_blocks(), desk_machine());
  const auto x = std::find_if(made.scales.begin(), made.scales.end(),
                              [](const SignalScale& scale) { return scale.signal.ends_with("x"); });
  ASSERT_NE(x, made.scales.end());
  EXPECT_GT(x->largest, 0.9);  // a factor of two digits uses more than nine tenths
}

// A count of 14 is 28 units of the diagram, and less than one of the machine; the carry is a level in both.
TEST(ScaledRealisation, BringsACountOntoTheMachineAndLeavesItsCarry) {
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 14.5
[blocks]
clock = { type = "pulse-train", period = 1, width = 0.5, delay = 0.75 }
n = { type = "counter", clock = "clock", step = 2, modulus = 20 }
[outputs]
count = "n.out"
carry = "n.carry"
)toml"),
                                                shipped_blocks(), desk_machine());
  const diagram::FlatDiagram flat = diagram::flatten(made.diagram, shipped_blocks());
  const auto counter = std::find_if(flat.blocks.begin(), flat.blocks.end(),
                                    [](const auto& block) { return block.definition->name == "counter"; });
  ASSERT_NE(counter, flat.blocks.end());
  const double step = counter->parameters[counter->definition->find_parameter("step").value()];
  EXPECT_LE(14 * step, 1 + 1e-6);
  EXPECT_GT(14 * step, 0.9);  // a factor of two digits uses more than nine tenths
  const solve::Trajectory run = trajectory_of(made.diagram);
  EXPECT_NEAR(run.at(run.rows() - 1, 1), 28, 1e-9);
  EXPECT_EQ(run.at(run.rows() - 1, 2), 0);
  EXPECT_EQ(run.at(0, 2), 1);
}

// A circular orbit, r″ = 1/r³ − 1/r² from r = 1: what is left of r′ is what the amplifier of the divider does
// not see, a millionth. That is no signal to scale up, and none to wait for.
TEST(ScaledRealisation, TakesWhatServoAmplifiersLeaveForNothing) {
  const ScaledRealisation made = realise_scaled(parsed(R"toml(
[run]
until = 60
[blocks]
one = { type = "constant" }
u   = { type = "divider", numerator = "one", denominator = "r" }
uu  = { type = "squarer", in = "u" }
uuu = { type = "multiplier", in = ["uu", "u"] }
v   = { type = "integrator", in = ["uuu", "-uu"] }
r   = { type = "integrator", in = "v", initial = 1 }
)toml"),
                                                shipped_blocks(), desk_machine());
  EXPECT_LE(made.time, 1);
  for (const SignalScale& scale : made.scales) EXPECT_GT(scale.unit, 0.1) << scale.signal;
}

// From where an amplifier goes to rest is scaled with it, but not beyond the machine: 1 of a root that is
// 0.04 at most would be 25 machine units, from which it went to the wrong limit.
TEST(ScaledRealisation, LetsAmplifiersComeToRestFromWhereTheyCanBe) {
  const diagram::Diagram diagram = parsed(R"toml(
[run]
until = 3
[blocks]
x = { type = "integrator", in = "-x", initial = 0.0015 }
r = { type = "square-root", in = "x" }
)toml");
  const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), desk_machine());
  EXPECT_THAT(diagram::write_diagram(made.diagram), HasSubstr("initial = 1 }"));
  EXPECT_LT(testing::difference(diagram, made.diagram), 1e-7);
}

}  // namespace
}  // namespace oblique::machine
