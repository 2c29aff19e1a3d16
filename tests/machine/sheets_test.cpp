// SPDX-License-Identifier: MIT
#include <oblique/machine/sheets.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/machine/realise.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>

#include "../support/compiled.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using testing::inverting_machine;
using testing::shipped_blocks;

// ẋ = −2.5 y + 0.2,  ẏ = 2.5 x, s = −25 (x·½y)
const char* const kBlocks = R"(
x   = { type = "integrator", in = ["-2.5*y", "0.2*one"], initial = 0.6 }
y   = { type = "integrator", in = ["2.5*x"], initial = -1 }
xy  = { type = "multiplier", in = ["x", "0.5*y"] }
s   = { type = "summer", in = ["-25*xy"] }
one = { type = "constant" }
)";

MachineSheets sheets(const diagram::MachineProfile& machine) {
  const diagram::Diagram diagram = diagram::parse_diagram(testing::diagram_text(kBlocks), "d.toml");
  const diagram::Diagram made = realise(diagram, shipped_blocks(), machine).diagram;
  const diagram::FlatDiagram flat = diagram::flatten(made, shipped_blocks());
  return make_sheets(flat, solve::static_test(network::Program(network::assemble(flat)), "d.toml"), machine);
}

diagram::MachineProfile ten_volts() {
  diagram::MachineProfile machine = inverting_machine();
  machine.unit = 10;
  return machine;
}

/// Those of a diagram of these blocks as they stand, on a machine of 10 V.
MachineSheets sheets_as_written(const std::string& blocks) {
  const diagram::FlatDiagram flat =
      diagram::flatten(diagram::parse_diagram(testing::diagram_text(blocks), "d.toml"), shipped_blocks());
  return make_sheets(flat, solve::static_test(network::Program(network::assemble(flat)), "d.toml"),
                     ten_volts());
}

// By hand, with integrators that invert: x is −∫(10·¼ y − 0.2), y is −∫10·¼ (−x), and −x takes an
// inverter; 25 is three inputs of 10 behind 25/30.
TEST(Sheets, ListEveryConnectionWithTheGainOfItsInput) {
  const Sheet list = sheets(ten_volts()).connections;
  EXPECT_THAT(list.columns, ElementsAre("from", "signal", "to", "element", "input"));
  EXPECT_THAT(list.rows, Contains(ElementsAre("A3", "y", "P1", "pot_1", "in")));
  EXPECT_THAT(list.rows, Contains(ElementsAre("P1", "pot_1", "A1", "x", "×10")));
  EXPECT_THAT(list.rows, Contains(ElementsAre("−REF", "minus_reference", "P2", "pot_2", "in")));
  EXPECT_THAT(list.rows, Contains(ElementsAre("P3", "pot_3", "A1", "x", "initial value")));
  EXPECT_THAT(list.rows, Contains(ElementsAre("P6", "pot_6", "A4", "s", "3 inputs ×10")));
  EXPECT_THAT(list.rows, Contains(ElementsAre("P5", "pot_5", "M1", "xy", "y")));
  EXPECT_THAT(list.rows, Contains(ElementsAre("A1", "x", "A2", "minus_x", "in")));
}

TEST(Sheets, LeaveOutWiresThatCarryNothing) {
  const MachineSheets made = sheets_as_written(R"(
one = { type = "constant" }
x = { type = "integrator", in = ["0*one"] }
)");
  EXPECT_TRUE(made.connections.rows.empty());
}

TEST(Sheets, SayWhatPotentiometersStandFor) {
  const Sheet pots = sheets(ten_volts()).potentiometers;
  EXPECT_THAT(pots.rows, Contains(ElementsAre("P1", "0.2500", "A3", "A1 ×10", "2.5 1/s of y in x")));
  EXPECT_THAT(pots.rows, Contains(ElementsAre("P2", "0.2000", "−REF", "A1 ×1", "−0.2 1/s in x")));
  EXPECT_THAT(pots.rows,
              Contains(ElementsAre("P3", "0.6000", "+REF", "A1 initial value", "x starts at 0.6")));
  EXPECT_THAT(pots.rows, Contains(ElementsAre("P6", "0.8333", "M1", "A4 3 inputs ×10", "25 of xy in s")));
}

