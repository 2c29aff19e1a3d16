// SPDX-License-Identifier: MIT
#include <oblique/diagram/diagram.h>

#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using testing::diagram_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;

const std::string kBlock = "a = { type = \"reference\" }\n";  // line 3

std::string diagram_message(const std::string& rest) {
  return message_of([&] { parse_diagram(diagram_text(kBlock, rest), "d.toml"); });
}

/// The message about one line of [expect], which is line 7, in a run of 2 s.
std::string expect_message(const std::string& line) {
  return diagram_message("[run]\nuntil = 2\n[expect]\n" + line + "\n");
}

// Of two diagrams that differ in one place only.
TEST(Diagram, IsEqualToNoOther) {
  Diagram one;
  one.title = "t";
  one.blocks = {{"a", "reference", "", "", {}, {}}};
  one.outputs = {{"a", "a", 1, "machine unit", {}}};
  one.expectations = {{"", "a", Expectation::Kind::at_time, 1, 2, 3, {}}};
  one.layout = {{"a", 1, 2, {}}};
  one.published.emplace().values.emplace_back();
  one.lesson.emplace().question.emplace();
  one.lesson->steps.emplace_back();
  EXPECT_TRUE(one == Diagram(one));
  const auto is_equal_after = [&](const std::function<void(Diagram&)>& change) {
    Diagram other = one;
    change(other);
    return one == other;
  };
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.title = "u"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.source = "u"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.machine.inverting = true; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.run.until = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.groups.emplace_back(); }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.timeline.phases.emplace_back(); }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.blocks[0].name = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.blocks[0].type = "adder"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.blocks[0].label = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.blocks[0].settings = {number_setting("value", 1)}; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.outputs[0].name = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.outputs[0].signal = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.outputs[0].scale = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.outputs[0].unit = "V"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.outputs[0].offset = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.expectations[0].output = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.expectations[0].kind = Expectation::Kind::maximum; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.expectations[0].time = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.expectations[0].value = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.expectations[0].within = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published.reset(); }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->kind = Published::Kind::equations; }));
  for (std::string Published::*const member :
       {&Published::author, &Published::title, &Published::in, &Published::number, &Published::page,
        &Published::address, &Published::machine, &Published::subject, &Published::picture})
    EXPECT_FALSE(is_equal_after([&](Diagram& d) { (*d.published).*member = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->year = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->plot = {"b"}; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->errata = {"b"}; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->values[0].expected.value = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->values[0].label = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->values[0].unit = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->values[0].factor = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->values[0].because = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->values[0].tried = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->leads = true; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.published->values[0].set = {{"b", "7"}}; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->title = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->text = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->steps[0].action = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->steps[0].set = {{"b", "7"}}; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->steps[0].see = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->steps[0].expectations.emplace_back(); }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->question->ask = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->question->answer = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->question->hint = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.lesson->question->expectations.emplace_back(); }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.layout[0].name = "b"; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.layout[0].x = 7; }));
  EXPECT_FALSE(is_equal_after([](Diagram& d) { d.layout[0].y = 7; }));
}

