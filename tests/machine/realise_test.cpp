// SPDX-License-Identifier: MIT
#include <oblique/machine/realise.h>

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>

#include "../support/compiled.h"
#include "machine_runs.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::diagram_text;
using testing::difference;
using testing::expect_machine_elements;
using ::testing::HasSubstr;
using testing::inverting_machine;
using testing::message_of;
using testing::shipped_blocks;
using testing::signed_machine;

const diagram::BlockInstance& block(const diagram::Diagram& diagram, const std::string& name) {
  const auto found = std::find_if(diagram.blocks.begin(), diagram.blocks.end(),
                                  [&](const diagram::BlockInstance& b) { return b.name == name; });
  if (found == diagram.blocks.end())
    throw std::out_of_range(name + " in\n" + diagram::write_diagram(diagram));
  return *found;
}

diagram::Diagram realised(const std::string& blocks, const std::string& rest,
                          const diagram::MachineProfile& machine) {
  return realise(diagram::parse_diagram(diagram_text(blocks, rest), "d.toml"), shipped_blocks(), machine)
      .diagram;
}

std::string line_of(const diagram::Diagram& diagram, const std::string& name) {
  const std::string text = diagram::write_diagram(diagram);
  const std::size_t begin = text.find("\n" + name + " ");
  if (begin == std::string::npos) return "nothing in:\n" + text;
  return text.substr(begin + 1, text.find('\n', begin + 1) - begin - 1);
}

TEST(Realise, SharesThePotentiometerOfOneSignalAndOneSetting) {
  const diagram::Diagram made = realised(R"(
a = { type = "integrator", in = ["-0.3*b"] }
b = { type = "integrator", in = ["a", "c"], initial = 1 }
c = { type = "integrator", in = ["-3*b"] }
)",
                                         "", inverting_machine());
  EXPECT_THAT(line_of(made, "pot_1"), HasSubstr("setting = 0.3"));
  const auto potentiometers =
      std::count_if(made.blocks.begin(), made.blocks.end(),
                    [](const diagram::BlockInstance& b) { return b.type == "potentiometer"; });
  EXPECT_EQ(potentiometers, 1);  // before an input of 1 and one of 10
}

TEST(Realise, CarriesInitialValuesFromTheReferenceWithTheSignOfTheSignal) {
  const std::string blocks = R"(
x = { type = "integrator", in = ["-x"], initial = 0.5 }
y = { type = "integrator", in = ["x"], initial = -1 }
)";
  const diagram::Diagram made = realised(blocks, "", inverting_machine());
  EXPECT_THAT(line_of(made, "x"), HasSubstr("in = \"x\", start = \"pot_1\""));
  EXPECT_THAT(line_of(made, "pot_1"), HasSubstr("in = \"reference\", setting = 0.5"));
  EXPECT_THAT(line_of(made, "minus_y"), HasSubstr("in = \"x\", start = \"reference\""));
  EXPECT_THAT(line_of(realised(blocks, "", signed_machine()), "x"), HasSubstr("initial = 0.5"));
}