TEST(Sheets, ListAPotentiometerThatIsTheFirstBlock) {
  const Sheet pots = sheets_as_written(R"(
a = { type = "potentiometer", in = "one", setting = 0.25 }
one = { type = "constant" }
x = { type = "integrator", in = ["a"] }
)")
                         .potentiometers;
  ASSERT_EQ(pots.rows.size(), 1U);
  EXPECT_EQ(pots.rows[0][0], "P1");
  EXPECT_EQ(pots.rows[0][1], "0.2500");
}

// x = 0.6, y = −1: ẋ = 2.5 + 0.2, ẏ = 1.5, x·½y = −0.3 [machine unit]; 10 V each.
TEST(Sheets, TellWhatEveryElementShowsAtTheStart) {
  const Sheet test = sheets(ten_volts()).static_test;
  EXPECT_THAT(test.columns, ElementsAre("element", "signal", "kind", "output [V]", "derivative [V/s]"));
  EXPECT_THAT(test.rows, Contains(ElementsAre("A1", "x", "integrator, k0 = 1 1/s", "6.0000", "27.0000")));
  EXPECT_THAT(test.rows, Contains(ElementsAre("A2", "minus_x", "inverter", "-6.0000", "")));
  EXPECT_THAT(test.rows, Contains(ElementsAre("A3", "y", "integrator, k0 = 1 1/s", "-10.0000", "15.0000")));
  EXPECT_THAT(test.rows, Contains(ElementsAre("M1", "xy", "multiplier", "-3.0000", "")));
  EXPECT_THAT(test.rows, Contains(ElementsAre("P2", "pot_2", "potentiometer", "-2.0000", "")));
}

// By hand: about 0 the line from (−0.4, −0.1) to (0.2, 0.2), of slope ½; above it 1, below it −1; then a jump
// of 0.5 at 0.5, beyond which it is level.
TEST(Sheets, GiveTheSettingsOfFunctionGenerators) {
  const Sheet functions = sheets_as_written(R"(
f = { type = "function-generator", in = "x", points = [[-1, 0.5], [-0.4, -0.1], [0.2, 0.2], [0.5, 0.5], [0.5, 0], [1, 0]] }
x = { type = "integrator", in = ["f"] }
)")
                              .functions;
  EXPECT_THAT(functions.columns, ElementsAre("element", "signal", "breakpoint [V]", "output [V]",
                                             "slope beyond", "slope added", "side"));
  EXPECT_THAT(functions.rows,
              ElementsAre(ElementsAre("F1", "f", "0.0000", "1.0000", "0.5000", "", ""),
                          ElementsAre("F1", "f", "2.0000", "2.0000", "1.0000", "0.5000", "above"),
                          ElementsAre("F1", "f", "5.0000", "5.0000", "jump", "", "above"),
                          ElementsAre("F1", "f", "5.0000", "0.0000", "0.0000", "", "above"),
                          ElementsAre("F1", "f", "-4.0000", "-1.0000", "-1.0000", "-1.5000", "below")));
  EXPECT_TRUE(sheets(ten_volts()).functions.rows.empty());
}

/// What a function generator gives that is set by a sheet alone, from the line about zero outwards [V].
double by_sheet(const Sheet& sheet, double x) {
  double y = std::stod(sheet.rows[0][3]) + std::stod(sheet.rows[0][4]) * x;
  for (std::size_t r = 1; r < sheet.rows.size(); ++r) {
    const double at = std::stod(sheet.rows[r][2]), added = std::stod(sheet.rows[r][5]);
    if (sheet.rows[r][6] == "above" ? x > at : x < at) y += added * (x - at);
  }
  return y;
}

// A corner at zero, or beside it by less than the sheet shows: of 0.0000 V nothing says on which side the
// function bends. −2 V … 2 V in steps of 1; four digits of a volt, and of slopes.
TEST(Sheets, SayOnWhichSideAFunctionGeneratorBends) {
  for (const char* const corner : {"0", "1e-9", "-1e-9"}) {
    for (const double below : {-1.0, 0.5}) {
      const diagram::FlatDiagram flat = diagram::flatten(
          diagram::parse_diagram(
              testing::diagram_text(fmt::format(
                  "x = {{ type = \"integrator\", in = [\"f\"] }}\nf = {{ type = \"function-generator\", in = "
                  "\"x\", points = [[-1, {}], [{}, 0], [1, 2]] }}\n",
                  -below, corner)),
              "d.toml"),
          shipped_blocks());
      const Sheet sheet =
          make_sheets(flat, solve::static_test(network::Program(network::assemble(flat)), "d.toml"),
                      ten_volts())
              .functions;
      for (const double x : {-2.0, -1.0, 1.0, 2.0})
        EXPECT_NEAR(by_sheet(sheet, x), x < 0 ? below * x : 2 * x, 4e-4) << corner << ", at " << x << " V";
    }
  }
}

