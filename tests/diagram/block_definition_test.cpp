// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_definition.h>

#include <oblique/text/expression_printer.h>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using ::testing::Not;

const std::string kHead = "format = \"oblique-block/1\"\ntitle = \"T\"\n";  // two lines

std::string block_message(const std::string& text) {
  return message_of([&] { parse_block(kHead + text, "b.toml", "b"); });
}

TEST(ParseBlock, ReadsEveryPartOfAPrimitiveBlock) {
  const std::string text = R"toml(format = "oblique-block/1"
title = "Servo amplifier"
summary = "Solves an equation."
source = "a book"
symbol = "open-amplifier"
doc = """
long text"""
[inputs]
in = { sum = true, doc = "residual" }
bias = { default = "1/4" }
[outputs]
out = { doc = "unknown" }
[parameters]
gain = { default = 1e6, unit = "1", above = 0, doc = "of the open loop" }
bandwidth = { default = "0.01 kHz", unit = "Hz", at_least = "1 Hz", below = "inf" }
initial = { default = 0, unit = "machine unit", at_most = 2 }
[equations]
help = "in + bias"
"der(out)" = "2*pi*bandwidth*(-out - gain*help)*polarity*time"
[[cases]]
when = "gain == inf and polarity > 0"
implicit = { out = "help" }
equations = { help = "in" }
[start]
out = { guess = "initial/2", at_rest = true }
)toml";
  const BlockDefinition block = parse_block(text, "servo.toml", "servo");
  EXPECT_EQ(block.name, "servo");
  EXPECT_EQ(block.file, "servo.toml");
  EXPECT_EQ(block.text, text);
  EXPECT_EQ(block.title, "Servo amplifier");
  EXPECT_EQ(block.summary, "Solves an equation.");
  EXPECT_EQ(block.source, "a book");
  EXPECT_EQ(block.symbol, "open-amplifier");
  EXPECT_EQ(block.doc, "long text");
  EXPECT_FALSE(block.is_composite());

  ASSERT_EQ(block.inputs.size(), 2U);
  EXPECT_TRUE(block.inputs[0].sum);
  EXPECT_EQ(block.inputs[0].doc, "residual");
  EXPECT_FALSE(block.inputs[0].default_value);
  EXPECT_FALSE(block.inputs[1].sum);
  EXPECT_EQ(block.inputs[1].default_value, 0.25);
  ASSERT_EQ(block.outputs.size(), 1U);
  EXPECT_EQ(block.outputs[0].doc, "unknown");
  EXPECT_EQ(block.find_input("bias"), 1U);
  EXPECT_EQ(block.find_output("out"), 0U);
  EXPECT_EQ(block.find_parameter("initial"), 2U);
  EXPECT_FALSE(block.find_input("out"));

  const ParameterDefinition& bandwidth = block.parameters[1];
  EXPECT_EQ(bandwidth.default_value, 10);
  EXPECT_EQ(bandwidth.unit, "Hz");
  EXPECT_EQ(bandwidth.at_least, 1);
  EXPECT_EQ(block.parameters[0].above, 0);
  EXPECT_EQ(block.parameters[2].at_most, 2);

  // Cases come first, the default last.
  ASSERT_EQ(block.behaviours.size(), 2U);
  ASSERT_TRUE(block.behaviours[0].when);
  EXPECT_EQ(text::to_string(*block.behaviours[0].when), "gain == inf and polarity > 0");
  ASSERT_EQ(block.behaviours[0].equations.size(), 2U);
  EXPECT_EQ(block.behaviours[0].equations[0].target, "help");
  EXPECT_EQ(block.behaviours[0].equations[0].kind, Equation::Kind::assignment);
  EXPECT_EQ(block.behaviours[0].equations[1].kind, Equation::Kind::implicit);
  EXPECT_FALSE(block.behaviours[1].when);
  ASSERT_EQ(block.behaviours[1].equations.size(), 2U);
  EXPECT_EQ(block.behaviours[1].equations[1].kind, Equation::Kind::derivative);
  EXPECT_EQ(block.behaviours[1].equations[1].target, "out");
  EXPECT_EQ(block.behaviours[1].equations[1].place.position.line, 19);

  ASSERT_EQ(block.starts.size(), 1U);
  EXPECT_EQ(block.starts[0].target, "out");
  EXPECT_EQ(text::to_string(block.starts[0].value), "initial/2");
  EXPECT_TRUE(block.starts[0].at_rest);
}

