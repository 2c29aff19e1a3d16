// SPDX-License-Identifier: MIT
#include <oblique/diagram/published.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using testing::diagram_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::small_library;

const std::string kPublishedHead = R"toml(a = { type = "reference" }
[run]
until = 2
[outputs]
x = { signal = "a", unit = "mm" }
y = "a"
[published]
author = "A. Author"
title = "A title"
)toml";  // [published] stands in line 9, what follows from line 12 on

Diagram published_with(const std::string& rest) {
  return parse_diagram(diagram_text(kPublishedHead, rest), "d.toml");
}

std::string published_message(const std::string& rest) {
  return message_of([&] { published_with(rest); });
}

std::string value_message(const std::string& rest) {
  return published_message("[[published.value]]\nname = \"x\"\nvalue = 1\nwithin = 0.1\n" + rest);
}

TEST(Published, IsReadWhole) {
  const Diagram d = published_with(R"toml(in = "A series"
year = 2019
number = 36
page = "12-14"
address = "https://example.org/36"
machine = "Model-1"
subject = "quantum mechanics"
picture = "a bell"
plot = ["y", "x"]
errata = "0.15 y is 1.5 y"
[[published.value]]
name = "x"
value = "3 cm"
within = 0.5
at = "1/2"
[[published.value]]
name = "y"
label = "v₀ at E = -0.1"
value = 20
within = "10 %"
unit = "machine unit"
at = "maximum"
set = { "a.value" = 0.5 }
because = "the amplifier overloads"
)toml");
  const Published& p = d.published.value();
  EXPECT_EQ(p.kind, Published::Kind::programme);
  EXPECT_EQ(citation(p), "A. Author, A title, A series 36, 2019, pp. 12-14");
  EXPECT_EQ(p.address, "https://example.org/36");
  EXPECT_EQ(p.machine, "Model-1");
  EXPECT_EQ(p.subject, "quantum mechanics");
  EXPECT_EQ(p.picture, "a bell");
  EXPECT_THAT(p.plot, ElementsAre("y", "x"));
  EXPECT_THAT(p.errata, ElementsAre("0.15 y is 1.5 y"));
  ASSERT_EQ(p.values.size(), 2U);
  EXPECT_EQ(p.values[0].expected,
            (Expectation{"x at 1/2", "x", Expectation::Kind::at_time, 0.5, 30, 0.5, {}}));
  EXPECT_EQ(p.values[0].factor, 1);
  EXPECT_EQ(name_of(p.values[0]), "x at 1/2");
  EXPECT_EQ(p.values[1].expected,
            (Expectation{"y maximum", "y", Expectation::Kind::maximum, 0, 20, 0.1, {}}));
  EXPECT_EQ(name_of(p.values[1]), "v₀ at E = -0.1");
  EXPECT_EQ(p.values[1].set, (std::vector<ParameterOverride>{{"a.value", "0.5"}}));
  EXPECT_EQ(p.values[1].because, "the amplifier overloads");
}

TEST(Published, CitesWhatIsKnown) {
  Published p;
  p.author = "A. Author";
  p.title = "A title";
  EXPECT_EQ(citation(p), "A. Author, A title");
  p.number = "7";
  p.page = "3";
  EXPECT_EQ(citation(p), "A. Author, A title, 7, p. 3");
  p.page = "fig. 2";
  EXPECT_EQ(citation(p), "A. Author, A title, 7, fig. 2");
}

TEST(Published, ReadsValuesInTheirOwnUnit) {
  const Diagram d =
      published_with("[[published.value]]\nname = \"x\"\nvalue = 1.5\nwithin = \"1 mm\"\nunit = \"cm\"\n");
  const PublishedValue& value = d.published->values.at(0);
  EXPECT_EQ(value.expected.value, 1.5);
  EXPECT_DOUBLE_EQ(value.expected.within, 0.1);
  EXPECT_EQ(value.factor, 10);  // millimetres in a centimetre
}

TEST(Published, GivesPeriodsInUnitsOfTime) {
  const std::string value = "[[published.value]]\nname = \"x\"\nat = \"period\"\nvalue = 1.5\nwithin = 0.1\n";
  const Diagram d = published_with(value + "unit = \"ms\"\n");
  EXPECT_EQ(d.published->values.at(0).expected.kind, Expectation::Kind::period);
  EXPECT_EQ(d.published->values.at(0).factor, 1e-3);
  EXPECT_EQ(name_of(d.published->values.at(0)), "x period");
  EXPECT_EQ(published_with(value).published->values.at(0).unit, "s");
  EXPECT_THAT(published_message(value + "unit = \"mm\"\n"),
              ::testing::HasSubstr("'unit' of [[published.value]] is 'mm'; expected a unit of time"));
}