// Whichever way z is fed, it is carried as its negative one way, and so is what it starts from.
TEST(Realise, CarriesInitialValuesFromSignalsWithTheSignOfTheSignal) {
  std::string written;
  for (const char* const inputs : {R"("x", "y")", R"("-x", "-y")"}) {
    const diagram::Diagram diagram =
        diagram::parse_diagram(diagram_text(R"(
x = { type = "integrator", in = ["-y"], initial = 0.5 }
y = { type = "integrator", in = ["x"], initial = 0.25 }
z = { type = "integrator", in = [)" + std::string(inputs) +
                                            R"(], start = "0.5*x", initial = 0.125 }
)"),
                               "d.toml");
    const diagram::Diagram made = realise(diagram, shipped_blocks(), inverting_machine()).diagram;
    EXPECT_LT(difference(diagram, made), 1e-6) << diagram::write_diagram(made);
    written += diagram::write_diagram(made);
  }
  EXPECT_THAT(written, HasSubstr("initial = 0.125"));
  EXPECT_THAT(written, HasSubstr("initial = -0.125"));
}

TEST(Realise, LeavesInitialValuesBeyondTheReferenceToTheIntegrator) {
  const diagram::Diagram made =
      realised("x = { type = \"integrator\", in = [\"-x\"], initial = 2 }\n", "", inverting_machine());
  EXPECT_THAT(line_of(made, "x"), HasSubstr("in = \"x\", initial = 2"));
}

// in.hold would become in_hold, which equations keep for themselves.
TEST(Realise, GivesFlattenedBlocksNamesThatTheyMayHave) {
  const diagram::BlockLibrary library =
      testing::shipped_blocks_and("cell",
                                  "[outputs]\nout = { wire = \"hold\" }\n[blocks]\n"
                                  "hold = { type = \"integrator\", in = [\"-0.5*hold\"], initial = 1 }\n");
  const diagram::Diagram diagram = diagram::parse_diagram(
      diagram_text("in = { type = \"cell\" }\nin_hold_2 = { type = \"cell\" }\n"), "d.toml");
  const diagram::Diagram made = realise(diagram, library, inverting_machine()).diagram;
  EXPECT_NO_THROW(diagram::parse_diagram(diagram::write_diagram(made), "made.toml"))
      << diagram::write_diagram(made);
}

TEST(Realise, KeepsWhatOutputsAdd) {
  const diagram::Diagram made = realised(
      "x = { type = \"integrator\", in = [\"-0.5*x\"], initial = 1 }\n",
      "[outputs]\nx = { signal = \"x\", scale = 4, offset = 65536, unit = \"m\" }\n", inverting_machine());
  EXPECT_EQ(made.outputs[0].offset, 65536);
  EXPECT_EQ(made.outputs[0].unit, "m");
}

TEST(Realise, LeavesOutWhatOnlyMultipliesByAConstant) {
  const diagram::Diagram made = realised(R"(
two  = { type = "constant", value = 2 }
x    = { type = "integrator", in = ["-x"], initial = 1 }
k    = { type = "gain", in = "x", factor = 4 }
p    = { type = "potentiometer", in = "k", setting = 0.5 }
m    = { type = "multiplier", in = ["p", "two"] }
n    = { type = "inverter", in = "m" }
s    = { type = "summer", in = ["0.25*n"] }
out  = { type = "integrator", in = ["s", "n"] }
)",
                                         "[outputs]\nout = \"out\"\n", inverting_machine());
  // s = −x and n = −4x: together −5x, which an inverting integrator takes as 10 times half of x
  EXPECT_THAT(line_of(made, "out"), HasSubstr("in = \"10*pot_1\""));
  EXPECT_THAT(line_of(made, "pot_1"), HasSubstr("in = \"x\", setting = 0.5"));
  EXPECT_EQ(made.blocks.size(), 4U);  // reference, x, pot_1, out
}

TEST(Realise, FormsAProductOnce) {
  const diagram::Diagram made = realised(R"(
x = { type = "integrator", in = ["-y"], initial = 1 }
y = { type = "integrator", in = ["x"] }
a = { type = "multiplier", in = ["x", "y"] }
b = { type = "multiplier", in = ["y", "x"] }
c = { type = "squarer", in = "x" }
d = { type = "multiplier", in = ["x", "x"] }
s = { type = "summer", in = ["a", "b", "c", "d"] }
)",
                                         "[outputs]\ns = \"s\"\n", inverting_machine());
  EXPECT_EQ(std::count_if(made.blocks.begin(), made.blocks.end(),
                          [](const diagram::BlockInstance& b) { return b.type == "multiplier"; }),
            2);
}

// Above its first element; of a composite too.
TEST(Realise, KeepsTheCommentOfABlock) {
  diagram::Diagram diagram = diagram::parse_diagram(diagram_text(R"(
x = { type = "integrator", in = ["-x"], initial = 0.5 }
q = { type = "divider", numerator = "x", denominator = "one" }
one = { type = "constant" }
)"),
                                                    "d.toml");
  diagram.blocks[0].comment = "falls";
  diagram.blocks[1].comment = "a quotient";
  const diagram::Diagram made = realise(diagram, shipped_blocks(), inverting_machine()).diagram;
  for (const std::string comment : {"falls", "a quotient"}) {
    EXPECT_EQ(std::count_if(made.blocks.begin(), made.blocks.end(),
                            [&](const diagram::BlockInstance& b) { return b.comment == comment; }),
              1);
  }
}

// Next to nothing, but all there is.
TEST(Realise, KeepsAWeightThatIsSmallAlone) {
  const diagram::Diagram made = realised(R"(
x = { type = "integrator", in = [], initial = 1 }
y = { type = "integrator", in = ["-1e-17*x"] }
)",
                                         "", inverting_machine());
  EXPECT_THAT(diagram::write_diagram(made), HasSubstr("setting = 1e-17"));
}

