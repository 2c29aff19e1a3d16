// SPDX-License-Identifier: MIT
// Files as laboratories have them: volts, percent, decimal commas, typeset signs. Each is taken for what it
// says, or refused with what to do.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/flatten.h>

#include "../support/scratch_folder.h"
#include "small_library.h"

namespace oblique::diagram {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::message_of;

const BlockLibrary& shipped_blocks() {
  static const BlockLibrary shipped = BlockLibrary::shipped();
  return shipped;
}

std::string on(const std::string& machine) {
  return "[machine]\nprofile = \"" + machine + "\"\n";
}

FlatDiagram flat(const std::string& blocks, const std::string& rest = "",
                 const std::string& file = "d.toml") {
  return flatten(parse_diagram(testing::diagram_text(blocks, rest), file), shipped_blocks());
}

double parameter(const std::string& block, const std::string& name, const std::string& rest = "") {
  const FlatDiagram made = flat("one = { type = \"constant\" }\n" + block, rest);
  const FlatBlock& last = made.blocks.back();
  return last.parameters[last.definition->find_parameter(name).value()];
}

std::string refusal(const std::string& block, const std::string& rest = "") {
  return message_of([&] { flat("one = { type = \"constant\" }\n" + block, rest); });
}

/// The points of a recording of a file with this text.
text::PointTable recorded(const std::string& csv, const std::string& columns, const std::string& rest = "") {
  const test::ScratchFolder folder;
  std::ofstream(folder / "lab.csv", std::ios::binary) << csv;
  const FlatDiagram made =
      flat("u = { type = \"recording\", data = { file = \"lab.csv\", " + columns + " } }\n", rest,
           (folder / "d.toml").string());
  return made.blocks.back().points.front();
}

constexpr const char* kTU = "x = \"t\", y = \"u\"";

// --- parameters

TEST(LabFile, GivesVoltsOnItsMachine) {
  EXPECT_DOUBLE_EQ(
      parameter("x = { type = \"integrator\", in = \"one\", initial = \"30 V\" }\n", "initial", on("ec-1")),
      0.5);
  EXPECT_DOUBLE_EQ(parameter("x = { type = \"integrator\", in = \"one\", initial = \"\u22125 V\" }\n",
                             "initial", on("tr-10")),
                   -0.5);
  EXPECT_DOUBLE_EQ(parameter("x = { type = \"ramp\", slope = \"5 V/ms\" }\n", "slope", on("tr-10")), 500);
  EXPECT_DOUBLE_EQ(parameter("x = { type = \"comparator\", in = [\"one\"], hysteresis = \"250 mV\" }\n",
                             "hysteresis", on("tr-10")),
                   0.025);
}

TEST(LabFile, GivesVoltsOnNoMachine) {
  EXPECT_EQ(
      refusal("x = { type = \"integrator\", in = \"one\", initial = \"30 V\" }\n"),
      "d.toml:4:54: parameter 'x.initial': 'V' is a voltage, and the unit of the machine 'ideal' is no known "
      "voltage; expected a quantity in 'machine unit'\n"
      "  remedy: name the machine, profile = \"ec-1\" in [machine], or divide by its greatest voltage: 30 V "
      "of "
      "60 V are 0.5");
  EXPECT_THAT(refusal("x = { type = \"integrator\", in = \"one\", initial = \"30 V\" }\n", on("mn-14")),
              HasSubstr("the unit of the machine 'mn-14' is no known voltage"));
}

TEST(LabFile, SetsPotentiometersInPercentAndDegrees) {
  EXPECT_DOUBLE_EQ(
      parameter("p = { type = \"potentiometer\", in = \"one\", setting = \"37.5 %\" }\n", "setting"), 0.375);
  EXPECT_DOUBLE_EQ(
      parameter("p = { type = \"potentiometer\", in = \"one\", setting = \"375/1000\" }\n", "setting"),
      0.375);
  EXPECT_DOUBLE_EQ(
      parameter("s = { type = \"sine-source\", phase = \"30°\", frequency = \"3000 rpm\" }\n", "phase"),
      std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(parameter("s = { type = \"sine-source\", frequency = \"3000 rpm\" }\n", "frequency"), 50);
  EXPECT_DOUBLE_EQ(parameter("s = { type = \"sine-source\", frequency = \"314 rad/s\" }\n", "frequency"),
                   314 / (2 * std::numbers::pi));
}

TEST(LabFile, CallsTheTimeFactorK0) {
  EXPECT_EQ(refusal("x = { type = \"integrator\", in = \"one\", k0 = 10 }\n"),
            "d.toml:4:40: block 'x' (integrator) has no input and no parameter 'k0'\n"
            "  remedy: 'rate' is time factor k0: a constant input of 1 gives a slope of k0");
  EXPECT_THAT(refusal("x = { type = \"integrator\", in = \"one\", IC = 0.5 }\n"),
              HasSubstr("remedy: 'initial' is"));
  EXPECT_DOUBLE_EQ(parameter("x = { type = \"integrator\", in = \"one\", rate = \"10 1/s\" }\n", "rate"), 10);
}

TEST(LabFile, HasADecimalComma) {
  EXPECT_THAT(refusal("x = { type = \"integrator\", in = \"one\", initial = \"0,5\" }\n"),
              HasSubstr("there is a comma in the number; expected a decimal point"));
  EXPECT_THAT(
      [] { parse_diagram(testing::diagram_text("x = { type = \"constant\", value = 0,5 }\n"), "d"); },
      ::testing::ThrowsMessage<text::ReadError>(HasSubstr("numbers have a decimal point, not a comma")));
}

TEST(LabFile, HasTypesetSignsInWires) {
  const FlatDiagram made =
      flat("x = { type = \"integrator\", in = [\"\u2212x\", \"\u20130.5*x\", \"2\u00b7x\"] }\n");
  std::vector<double> weights;
  for (const FlatTerm& term : made.blocks[0].inputs[0].terms) weights.push_back(term.weight);
  EXPECT_THAT(weights, ElementsAre(-1, -0.5, 2));
}

TEST(LabFile, OverridesInVolts) {
  const Diagram diagram = parse_diagram(
      testing::diagram_text("x = { type = \"integrator\", in = \"x\" }\n", on("ec-1")), "d.toml");
  const FlatDiagram made = flatten(diagram, shipped_blocks(), {{"x.initial", "-15 V"}});
  EXPECT_DOUBLE_EQ(made.blocks[0].parameters[made.blocks[0].definition->find_parameter("initial").value()],
                   -0.25);
}

TEST(LabFile, EndsAPhaseAtAVoltage) {
  const std::string blocks = "x = { type = \"integrator\", in = \"x\", initial = 0.1 }\n";
  const std::string timeline =
      "[timeline]\nphases = [{ mode = \"operate\", until = \"x > 30 V\" }, { mode = \"hold\", for = 1 }]\n";
  EXPECT_DOUBLE_EQ(flat(blocks, on("ec-1") + timeline).timeline.phases[0].until->threshold, 0.5);
  EXPECT_THAT(message_of([&] { flat(blocks, timeline); }), HasSubstr("phase 1: 'V' is a voltage"));
}

TEST(LabFile, ExpectsVolts) {
  const std::string blocks = "x = { type = \"constant\", value = 0.5 }\n";
  const std::string rest =
      on("ec-1") +
      "[outputs]\nx = \"x\"\nv = { signal = \"x\", scale = 60, unit = \"V\" }\n[expect]\n"
      "\"x at 0\" = { value = \"30 V\", within = \"60 mV\" }\n"
      "\"v at 0\" = { value = \"30 V\", within = \"60 mV\" }\n";
  const Diagram diagram = parse_diagram(testing::diagram_text(blocks, rest), "d.toml");
  EXPECT_DOUBLE_EQ(diagram.expectations[0].value, 0.5);
  EXPECT_DOUBLE_EQ(diagram.expectations[0].within, 0.001);
  EXPECT_DOUBLE_EQ(diagram.expectations[1].value, 30);
  EXPECT_DOUBLE_EQ(diagram.expectations[1].within, 0.06);
}

// --- inputs that nothing feeds

TEST(LabFile, LeavesTheInputOfASetIntegratorOpen) {
  EXPECT_NO_THROW(
      flat("c = { type = \"pulse-train\" }\nx = { type = \"integrator\", set = \"c\", initial = 1 }\n"));
  EXPECT_NO_THROW(flat("x = { type = \"integrator\", in = [], initial = 1 }\n"));
  EXPECT_EQ(refusal("x = { type = \"integrator\", initial = 1 }\n"),
            "d.toml:4:1: input 'x.in' (integrator) is not connected; expected a signal\n"
            "  remedy: in = \"NAME OF A SIGNAL\", or in = [] where nothing is to be added");
}

// --- recordings

TEST(LabFile, RecordsInMilliseconds) {
  EXPECT_THAT(recorded("t [ms];u\n0;0\n500;1\n", kTU).x, ElementsAre(0, 0.5));
  EXPECT_THAT(recorded("t/min\tu\n0\t0\n2\t1\n", kTU).x, ElementsAre(0, 120));
}

TEST(LabFile, RecordsVolts) {
  const std::string csv = "t [s]; u [V]\n0,0; -30,0\n0,5; 60,0\n";
  EXPECT_THAT(recorded(csv, kTU, on("ec-1")).y, ElementsAre(-0.5, 1));
  EXPECT_THAT(recorded(csv, kTU).y, ElementsAre(-30, 60)) << "the ideal machine has no volts";
}

TEST(LabFile, KeepsUnitsThatSayNothingAboutSignals) {
  EXPECT_THAT(recorded("t,s [mm]\n0,1\n1,2\n", "x = \"t\", y = \"s\"").y, ElementsAre(1, 2));
}

TEST(LabFile, RecordsInPercent) {
  EXPECT_THAT(recorded("t,u [%]\n0,10\n1,20\n", kTU).y, ElementsAre(0.1, 0.2));
}

TEST(LabFile, RecordsSteps) {
  const text::PointTable table = recorded("t,u\n0,0\n1,0\n1,5\n2,5\n", kTU);
  EXPECT_THAT(table.x, ElementsAre(0, 1, 1, 2));
  EXPECT_THAT(table.y, ElementsAre(0, 0, 5, 5));
  EXPECT_THAT(message_of([] { recorded("t,u\n0,0\n1,0\n1,5\n1,6\n2,5\n", kTU); }),
              HasSubstr("has more than two points at x = 1; expected one, or two that make a jump\n"
                        "  remedy: keep the first and the last of them"));
  EXPECT_THAT(message_of([] { recorded("t,u\n0,0\n1,0\n0.5,5\n", kTU); }),
              HasSubstr("has x = 0.5 after x = 1"));
}

TEST(LabFile, BeginsOrEndsWithAStep) {
  const text::PointTable table = recorded("t,u\n0,0\n0,1\n2,1\n2,3\n", kTU);
  EXPECT_THAT(table.x, ElementsAre(-1, 0, 0, 2, 2, 4));
  EXPECT_THAT(table.y, ElementsAre(0, 0, 1, 1, 3, 3));
}

TEST(LabFile, HoldsItsEnds) {
  const text::PointTable table = recorded("t,u\n1,2\n4,3\n", std::string(kTU) + ", beyond = \"hold\"");
  EXPECT_THAT(table.x, ElementsAre(0, 1, 4, 8));
  EXPECT_THAT(table.y, ElementsAre(2, 2, 3, 3));
  EXPECT_THAT(recorded("t,u\n1,2\n4,3\n", std::string(kTU) + ", beyond = \"extrapolate\"").x,
              ElementsAre(1, 4));
  EXPECT_THAT(
      message_of([] { recorded("t,u\n1,2\n4,3\n", std::string(kTU) + ", beyond = \"stay\""); }),
      HasSubstr(
          "'beyond' is 'stay'; expected what holds before the first and after the last point: \"hold\""));
}

TEST(LabFile, HasPointsWithUnits) {
  const FlatDiagram made =
      flat("u = { type = \"recording\", data = { points = [[\"0 ms\", \"0 V\"], [\"20 ms\", \"5 V\"]] } }\n",
           on("tr-10"));
  EXPECT_THAT(made.blocks[0].points[0].x, ElementsAre(0, 0.02));
  EXPECT_THAT(made.blocks[0].points[0].y, ElementsAre(0, 0.5));
}

TEST(LabFile, NamesItsColumnsWhereOneIsNotThere) {
  EXPECT_THAT(message_of([] { recorded("Zeit;Spannung\n0;0\n1;1\n", kTU); }),
              HasSubstr("has no column 't'\n  remedy: known: Zeit, Spannung"));
  EXPECT_THAT(message_of([] { recorded("t,Spannung\n0,0\n1,1\n", kTU); }),
              EndsWith("has no column 'u'\n  remedy: known: t, Spannung"));
  EXPECT_THAT(message_of([] { recorded("Zeit,u\n0,0\n1,1\n", kTU); }),
              EndsWith("has no column 't'\n  remedy: known: Zeit, u"));
}

}  // namespace
}  // namespace oblique::diagram
