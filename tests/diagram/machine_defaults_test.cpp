// SPDX-License-Identifier: MIT
// What the machine of a diagram is for the parameters of its blocks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/diagram/machine_profile.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr const char* kEc1 = "[machine]\nprofile = \"ec-1\"\n";

class OnAMachine : public ::testing::Test {
 protected:
  void add(const std::string& name, const std::string& text) {
    library_.add(parse_block("format = \"oblique-block/1\"\ntitle = \"T\"\n" + text, name + ".toml", name));
  }

  FlatDiagram flat(const std::string& blocks, const std::string& machine = kEc1,
                   const std::vector<ParameterOverride>& overrides = {}) const {
    return flatten(parse_diagram(testing::diagram_text(blocks, machine), "d.toml"), library_, overrides);
  }

  static double parameter(const FlatDiagram& flat, std::string_view path, std::string_view name) {
    for (const FlatBlock& block : flat.blocks) {
      if (block.path == path) return block.parameters[block.definition->find_parameter(name).value()];
    }
    throw std::out_of_range(std::string(path));
  }

 private:
  BlockLibrary library_ = BlockLibrary::shipped();
};

constexpr const char* kSummers =
    "a = { type = \"summer\", in = \"a\" }\nb = { type = \"summer\", in = \"a\", gain = 50 }\n";

TEST_F(OnAMachine, OpenParametersTakeItsFigures) {
  EXPECT_EQ(parameter(flat(kSummers), "a", "gain"), 1000);
  EXPECT_EQ(parameter(flat(kSummers, ""), "a", "gain"), std::numeric_limits<double>::infinity());
}

TEST_F(OnAMachine, ValuesOfTheUserStay) {
  EXPECT_EQ(parameter(flat(kSummers), "b", "gain"), 50);
  const FlatDiagram set = flat(kSummers, kEc1, {{"a.gain", "70"}});
  EXPECT_EQ(parameter(set, "a", "gain"), 70);
}

