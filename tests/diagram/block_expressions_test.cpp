// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_expressions.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/text/expression_printer.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

const std::string kExpressionsHead =
    "format = \"oblique-block/1\"\ntitle = \"T\"\n[inputs]\nx = {}\n[outputs]\ny = {}\n"
    "[parameters]\nk = { default = 2 }\n";  // eight lines

BlockDefinition block(const std::string& body) {
  return parse_block(kExpressionsHead + body, "b.toml", "b");
}

std::string expressions_message(const std::string& body) {
  return message_of([&] { block(body); });
}

/// The equations of every case, the starts and the events, as text with every parenthesis that they need.
std::vector<std::string> texts_of(const BlockDefinition& definition) {
  std::vector<std::string> texts;
  for (const Behaviour& behaviour : definition.behaviours) {
    if (behaviour.when) texts.push_back(text::to_string(*behaviour.when));
    for (const Equation& equation : behaviour.equations)
      texts.push_back(equation.target + " = " + text::to_string(equation.expression));
  }
  for (const StartRule& start : definition.starts) texts.push_back(text::to_string(start.value));
  for (const MemoryRule& memory : definition.memories) texts.push_back(text::to_string(memory.initial));
  for (const EventRule& event : definition.events) {
    texts.push_back(text::to_string(event.when));
    for (const EventAction& action : event.actions) texts.push_back(text::to_string(action.value));
  }
  return texts;
}

TEST(Let, IsTheSameBlockAsTheOneWrittenOut) {
  const std::string with_let = R"toml(
[let]
half  = "k/2"
fed   = "half*x - y"
twice = "fed*fed"
few   = 3
[memories]
m = "half"
[[cases]]
when = "half > few"
equations = { "der(y)" = "-fed", inner = "twice^2 + weights(x)" }
[equations]
"der(y)" = "1/fed"
inner = "few*m"
[start]
y = "half"
[[events]]
when = "fed > few"
set = { m = "half + fed" }
)toml";
  const std::string written_out = R"toml(
[memories]
m = "k/2"
[[cases]]
when = "k/2 > 3"
equations = { "der(y)" = "-(k/2*x - y)", inner = "((k/2*x - y)*(k/2*x - y))^2 + weights(x)" }
[equations]
"der(y)" = "1/(k/2*x - y)"
inner = "3*m"
[start]
y = "k/2"
[[events]]
when = "k/2*x - y > 3"
set = { m = "k/2 + (k/2*x - y)" }
)toml";
  EXPECT_EQ(texts_of(block(with_let)), texts_of(block(written_out)));
}

TEST(Let, MayNameWhatOnlySomeCasesHave) {
  const std::string let = "[let]\nsum = \"x + inner\"\n[[cases]]\nwhen = \"k > 1\"\n";
  EXPECT_EQ(expressions_message(let + "equations = { inner = \"2*x\", y = \"sum\" }\n[equations]\ny = 1\n"),
            "");
  EXPECT_EQ(
      expressions_message(let + "equations = { inner = \"2*x\", y = 1 }\n[equations]\ny = \"1 + sum\"\n"),
      "b.toml:15:10: equation 'y': 'sum' of [let] names 'inner'; expected what may be named here\n"
      "  remedy: there is no 'inner' here");
  EXPECT_THAT(
      expressions_message("[let]\nsum = \"x + k\"\n[[cases]]\nwhen = \"sum > 0\"\nequations = { y = 1 }\n"
                          "[equations]\ny = 2\n"),
      HasSubstr("b.toml:12:9: 'when': 'sum' of [let] names 'x'; expected what may be named here"))
      << "a condition of a case is of parameters";
}

TEST(Let, ReportsItsOwnMistakesOnceAndInTheirPlace) {
  const std::string rest = "[equations]\ny = \"a + a\"\n";
  EXPECT_EQ(expressions_message("[let]\na = \"x*kk\"\n" + rest),
            "b.toml:10:8: 'a' of [let]: there is no name 'kk'\n  remedy: known: k, polarity, time, "
            "in_initial, in_operate, "
            "in_hold, x, y");
  EXPECT_THAT(expressions_message("[let]\na = \"x +\"\n" + rest),
              HasSubstr("b.toml:10:9: 'a' of [let]: the expression ends too early"));
  EXPECT_EQ(expressions_message("[let]\na = [1]\n" + rest),
            "b.toml:10:5: 'a' of [let] is an array; expected a number or an expression");
  EXPECT_EQ(expressions_message("[let]\nb = \"2*a\"\na = \"x\"\n" + rest),
            "b.toml:10:8: 'b' of [let]: there is no name 'a' yet\n  remedy: [let] names what stands above: "
            "put it there");
  EXPECT_THAT(expressions_message("[let]\nfed = \"x\"\n[equations]\ny = \"feed\"\n"),
              HasSubstr("b.toml:12:6: equation 'y': there is no name 'feed'\n  remedy: did you mean 'fed'?"));
}

TEST(Let, HasNamesOfItsOwn) {
  for (const char* const taken : {"x", "y", "k"}) {
    EXPECT_EQ(expressions_message("[let]\n" + std::string(taken) + " = 1\n[equations]\ny = 1\n"),
              "b.toml:10:1: the name '" + std::string(taken) +
                  "' is used twice; expected different names for inputs, outputs, parameters and [let]");
  }
  EXPECT_THAT(expressions_message("[let]\ntime = 1\n[equations]\ny = 1\n"),
              HasSubstr("b.toml:10:1: 'time' cannot be the name of an expression of [let]: it is reserved"));
  EXPECT_EQ(expressions_message("[let]\na = 1\n[equations]\ny = 1\na = 2\n"),
            "b.toml:13:1: 'a' is an expression of [let] and cannot have an equation; expected an output or "
            "another name");
  EXPECT_THAT(expressions_message("[let]\nm = 1\n[memories]\nm = 1\n[equations]\ny = 1\n"),
              HasSubstr("b.toml:12:1: the name 'm' is used twice"));
}

TEST(Let, BelongsToBlocksWithEquations) {
  EXPECT_THAT(message_of([] {
                parse_block(
                    "format = \"oblique-block/1\"\ntitle = \"T\"\n[outputs]\ny = { wire = \"a\" }\n"
                    "[let]\nh = 1\n[blocks]\na = { type = \"t\" }\n",
                    "b.toml", "b");
              }),
              HasSubstr("b.toml:5:1: a block with [blocks] has 'let' too; expected one or the other"));
}

TEST(Let, RefusesWhatGrowsWithoutEnd) {
  // Each name is the one before it twice: 2ⁿ − 1 operators; the tenth would have 1023.
  std::string let = "[let]\na0 = \"x + x\"\n";
  for (int n = 1; n < 40; ++n) {
    const std::string before = "a" + std::to_string(n - 1);
    let += "a" + std::to_string(n) + " = \"" + before + " + " + before + "\"\n";
  }
  EXPECT_EQ(expressions_message(let + "[equations]\ny = \"a39\"\n"),
            "b.toml:19:7: 'a9' of [let]: with [let] put in it has 1023 operators; expected at most 1000\n"
            "  remedy: make it an equation with a name of its own");
}

}  // namespace
}  // namespace oblique::diagram
