// SPDX-License-Identifier: MIT
#include <oblique/commission/diagram_on_machine.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>
#include <oblique/solve/run.h>
#include <oblique/text/file.h>

#include "../support/compiled.h"

namespace oblique::commission {
namespace {

using testing::shipped_blocks;

DiagramOnMachine on(const std::string& machine, const std::string& file) {
  const diagram::Diagram diagram =
      diagram::read_diagram(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + file + ".toml");
  return put_on_machine(diagram, shipped_blocks(), *diagram::find_machine(machine));
}

/// The overloads of a run on the machine's elements, by the run's own watch.
std::size_t overloads_of(const diagram::Diagram& diagram) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, shipped_blocks());
  solve::RunOptions options = solve::options_of(diagram.run);
  options.watch_overloads = true;
  return solve::run(network::Program(network::assemble(flat)), flat, options).overloads.size();
}

// A multiplier of 1 MHz in the loop of an amplifier of gain 1e6 and 10 Hz: 1e7 Hz of unity gain meet a pole
// at a tenth of it. The loop must be slower, and is then well damped.
TEST(DiagramOnMachine, SlowsServoLoopsThatTheMultipliersCannotFollow) {
  const std::string file = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/lessons/division.toml";
  const std::string of_lesson = "gain = 1e8, bandwidth = inf";
  std::string text = text::read_file(file);
  ASSERT_NE(text.find(of_lesson), std::string::npos);
  text.replace(text.find(of_lesson), of_lesson.size(), R"(gain = 1e6, bandwidth = "10 Hz")");
  const DiagramOnMachine patched = put_on_machine(diagram::parse_diagram(text, file), shipped_blocks(),
                                                  *diagram::find_machine("the-analog-thing"));
  EXPECT_LT(patched.loop_speed, 1);
  EXPECT_GT(patched.loop_speed, 1e-3);
  EXPECT_THAT(patched.loop_fault, ::testing::HasSubstr("badly damped"));
  ASSERT_TRUE(patched.loops);
  EXPECT_TRUE(patched.loops->well_damped());
  EXPECT_LT(patched.difference, 1e-6);
  EXPECT_EQ(patched.failure, "");
}

// Monod's culture: of what it feeds on little is left in the end, so that the divisor of its growth is small.
const char* const kChemostat = R"toml(format = "oblique-diagram/1"
[run]
until = 40
[blocks]
one   = { type = "constant" }
d     = { type = "summer", in = ["s", "0.12*one"] }
m     = { type = "divider", numerator = "s", denominator = "d" }
grown = { type = "multiplier", in = ["m", "x"] }
s     = { type = "integrator", in = ["0.3*4*one", "-0.3*s", "-0.53/0.4*grown"], initial = 4 }
x     = { type = "integrator", in = ["0.53*grown", "-0.3*x"], initial = 0.05 }
[outputs]
x = "x"
)toml";

// Its amplifier is too fast for the multiplier of 1 MHz at full speed, and too slow for the culture at a
// millionth of it, the middle of what is tried.
TEST(DiagramOnMachine, FindsASpeedOfServoLoopsBetweenTooFastAndTooSlow) {
  const DiagramOnMachine patched =
      put_on_machine(diagram::parse_diagram(kChemostat, "chemostat.toml"), shipped_blocks(),
                     *diagram::find_machine("the-analog-thing"));
  EXPECT_LT(patched.loop_speed, 1);
  EXPECT_GT(patched.loop_speed, 1e-4);
  ASSERT_TRUE(patched.loops);
  EXPECT_TRUE(patched.loops->well_damped());
  EXPECT_EQ(patched.failure, "");
}

// The multipliers of a TR-10 err by 0.8 % of the machine unit: scaled for ideal elements alone signals would
// leave the range.
TEST(DiagramOnMachine, MakesRoomForTheErrorsOfTheMachine) {
  for (const std::string file : {"historical/van-der-pol", "historical/nerve", "lessons/duffing"}) {
    const DiagramOnMachine patched = on("tr-10", file);
    EXPECT_EQ(patched.failure, "") << file;
    EXPECT_TRUE(patched.overloads.empty()) << file << ": " << patched.overloads.front().signal;
    EXPECT_EQ(overloads_of(patched.made.diagram), 0U) << file;
    const auto most = std::max_element(patched.made.scales.begin(), patched.made.scales.end(),
                                       [](const auto& a, const auto& b) { return a.largest < b.largest; });
    EXPECT_GT(most->largest, 0.9) << file;
    EXPECT_LT(patched.difference, 1e-6) << file;
  }
}