TEST(ParseDiagram, ReadsEveryPart) {
  const Diagram d = parse_diagram(R"toml(format = "oblique-diagram/1"
title = "A title"
source = "a book"
[machine]
profile = "ideal"
inverting = true
[run]
until = "2 min"
tolerance = 1e-6
method = "adams"
samples = 11
max_steps = 5000
[blocks]
a = { type = "reference", label = "φ̇", value = "1/2" }
b = { type = "adder", in = ["a", "-2*b"] }
[outputs]
"C.x" = { signal = "a", scale = "1/2", unit = "m" }
"at φ" = "b"
[expect]
"C.x at 1 min" = { value = 0.25, within = 1e-3 }
"at φ at pi" = { value = 1, within = 1 }
"at φ maximum" = { value = "sqrt(4)", within = 1e-3 }
"C.x minimum" = { value = -1, within = 1e-3 }
)toml",
                                  "d.toml");
  EXPECT_EQ(d.file, "d.toml");
  EXPECT_EQ(d.title, "A title");
  EXPECT_EQ(d.source, "a book");
  EXPECT_EQ(d.machine, (MachineSettings{"ideal", true}));
  EXPECT_EQ(d.run, (RunSettings{120, 1e-6, IntegrationMethod::adams, 11, 5000, true, {}, {}, {}}));

  ASSERT_EQ(d.blocks.size(), 2U);
  EXPECT_EQ(d.blocks[0].name, "a");
  EXPECT_EQ(d.blocks[0].label, "φ̇");
  EXPECT_EQ(d.blocks[1].type, "adder");
  EXPECT_EQ(d.blocks[1].place, (text::Place{"d.toml", {15, 1}}));
  ASSERT_EQ(d.blocks[1].settings.size(), 1U);
  EXPECT_EQ(d.blocks[1].settings[0].value.elements[1].text, "-2*b");

  ASSERT_EQ(d.outputs.size(), 2U);
  EXPECT_EQ(d.outputs[0], (OutputSpec{"C.x", "a", 0.5, "m", {}}));
  EXPECT_EQ(d.outputs[1], (OutputSpec{"at φ", "b", 1, "machine unit", {}}));

  using Kind = Expectation::Kind;
  ASSERT_EQ(d.expectations.size(), 4U);
  EXPECT_EQ(d.expectations[0], (Expectation{"C.x at 1 min", "C.x", Kind::at_time, 60, 0.25, 1e-3, {}}));
  EXPECT_EQ(d.expectations[1],
            (Expectation{"at φ at pi", "at φ", Kind::at_time, std::numbers::pi, 1, 1, {}}));
  EXPECT_EQ(d.expectations[2], (Expectation{"at φ maximum", "at φ", Kind::maximum, 0, 2, 1e-3, {}}));
  EXPECT_EQ(d.expectations[3], (Expectation{"C.x minimum", "C.x", Kind::minimum, 0, -1, 1e-3, {}}));
}

TEST(ParseDiagram, HasUsualSettings) {
  const Diagram d = parse_diagram(diagram_text(kBlock), "d.toml");
  EXPECT_EQ(d.machine, MachineSettings{});
  EXPECT_EQ(d.run, RunSettings{});
  EXPECT_TRUE(d.outputs.empty());
  EXPECT_TRUE(d.expectations.empty());
}

TEST(ParseDiagram, BrokenTomlIsAReadError) {
  EXPECT_THAT(message_of<text::ReadError>([] { parse_diagram("a = = 1", "d.toml"); }),
              HasSubstr("d.toml:1:"));
  EXPECT_THAT(message_of<text::ReadError>([] { parse_diagram(diagram_text(kBlock + kBlock), "d.toml"); }),
              HasSubstr("d.toml:4:"));
  EXPECT_THAT(message_of<text::ReadError>([] { read_diagram("no/such.toml"); }),
              HasSubstr("no/such.toml: cannot open"));
}