// 30 V of the EC-1's 60 V; its gain is left out, one that the diagram gives is not.
TEST_F(OnAMachine, IdealElementsKeepTheVoltageOfTheMachine) {
  const Diagram diagram = parse_diagram(
      testing::diagram_text(std::string(kSummers) + "c = { type = \"constant\", value = \"30 V\" }\n", kEc1),
      "d.toml");
  const BlockLibrary library = BlockLibrary::shipped();
  const FlatDiagram ideal = flatten_on_ideal_elements(diagram, library, {{"a.offset", "6 V"}});
  EXPECT_EQ(parameter(ideal, "c", "value"), 0.5);
  EXPECT_EQ(parameter(ideal, "a", "offset"), 0.1);
  EXPECT_EQ(parameter(ideal, "a", "gain"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parameter(ideal, "a", "limit"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parameter(ideal, "b", "gain"), 50);
}

TEST_F(OnAMachine, ValuesOfTheUserStayWhereTheyAreTheDefault) {
  EXPECT_EQ(parameter(flat("a = { type = \"summer\", in = \"a\", gain = inf }\n"), "a", "gain"),
            std::numeric_limits<double>::infinity());
}

TEST_F(OnAMachine, WhatItDoesNotSayKeepsTheDefaultOfTheBlock) {
  const FlatDiagram servo = flat("a = { type = \"servo-amplifier\", in = \"a\" }\n");
  EXPECT_EQ(parameter(servo, "a", "gain"), 1000);
  EXPECT_EQ(parameter(servo, "a", "bandwidth"), 10);
}

// divider: quotient = { type = "servo-amplifier", …, gain = "gain", … }, gain = { default = 1e6, … }
TEST_F(OnAMachine, AmplifiersOfACompositeHaveItsGain) {
  const std::string divider =
      "one = { type = \"constant\" }\nq = { type = \"divider\", in = [\"one\", \"one\"]";
  EXPECT_EQ(parameter(flat(divider + " }\n"), "q.quotient", "gain"), 1000);
  EXPECT_EQ(parameter(flat(divider + " }\n", ""), "q.quotient", "gain"), 1e6);
  EXPECT_EQ(parameter(flat(divider + ", gain = 50 }\n"), "q.quotient", "gain"), 50);
  EXPECT_EQ(parameter(flat(divider + " }\n", kEc1, {{"q.gain", "70"}}), "q.quotient", "gain"), 70);
  EXPECT_EQ(parameter(flat(divider + " }\n", kEc1, {{"q.quotient.gain", "80"}}), "q.quotient", "gain"), 80);
}

// dyad-rrr hands its gain to vector-direction, and that to its amplifiers.
TEST_F(OnAMachine, AmplifiersOfACompositeInACompositeHaveItsGain) {
  const std::string dyad =
      "one = { type = \"constant\" }\n"
      "c = { type = \"dyad-rrr\", px = \"0*one\", py = \"0*one\", qx = \"one\", qy = \"0*one\", r1 = 1, r2 = "
      "1";
  EXPECT_EQ(parameter(flat(dyad + " }\n"), "c.direction.side", "gain"), 1000);
  EXPECT_EQ(parameter(flat(dyad + ", gain = 50 }\n"), "c.direction.side", "gain"), 50);
}

TEST_F(OnAMachine, WhatACompositeFixesStays) {
  add("stage",
      "[inputs]\nin = {}\n[outputs]\nout = { wire = \"c\" }\n[parameters]\ngain = { default = 7 }\n[blocks]\n"
      "a = { type = \"inverter\", in = \"in\", gain = 20 }\n"
      "b = { type = \"inverter\", in = \"a\", gain = \"2*gain\" }\n"
      "c = { type = \"inverter\", in = \"b\" }\n"
      "d = { type = \"inverter\", in = \"b\", gain = \"gain %\" }\n");
  const FlatDiagram made = flat("one = { type = \"constant\" }\ns = { type = \"stage\", in = \"one\" }\n");
  EXPECT_EQ(parameter(made, "s.a", "gain"), 20);
  EXPECT_EQ(parameter(made, "s.b", "gain"),
            14);  // a formula of the composite's own, not the open value as it is
  EXPECT_EQ(parameter(made, "s.c", "gain"), 1000);
  EXPECT_DOUBLE_EQ(parameter(made, "s.d", "gain"), 0.07);
}

TEST_F(OnAMachine, ABlockOfTheUserTakesTheFiguresOfTheParametersItKeeps) {
  add("summer",
      "[inputs]\nin = { sum = true }\n[outputs]\nout = {}\n[parameters]\nscale = { default = 1 }\n"
      "gain = { default = 5, above = 0 }\n[equations]\nout = \"scale*in/gain\"\n");
  const FlatDiagram made = flat("a = { type = \"summer\", in = \"a\" }\n");
  EXPECT_EQ(parameter(made, "a", "gain"), 1000);
  EXPECT_EQ(parameter(made, "a", "scale"), 1);
}

TEST_F(OnAMachine, ABlockOfTheUserMayNotTakeItsFigure) {
  add("summer",
      "[inputs]\nin = { sum = true }\n[outputs]\nout = {}\n[parameters]\ngain = { default = 5, at_most = 10 "
      "}\n"
      "[equations]\nout = \"in/gain\"\n");
  EXPECT_EQ(message_of([&] { flat("a = { type = \"summer\", in = \"a\" }\n"); }),
            "d.toml:3:1: parameter 'a.gain' is 1000; expected a number at most 10\n"
            "  remedy: it follows from the machine 'ec-1'");
}

TEST_F(OnAMachine, SummersInvertAsItSaysUnlessTheDiagramSays) {
  const auto polarity = [&](const std::string& machine) {
    return flat(kSummers, machine).blocks[0].polarity;
  };
  EXPECT_EQ(polarity(kEc1), -1);
  EXPECT_EQ(polarity("[machine]\nprofile = \"ec-1\"\ninverting = false\n"), 1);
  EXPECT_EQ(polarity("[machine]\nprofile = \"ideal\"\n"), 1);
  EXPECT_EQ(polarity(""), 1);
}

TEST_F(OnAMachine, ItIsOneThatIsKnown) {
  EXPECT_EQ(message_of([&] { flat(kSummers, "[machine]\nprofile = \"EC1\"\n"); }),
            "d.toml:6:11: there is no machine 'EC1'\n  remedy: did you mean 'ec-1'? 'machines' lists all");
  Diagram diagram = parse_diagram(testing::diagram_text(kSummers), "d.toml");
  diagram.machine.profile = "EC1";
  EXPECT_THAT(message_of([&] { flatten(diagram, BlockLibrary::shipped()); }),
              HasSubstr("there is no machine 'EC1'"));
}

}  // namespace
}  // namespace oblique::diagram
