// SPDX-License-Identifier: MIT
// A block of a user's own is on a machine what its role says, whatever it is called.
#include <fstream>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_writer.h>
#include <oblique/machine/component_list.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/sheets.h>

#include "../support/compiled.h"
#include "../support/scratch_folder.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::diagram_text;
using ::testing::HasSubstr;
using testing::inverting_machine;
using testing::message_of;
using testing::shipped_blocks;

/// The shipped blocks, and each that has a role a second time, from files of a folder: my-integrator …
class OwnBlocks : public ::testing::Test {
 protected:
  OwnBlocks() {
    for (const std::string& name : shipped_blocks().names()) {
      const diagram::BlockDefinition& block = *shipped_blocks().find(name);
      if (block.role != diagram::Role::other) write("my-" + name, block.text);
    }
    library_.add_directory(folder_.path());
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / (name + ".toml")) << text;
  }

  static diagram::Diagram parse(const std::string& blocks) {
    return diagram::parse_diagram(diagram_text(blocks), "d.toml");
  }

  test::ScratchFolder folder_;
  diagram::BlockLibrary library_ = diagram::BlockLibrary::shipped();
};

/// The same text with the user's names replaced by the shipped ones.
std::string without_my(const std::string& text) {
  return std::regex_replace(text, std::regex("my-"), "");
}

const std::string kOwnBlocks = R"(
one = { type = "my-constant", value = 0.5 }
x   = { type = "my-integrator", in = ["-v", "3*pot"], initial = 0.25, rate = 2 }
v   = { type = "my-integrator", in = ["sum", "x"], leakage = 0.1 }
sum = { type = "my-summer", in = ["x", "-0.3*product", "half"], offset = 1e-3 }
pot = { type = "my-potentiometer", in = "minus", setting = 0.7 }
minus = { type = "my-inverter", in = "v" }
half = { type = "my-gain", in = "x", factor = -2.5 }
product = { type = "my-multiplier", in = ["x", "amplifier"] }
square  = { type = "my-squarer", in = "x" }
third = { type = "my-multiplier", in = ["one", "v"] }
amplifier = { type = "my-servo-amplifier", in = ["amplifier", "-x", "square", "third"], gain = 1e4 }
switch = { type = "my-comparator", in = ["v"], high = 0.5 }
curve = { type = "my-function-generator", in = "switch", points = [[0, 0], [1, 0.5]] }
[outputs]
x = "x"
a = "amplifier"
c = "curve"
)";

TEST_F(OwnBlocks, AreRealisedAsTheShippedOnes) {
  for (const char* const name : {"tr-10", "mn-7", "lucidac", "the-analog-thing"}) {
    const diagram::MachineProfile& machine = *diagram::find_machine(name);
    const Realisation own = realise(parse(kOwnBlocks), library_, machine);
    const Realisation shipped = realise(parse(without_my(kOwnBlocks)), shipped_blocks(), machine);
    EXPECT_EQ(own.inverters, shipped.inverters) << name;
    const std::string text = diagram::write_diagram(own.diagram);
    EXPECT_THAT(text, HasSubstr("my-integrator")) << "it stays the user's block";
    EXPECT_EQ(without_my(text), diagram::write_diagram(shipped.diagram)) << name;

    const diagram::FlatDiagram flat = diagram::flatten(own.diagram, library_);
    const diagram::FlatDiagram shipped_flat = diagram::flatten(shipped.diagram, shipped_blocks());
    // The figures of the machine act on them too.
    ASSERT_EQ(flat.blocks.size(), shipped_flat.blocks.size());
    for (std::size_t b = 0; b < flat.blocks.size(); ++b)
      EXPECT_EQ(flat.blocks[b].parameters, shipped_flat.blocks[b].parameters) << flat.blocks[b].path;

    const ComponentList components = component_list_of(flat, machine),
                        shipped_components = component_list_of(shipped_flat, machine);
    ASSERT_EQ(components.rows.size(), shipped_components.rows.size()) << name;
    for (std::size_t row = 0; row < components.rows.size(); ++row) {
      EXPECT_EQ(components.rows[row].element, shipped_components.rows[row].element);
      EXPECT_EQ(components.rows[row].needed, shipped_components.rows[row].needed)
          << components.rows[row].element;
    }
    const MachineSheets sheets = sheets_of(own.diagram, flat, library_, machine);
    const MachineSheets shipped_sheets = sheets_of(shipped.diagram, shipped_flat, shipped_blocks(), machine);
    EXPECT_EQ(to_csv(sheets.connections), to_csv(shipped_sheets.connections)) << name;
    EXPECT_EQ(to_csv(sheets.potentiometers), to_csv(shipped_sheets.potentiometers)) << name;
    EXPECT_EQ(without_my(to_csv(sheets.static_test)), to_csv(shipped_sheets.static_test)) << name;
  }
}

TEST_F(OwnBlocks, AreElementsOfTheirOwnWithoutARole) {
  write("plain",
        std::regex_replace(shipped_blocks().find("summer")->text, std::regex("role *= [^\n]*\n"), ""));
  library_.add_directory(folder_.path());
  const diagram::Diagram made = realise(parse("x = { type = \"integrator\", in = [\"p\"], initial = 1 }\n"
                                              "p = { type = \"plain\", in = [\"-x\"] }\n"),
                                        library_, inverting_machine())
                                    .diagram;
  EXPECT_THAT(diagram::write_diagram(made),
              HasSubstr("= { type = \"plain\", label = \"X1\", in = \"minus_x\" }"));
  const std::vector<std::string> absent =
      component_list_of(diagram::flatten(made, library_), inverting_machine()).absent();
  EXPECT_THAT(absent, ::testing::ElementsAre("plain"));
}

TEST_F(OwnBlocks, WriteNoElementsWhereNoBlockHasTheRole) {
  for (const char* const name : {"inverter", "my-inverter"}) {
    write(name,
          std::regex_replace(shipped_blocks().find("inverter")->text, std::regex("role *= [^\n]*\n"), ""));
  }
  library_.add_directory(folder_.path());
  const std::string message = message_of<RealiseError>([&] {
    realise(parse("x = { type = \"integrator\", in = [\"v\"], initial = 1 }\n"
                  "v = { type = \"integrator\", in = [\"-x\"] }\n"),
            library_, inverting_machine());
  });
  EXPECT_EQ(
      message,
      "no block has the role 'inverter', which the machine's elements are written with; expected role = "
      "\"inverter\" in a block file\n  remedy: a block in the place of a shipped one takes its role too");
}

TEST_F(OwnBlocks, ThatSquareSayWhatAMultiplierCannot) {
  std::string text = shipped_blocks().find("squarer")->text;
  text = std::regex_replace(text, std::regex("\nlimit = "), "\nbend = {}\nlimit = ");
  write("bent", std::regex_replace(text, std::regex("\"in\\*in\""), "\"in*in + bend\""));
  library_.add_directory(folder_.path());
  const std::string message = message_of<RealiseError>([&] {
    realise(parse("x = { type = \"integrator\", in = [\"-q\"], initial = 1 }\n"
                  "q = { type = \"bent\", in = \"x\", bend = 0.1 }\n"),
            library_, inverting_machine());
  });
  EXPECT_EQ(message,
            "d.toml:4:1: squarer 'q' sets 'bend', which 'multiplier' does not have; expected parameters of "
            "'multiplier'\n  remedy: a squarer is a multiplier there: leave it out, or take a block that "
            "multiplies");
}

}  // namespace
}  // namespace oblique::machine