// Nothing is said of the time: what the run ends with.
TEST(Published, MeansTheEndOfTheRun) {
  const Diagram d = published_with("[[published.value]]\nname = \"x\"\nvalue = 1\nwithin = 0.1\n");
  EXPECT_EQ(d.published->values.at(0).expected.time, 2);
  EXPECT_EQ(name_of(d.published->values.at(0)), "x at end");
}

TEST(Published, IsCalledByWhatItSets) {
  const Diagram d = published_with(
      "[[published.value]]\nname = \"x\"\nvalue = 1\nwithin = 0.1\nset = { \"a.value\" = \"1/3\", \"a.b\" = "
      "2 }\n");
  EXPECT_EQ(name_of(d.published->values.at(0)), "x at end with a.value = 1/3, a.b = 2");
}

TEST(Published, IsNothingWithoutSomethingToHold) {
  EXPECT_EQ(published_message(""),
            "d.toml:9:1: [published] gives nothing to hold the run against; expected [[published.value]] or "
            "'picture', what a published picture shows\n"
            "  remedy: where only equations were published, say kind = \"equations\"");
  EXPECT_EQ(published_message("kind = \"equations\"\n"), "");
  EXPECT_EQ(published_message("picture = \"a bell\"\n"), "");
}

TEST(Published, RefusesWhatItCannotMean) {
  const std::string held = "picture = \"a bell\"\n";  // line 12
  EXPECT_EQ(published_message(held + "kind = \"equation\"\n"),
            "d.toml:13:8: 'kind' of [published] is 'equation'; expected \"programme\", a circuit as it was "
            "patched, or \"equations\", composed here\n  remedy: did you mean 'equations'?");
  EXPECT_EQ(published_message(held + "year = 19.5\n"),
            "d.toml:13:8: 'year' of [published] is 19.5; expected a whole number from 1800 to 2199");
  EXPECT_EQ(published_message(held + "page = 1.5\n"),
            "d.toml:13:8: 'page' of [published] is 1.5; expected a text, or a whole number from 0 on");
  EXPECT_EQ(published_message(held + "plot = [\"x\"]\n"),
            "d.toml:13:8: 'plot' of [published] names one output; expected [\"y\", \"x\"]: y against x, the "
            "last along the horizontal axis");
  EXPECT_EQ(published_message(held + "plot = [\"x\", \"z\"]\n"),
            "d.toml:9:1: 'plot' of [published] names 'z', which is no output\n  remedy: known: x, y");
  EXPECT_EQ(published_message(held + "plot = [\"x\", \"t\"]\n"), "");
  EXPECT_EQ(published_message(held + "pages = 7\n"),
            "d.toml:13:1: unknown key 'pages' in [published]\n  remedy: did you mean 'page'?");
  EXPECT_EQ(published_message(held + "value = 7\n"),
            "d.toml:13:9: 'value' of [published] is a number; expected tables [[published.value]]");
  EXPECT_EQ(message_of([] {
              parse_diagram(diagram_text("a = { type = \"reference\" }\n[published]\npicture = \"a bell\"\n"),
                            "d.toml");
            }),
            "d.toml:4:1: [published] has no 'author'; expected a text\n"
            "d.toml:4:1: [published] has no 'title'; expected a text");
}

TEST(Published, RefusesWhatSaysNothing) {
  EXPECT_EQ(
      value_message("because = \"a\"\ntried = \"b\"\n"),
      "d.toml:17:9: [[published.value]] has 'because' and 'tried'; expected the one where the difference is "
      "explained, the other where it is not");
  const std::string held = "picture = \"a bell\"\n";
  EXPECT_EQ(published_message("kind = \"equations\"\npicture = 3\n"),
            "d.toml:13:11: 'picture' of [published] is a number; expected a string");
  EXPECT_EQ(published_message(held + "page = -3\n"),
            "d.toml:13:8: 'page' of [published] is -3; expected a text, or a whole number from 0 on");
  EXPECT_EQ(
      published_message(held + "plot = [\"t\", \"x\", \"t\"]\n"),
      "d.toml:13:8: 'plot' of [published] names 't' twice; expected each output once, and the last along the "
      "horizontal axis");
}