// Kepler's ellipse of the eccentricity 0.4, by r³ = r · r² and two divisions: by the errors of its
// multipliers a machine leaves the ellipse. On a TR-10 it goes farther the more room it has; on THE ANALOG
// THING the loops of the quotients jump without end. It stays scaled for what it is to compute, and what goes
// too far is told.
TEST(DiagramOnMachine, GivesNoRoomToWhatLeavesTheSolution) {
  const diagram::Diagram kepler = diagram::parse_diagram(R"toml(format = "oblique-diagram/1"
[run]
until = 12
[blocks]
x  = { type = "integrator", in = ["u"], initial = 1 }
y  = { type = "integrator", in = ["v"] }
u  = { type = "integrator", in = ["-ax"] }
v  = { type = "integrator", in = ["-ay"], initial = "sqrt(1.4)" }
xx = { type = "squarer", in = "x" }
yy = { type = "squarer", in = "y" }
r2 = { type = "summer", in = ["xx", "yy"] }
r  = { type = "square-root", in = "r2", bandwidth = "100 Hz" }
r3 = { type = "multiplier", in = ["r", "r2"] }
ax = { type = "divider", numerator = "x", denominator = "r3", bandwidth = "100 Hz" }
ay = { type = "divider", numerator = "y", denominator = "r3", bandwidth = "100 Hz" }
[outputs]
x = "x"
y = "y"
)toml",
                                                         "kepler.toml");
  for (const char* const machine : {"tr-10", "the-analog-thing"}) {
    const DiagramOnMachine patched =
        put_on_machine(kepler, shipped_blocks(), *diagram::find_machine(machine));
    EXPECT_FALSE(patched.overloads.empty()) << machine;
    // The apocentre is at 1/(1 − e) (1 + e) = 7/3; twice that, of which two digits are chosen, is the most.
    for (const machine::SignalScale& scale : patched.made.scales) {
      if (scale.signal == "x" || scale.signal == "minus_x") {
        EXPECT_LE(scale.unit, 2 * 7.0 / 3 / 0.9) << machine;
      }
    }
    // With ideal elements it is the ellipse: what the gain of 10⁶ of the quotients leaves, at a denominator
    // of a tenth of the unit or more.
    EXPECT_LT(patched.difference, 1e-2) << machine;
  }
}

// Values in volts are those of the machine that the diagram is for, 10 V, wherever it is put: x′ = 0.3 t − x
// from ½. With ideal elements what is left is the solver's 1e-8.
TEST(DiagramOnMachine, TakesValuesInVoltsOfTheMachineThatTheDiagramIsFor) {
  const diagram::Diagram diagram = diagram::parse_diagram(R"toml(format = "oblique-diagram/1"
[machine]
profile = "tr-10"
inverting = false
[run]
until = 1
[blocks]
u = { type = "ramp", slope = "3 V/s" }
x = { type = "integrator", in = ["-x", "u"], initial = "5 V", limit = "8 V" }
[outputs]
x = "x"
)toml",
                                                          "volts.toml");
  // x = 0.5 e^(−t) + 0.3 (t − 1 + e^(−t))
  const double end = 0.8 * std::exp(-1);
  for (const char* const machine : {"tr-10", "rat-700"}) {
    const DiagramOnMachine placed =
        put_on_machine(diagram, shipped_blocks(), *diagram::find_machine(machine));
    EXPECT_LT(placed.difference, 1e-7) << machine;
    diagram::Diagram ideal = placed.made.diagram;
    ideal.machine.profile = "ideal";
    const solve::Trajectory run = solve::run(ideal, shipped_blocks()).trajectory;
    EXPECT_NEAR(run.at(run.rows() - 1, 1), end, 1e-7) << machine;
  }
}

// An amplifier that only inverts what stands at the machine unit goes beyond it by its own offset: there is
// room for that too.
TEST(DiagramOnMachine, MakesRoomForTheErrorsOfInverters) {
  const DiagramOnMachine placed = put_on_machine(diagram::parse_diagram(R"toml(format = "oblique-diagram/1"
[run]
until = 3
[blocks]
x = { type = "integrator", in = ["-0.5*x", "0.01*k"], initial = 1 }
y = { type = "integrator", in = ["x", "-y"] }
c = { type = "comparator", in = ["x", "-0.3*y"] }
d = { type = "comparator", in = ["y", "-0.1*x"] }
k = { type = "multiplier", in = ["c", "d"] }
[outputs]
x = "x"
)toml",
                                                                        "decay.toml"),
                                                 shipped_blocks(), *diagram::find_machine("tr-10"));
  EXPECT_EQ(placed.failure, "");
  EXPECT_TRUE(placed.overloads.empty()) << placed.overloads.front().signal;
}

