// SPDX-License-Identifier: MIT
// Problems of textbooks on analog computation, written in their own units (millimetres, heads, metres,
// moles a litre, days, kilohertz), put onto machines: what they give there, and how well the machine is used.
#include <oblique/commission/diagram_on_machine.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>
#include <oblique/solve/run.h>

#include "../support/compiled.h"

namespace oblique::commission {
namespace {

using testing::shipped_blocks;

/// A value that an output has at a time, and the largest magnitude of the output.
struct Truth {
  const char* output;
  double time, value, size;
};

struct Problem {
  const char* name;
  double until;
  const char* blocks;
  std::vector<Truth> truths;  ///< SciPy's DOP853 or Radau at tolerances of 1e-11 and less
  /// How far a TR-10 may be off, of the size: about twice what it is. Its multipliers err by 0.8 % of the
  /// machine unit, which rates of change gather, and its potentiometers by 0.0125 %. Of a Model-1 no errors
  /// are published. Nothing: it is not put onto a TR-10.
  std::optional<double> on_tr10;
  double least_setting = 0.002;  ///< of a potentiometer: 8 of the 4000 steps of a TR-10
  double least_signal = 0.3;     ///< the peak of any amplifier [machine unit]
};

/// Where errors of the multipliers decide the phase of a relaxation, or are larger than the start, how far it
/// goes is all that is asked.
constexpr double kAnywhere = 2;

const std::vector<Problem> kProblems = {
    // a mass of 1200 kg on 48 kN/m and 1.2 kNs/m under 6 kN [mm]
    {"spring",
     6,
     R"toml(
one = { type = "constant" }
v   = { type = "integrator", in = ["6000/1200*1000*one", "-1200/1200*v", "-48000/1200*x"] }
x   = { type = "integrator", in = "v", initial = 20 }
)toml",
     {{"x", 1.8, 113.4185391965652, 207},
      {"v", 1.8, -254.14220881696917, 590},
      {"x", 6, 119.7625794739642, 207}},
     5e-4},
    // van der Pol's oscillator of 50 Hz, mu = 3, 10 V [V, V/s]
    {"van_der_pol",
     0.1,
     R"toml(
xx  = { type = "squarer", in = "x" }
xxv = { type = "multiplier", in = ["xx", "v"] }
v   = { type = "integrator", in = ["3*2*pi*50*v", "-3*2*pi*50/100*xxv", "-(2*pi*50)^2*x"] }
x   = { type = "integrator", in = "v", initial = 5 }
)toml",
     {{"x", 0.07, -8.552622845970875, 20.2}, {"x", 0.1, 2.846376019818333, 20.2}},
     kAnywhere},
    // Volterra's hares and lynxes [heads, years]
    {"volterra",
     30,
     R"toml(
hl = { type = "multiplier", in = ["h", "l"] }
h  = { type = "integrator", in = ["0.55*h", "-2.8e-5*hl"], initial = 30000 }
l  = { type = "integrator", in = ["-0.84*l", "2.6e-5*hl"], initial = 4000 }
)toml",
     {{"h", 9, 17393.86277658994, 77500},
      {"l", 9, 5457.9746864344925, 55900},
      {"h", 30, 20677.640817779273, 77500}},
     0.1},
    // J0 from 1 on, by z = x y', y' = z/x: a divider whose denominator grows to 20
    {"bessel",
     19,
     R"toml(
one = { type = "constant" }
x   = { type = "integrator", in = "one", initial = 1 }
q   = { type = "divider", numerator = "z", denominator = "x" }
xy  = { type = "multiplier", in = ["x", "y"] }
y   = { type = "integrator", in = "q", initial = 0.7651976865579666 }
z   = { type = "integrator", in = "-xy", initial = -0.44005058574493355 }
)toml",
     {{"y", 5.7, 0.28506473771059915, 0.765}, {"y", 19, 0.1670246643406815, 0.765}},
     0.02},
    // A to B to C, at 400 and 1.5 1/s [mol/m3]
    {"kinetics",
     5,
     R"toml(
a = { type = "integrator", in = "-400*a", initial = 2.5e5 }
b = { type = "integrator", in = ["400*a", "-1.5*b"] }
c = { type = "integrator", in = "1.5*b" }
)toml",
     {{"b", 1.5, 26448.98985240678, 2.45e5}, {"c", 3.5, 248683.18233395054, 2.5e5}},
     0.003},
    // two tanks that run out by Torricelli's law [m, s]
    {"tanks",
     3600,
     R"toml(
one = { type = "constant" }
r1  = { type = "square-root", in = "h1" }
r2  = { type = "square-root", in = "h2" }
h1  = { type = "integrator", in = ["2e-3*one", "-1.5e-3*r1"], initial = 3.2 }
h2  = { type = "integrator", in = ["1.5e-3*r1", "-1.8e-3*r2"], initial = 0.4 }
)toml",
     {{"h1", 1080, 2.610939329758902, 3.2}, {"h2", 3600, 1.462787467923222, 1.5}},
     0.01},
    // a shell of 800 m/s with quadratic drag [m]
    {"projectile",
     50,
     R"toml(
one = { type = "constant" }
vx2 = { type = "squarer", in = "vx" }
vy2 = { type = "squarer", in = "vy" }
v2  = { type = "summer", in = ["vx2", "vy2"] }
v   = { type = "square-root", in = "v2", initial = 800 }
ax  = { type = "multiplier", in = ["v", "vx"] }
ay  = { type = "multiplier", in = ["v", "vy"] }
vx  = { type = "integrator", in = "-5e-5*ax", initial = "800*cos(pi/4)" }
vy  = { type = "integrator", in = ["-9.81*one", "-5e-5*ay"], initial = "800*sin(pi/4)" }
x   = { type = "integrator", in = "vx" }
y   = { type = "integrator", in = "vy" }
)toml",
     {{"x", 15, 6706.416439087729, 16400},
      {"y", 35, 8043.762301028702, 8050},
      {"x", 50, 16378.88063478626, 16400}},
     0.003},
    // a rocket that burns 1.2 t of its 2 t at 50 kN [m, s]
    {"rocket",
     60,
     R"toml(
one    = { type = "constant" }
m      = { type = "integrator", in = "-20*one", initial = 2000 }
thrust = { type = "gain", in = "one", factor = 5e4 }
a      = { type = "divider", numerator = "thrust", denominator = "m", initial = 25 }
v      = { type = "integrator", in = ["a", "-9.81*one"] }
h      = { type = "integrator", in = "v" }
)toml",
     {{"v", 42, 949.7979386041683, 1700}, {"h", 60, 40712.926812573096, 40700}},
     0.02},
    // a satellite of 8.6 km/s at 7000 km [km, s]
    {"satellite",
     9000,
     R"toml(
one = { type = "constant" }
u   = { type = "divider", numerator = "one", denominator = "r" }
uu  = { type = "squarer", in = "u" }
uuu = { type = "multiplier", in = ["uu", "u"] }
v   = { type = "integrator", in = ["(7000*8.6)^2*uuu", "-398600.4418*uu"] }
r   = { type = "integrator", in = "v", initial = 7000 }
phi = { type = "integrator", in = "7000*8.6*uu" }
)toml",
     {{"r", 2700, 11178.01462338314, 13000},
      {"r", 9000, 7908.547330410978, 13000},
      {"phi", 9000, 5.236794719735244, 5.3}},
     0.025},
    // Michaelis and Menten, from 100 umol/l [mol/l, s]: an ideal amplifier divides by numbers of 1e-4, before
    // a
    // real summer of a TR-10 gives it one
    {"enzyme",
     200,
     R"toml(
one = { type = "constant" }
d   = { type = "summer", in = ["5e-5*one", "s"] }
q   = { type = "divider", numerator = "s", denominator = "d", gain = "inf", bandwidth = "inf" }
s   = { type = "integrator", in = "-1e-6*q", initial = 1e-4 }
p   = { type = "integrator", in = "1e-6*q" }
)toml",
     {{"s", 60, 6.30567519916192e-05, 1e-4}, {"p", 200, 8.91142447119112e-05, 9e-5}},
     std::nullopt},
    // Mathieu's equation at 1 kHz, from 2 um [m]
    {"mathieu",
     0.01,
     R"toml(
drive = { type = "sine-source", amplitude = 1, frequency = "1 kHz", phase = "90 deg" }
dy    = { type = "multiplier", in = ["drive", "y"] }
v     = { type = "integrator", in = ["-(pi*1000)^2*0.2*y", "(pi*1000)^2*2*0.35*dy"] }
y     = { type = "integrator", in = "v", initial = 2e-6 }
)toml",
     {{"y", 0.003, 5.887989689840181e-07, 3.3e-6}, {"y", 0.01, -1.0871761075135724e-06, 3.3e-6}},
     0.01},
    // a ball on a stiff floor, from 800 mm [mm]: a dead zone, of which a comparator makes the corner on a
    // Model-1
    {"ball",
     2,
     R"toml(
one = { type = "constant" }
s   = { type = "dead-zone", in = "y", low = 0, high = 1e7 }
v   = { type = "integrator", in = ["-9810*one", "-4e4*s"] }
y   = { type = "integrator", in = "v", initial = 800 }
)toml",
     {{"y", 0.6, 554.8925407580131, 800}, {"y", 2, 189.08236719263994, 800}},
     0.01,
     0.002,
     0.2},  // the floor gives by a fortieth of the height
    // a servo of 90 degrees by PID, whose drive has a limit [degrees]
    {"pid",
     8,
     R"toml(
one       = { type = "constant" }
e         = { type = "summer", in = ["90*one", "-a"] }
i         = { type = "integrator", in = "e" }
u         = { type = "summer", in = ["8*e", "2*i", "-3*w"] }
u_limited = { type = "limiter", in = "u", low = -200, high = 200 }
w         = { type = "integrator", in = ["u_limited", "-1.5*w"] }
a         = { type = "integrator", in = "w" }
)toml",
     {{"a", 2.4, 107.539562970445, 108}, {"a", 8, 93.11634371068662, 108}},
     0.002},
    // an epidemic in a town of 2.4 million [persons, days]: 100 of them are a start of 1.4e-4
    {"epidemic",
     100,
     R"toml(
si = { type = "multiplier", in = ["s", "i"] }
s  = { type = "integrator", in = "-0.35/2.4e6*si", initial = 2399900 }
i  = { type = "integrator", in = ["0.35/2.4e6*si", "-0.12*i"], initial = 100 }
)toml",
     {{"s", 70, 199589.44678020477, 2.4e6}, {"i", 30, 90520.49279633292, 7e5}},
     kAnywhere,
     1e-4},
};

