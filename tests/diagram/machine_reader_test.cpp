// SPDX-License-Identifier: MIT
// What the reader of machine files takes, and what it says where something is wrong.
#include <oblique/diagram/machine_reader.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;

// Nine lines, so that what a test adds begins on line 10.
constexpr const char* kMachineHead =
    "format = \"oblique-machine/1\"\ntitle = \"Machine\"\nsource = \"its book\"\nunit = \"10 V\"\n"
    "input_gains = [1, 10]\nrates = \"any\"\n\n[elements]\namplifier = 3\n";

const BlockLibrary& library() {
  static const BlockLibrary shipped = BlockLibrary::shipped();
  return shipped;
}

MachineProfile machine_with(const std::string& rest, const std::string& head = kMachineHead) {
  return parse_machine(head + rest, "m.toml", "m", library());
}

std::string message_with(const std::string& rest, const std::string& head = kMachineHead) {
  return message_of([&] { machine_with(rest, head); });
}

/// The head with one line replaced.
std::string head_with(std::string_view line, const std::string& other) {
  std::string head = kMachineHead;
  head.replace(head.find(line), line.size(), other);
  return head;
}

TEST(ParseMachine, ReadsWhatAMachineIs) {
  const MachineProfile machine = machine_with(
      "integrator = { count = \"inf\", note = \"on cards\" }\ncomparator = \"unknown\"\n"
      "[figures]\ndrift = \"unknown\"\nmodes = { value = \"hold\", source = \"a letter\" }\n"
      "[figures.offset]\nvalue = \"1 mV\"\n"
      "errors = { summer.offset = \"1 mV\", integrator.drift = \"20 µV/s\" }\n"
      "scatters = { summer.tolerance = \"1 %\" }\n");
  EXPECT_EQ(machine.name, "m");
  EXPECT_EQ(machine.title, "Machine");
  EXPECT_EQ(machine.unit, 10);
  EXPECT_TRUE(machine.inverting);
  EXPECT_FALSE(machine.signed_coefficients);
  EXPECT_THAT(machine.input_gains, ElementsAre(1, 10));
  EXPECT_TRUE(machine.rates_known);
  EXPECT_EQ(machine.find(ElementKind::amplifier)->count, 3);
  EXPECT_TRUE(std::isinf(machine.find(ElementKind::integrator)->count.value()));
  EXPECT_EQ(machine.find(ElementKind::integrator)->note, "on cards");
  EXPECT_EQ(machine.find(ElementKind::comparator)->count, std::nullopt);
  EXPECT_EQ(machine.find(ElementKind::multiplier), nullptr);
  ASSERT_EQ(machine.figures.size(), 3U);
  EXPECT_EQ(machine.figures[0].source, "");
  EXPECT_EQ(machine.figures[1].source, "a letter");
  EXPECT_EQ(machine.figures[2].source, "its book");
  ASSERT_EQ(machine.errors.size(), 2U);
  EXPECT_DOUBLE_EQ(machine.errors[0].value, 1e-4);
  EXPECT_DOUBLE_EQ(machine.errors[1].value, 2e-6);
  EXPECT_EQ(machine.errors[1].figure, "offset");
  ASSERT_EQ(machine.scatters.size(), 1U);
  EXPECT_DOUBLE_EQ(machine.scatters[0].value, 0.01);
}

TEST(ParseMachine, TakesMachineUnitsToo) {
  const MachineProfile machine = machine_with(
      "[figures.offset]\nvalue = \"?\"\n"
      "errors = { summer.offset = 0.5, inverter.offset = \"2 machine unit\", multiplier.offset = \"1/4\" "
      "}\n");
  EXPECT_EQ(machine.errors[0].value, 0.5);
  EXPECT_EQ(machine.errors[1].value, 2);
  EXPECT_EQ(machine.errors[2].value, 0.25);
}