TEST(ParseDiagram, NamesWhatIsMissingOrUnknown) {
  EXPECT_EQ(message_of([] { parse_diagram("[blocks]\na = { type = \"b\" }\n", "d.toml"); }),
            "d.toml:1:1: the diagram has no 'format'; expected format = \"oblique-diagram/1\"");
  EXPECT_THAT(message_of([] {
                parse_diagram("format = \"oblique-block/1\"\n[blocks]\na = { type = \"b\" }\n", "d");
              }),
              HasSubstr("d:1:10: the format is 'oblique-block/1'; expected 'oblique-diagram/1'"));
  EXPECT_EQ(message_of([] { parse_diagram("format = \"oblique-diagram/1\"\n", "d.toml"); }),
            "d.toml:1:1: the diagram has no [blocks]; expected at least one block");
  EXPECT_EQ(message_of([] { parse_diagram(diagram_text(""), "d.toml"); }),
            "d.toml:2:1: [blocks] is empty; expected at least one block");
  EXPECT_EQ(diagram_message("[output]\nx = \"a\"\n"),
            "d.toml:4:2: unknown key 'output' in the diagram\n  remedy: did you mean 'outputs'?");
  EXPECT_THAT(diagram_message("[run]\nuntill = 3\n"),
              HasSubstr("d.toml:5:1: unknown key 'untill' in [run]\n  remedy: did you mean 'until'?"));
  EXPECT_THAT(diagram_message("[outputs]\nx = { signal = \"a\", units = \"m\" }\n"),
              HasSubstr("unknown key 'units' in output 'x'\n  remedy: did you mean 'unit'?"));
}

TEST(ParseDiagram, ChecksBlocks) {
  EXPECT_EQ(diagram_message("b = 3\n"), "d.toml:4:5: block 'b' is a number; expected a table");
  EXPECT_EQ(diagram_message("b = { label = \"x\" }\n"),
            "d.toml:4:5: block 'b' has no 'type'; expected the name of a block type");
  EXPECT_THAT(diagram_message("b = { type = 3 }\n"),
              HasSubstr("'type' of block 'b' is a number; expected a string"));
  EXPECT_EQ(diagram_message("b = { type = \"adder\", in = true }\n"),
            "d.toml:4:28: 'b.in' is true or false; expected a number, a string or a list of strings\n"
            "  remedy: an input takes \"signal\" or [\"signal\", …], a parameter a number or a quantity");
  EXPECT_THAT(diagram_message("b = { type = \"adder\", in = [\"a\", 3] }\n"),
              HasSubstr("'b.in' is an array; expected"));
  EXPECT_THAT(
      diagram_message("time = { type = \"adder\" }\n"),
      HasSubstr(
          "d.toml:4:1: 'time' cannot be the name of a block: it is reserved; expected another name than "
          "time, polarity, in_initial, in_operate, in_hold, pi, inf, and, or, not"));
  EXPECT_THAT(
      diagram_message("a-b = { type = \"adder\" }\n"),
      HasSubstr("'a-b' cannot be the name of a block; expected letters, digits and '_', with a letter or '_' "
                "first"));
}

TEST(ParseDiagram, ChecksMachineAndRun) {
  EXPECT_EQ(diagram_message("[machine]\nprofile = \"tr-11\"\n"),
            "d.toml:5:11: there is no machine 'tr-11'\n  remedy: did you mean 'tr-10'? 'machines' "
            "lists all");
  EXPECT_THAT(diagram_message("[machine]\ninverting = 1\n"),
              HasSubstr("'inverting' of [machine] is a number"));
  EXPECT_EQ(diagram_message("[run]\nuntil = 0\n"),
            "d.toml:5:9: 'until' of [run] is 0 s; expected a finite time above 0 [s]");
  EXPECT_THAT(diagram_message("[run]\nuntil = inf\n"), HasSubstr("'until' of [run] is inf s"));
  EXPECT_THAT(diagram_message("[run]\nuntil = \"3 m\"\n"), HasSubstr("'m' is the wrong unit here"));
  EXPECT_EQ(diagram_message("[run]\ntolerance = 1\n"),
            "d.toml:5:13: 'tolerance' of [run] is 1; expected a number above 0 and below 1, such as 1e-8");
  EXPECT_EQ(diagram_message("[run]\nsamples = 1\n"),
            "d.toml:5:11: 'samples' of [run] is 1; expected a whole number from 2 to 10000000");
  EXPECT_THAT(diagram_message("[run]\nsamples = 2.5\n"), HasSubstr("'samples' of [run] is 2.5"));
  EXPECT_THAT(diagram_message("[run]\nsamples = inf\n"), HasSubstr("'samples' of [run] is inf"));
  EXPECT_THAT(diagram_message("[run]\nmethod = \"adam\"\n"),
              HasSubstr("there is no method 'adam'\n  remedy: did you mean 'adams'?"));
  EXPECT_EQ(diagram_message("[run]\nabsolute_tolerance = 0\n"),
            "d.toml:5:22: 'absolute_tolerance' of [run] is 0 machine unit; expected a finite number above 0 "
            "[machine unit]");
  EXPECT_EQ(diagram_message("[run]\nmax_step = \"-1 ms\"\n"),
            "d.toml:5:12: 'max_step' of [run] is -0.001 s; expected a finite number above 0 [s]");
  EXPECT_THAT(diagram_message("[run]\nmax_step = inf\n"), HasSubstr("'max_step' of [run] is inf s"));
  EXPECT_THAT(diagram_message("[run]\nmax_steps = 0\n"), HasSubstr("'max_steps' of [run] is 0"));
}

