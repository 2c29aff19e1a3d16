// SPDX-License-Identifier: MIT
#include <oblique/diagram/diagram_writer.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <oblique/diagram/diagram_reader.h>

namespace oblique::diagram {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

TEST(WriteDiagram, IsReadable) {
  Diagram d;
  d.title = "Sides";
  d.source = "a \"book\"";
  d.comment = "made by hand\n\nfor a test";
  d.run.until = 1e-3;
  d.blocks = {
      {"a", "reference", "", "", {number_setting("value", 0.1)}, {}},
      {"long_one", "adder", "φ̇", "the sum\nof two", {wire_setting("in", {{2, "a"}, {-1, "long_one"}})}, {}},
      {"c", "servo", "", "", {wire_setting("in", {{1, "a"}}), number_setting("gain", kForever)}, {}}};
  d.outputs = {{"c", "c", 1, "machine unit", {}}, {"C.x", "a", 2.5, "m", {}}};
  d.expectations = {{"", "C.x", Expectation::Kind::at_time, 0.0005, 0.25, 1e-3, {}},
                    {"c  maximum", "c ", Expectation::Kind::maximum, 0, 1, 0.5, {}}};
  d.layout = {{"long_one", 12.5, -3, {}}, {"c", 0, 1, {}}};
  EXPECT_EQ(write_diagram(d), R"toml(# made by hand
#
# for a test

format = "oblique-diagram/1"
title  = "Sides"
source = "a \"book\""

[machine]
profile   = "ideal"
inverting = false

[run]
until     = 0.001
tolerance = 1e-08
method    = "auto"
samples   = 1001
max_steps = 10000000

[blocks]
a        = { type = "reference", value = 0.1 }

# the sum
# of two
long_one = { type = "adder", label = "φ̇", in = ["2*a", "-long_one"] }
c        = { type = "servo", in = "a", gain = inf }

[outputs]
c     = "c"
"C.x" = { signal = "a", scale = 2.5, unit = "m" }

[expect]
"C.x at 0.0005" = { value = 0.25, within = 0.001 }
"c  maximum"    = { value = 1, within = 0.5 }

[layout]
long_one = [12.5, -3]
c        = [0, 1]
)toml");
}

TEST(WriteDiagram, HasWhatWasPublishedAndTheLesson) {
  Diagram d;
  d.blocks = {{"a", "reference", "", "", {}, {}}};
  d.outputs = {{"x", "a", 1, "machine unit", {}}};
  Published& p = d.published.emplace();
  p.author = "A. Author";
  p.title = "A title";
  p.in = "A series";
  p.year = 2019;
  p.number = "36";
  p.plot = {"x", "t"};
  p.errata = {"0.15 is 1.5"};
  PublishedValue value;
  value.expected = {"x at 1/2", "x", Expectation::Kind::at_time, 0.5, 0.343, 0.001, {}};
  value.label = "v₀";
  value.set = {{"a.value", "1/3"}};
  value.because = "it drifts";
  p.leads = true;
  p.values = {value, value};
  p.values.back().because.clear();
  p.values.back().tried = "a longer run";
  d.lesson = Lesson{
      "One",
      "Of sums.",
      {{"turn",
        "how far?",
        {{"a.value", "2"}},
        "more",
        {{"", "x", Expectation::Kind::maximum, 0, 1, 0.5, {}}}}},
      LessonQuestion{"why?", "a.value", "look", {{"", "x", Expectation::Kind::minimum, 0, 1, 0.5, {}}}, {}}};
  const std::string text = write_diagram(d);
  EXPECT_EQ(text.substr(text.find("\n[published]")), R"toml(
[published]
author = "A. Author"
title = "A title"
in = "A series"
year = 2019
number = "36"
leads = true
plot = ["x", "t"]
errata = ["0.15 is 1.5"]

[[published.value]]
name = "x"
label = "v₀"
value = 0.343
within = 0.001
at = "1/2"
set = { "a.value" = "1/3" }
because = "it drifts"

[[published.value]]
name = "x"
label = "v₀"
value = 0.343
within = 0.001
at = "1/2"
set = { "a.value" = "1/3" }
tried = "a longer run"

[lesson]
title = "One"
text = "Of sums."

[[lesson.step]]
do = "turn"
guess = "how far?"
set = { "a.value" = "2" }
see = "more"
expect = { "x maximum" = { value = 1, within = 0.5 } }

[lesson.question]
ask = "why?"
answer = "a.value"
hint = "look"
expect = { "x minimum" = { value = 1, within = 0.5 } }
)toml");
}

TEST(WriteDiagram, HasWhatHoldsAGroup) {
  for (const auto& [initial, hold, written] : {std::array{"", "", "{ blocks = [\"x\"] }"},
                                               std::array{"u", "", "{ blocks = [\"x\"], initial = \"u\" }"},
                                               std::array{"", "u", "{ blocks = [\"x\"], hold = \"u\" }"}}) {
    Diagram d;
    d.blocks = {{"x", "integrator", "", "", {}, {}}, {"u", "constant", "", "", {}, {}}};
    d.groups = {{"slow", {"x"}, initial, hold, {}}};
    const std::string text = write_diagram(d);
    EXPECT_NE(text.find(std::string("[groups]\nslow = ") + written + "\n"), std::string::npos) << text;
    EXPECT_TRUE(parse_diagram(text, "d.toml") == d);
  }
}

// A bare key is of letters, digits, `_` and `-` (TOML 1.0); everything else stands in quotes.
TEST(WriteDiagram, QuotesOnlyTheNamesThatNeedIt) {
  const auto output_line = [](const std::string& name) {
    Diagram d;
    d.blocks = {{"u", "constant", "", "", {}, {}}};
    d.outputs = {{name, "u", 1, "machine unit", {}}};
    const std::string text = write_diagram(d);
    const std::size_t begin = text.find("[outputs]\n") + 10;
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  for (const std::string bare : {"a", "z", "A", "Z", "0", "9", "_", "-", "x_10-Y"}) {
    EXPECT_EQ(output_line(bare), bare + " = \"u\"");
  }
  // neighbours of the ends of each range, and what a word of another language begins with
  for (const std::string quoted : {"`", "{", "@", "[", "/", ":", " ", ".", "φ", "a b"}) {
    EXPECT_EQ(output_line(quoted), "\"" + quoted + "\" = \"u\"");
  }
}

/// Small things: what may go wrong shows in a few characters and a few blocks.
template <class T>
rc::Gen<T> small(rc::Gen<T> gen) {
  return rc::gen::resize(6, std::move(gen));
}

rc::Gen<std::string> identifier() {
  return rc::gen::map(small(rc::gen::container<std::string>(rc::gen::elementOf(std::string("abcXYZ_019")))),
                      [](std::string text) { return "b" + std::move(text); });
}

/// Any text that UTF-8 can hold, control characters and quotes among it.
rc::Gen<std::string> any_text() {
  const std::vector<std::string> pieces{"a",  "Z",    "0",    " ",    "\"", "\\", "\n",   "\t",
                                        "\r", "\x01", "\x1f", "\x7f", "'",  "#",  "=",    ".",
                                        "φ",  "̇",     "€",    "😀",    "{",  "]",  " at ", " maximum"};
  return rc::gen::map(small(rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(pieces))),
                      [](const std::vector<std::string>& chosen) {
                        std::string text;
                        for (const std::string& piece : chosen) text += piece;
                        return text;
                      });
}

rc::Gen<double> any_number() {
  return rc::gen::oneOf(
      rc::gen::map(rc::gen::arbitrary<double>(), [](double x) { return std::isnan(x) ? 0 : x; }),
      rc::gen::map(rc::gen::inRange(-1000, 1000), [](int x) { return x / 8.0; }),
      rc::gen::element(kForever, -kForever, 0.1, 1e-308, 5e-324, 1e15, 1e16, 1.7976931348623157e308));
}

rc::Gen<double> positive_number() {
  return rc::gen::map(rc::gen::inRange(1, 1'000'000), [](int x) { return x / 1024.0; });
}

text::Entry any_setting(const std::string& key) {
  switch (*rc::gen::inRange(0, 3)) {
    case 0:
      return number_setting(key, *any_number());
    case 1:
      return text_setting(key, *any_text());
    default:
      break;
  }
  std::vector<WeightedSignal> terms;
  for (const std::string& signal : *small(rc::gen::container<std::vector<std::string>>(identifier()))) {
    terms.push_back({*any_number(), signal});
  }
  return wire_setting(key, terms);
}

BlockInstance any_block(const std::string& name) {
  BlockInstance block{name, *any_text(), *any_text(), *any_text(), {}, {}};
  for (const std::string& key : *small(rc::gen::container<std::set<std::string>>(identifier()))) {
    block.settings.push_back(any_setting(key));
  }
  return block;
}

/// Times in eighths of a second, which decimals hold exactly.
Expectation any_expectation(const std::string& output) {
  const double value = *rc::gen::inRange(-1000, 1000) / 7.0;
  const double within = *positive_number();
  switch (*rc::gen::inRange(0, 3)) {
    case 0:
      return {output + " maximum", output, Expectation::Kind::maximum, 0, value, within, {}};
    case 1:
      return {output + " minimum", output, Expectation::Kind::minimum, 0, value, within, {}};
    default:
      break;
  }
  const double time = *rc::gen::inRange(0, 800) / 8.0;
  return {
      output + " at " + std::to_string(time), output, Expectation::Kind::at_time, time, value, within, {}};
}

/// Parameters that are set; the blocks that they name are not looked for by the reader.
std::vector<ParameterOverride> any_settings() {
  std::vector<ParameterOverride> settings;
  for (const std::string& path : *small(rc::gen::container<std::set<std::string>>(any_text())))
    settings.push_back({path, *any_text()});
  return settings;
}

PublishedValue any_published_value(const std::string& output) {
  PublishedValue value;
  value.expected = any_expectation(output);
  value.label = *any_text();
  value.set = any_settings();
  value.because = *any_text();
  if (*rc::gen::arbitrary<bool>()) value.unit = "machine unit";
  return value;
}

Published any_published(const std::vector<OutputSpec>& outputs) {
  Published p;
  p.kind = *rc::gen::element(Published::Kind::programme, Published::Kind::equations);
  for (std::string Published::*const member :
       {&Published::author, &Published::title, &Published::in, &Published::number, &Published::page,
        &Published::address, &Published::machine, &Published::subject})
    p.*member = *any_text();
  p.picture = "a" + *any_text();
  if (*rc::gen::arbitrary<bool>()) p.year = *rc::gen::inRange(1800, 2200);
  p.errata = *small(rc::gen::container<std::vector<std::string>>(any_text()));
  for (const OutputSpec& output : outputs) {
    if (output.unit == "machine unit" && *rc::gen::arbitrary<bool>())
      p.values.push_back(any_published_value(output.name));
  }
  if (!outputs.empty()) p.plot = {outputs.back().name, "t"};
  return p;
}

Lesson any_lesson(const std::vector<OutputSpec>& outputs) {
  const auto expectations = [&] {
    std::vector<Expectation> all;
    for (const OutputSpec& output : outputs) all.push_back(any_expectation(output.name));
    return all;
  };
  Lesson lesson{*any_text(), *any_text(), {}, {}};
  for (int steps = *rc::gen::inRange(0, 3); steps > 0; --steps)
    lesson.steps.push_back(
        {"a" + *any_text(), *any_text(), any_settings(), "b" + *any_text(), expectations()});
  if (!outputs.empty())
    lesson.question = LessonQuestion{"a" + *any_text(), "b" + *any_text(), *any_text(), expectations(), {}};
  return lesson;
}

Diagram any_diagram() {
  Diagram d;
  d.title = *any_text();
  d.source = *any_text();
  d.comment = *any_text();
  d.machine.inverting = *rc::gen::arbitrary<bool>();
  d.run.until = 100 + *positive_number();
  d.run.tolerance = 1 / (1 + *positive_number());
  d.run.method = *rc::gen::elementOf(
      std::vector<IntegrationMethod>(std::begin(kIntegrationMethods), std::end(kIntegrationMethods)));
  d.run.samples = *rc::gen::inRange(2, 1'000'000);
  d.run.max_steps = *rc::gen::inRange(1L, 1'000'000'000'000L);
  if (*rc::gen::arbitrary<bool>()) d.run.absolute_tolerance = *positive_number();
  if (*rc::gen::arbitrary<bool>()) d.run.max_step = *positive_number();
  for (const std::string& name :
       *small(rc::gen::nonEmpty(rc::gen::container<std::set<std::string>>(identifier())))) {
    d.blocks.push_back(any_block(name));
    if (*rc::gen::arbitrary<bool>())
      d.layout.push_back(
          {name, *rc::gen::inRange(-9000, 9000) / 7.0, *rc::gen::inRange(-9000, 9000) / 7.0, {}});
  }
  for (const std::string& name :
       *small(rc::gen::container<std::set<std::string>>(rc::gen::nonEmpty(any_text())))) {
    const double scale = *rc::gen::inRange(-1000, 1000) / 3.0;
    d.outputs.push_back({name,
                         *any_text(),
                         *rc::gen::element(1.0, scale),
                         *rc::gen::element<std::string>("machine unit", "m"),
                         {}});
    if (*rc::gen::arbitrary<bool>()) d.expectations.push_back(any_expectation(name));
  }
  if (*rc::gen::arbitrary<bool>()) d.published = any_published(d.outputs);
  if (*rc::gen::arbitrary<bool>()) d.lesson = any_lesson(d.outputs);
  return d;
}

RC_GTEST_PROP(WriteDiagram, IsReadBackUnchanged, ()) {
  const Diagram d = any_diagram();
  const std::string text = write_diagram(d);
  RC_LOG() << text;
  RC_ASSERT(parse_diagram(text, "d.toml") == d);
}

TEST(WriteDiagram, DiagramsThatDifferAnywhereAreNotEqual) {
  Diagram d;
  d.blocks = {{"a", "reference", "l", "", {number_setting("value", 1)}, {}}};
  d.outputs = {{"o", "a", 1, "m", {}}};
  d.expectations = {{"o maximum", "o", Expectation::Kind::maximum, 0, 1, 1, {}}};
  const auto differs = [&](auto change) {
    Diagram other = d;
    change(other);
    return !(other == d);
  };
  EXPECT_FALSE(differs([](Diagram& o) {
    o.file = "other";
    o.comment = "other";
    o.blocks[0].comment = "other";
    o.blocks[0].place.position.line = 7;
  }));
  EXPECT_TRUE(differs([](Diagram& o) { o.title = "x"; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.source = "x"; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.machine.inverting = true; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.run.method = IntegrationMethod::bdf; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.run.samples = 2; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.run.absolute_tolerance = 2; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.run.max_step = 2; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.blocks[0].name = "x"; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.blocks[0].label = "x"; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.blocks[0].settings[0].value.number = 2; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.blocks[0].settings[0] = text_setting("value", "1"); }));
  EXPECT_TRUE(differs([](Diagram& o) { o.blocks[0].settings.clear(); }));
  EXPECT_TRUE(differs([](Diagram& o) { o.outputs[0].scale = 2; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.expectations[0].within = 2; }));
  EXPECT_TRUE(differs([](Diagram& o) { o.layout = {{"a", 1, 2, {}}}; }));
}

}  // namespace
}  // namespace oblique::diagram