diagram::Diagram diagram_of(const Problem& problem) {
  std::string text = fmt::format("format = \"oblique-diagram/1\"\n[run]\nuntil = {}\n[blocks]{}[outputs]\n",
                                 problem.until, problem.blocks);
  std::string expect = "[expect]\n";
  for (const Truth& truth : problem.truths) {
    const std::string line = fmt::format("{0} = \"{0}\"\n", truth.output);
    if (text.find("\n" + line) == std::string::npos) text += line;
    // What the solver's tolerance of 1e-8 a step gathers, and the servo amplifiers' gain of 1e6 leaves.
    expect += fmt::format("\"{} at {}\" = {{ value = {:.17g}, within = {} }}\n", truth.output, truth.time,
                          truth.value, 1e-5 * truth.size);
  }
  return diagram::parse_diagram(text + expect, "problem.toml");
}

std::vector<report::ExpectationResult> results_of(const diagram::Diagram& diagram) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, shipped_blocks());
  solve::RunOptions options = solve::options_of(diagram.run);
  report::ask_for_expectations(diagram, options);
  const solve::Run run = solve::run(network::Program(network::assemble(flat)), flat, options);
  return report::check_expectations(diagram, run);
}

using Placed = std::tuple<Problem, std::string>;

class TextbookDiagram : public ::testing::TestWithParam<Placed> {};
INSTANTIATE_TEST_SUITE_P(DiagramOnMachine, TextbookDiagram,
                         ::testing::Combine(::testing::ValuesIn(kProblems),
                                            ::testing::Values("tr-10", "model-1")),
                         [](const auto& tested) {
                           std::string name =
                               std::string(std::get<0>(tested.param).name) + "_" + std::get<1>(tested.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(TextbookDiagram, GivesTheTruthAndUsesTheMachine) {
  const auto& [problem, machine] = GetParam();
  if (machine == "tr-10" && !problem.on_tr10) return;
  const diagram::Diagram diagram = diagram_of(problem);
  const DiagramOnMachine placed = put_on_machine(diagram, shipped_blocks(), *diagram::find_machine(machine));
  EXPECT_EQ(placed.failure, "");
  EXPECT_TRUE(placed.overloads.empty()) << placed.overloads.front().signal;
  if (placed.loops) {
    EXPECT_TRUE(placed.loops->well_damped()) << fault_of(*placed.loops);
  }

  diagram::Diagram ideal = placed.made.diagram;
  ideal.machine.profile = "ideal";
  for (const report::ExpectationResult& result : results_of(ideal))
    EXPECT_TRUE(result.met) << result.expectation.text << " = " << result.actual;
  const std::vector<report::ExpectationResult> real = results_of(placed.made.diagram);
  for (std::size_t k = 0; k < real.size(); ++k) {
    const Truth& truth = problem.truths[k];
    EXPECT_NEAR(real[k].actual, truth.value, (machine == "tr-10" ? *problem.on_tr10 : 1e-5) * truth.size)
        << real[k].expectation.text;
  }

  const diagram::FlatDiagram flat = diagram::flatten(placed.made.diagram, shipped_blocks());
  for (const diagram::FlatBlock& block : flat.blocks) {
    if (const auto setting = block.definition->find_parameter("setting")) {
      EXPECT_GE(block.parameters[*setting], problem.least_setting) << block.path;
      EXPECT_LE(block.parameters[*setting], 1) << block.path;
    }
    // No wire goes to more than two inputs of one element.
    for (const diagram::FlatInput& input : block.inputs) {
      for (const diagram::FlatTerm& term : input.terms) {
        const auto is_same = [&](const diagram::FlatTerm& other) {
          return other.signal == term.signal && other.weight == term.weight;
        };
        EXPECT_LE(std::count_if(input.terms.begin(), input.terms.end(), is_same), 2) << block.path;
      }
    }
  }
  for (const machine::SignalScale& scale : placed.made.scales) {
    const auto of_scale = [&](const diagram::FlatBlock& block) { return block.path == scale.signal; };
    const auto block = std::find_if(flat.blocks.begin(), flat.blocks.end(), of_scale);
    ASSERT_NE(block, flat.blocks.end());
    EXPECT_LE(scale.largest, 1 + 1e-5) << scale.signal;
    // What a multiplier gives is the product of two signals, whose peaks may lie apart.
    if (block->definition->role != diagram::Role::multiplier) {
      EXPECT_GE(scale.largest, problem.least_signal) << scale.signal;
    }
  }
}

}  // namespace
}  // namespace oblique::commission