TEST(ParseDiagram, ChecksOutputs) {
  EXPECT_EQ(diagram_message("[outputs]\nx = 3\n"),
            "d.toml:5:5: output 'x' is a number; expected \"signal\" or { signal = \"…\", scale = 1, unit = "
            "\"…\" }");
  EXPECT_THAT(diagram_message("[outputs]\nx = { scale = 2 }\n"),
              HasSubstr("output 'x' has no 'signal'; expected the name of a signal"));
  EXPECT_THAT(diagram_message("[outputs]\nx = { signal = \"a\", scale = inf }\n"),
              HasSubstr("'scale' of output 'x' is infinite; expected a finite number"));
}

TEST(ParseDiagram, ReadsPlacesOfBlocks) {
  const Diagram d = parse_diagram(diagram_text(kBlock, "[layout]\na = [\"3/2\", -4]\n"), "d.toml");
  EXPECT_EQ(d.layout, (std::vector<BlockPlace>{{"a", 1.5, -4, {}}}));
  EXPECT_EQ(d.layout.front().place.position.line, 5);
}

TEST(ParseDiagram, ChecksPlacesOfBlocks) {
  EXPECT_EQ(diagram_message("[layout]\nA = [1, 2]\n"),
            "d.toml:5:1: [layout] gives a place to 'A', and there is no such block; expected the name of a "
            "block of this file\n  remedy: known: a");
  EXPECT_EQ(diagram_message("[layout]\na = 3\n"),
            "d.toml:5:5: place of 'a' in [layout] is a number; expected [x, y], two numbers from -10000 to "
            "10000");
  EXPECT_THAT(diagram_message("[layout]\na = [1, 2, 3]\n"),
              HasSubstr("d.toml:5:5: place of 'a' in [layout] is a list of 3; expected [x, y]"));
  EXPECT_THAT(diagram_message("[layout]\na = [1, inf]\n"),
              HasSubstr("d.toml:5:9: place of 'a' in [layout] has inf; expected [x, y]"));
  EXPECT_THAT(diagram_message("[layout]\na = [1, \"2 m\"]\n"),
              HasSubstr("d.toml:5:12: place of 'a' in [layout]: 'm' is the wrong unit here"));
}