TEST(Published, RefusesValuesThatCannotBeHeld) {
  EXPECT_EQ(published_message("[[published.value]]\nvalue = 1\nwithin = 0.1\n"),
            "d.toml:12:1: [[published.value]] has no 'name'; expected an output");
  EXPECT_EQ(published_message("[[published.value]]\nname = \"z\"\nvalue = 1\nwithin = 0.1\n"),
            "d.toml:12:1: [[published.value]] names 'z', which is no output\n  remedy: known: x, y");
  EXPECT_EQ(published_message("[[published.value]]\nname = \"x\"\nvalue = 1\n"),
            "d.toml:12:1: [[published.value]] has no 'within'; expected a quantity in 'mm'");
  EXPECT_EQ(
      value_message("at = 3\n"),
      "d.toml:16:6: 'at' of [[published.value]] is 3 s; expected a time from 0 to the end of the run, 2 s\n"
      "  remedy: name a time within the run, or lengthen 'until' of [run]");
  EXPECT_THAT(value_message("at = \"maximal\"\n"),
              HasSubstr("d.toml:16:7: 'at' of [[published.value]]: 'maximal' is not a known constant"));
  EXPECT_EQ(value_message("unit = \"V\"\n"),
            "d.toml:16:8: 'unit' of [[published.value]] is 'V'; expected a unit that 'mm', the unit of the "
            "output, can be given in");
  EXPECT_EQ(value_message("set = { a = { value = 3 } }\n"),
            "d.toml:16:13: 'a' in 'set' of [[published.value]] is a table; expected a number or a quantity\n"
            "  remedy: quote the whole name: \"a.…\" = …");
  EXPECT_EQ(value_message("sigma = 3\n"),
            "d.toml:16:1: unknown key 'sigma' in [[published.value]]\n"
            "  remedy: known: name, label, because, tried, at, unit, set, value, within");
}

// What is set is known only where the blocks are.
TEST(Published, RefusesToSetWhatIsNotThere) {
  const auto flatten_message = [](const std::string& setting) {
    return message_of([&] {
      flatten(published_with("[[published.value]]\nname = \"x\"\nvalue = 1\nwithin = 0.1\nset = { " +
                             setting + " }\n"),
              small_library());
    });
  };
  EXPECT_EQ(flatten_message("\"a.value\" = 3"), "");
  EXPECT_EQ(
      flatten_message("\"a.valu\" = 3"),
      "d.toml:16:9: 'valu' of block type 'reference' is not a parameter\n  remedy: did you mean 'value'?");
  EXPECT_EQ(flatten_message("\"b.value\" = 3"), "d.toml:16:9: there is no block 'b'\n  remedy: known: a");
  EXPECT_THAT(flatten_message("\"a.value\" = \"3 s\""), HasSubstr("d.toml:16:9: "));
}

// Of a diagram without [outputs] every signal is one.
TEST(Published, NamesSignalsWhereThereAreNoOutputs) {
  const std::string text = diagram_text(
      "a = { type = \"reference\" }\n[published]\nauthor = \"A\"\ntitle = \"T\"\n"
      "[[published.value]]\nname = \"b\"\nvalue = 1\nwithin = 0.1\n");
  EXPECT_EQ(message_of([&] { flatten(parse_diagram(text, "d.toml"), small_library()); }),
            "d.toml:7:1: [[published.value]] names 'b', which is no output\n  remedy: known: a");
}

TEST(Published, LosesOnlyWhatItSets) {
  Diagram d = published_with(
      "[[published.value]]\nname = \"x\"\nvalue = 1\nwithin = 0.1\n"
      "[[published.value]]\nname = \"x\"\nvalue = 1\nwithin = 0.1\nset = { \"a.value\" = 1 }\n");
  EXPECT_EQ(without_settings(d.published)->values.size(), 1U);
  d.published->values.erase(d.published->values.begin());
  EXPECT_FALSE(without_settings(d.published));
  d.published->picture = "a bell";
  EXPECT_TRUE(without_settings(d.published));
  EXPECT_FALSE(without_settings(std::nullopt));
}

}  // namespace
}  // namespace oblique::diagram