// The same circuit on a machine whose summers do not invert: s = −25 xy is then −25 of xy at its inputs, and
// all else is as it was.
TEST(Sheets, GiveTheOtherSignToSummersThatDoNotInvert) {
  diagram::MachineProfile machine = testing::signed_machine();
  const MachineSheets inverting = sheets(machine);
  machine.inverting_summers = false;
  const MachineSheets made = sheets(machine);
  const auto to_s = [](const Sheet& connections) {
    std::vector<std::string> inputs;
    for (const auto& row : connections.rows) {
      if (row[3] == "s") inputs.push_back(row[4]);
    }
    return inputs;
  };
  EXPECT_THAT(to_s(inverting.connections), ElementsAre("3 inputs ×10"));
  EXPECT_THAT(to_s(made.connections), ElementsAre("3 inputs −×10"));
  EXPECT_EQ(to_csv(made.static_test), to_csv(inverting.static_test));
  EXPECT_THAT(made.potentiometers.rows, Contains(Contains("−25 of xy in s")));
}

TEST(Sheets, ComputeInMachineUnitsWhereTheVoltageIsNotKnown) {
  const Sheet test = sheets(inverting_machine()).static_test;
  EXPECT_THAT(test.columns, ElementsAre("element", "signal", "kind", "output [machine unit]",
                                        "derivative [machine unit/s]"));
  EXPECT_THAT(test.rows, Contains(ElementsAre("A1", "x", "integrator, k0 = 1 1/s", "0.6000", "2.7000")));
}

// What is set at an element itself, not by a potentiometer: in volts, but for what is the machine's.
TEST(Sheets, SayWhatIsSetAtAnElementItself) {
  const Sheet test = sheets_as_written(R"(
x = { type = "integrator", in = "k", rate = 10, initial = 0.2, limit = 0.5 }
k = { type = "comparator", in = "x", low = -1, hysteresis = 0.05 }
a = { type = "servo-amplifier", in = ["x", "a"], gain = 1e5, bandwidth = 20 }
)")
                         .static_test;
  std::vector<std::string> kinds;
  for (const auto& row : test.rows) kinds.push_back(row[2]);
  EXPECT_THAT(kinds, ElementsAre("integrator, k0 = 10 1/s, starts at 2 V, limited to ±5 V",
                                 "comparator, -10 or 10 V, hysteresis 0.5 V",
                                 "open amplifier, gain 1e+05, bandwidth 20 Hz"));
}

// What stays as it is on a machine has to be set there: voltages in volts, the rest as the block says.
TEST(Sheets, SayAllThatIsSetAtLogicAndDelays) {
  const Sheet test = sheets_as_written(R"(
x = { type = "integrator", in = ["m"] }
m = { type = "monostable", trigger = "n.carry", length = 0.4, low = -0.2 }
n = { type = "counter", clock = "x", modulus = 4, step = 0.25 }
)")
                         .static_test;
  EXPECT_THAT(test.rows, Contains(ElementsAre(
                             "X1", "m", "monostable, length 0.4 s, retriggerable 0, low -2 V, high 10 V",
                             "-2.0000", "")));
  EXPECT_THAT(test.rows,
              Contains(ElementsAre("X2", "n.out", "counter, modulus 4, step 2.5 V", "0.0000", "")));
}

TEST(Sheets, AreQuotedAsCsvWhereTheyHaveTo) {
  const Sheet sheet{"title", {"a", "b"}, {{"1, 2", "say \"x\""}, {"", "plain"}}};
  EXPECT_EQ(to_csv(sheet), "a,b\n\"1, 2\",\"say \"\"x\"\"\"\n,plain\n");
}

}  // namespace
}  // namespace oblique::machine