// 0.1 + 0.2 − 0.3 is 5.6e-17: rounding beside the weights, and no potentiometer.
TEST(Realise, LeavesOutWeightsThatCancel) {
  const diagram::Diagram made = realised(R"(
x = { type = "integrator", in = [], initial = 1 }
y = { type = "integrator", in = ["-0.5*y", "0.1*x", "0.2*x", "-0.3*x"] }
)",
                                         "", inverting_machine());
  EXPECT_THAT(diagram::write_diagram(made), Not(HasSubstr("e-17")));
}

TEST(Realise, PutsAnAmplifierBeforeAFactorAboveOne) {
  const std::string blocks = R"(
x = { type = "integrator", in = ["-x"], initial = 0.3 }
m = { type = "multiplier", in = ["3*x", "-3*x"] }
)";
  const diagram::Diagram made = realised(blocks, "", inverting_machine());
  EXPECT_EQ(std::count_if(made.blocks.begin(), made.blocks.end(),
                          [](const diagram::BlockInstance& b) { return b.type == "summer"; }),
            1)
      << diagram::write_diagram(made);
  expect_machine_elements(made, false);
  EXPECT_LT(difference(diagram::parse_diagram(diagram_text(blocks), "d.toml"), made), 1e-7);
}

TEST(Realise, ChoosesTheTimeFactorOfTheMachine) {
  diagram::MachineProfile machine = inverting_machine();
  machine.rates = {10, 1000};
  const std::string blocks = "x = { type = \"integrator\", in = [\"-20*x\"], rate = 50, initial = 1 }\n";
  EXPECT_THAT(line_of(realised(blocks, "", machine), "x"),
              HasSubstr("in = \"x\", start = \"reference\", rate = 1000"));
  machine.rates = {10};
  EXPECT_THAT(line_of(realised(blocks, "", machine), "x"), HasSubstr("rate = 100"));
}

// A servo amplifier inverts by itself: carried as its negative it takes the negatives of all its inputs.
TEST(Realise, TurnsServoAmplifiersRound) {
  const std::string blocks = R"(
x = { type = "integrator", in = ["-0.2*one"], initial = 1 }
one = { type = "constant" }
r = { type = "servo-amplifier", in = ["r2", "-x"], initial = 1, bandwidth = "1 kHz" }
r2 = { type = "multiplier", in = ["r", "r"] }
)";
  const diagram::Diagram diagram = diagram::parse_diagram(diagram_text(blocks), "d.toml");
  for (const diagram::MachineProfile& machine : {inverting_machine(), signed_machine()})
    EXPECT_LT(difference(diagram, realise(diagram, shipped_blocks(), machine).diagram), 1e-6);
}

TEST(Realise, LeavesTheGainOfServoAmplifiersToAMachineThatStatesIt) {
  const std::string blocks =
      "x = { type = \"servo-amplifier\", in = [\"x\", \"-0.5*one\"], gain = 1e5 }\none = { type = "
      "\"constant\" "
      "}\n";
  diagram::MachineProfile machine = inverting_machine();
  EXPECT_THAT(line_of(realised(blocks, "", machine), "x"), HasSubstr("gain = 100000, bandwidth = 10 "));
  machine.errors = {{"servo-amplifier", "gain", 1000, "amplifier, open-loop gain"}};
  EXPECT_THAT(line_of(realised(blocks, "", machine), "x"), Not(HasSubstr("gain")));
}

TEST(Realise, KeepsOtherBlocksAsTheyAre) {
  const std::string blocks = R"(
x = { type = "integrator", in = ["-2*y"], initial = 1 }
y = { type = "integrator", in = ["2*x"] }
f = { type = "function-generator", in = "-x", points = [[-1, 1], [0, 0], [1, 0.5]] }
u = { type = "time-function", formula = "cos(2*time)^2", scale = 0.5 }
v = { type = "integrator", in = ["-0.5*u", "0.1*f"] }
)";
  const diagram::Diagram diagram =
      diagram::parse_diagram(diagram_text(blocks, "[outputs]\nf = \"f\"\nv = \"v\"\n"), "d.toml");
  const diagram::Diagram made = realise(diagram, shipped_blocks(), inverting_machine()).diagram;
  EXPECT_EQ(block(made, "f").type, "function-generator");
  EXPECT_LT(difference(diagram, made), 1e-6);
}