TEST(ParseMachine, ReportsAllFindingsOfAFile) {
  const std::string message =
      message_of([] { parse_machine("title = 3\nunits = \"1 V\"\n", "m.toml", "m", library()); });
  for (const char* const part :
       {R"(m.toml:1:1: the machine file has no 'format'; expected format = "oblique-machine/1")",
        "m.toml:1:9: 'title' of the machine file is a number; expected a string",
        "m.toml:1:1: the machine file has no 'source'; expected where its figures are from",
        R"(m.toml:1:1: the machine file has no 'unit'; expected a voltage such as "10 V", or "unknown")",
        "m.toml:2:1: unknown key 'units' in the machine file\n  remedy: did you mean 'unit'?",
        "the machine file has no 'input_gains'; expected a list of numbers above 0, each above the one "
        "before;",
        "the machine file has no 'rates'; expected a list",
        "m.toml:1:1: the machine has no [elements]; expected at least one kind of element"}) {
    EXPECT_THAT(message, HasSubstr(part));
  }
}

TEST(ParseMachine, ChecksTheUnit) {
  EXPECT_EQ(message_with("", head_with("\"10 V\"", "0")),
            "m.toml:4:8: 'unit' is 0 V; expected a finite voltage above 0");
  EXPECT_THAT(message_with("", head_with("\"10 V\"", "\"10 s\"")), HasSubstr("'s' is the wrong unit here"));
  EXPECT_EQ(machine_with("", head_with("\"10 V\"", "\"unknown\"")).unit, std::nullopt);
}

TEST(ParseMachine, ChecksSteps) {
  const auto message = [](const std::string& rates) { return message_with("", head_with("\"any\"", rates)); };
  EXPECT_EQ(
      message("[10, 1]"),
      "m.toml:6:14: 'rates' holds 1 here; expected a list of numbers above 0, each above the one before; "
      "\"any\" or \"unknown\"");
  EXPECT_THAT(message("[0]"), HasSubstr("m.toml:6:10: 'rates' holds 0 here"));
  EXPECT_THAT(message("[inf]"), HasSubstr("'rates' holds inf here"));
  EXPECT_THAT(message("[]"), HasSubstr("m.toml:6:9: 'rates' is an empty list; expected"));
  EXPECT_THAT(message("10"), HasSubstr("m.toml:6:9: 'rates' is a number; expected"));
  EXPECT_THAT(message("\"all\""), HasSubstr("m.toml:6:9: 'rates' is a string; expected"));
  EXPECT_FALSE(machine_with("", head_with("\"any\"", "\"unknown\"")).rates_known);
}

TEST(ParseMachine, ChecksElements) {
  EXPECT_EQ(message_with("integrators = 3\n"),
            "m.toml:10:1: there is no kind of element 'integrators'\n  remedy: did you mean 'integrator'?");
  EXPECT_EQ(
      message_with("summer = 2.5\n"),
      "m.toml:10:10: element 'summer': the count is 2.5; expected a whole number from 1, inf or \"unknown\"\n"
      "  remedy: leave out what the machine has none of");
  EXPECT_THAT(message_with("summer = 0\n"), HasSubstr("element 'summer': the count is 0"));
  EXPECT_EQ(message_with("summer = { note = \"?\" }\n"),
            "m.toml:10:10: element 'summer' has no 'count'; expected a whole number, inf or \"unknown\"");
  EXPECT_THAT(message_with("summer = { count = 1, notes = \"?\" }\n"),
              HasSubstr("unknown key 'notes' in element 'summer'\n  remedy: did you mean 'note'?"));
}

TEST(ParseMachine, ChecksFigures) {
  const auto message = [](const std::string& figure) { return message_with("[figures.f]\n" + figure); };
  EXPECT_EQ(message("source = \"a letter\"\n"),
            "m.toml:10:1: figure 'f' has no 'value'; expected what is published, or \"unknown\"");
  EXPECT_EQ(
      message("value = \"unknown\"\nerrors = { summer.gain = 3 }\n"),
      "m.toml:10:10: figure 'f' is unknown and yet acts on blocks; expected a figure that acts has a value");
  EXPECT_THAT(message("value = \"1\"\nerror = { summer.gain = 3 }\n"),
              HasSubstr("unknown key 'error' in figure 'f'\n  remedy: did you mean 'errors'?"));
}