TEST(ParseBlock, StartsEveryStateAndUnknownSomewhere) {
  const std::string body = R"toml([outputs]
out = {}
[equations]
out = "a + b"
"der(a)" = 1
"der(b)" = "-b"
[implicit]
c = "c - a"
)toml";
  const BlockDefinition plain = parse_block(kHead + body + "[start]\nb = 2.5\n", "b.toml", "b");
  ASSERT_EQ(plain.starts.size(), 3U);
  EXPECT_EQ(plain.starts[0].target, "a");
  EXPECT_EQ(text::to_string(plain.starts[0].value), "0");
  EXPECT_EQ(text::to_string(plain.starts[1].value), "2.5");
  EXPECT_EQ(plain.starts[2].target, "c");
  EXPECT_FALSE(plain.starts[2].at_rest);

  // A parameter `initial` is the usual start.
  const BlockDefinition named = parse_block(
      kHead + body + "[start]\nb = \"2*initial\"\nc = { at_rest = true }\n[parameters]\ninitial = {}\n",
      "b.toml", "b");
  EXPECT_EQ(text::to_string(named.starts[0].value), "initial");
  EXPECT_EQ(text::to_string(named.starts[1].value), "2*initial");
  EXPECT_EQ(text::to_string(named.starts[2].value), "initial");
  EXPECT_TRUE(named.starts[2].at_rest);
}

TEST(ParseBlock, ReadsAComposite) {
  const BlockDefinition block = parse_block(kHead + R"toml([inputs]
x = {}
[outputs]
y = { wire = "twice" }
[parameters]
k = { default = 2 }
[machine]
inverting = true
[blocks]
twice = { type = "adder", label = "φ̇", in = ["k*x", "x"] }
)toml",
                                            "b.toml", "b");
  EXPECT_TRUE(block.is_composite());
  EXPECT_TRUE(block.inverting);
  EXPECT_TRUE(block.behaviours.empty());
  EXPECT_EQ(block.outputs[0].wire, "twice");
  ASSERT_EQ(block.blocks.size(), 1U);
  EXPECT_EQ(block.blocks[0].name, "twice");
  EXPECT_EQ(block.blocks[0].type, "adder");
  EXPECT_EQ(block.blocks[0].label, "φ̇");
  ASSERT_EQ(block.blocks[0].settings.size(), 1U);
  EXPECT_EQ(block.blocks[0].settings[0].key, "in");
  EXPECT_EQ(block.blocks[0].place, (text::Place{"b.toml", {12, 1}}));
}