// An offset at a summing junction turns with the output. The weights are 1, since an amplifier's noise gain
// is a matter of its input resistors.
TEST(Realise, TurnsImperfectionsWithTheSignal) {
  const std::string blocks = R"(
x = { type = "integrator", in = ["-y"], initial = 0.5, drift = 0.01 }
y = { type = "integrator", in = ["x"], offset = 0.02 }
s = { type = "summer", in = ["x", "y"], offset = 0.03 }
n = { type = "inverter", in = "s", offset = 0.04, drift = 0.005 }
m = { type = "multiplier", in = ["n", "y"], offset = 0.05 }
c = { type = "servo-amplifier", in = ["c", "-m"], bandwidth = "1 kHz", offset = 0.06 }
z = { type = "integrator", in = ["c", "-m", "s"] }
)";
  for (const char* const inverting : {"", "[machine]\ninverting = true\n"}) {
    const diagram::Diagram diagram = diagram::parse_diagram(diagram_text(blocks, inverting), "d.toml");
    const diagram::Diagram made = realise(diagram, shipped_blocks(), inverting_machine()).diagram;
    EXPECT_THAT(diagram::write_diagram(made), HasSubstr("minus_"));  // or nothing is turned
    EXPECT_LT(difference(diagram, made), 1e-6) << diagram::write_diagram(made);
  }
}

TEST(Realise, KeepsGainsThatDriveEachOther) {
  const std::string blocks = R"(
a = { type = "gain", in = "b", factor = 0.5 }
b = { type = "summer", in = ["-a", "one"] }
one = { type = "constant" }
)";
  const diagram::Diagram diagram = diagram::parse_diagram(diagram_text(blocks), "d.toml");
  EXPECT_LT(difference(diagram, realise(diagram, shipped_blocks(), inverting_machine()).diagram), 1e-12);
}

// A composite has its own convention: the summers in crank-generator do not invert, whatever the diagram
// says.
TEST(Realise, KnowsWhichSummersOfTheDiagramInvert) {
  diagram::Diagram diagram = diagram::parse_diagram(diagram_text(R"(
crank = { type = "crank-generator" }
s = { type = "summer", in = ["0.5*crank.cos", "0.25*crank.sin"] }
)"),
                                                    "d.toml");
  diagram.machine.inverting = true;
  for (const diagram::MachineProfile& machine : {inverting_machine(), signed_machine()})
    EXPECT_LT(difference(diagram, realise(diagram, shipped_blocks(), machine).diagram), 1e-6);
}

TEST(Realise, GivesAbsoluteTolerancesToTheStatesTheyWereMeantFor) {
  diagram::Diagram diagram = diagram::parse_diagram(
      diagram_text("x = { type = \"integrator\", in = [\"x\"], initial = 0.1 }\n"), "d.toml");
  diagram.run.tolerances = {{"x", 1e-12}};
  const diagram::Diagram made = realise(diagram, shipped_blocks(), inverting_machine()).diagram;
  ASSERT_EQ(made.run.tolerances.size(), 1U);
  EXPECT_NO_THROW(diagram::flatten(made, shipped_blocks()));
  EXPECT_EQ(made.run.tolerances[0].second, 1e-12);
}

// x is carried as its negative, or not: its phase ends where x is below 0.
TEST(Realise, KeepsTheTimelineAndTheGroups) {
  const diagram::Diagram made = realise(diagram::read_diagram(std::string(OBLIQUE_SOURCE_DIR) +
                                                              "/diagrams/lessons/repetitive-operation.toml"),
                                        shipped_blocks(), inverting_machine())
                                    .diagram;
  ASSERT_EQ(made.groups.size(), 1U);
  EXPECT_EQ(made.groups[0].hold, "is_below");
  ASSERT_EQ(made.groups[0].blocks.size(), 1U);
  EXPECT_THAT(made.groups[0].blocks[0], ::testing::EndsWith("time_above"));
  ASSERT_EQ(made.timeline.phases.size(), 2U);
  EXPECT_EQ(made.timeline.phases[0].duration, 0.4);
  EXPECT_THAT(made.timeline.phases[1].until, ::testing::AnyOf("x < 0", "minus_x > 0"));
  EXPECT_TRUE(std::isinf(made.timeline.cycles));
}

TEST(Realise, RefusesPotentiometersWithImperfectionsOfTheirOwn) {
  const std::string message = message_of<RealiseError>([] {
    realised(
        "x = { type = \"integrator\", in = [\"-p\"], initial = 1 }\n"
        "p = { type = \"potentiometer\", in = \"x\", setting = 0.5, turns = 1000 }\n",
        "", inverting_machine());
  });
  EXPECT_THAT(message, HasSubstr("d.toml:4:1: potentiometer 'p' has imperfections of its own; expected a "
                                 "setting and nothing else"));
}

}  // namespace
}  // namespace oblique::machine