// An orbit about a centre, by dividers: y reaches the machine unit and goes over it by a millionth, for which
// the gain of the amplifiers is to blame, and its square by two. The square is what the scale of y makes it.
TEST(DiagramOnMachine, MakesRoomForProductsInTheirFactors) {
  const diagram::Diagram diagram = diagram::parse_diagram(R"toml(format = "oblique-diagram/1"
[run]
until = 7
[blocks]
xx = { type = "squarer", in = "x" }
yy = { type = "squarer", in = "y" }
rr = { type = "summer", in = ["xx", "yy"] }
r  = { type = "square-root", in = "rr" }
r3 = { type = "multiplier", in = ["r", "rr"] }
ax = { type = "divider", numerator = "x", denominator = "r3" }
ay = { type = "divider", numerator = "y", denominator = "r3" }
u  = { type = "integrator", in = "-ax" }
v  = { type = "integrator", in = "-ay", initial = 1 }
x  = { type = "integrator", in = "u", initial = 1 }
y  = { type = "integrator", in = "v" }
[outputs]
x = "x"
y = "y"
)toml",
                                                          "orbit.toml");
  const DiagramOnMachine placed = put_on_machine(diagram, shipped_blocks(), *diagram::find_machine("gp-6"));
  EXPECT_EQ(placed.failure, "");
  EXPECT_TRUE(placed.overloads.empty()) << placed.overloads.front().signal;
}

// A circular orbit in r and r′: what the dividers' gain of 1e6 leaves of r′ is nobody's signal, and what
// becomes of it on the machine no difference. r = 1 is off by about as much.
TEST(DiagramOnMachine, TakesAnOutputThatIsNothingForNothing) {
  const diagram::Diagram diagram = diagram::parse_diagram(R"toml(format = "oblique-diagram/1"
[run]
until = 60
[blocks]
one = { type = "constant" }
u   = { type = "divider", numerator = "one", denominator = "r" }
uu  = { type = "squarer", in = "u" }
uuu = { type = "multiplier", in = ["uu", "u"] }
v   = { type = "integrator", in = ["uuu", "-uu"] }
r   = { type = "integrator", in = "v", initial = 1 }
[outputs]
r = "r"
v = "v"
)toml",
                                                          "orbit.toml");
  EXPECT_LT(put_on_machine(diagram, shipped_blocks(), *diagram::find_machine("model-1")).difference, 1e-5);
}

// A row that lies just where a pulse begins has two values: none of its own machine differs. Here all rows
// do, so that what ten straight lines leave of a sine, 1/(16·10²)·(∫√|sin|)² = 0.0036, shows half way
// between.
TEST(DiagramOnMachine, ComparesNothingWhereSomethingJumps) {
  const auto difference = [](const char* output) {
    const diagram::Diagram diagram = diagram::parse_diagram(std::string(R"toml(format = "oblique-diagram/1"
[run]
until = 3
samples = 31
[blocks]
clock = { type = "pulse-train", period = 0.1, width = 0.03, delay = 0.1 }
count = { type = "counter", clock = "clock" }
x     = { type = "ramp", slope = 1 }
wave  = { type = "sine", in = "x" }
[outputs]
y = ")toml") + output + "\"\n",
                                                            "clock.toml");
    return put_on_machine(diagram, shipped_blocks(), *diagram::find_machine("tr-48")).difference;
  };
  EXPECT_LT(difference("count.out"), 1e-7);
  EXPECT_GT(difference("wave"), 1e-3);
  EXPECT_LT(difference("wave"), 0.0036);
}

// What is expected of iterative and repetitive operation is met by the same diagrams on a machine.
TEST(DiagramOnMachine, KeepsModesOfOperation) {
  for (const std::string file :
       {"lessons/iterative-operation", "lessons/repetitive-operation", "historical/shooting"}) {
    const DiagramOnMachine patched = on("model-1", file);
    EXPECT_EQ(patched.failure, "") << file;
    EXPECT_LT(patched.difference, 1e-5) << file;
    const diagram::Diagram& made = patched.made.diagram;
    ASSERT_FALSE(made.expectations.empty()) << file;
    const diagram::FlatDiagram flat = diagram::flatten(made, shipped_blocks());
    solve::RunOptions options = solve::options_of(made.run);
    report::ask_for_expectations(made, options);
    const solve::Run run = solve::run(network::Program(network::assemble(flat)), flat, options);
    for (const report::ExpectationResult& result : report::check_expectations(made, run))
      EXPECT_TRUE(result.met) << file << ": " << result.expectation.text << " = " << result.actual;
  }
}

TEST(DiagramOnMachine, TellsOfADiagramWithoutServoLoopsNothingOfThem) {
  const DiagramOnMachine patched = on("tr-10", "lessons/circle");
  EXPECT_FALSE(patched.loops);
  EXPECT_EQ(patched.loop_speed, 1);
  EXPECT_LT(patched.difference, 1e-4);  // a thousand turns at a tolerance of 1e-8
}

}  // namespace
}  // namespace oblique::commission