TEST(ParameterDefinition, KnowsItsRange) {
  ParameterDefinition p;
  EXPECT_EQ(p.range(), "a number");
  EXPECT_TRUE(p.allows(-std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(p.allows(std::nan("")));
  p.above = 0;
  p.at_most = 5;
  p.unit = "Hz";
  EXPECT_EQ(p.range(), "a number above 0 and at most 5 [Hz]");
  EXPECT_FALSE(p.allows(0));
  EXPECT_TRUE(p.allows(5));
  EXPECT_FALSE(p.allows(std::nextafter(5, 6)));
  p = {};
  p.at_least = 0;
  p.below = std::numeric_limits<double>::infinity();
  EXPECT_EQ(p.range(), "a number at least 0 and below inf");
  EXPECT_TRUE(p.allows(0));
  EXPECT_FALSE(p.allows(*p.below));
}

TEST(ParseBlock, BrokenTomlIsAReadError) {
  EXPECT_THAT(message_of<text::ReadError>([] { parse_block("[outputs\n", "b.toml", "b"); }),
              HasSubstr("b.toml:"));
  EXPECT_THAT(
      message_of<text::ReadError>([] { parse_block(kHead + "[outputs]\nx = {}\nx = {}\n", "b.toml", "b"); }),
      HasSubstr("b.toml:5:"));
}

// What is no block says nothing of one.
TEST(ParseBlock, LooksNoFurtherIntoAFileOfAnotherFormat) {
  const std::string message = message_of(
      [] { parse_block("format = \"oblique-diagram/1\"\n[outputs]\ny = \"x\"\n[levels]\n", "b.toml", "b"); });
  EXPECT_THAT(message, HasSubstr("b.toml:1:10: the format is 'oblique-diagram/1'"));
  EXPECT_THAT(message, Not(HasSubstr("'y'")));
  EXPECT_THAT(message, Not(HasSubstr("levels")));
}

TEST(ParseBlock, NamesWhatIsMissing) {
  EXPECT_EQ(
      message_of([] { parse_block("title = 'x'\n[outputs]\ny = {}\n[equations]\ny = 1\n", "b.toml", "b"); }),
      "b.toml:1:1: the block file has no 'format'; expected format = \"oblique-block/1\"");
  EXPECT_EQ(block_message("[equations]\ny = 1\n"),
            "b.toml:1:1: the block has no [outputs]; expected at least one output");
  EXPECT_EQ(
      block_message("[outputs]\ny = {}\n"),
      "b.toml:4:1: output 'y' has no equation; expected 'y = …', 'der(y) = …' or an [implicit] entry 'y'");
  EXPECT_EQ(
      block_message(
          "[outputs]\ny = {}\n[equations]\ny = 1\n[[cases]]\nwhen = \"1 > 0\"\nequations = { z = 2 }\n"),
      "b.toml:4:1: output 'y' has no equation where 1 > 0; expected 'y = …', 'der(y) = …' or an [implicit] "
      "entry "
      "'y'");
  EXPECT_THAT(block_message("[outputs]\ny = {}\n[blocks]\na = { type = \"adder\" }\n"),
              HasSubstr("output 'y' has no 'wire'; expected the inner signal that the output shows"));
  EXPECT_THAT(block_message("[outputs]\ny = { wire = \"a\" }\n[blocks]\n"),
              HasSubstr("[blocks] is empty; expected at least one block"));
}

TEST(ParseBlock, RefusesUnknownKeys) {
  EXPECT_EQ(block_message("sumary = \"x\"\n[outputs]\ny = {}\n[equations]\ny = 1\n"),
            "b.toml:3:1: unknown key 'sumary' in the block file\n  remedy: did you mean 'summary'?");
  EXPECT_THAT(block_message("[inputs]\nx = { sums = true }\n[outputs]\ny = {}\n[equations]\ny = 1\n"),
              HasSubstr("b.toml:4:7: unknown key 'sums' in input 'x'\n  remedy: did you mean 'sum'?"));
  EXPECT_THAT(block_message("[outputs]\ny = {}\n[equations]\ny = 1\n[machine]\ninverting = true\n"),
              HasSubstr("unknown key 'machine'"));
}

TEST(ParseBlock, RefusesNamesThatEquationsCannotUse) {
  EXPECT_THAT(
      block_message("[outputs]\n\"a b\" = {}\n[equations]\ny = 1\n"),
      HasSubstr("b.toml:4:1: 'a b' cannot be the name of an output; expected letters, digits and '_'"));
  EXPECT_THAT(
      block_message("[inputs]\ntime = {}\n[outputs]\ny = {}\n[equations]\ny = 1\n"),
      HasSubstr(
          "b.toml:4:1: 'time' cannot be the name of an input: it is reserved; expected another name than "
          "time, polarity, in_initial, in_operate, in_hold, pi, inf, and, or, not"));
  EXPECT_THAT(
      block_message("[parameters]\nin = {}\n[outputs]\ny = {}\n[equations]\ny = 1\n"),
      HasSubstr("'in' cannot be the name of a parameter: a block in a diagram uses that key itself; expected "
                "another name than type, label, in"));
  EXPECT_THAT(block_message("[inputs]\nlabel = {}\n[outputs]\ny = {}\n[equations]\ny = 1\n"),
              HasSubstr("'label' cannot be the name of an input: a block in a diagram uses that key itself"));
  EXPECT_THAT(
      block_message("[inputs]\ny = {}\n[outputs]\ny = {}\n[equations]\ny = 1\n"),
      HasSubstr("b.toml:6:1: the name 'y' is used twice; expected different names for inputs, outputs and "
                "parameters"));
}

TEST(ParseBlock, ChecksParameters) {
  const std::string rest = "[outputs]\ny = {}\n[equations]\ny = 1\n[parameters]\n";
  EXPECT_EQ(block_message(rest + "p = { default = 1, unit = \"hurz\" }\n"),
            "b.toml:8:27: parameter 'p': there is no unit 'hurz'; expected a unit such as \"1\", \"Hz\", "
            "\"s\", \"rad\", "
            "\"m/s\" or \"machine unit\"");
  EXPECT_EQ(block_message(rest + "p = { default = -1, above = 0 }\n"),
            "b.toml:8:17: the default of parameter 'p' is -1; expected a number above 0");
  EXPECT_THAT(
      block_message(rest + "p = { default = \"3 m\", unit = \"s\" }\n"),
      HasSubstr("'default' of parameter 'p': 'm' is the wrong unit here; expected a quantity in 's'"));
  EXPECT_THAT(block_message(rest + "[inputs]\nx = { default = inf }\n"),
              HasSubstr("'default' of input 'x' is infinite; expected a finite number"));
}

TEST(ParseBlock, ChecksEquations) {
  const std::string ports =
      "[inputs]\nx = {}\n[parameters]\ngain = {}\n[outputs]\ny = {}\n[equations]\n";  // 3 to 9
  EXPECT_EQ(block_message(ports + "y = \"x*gian\"\n"),
            "b.toml:10:8: equation 'y': there is no name 'gian'\n  remedy: did you mean 'gain'?");
  EXPECT_THAT(block_message(ports + "y = \"x +\"\n"),
              HasSubstr("b.toml:10:9: equation 'y': the expression ends too early"));
  EXPECT_EQ(block_message(ports + "y = [1]\n"),
            "b.toml:10:5: equation 'y' is an array; expected a number or an expression");
  EXPECT_EQ(
      block_message(ports + "y = 1\n\"der(y)\" = 2\n"),
      "b.toml:11:12: 'y' has two equations; expected one\n  remedy: name it once: as 'x', as 'der(x)' or in "
      "[implicit]");
  EXPECT_EQ(block_message(ports + "y = 1\n\"y+1\" = 2\n"),
            "b.toml:11:1: 'y+1' is not the left side of an equation; expected \"name\" or \"der(name)\"");
  EXPECT_EQ(block_message(ports + "y = 1\nx = 2\n"),
            "b.toml:11:1: 'x' is an input and cannot have an equation; expected an output or another name");
  EXPECT_EQ(
      block_message(ports + "y = 1\n\"der(gain)\" = 2\n"),
      "b.toml:11:1: 'gain' is a parameter and cannot have an equation; expected an output or another name");
  EXPECT_THAT(block_message(ports + "y = 1\npi = 2\n"), HasSubstr("'pi' cannot be the name of an unknown"));
  EXPECT_THAT(block_message(ports + "y = 1\n[implicit]\n\"der(z)\" = 1\n"),
              HasSubstr("'der(z)' is not the left side of an equation; expected the name of an unknown"));
}

TEST(ParseBlock, ChecksCasesAndStarts) {
  const std::string ports =
      "[inputs]\nx = {}\n[parameters]\ngain = {}\n[outputs]\ny = {}\n[equations]\ny = 1\n";
  EXPECT_THAT(block_message(ports + "[[cases]]\nequations = { y = 1 }\n"),
              HasSubstr("[[cases]] has no 'when'; expected a condition on the parameters"));
  EXPECT_EQ(block_message(ports + "[[cases]]\nwhen = \"x > 0\"\nequations = { y = 1 }\n"),
            "b.toml:12:9: 'when': there is no name 'x'\n  remedy: known: gain, polarity");
  EXPECT_THAT(
      block_message(ports + "[memories]\nm = 0\n[[events]]\nwhen = \"x > 0\"\nset = { m = 1 }\n"
                            "at_start = false\nbefore_start = true\n"),
      HasSubstr("[[events]] comes before the start, and does not come there; expected 'at_start = false' "
                "or 'before_start = true', not both"));
  EXPECT_THAT(block_message("cases = 3\n" + ports),
              HasSubstr("'cases' is a number; expected [[cases]], an array of tables"));
  EXPECT_THAT(block_message(ports + "[start]\ny = 0\n"),
              HasSubstr("b.toml:12:1: [start] names 'y', which is no state and no unknown"));
  EXPECT_THAT(block_message(ports + "\"der(z)\" = 1\n[start]\nz = \"u\"\n"),
              HasSubstr("b.toml:13:6: start of 'z': there is no name 'u'"));
  EXPECT_EQ(block_message(ports + "\"der(z)\" = 1\n[start]\nz = \"x\"\n"), "") << "an input may be the start";
  EXPECT_THAT(block_message(ports + "\"der(z)\" = 1\n[start]\nz = { guess = \"x\", at_rest = true }\n"),
              HasSubstr("start of 'z': there is no name 'x'"));
  EXPECT_THAT(block_message(ports + "\"der(z)\" = 1\n[start]\nz = { gues = 1 }\n"),
              HasSubstr("unknown key 'gues' in start of 'z'\n  remedy: did you mean 'guess'?"));
}

TEST(ParseBlock, RefusesMixedPrimitiveAndComposite) {
  EXPECT_THAT(
      block_message("[outputs]\ny = { wire = \"a\" }\n[blocks]\na = { type = \"t\" }\n[equations]\ny = 1\n"),
      HasSubstr("a block with [blocks] has 'equations' too; expected one or the other"));
  EXPECT_THAT(block_message("[outputs]\ny = { wire = \"a\" }\n[equations]\ny = 1\n"),
              HasSubstr("output 'y' of a block without [blocks] has a 'wire'"));
}

TEST(ParseBlock, ReadsPlacesOfInnerBlocks) {
  const BlockDefinition block = parse_block(
      "format = \"oblique-block/1\"\ntitle = \"b\"\n[outputs]\ny = { wire = \"a\" }\n[blocks]\n"
      "a = { type = \"t\" }\n[layout]\na = [2, 3]\n",
      "b.toml", "b");
  EXPECT_EQ(block.layout, (std::vector<BlockPlace>{{"a", 2, 3, {}}}));
  EXPECT_THAT(block_message(
                  "[outputs]\ny = { wire = \"a\" }\n[blocks]\na = { type = \"t\" }\n[layout]\ny = [1, 2]\n"),
              HasSubstr("[layout] gives a place to 'y', and there is no such block"));
  EXPECT_THAT(block_message("[outputs]\ny = {}\n[equations]\ny = \"1\"\n[layout]\n"),
              HasSubstr("a block without [blocks] has a [layout]\n  remedy: leave it out"));
}

TEST(ParseBlock, RefusesInnerBlocksThatHideANameOfTheComposite) {
  const std::string text =
      "[inputs]\nx = {}\n[parameters]\nk = {}\n[outputs]\ny = { wire = \"k\" }\n[blocks]\n";
  EXPECT_EQ(block_message(text + "k = { type = \"t\" }\n"),
            "b.toml:10:1: 'k' is the name of an inner block and of a parameter too; expected different "
            "names, since a "
            "wire may name either");
  EXPECT_THAT(block_message(text + "x = { type = \"t\" }\n"),
              HasSubstr("'x' is the name of an inner block and of an input too"));
}

TEST(ParseBlock, ReportsAllFindingsInTheOrderOfTheFile) {
  try {
    parse_block(kHead +
                    "sumary = 1\n[outputs]\ntime = {}\ny = {}\n[equations]\ny = \"nix\"\n[parameters]\np = { "
                    "unit = \"q\" }\n",
                "b.toml", "b");
    FAIL() << "no error";
  } catch (const DiagramError& error) {
    std::vector<int> lines;
    for (const text::Diagnostic& d : error.diagnostics()) lines.push_back(d.place.position.line);
    EXPECT_THAT(lines, ElementsAre(3, 5, 5, 8, 10)) << error.what();
  }
}

// What parameters must meet together is said in the block's file, and told with the values that do not.
TEST(BlockDefinition, SaysWhatItsParametersMustMeetTogether) {
  const std::string head = kHead + "valid = [\"low <= high\", \"width < 2*high\"]\n", body = R"toml([outputs]
out = {}
[parameters]
low = { default = 0, unit = "s" }
high = { default = 1, unit = "s" }
width = { default = 0.5 }
[equations]
out = "low"
)toml";
  BlockLibrary library;
  library.add(parse_block(head + body, "b.toml", "b"));
  const auto message = [&](const std::string& settings) {
    try {
      flatten(
          parse_diagram("format = \"oblique-diagram/1\"\n[blocks]\nx = { type = \"b\"" + settings + " }\n",
                        "d.toml"),
          library);
    } catch (const DiagramError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(""), "");
  EXPECT_EQ(message(", low = 1"), "");
  EXPECT_EQ(message(", low = 1.5"),
            "d.toml:3:1: 'x' (b) has low = 1.5 [s] and high = 1 [s]; expected low <= high");
  EXPECT_EQ(message(", width = 2"),
            "d.toml:3:1: 'x' (b) has width = 2 and high = 1 [s]; expected width < 2*high");
  EXPECT_THAT(block_message("valid = \"low < high\"\n" + body), HasSubstr("'valid' is no list of texts"));
  EXPECT_THAT(block_message("valid = [\"low < hihg\"]\n" + body), HasSubstr("did you mean 'high'?"));
  EXPECT_THAT(block_message("valid = [\"low > high\"]\n" + body),
              HasSubstr("the defaults do not meet 'low > high'"));
}

TEST(BlockDefinition, SaysWhatItRequires) {
  const std::string body =
      "[outputs]\nout = {}\n[parameters]\nn = { default = 3 }\n[equations]\nout = \"n\"\n";
  const BlockDefinition block =
      parse_block(kHead + body + "[requires]\nstore = \"n + 1\"\nflip_flop = 2\n", "b.toml", "b");
  ASSERT_EQ(block.needs.size(), 2U);
  EXPECT_EQ(block.needs[0].kind, ElementKind::store);
  EXPECT_EQ(block.needs[1].kind, ElementKind::flip_flop);
  EXPECT_EQ(text::evaluate(block.needs[1].count), 2);
  EXPECT_THAT(
      block_message(body + "[requires]\nstorre = 1\ndiode = \"m\"\n"),
      ::testing::AllOf(HasSubstr("b.toml:10:1: there is no kind of element 'storre'"),
                       HasSubstr("did you mean 'store'?"), HasSubstr("b.toml:11:"), HasSubstr("'m'")));
  EXPECT_THAT(
      block_message("role = \"reference\"\n[outputs]\nout = {}\n[parameters]\nvalue = {}\n[equations]\nout = "
                    "\"value\"\n[requires]\nstore = 1\n"),
      HasSubstr("a block with a role has 'requires'"));
}

}  // namespace
}  // namespace oblique::diagram