TEST(ParseDiagram, ChecksExpectations) {
  EXPECT_EQ(expect_message("a = { value = 1, within = 1 }"),
            "d.toml:7:1: [expect] cannot read 'a'; expected \"OUTPUT at TIME\", \"OUTPUT maximum\", "
            "\"OUTPUT minimum\" or \"OUTPUT period\"");
  EXPECT_THAT(expect_message("\" maximum\" = { value = 1, within = 1 }"),
              HasSubstr("[expect] cannot read ' maximum'"));
  EXPECT_EQ(expect_message("\"a at 3\" = { value = 1, within = 1 }"),
            "d.toml:7:1: time of 'a at 3' is 3 s; expected a time from 0 to the end of the run, 2 s\n"
            "  remedy: name a time within the run, or lengthen 'until' of [run]");
  EXPECT_THAT(expect_message("\"a at -1\" = { value = 1, within = 1 }"),
              HasSubstr("time of 'a at -1' is -1 s"));
  EXPECT_THAT(expect_message("\"a at noon\" = { value = 1, within = 1 }"),
              HasSubstr("d.toml:7:7: time of 'a at noon': 'noon' is not a known constant"));
  EXPECT_EQ(expect_message("\"a at 1\" = 3"), "d.toml:7:12: [expect] 'a at 1' is a number; expected a table");
  EXPECT_THAT(expect_message("\"a at 1\" = { value = 1 }"), HasSubstr("[expect] 'a at 1' has no 'within'"));
  EXPECT_THAT(expect_message("\"a at 1\" = { value = inf, within = 1 }"),
              HasSubstr("is infinite; expected a finite number"));
  EXPECT_THAT(expect_message("\"a at 1\" = { value = 1, within = 0 }"),
              HasSubstr("'within' of [expect] 'a at 1' is 0; expected a finite number above 0"));
  EXPECT_EQ(
      diagram_message("[outputs]\nside = \"a\"\n[expect]\n\"sied maximum\" = { value = 1, within = 1 }\n"),
      "d.toml:7:1: [expect] names 'sied', which is no output\n  remedy: did you mean 'side'?");
}

TEST(ParseDiagram, JudgesNoTimeByARunThatIsWrong) {
  EXPECT_EQ(diagram_message("[run]\nuntil = -1\n[expect]\n\"a at 3\" = { value = 1, within = 1 }\n"),
            "d.toml:5:9: 'until' of [run] is -1 s; expected a finite time above 0 [s]");
}

/// 3·100 ms is above 0.3 s by rounding, and is meant as the end of the run.
TEST(ParseDiagram, TakesTheEndOfTheRunInAnyUnit) {
  const Diagram d = parse_diagram(
      diagram_text(kBlock, "[run]\nuntil = 0.3\n[expect]\n\"a at 3*0.1\" = { value = 1, within = 1 }\n"),
      "d.toml");
  EXPECT_EQ(d.expectations.at(0).time, 0.3);
}

TEST(ParseDiagram, ReportsAllFindingsInTheOrderOfTheFile) {
  try {
    parse_diagram(diagram_text("a = 1\npi = { type = \"adder\" }\n",
                               "[run]\nuntil = -1\nsamples = \"x\"\n[outputs]\ny = 3\n[other]\n"),
                  "d.toml");
    FAIL() << "no error";
  } catch (const DiagramError& error) {
    std::vector<int> lines;
    for (const text::Diagnostic& d : error.diagnostics()) lines.push_back(d.place.position.line);
    EXPECT_THAT(lines, ElementsAre(3, 4, 6, 7, 9, 10)) << error.what();
  }
}

TEST(Settings, AreBuiltAsFilesHaveThem) {
  EXPECT_EQ(to_string(WeightedSignal{1, "a"}), "a");
  EXPECT_EQ(to_string(WeightedSignal{-1, "a.b"}), "-a.b");
  EXPECT_EQ(to_string(WeightedSignal{-0.1, "a"}), "-0.1*a");
  EXPECT_EQ(number_setting("k", 2.5).value.number, 2.5);
  EXPECT_EQ(text_setting("k", "1 Hz").value.text, "1 Hz");
  EXPECT_EQ(wire_setting("in", {{2, "a"}}).value.text, "2*a");
  const text::Entry list = wire_setting("in", {{2, "a"}, {-1, "b"}});
  ASSERT_EQ(list.value.elements.size(), 2U);
  EXPECT_EQ(list.value.elements[1].text, "-b");
  EXPECT_TRUE(wire_setting("in", {}).value.elements.empty());
}

}  // namespace
}  // namespace oblique::diagram