TEST(ParseMachine, ChecksWhatFiguresActOn) {
  const auto message = [](const std::string& errors, const std::string& kind = "errors") {
    return message_with("[figures.f]\nvalue = \"1\"\n" + kind + " = { " + errors + " }\n");
  };
  EXPECT_EQ(message("sumer.gain = 3"),
            "m.toml:12:12: figure 'f': there is no block 'sumer'\n  remedy: did you mean 'summer'?");
  EXPECT_EQ(message("divider.gain = 3"),
            "m.toml:12:12: figure 'f': 'divider' is a composite, which no figure reaches; expected one of "
            "the blocks "
            "it is made of");
  EXPECT_EQ(message("summer = 3"),
            "m.toml:12:21: figure 'f': 'summer' is a number; expected BLOCK.PARAMETER = VALUE");
  EXPECT_EQ(message("summer.gian = 3"),
            "m.toml:12:19: figure 'f': block 'summer' has no number 'gian'\n  remedy: did you mean 'gain'?");
  EXPECT_THAT(message("function-generator.points = 3"),
              HasSubstr("block 'function-generator' has no number 'points'"));
  EXPECT_EQ(message("summer.gain = -3"),
            "m.toml:12:26: figure 'f': 'summer.gain' is -3; expected a number above 0");
  EXPECT_THAT(message("summer.bandwidth = \"3 V\""), HasSubstr("'V' is the wrong unit here"));
  EXPECT_THAT(message("summer.offset = \"3 s\""), HasSubstr("'s' is the wrong unit here"));
  EXPECT_EQ(message("summer.gain = 3, summer.tolerance = 0, summer.offset = 0"), "");
  EXPECT_EQ(
      message("summer.tolerance = 0", "scatters"),
      "m.toml:12:33: figure 'f': 'summer.tolerance' is 0; expected a half width above 0 that keeps 0 ± it a "
      "number above -1 and below inf");
  EXPECT_THAT(message("summer.tolerance = 1", "scatters"),
              HasSubstr("'summer.tolerance' is 1; expected a half"));
}

TEST(ParseMachine, TakesOneFigureAParameter) {
  EXPECT_EQ(message_with("[figures.a]\nvalue = \"1\"\nerrors = { summer.gain = 3 }\n"
                         "[figures.b]\nvalue = \"2\"\nerrors = { summer.gain = 4 }\n"),
            "m.toml:15:19: figure 'b': 'summer.gain' has a value already; expected one figure a parameter");
  EXPECT_EQ(message_with("[figures.a]\nvalue = \"1\"\nerrors = { summer.tolerance = 0.1 }\n"
                         "[figures.b]\nvalue = \"2\"\nscatters = { summer.tolerance = 0.2 }\n"),
            "");
}

TEST(ParseMachine, TakesOneSaturation) {
  const auto figure = [](const std::string& name, const std::string& saturation) {
    return "[figures." + name + "]\nvalue = \"1\"\nsaturation = " + saturation + "\n";
  };
  EXPECT_EQ(machine_with("").saturation, std::nullopt);
  EXPECT_EQ(machine_with(figure("a", "\"12 V\"")).saturation, 1.2);
  EXPECT_EQ(machine_with(figure("a", "1")).saturation, 1);
  EXPECT_EQ(message_with(figure("a", "0.5")),
            "m.toml:12:14: figure 'a': 'saturation' is 0.5; expected at least 1 [machine unit]");
  EXPECT_THAT(message_with(figure("a", "\"inf\"")), HasSubstr("figure 'a': 'saturation' is inf"));
  EXPECT_EQ(
      message_with(figure("a", "1.2") + figure("b", "1.3")),
      "m.toml:15:14: figure 'b': 'saturation' is given a second time; expected one figure that says it");
}

TEST(ParseMachine, CannotTurnVoltsIntoUnknownUnits) {
  EXPECT_EQ(
      message_with("[figures.f]\nvalue = \"1\"\nerrors = { summer.offset = \"3 mV\" }\n",
                   head_with("\"10 V\"", "\"unknown\"")),
      "m.toml:12:28: figure 'f': 'summer.offset' is in volts, and the machine unit is unknown; expected a "
      "quantity in 'machine unit'");
}

}  // namespace
}  // namespace oblique::diagram
