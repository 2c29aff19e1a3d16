// SPDX-License-Identifier: MIT
#include <oblique/diagram/flatten.h>

#include <algorithm>
#include <limits>

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
using testing::small_library;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An input as text: "2*a - 1*b + 0.5".
std::string input_text(const FlatDiagram& flat, const FlatInput& input) {
  std::string text;
  const auto number = [](double x) {
    std::string digits = std::to_string(x);
    digits.erase(digits.find_last_not_of('0') + 1);
    return digits.back() == '.' ? digits.substr(0, digits.size() - 1) : digits;
  };
  for (const FlatTerm& term : input.terms) {
    text += (text.empty() ? "" : " + ") + number(term.weight) + "*" + flat.signal_name(term.signal);
  }
  if (input.constant != 0) text += (text.empty() ? "" : " + ") + number(input.constant);
  return text;
}

std::vector<std::string> paths(const FlatDiagram& flat) {
  std::vector<std::string> names;
  for (const FlatBlock& block : flat.blocks) names.push_back(block.path);
  return names;
}

const FlatBlock& block_at(const FlatDiagram& flat, const std::string& path) {
  for (const FlatBlock& block : flat.blocks) {
    if (block.path == path) return block;
  }
  throw std::out_of_range(path);
}

/// The inputs of a block as text, in the order of its definition.
std::vector<std::string> inputs_of(const FlatDiagram& flat, const std::string& path) {
  std::vector<std::string> texts;
  for (const FlatInput& input : block_at(flat, path).inputs) texts.push_back(input_text(flat, input));
  return texts;
}

std::vector<std::string> outputs_of(const FlatDiagram& flat) {
  std::vector<std::string> texts;
  for (const FlatOutput& output : flat.outputs)
    texts.push_back(output.name + " = " + flat.signal_name(output.signal));
  return texts;
}

class Flatten : public ::testing::Test {
 protected:
  FlatDiagram flat(const std::string& blocks, const std::string& rest = "",
                   const std::vector<ParameterOverride>& overrides = {}) const {
    return flatten(parse_diagram(diagram_text(blocks, rest), "d.toml"), library_, overrides);
  }

  void add(const std::string& name, const std::string& text) {
    library_.add(parse_block("format = \"oblique-block/1\"\ntitle = \"Box\"\n" + text, name + ".toml", name));
  }

  BlockLibrary library_ = small_library();
};

//      ┌───────────────┐
//  a ──┴─►[×] p ──►[+] s ──► (back to s with weight −2)
TEST_F(Flatten, ResolvesWiresAndWeights) {
  const FlatDiagram d =
      flat(R"toml(s = { type = "adder", in = ["a", "-2*s", "3/2*p", "-p/4", "-(1 - 2^2)*pi/pi*a"] }
a = { type = "reference", value = 2.5 }
p = { type = "product", in = ["a", "-a"] }
)toml");
  EXPECT_THAT(paths(d), ElementsAre("s", "a", "p"));
  EXPECT_THAT(inputs_of(d, "s"), ElementsAre("1*a + -2*s + 1.5*p + -0.25*p + 3*a"));
  EXPECT_THAT(inputs_of(d, "p"), ElementsAre("1*a", "-1*a"));
  EXPECT_THAT(inputs_of(d, "a"), ElementsAre());
  EXPECT_EQ(block_at(d, "a").parameters, std::vector{2.5});
  EXPECT_EQ(block_at(d, "a").definition, library_.find("reference"));
  EXPECT_EQ(block_at(d, "a").place, (text::Place{"d.toml", {4, 1}}));
  EXPECT_EQ(d.file, "d.toml");
}

TEST_F(Flatten, InputsMayBeListedOrNamed) {
  const FlatDiagram d = flat(R"toml(a = { type = "reference" }
r = { type = "resolver", in = ["a", "r.y"] }
q = { type = "resolver", radius = "2*r.x" }
f = { type = "resolver", in = "a" }
c = { type = "cosine-of", in = "-r.x" }
g = { type = "cosine-of", in = ["c.out"] }
)toml");
  EXPECT_THAT(inputs_of(d, "r"), ElementsAre("1*a", "1*r.y"));
  EXPECT_THAT(inputs_of(d, "q"), ElementsAre("0.5", "2*r.x"));
  EXPECT_THAT(inputs_of(d, "f"), ElementsAre("1*a", "1"));
  EXPECT_THAT(inputs_of(d, "c"), ElementsAre("-1*r.x"));
  EXPECT_THAT(inputs_of(d, "g"), ElementsAre("1*c"));
}

TEST_F(Flatten, ConvertsParametersAndChoosesTheBehaviour) {
  const FlatDiagram d = flat(R"toml(a = { type = "servo", in = "a", bandwidth = "2 kHz", gain = "10^3/2" }
b = { type = "servo", in = "a", gain = inf, bandwidth = inf }
c = { type = "servo", in = "a", bandwidth = "inf", initial = -1 }
)toml");
  EXPECT_THAT(block_at(d, "a").parameters, ElementsAre(500, 2000, 0.5, 0));
  EXPECT_THAT(block_at(d, "b").parameters, ElementsAre(kInfinity, kInfinity, 0.5, 0));
  EXPECT_THAT(block_at(d, "c").parameters, ElementsAre(1e6, kInfinity, 0.5, -1));
  const std::vector<Behaviour>& behaviours = library_.find("servo")->behaviours;
  EXPECT_EQ(block_at(d, "a").behaviour, &behaviours[2]);  // the default
  EXPECT_EQ(block_at(d, "b").behaviour, &behaviours[0]);  // the first case that holds
  EXPECT_EQ(block_at(d, "c").behaviour, &behaviours[1]);
}

TEST_F(Flatten, BehavioursMayHangOnThePolarity) {
  add("sided",
      "[outputs]\ny = {}\n[equations]\ny = 1\n[[cases]]\nwhen = \"polarity < 0\"\nequations = { y = -1 }\n");
  const std::string block = "a = { type = \"sided\" }\n";
  EXPECT_EQ(flat(block).blocks[0].behaviour, &library_.find("sided")->behaviours[1]);
  EXPECT_EQ(flat(block, "[machine]\ninverting = true\n").blocks[0].behaviour,
            &library_.find("sided")->behaviours[0]);
}

//              ┌──────────────── outer ────────────────────┐
//   u ──2·──►v─┤  ┌────────── inner ──────────┐            │
//              └─►│ x ──k·──► [+] s ──3·──► [+] t ─► z │──► [+] w ─► y
//                 └────────────────────────────┘
TEST_F(Flatten, ExpandsNestedCompositesWithWeightsAndParameters) {
  add("inner", R"toml([inputs]
x = { sum = true }
b = { default = 0.25 }
[outputs]
z = { wire = "t" }
[parameters]
k = { default = 2 }
band = { default = "1 kHz", unit = "Hz", above = 0 }
[blocks]
s = { type = "adder", in = ["k*x", "-b"] }
t = { type = "servo", in = "3*s", gain = "k^2", bandwidth = "band", initial = "1/k" }
)toml");
  add("outer", R"toml([inputs]
v = {}
[outputs]
y = { wire = "w" }
deep = { wire = "i.s" }
[parameters]
m = { default = 5 }
[blocks]
w = { type = "adder", in = ["-i", "2*v"] }
i = { type = "inner", x = ["m/2*v", "w"], k = "m + 1", band = "2 kHz" }
)toml");
  const FlatDiagram d = flat(R"toml(o = { type = "outer", in = "2*u", m = 7 }
u = { type = "reference" }
p = { type = "product", in = ["-o.y", "o.deep"] }
q = { type = "product", in = ["o.i.t", "o.i"] }
n = { type = "inner", x = "-u", b = "4*o.i.s.out" }
)toml");
  EXPECT_THAT(paths(d), ElementsAre("o.w", "o.i.s", "o.i.t", "u", "p", "q", "n.s", "n.t"));
  EXPECT_THAT(inputs_of(d, "o.w"), ElementsAre("-1*o.i.t + 4*u"));
  // k = 8: 8·(7/2·2u + w) − 0.25
  EXPECT_THAT(inputs_of(d, "o.i.s"), ElementsAre("56*u + 8*o.w + -0.25"));
  EXPECT_THAT(inputs_of(d, "o.i.t"), ElementsAre("3*o.i.s"));
  EXPECT_THAT(block_at(d, "o.i.t").parameters, ElementsAre(64, 2000, 0.5, 0.125));
  EXPECT_THAT(inputs_of(d, "p"), ElementsAre("-1*o.w", "1*o.i.s"));
  EXPECT_THAT(inputs_of(d, "q"), ElementsAre("1*o.i.t", "1*o.i.t"));
  EXPECT_THAT(inputs_of(d, "n.s"), ElementsAre("-2*u + -4*o.i.s"));
  EXPECT_THAT(block_at(d, "n.t").parameters, ElementsAre(4, 1000, 0.5, 0.5));
  EXPECT_EQ(block_at(d, "n.t").place, (text::Place{"d.toml", {7, 1}}));  // where "n" stands
}

/// A weighted sum may reach an inner input that takes one signal from the composite's point of view.
TEST_F(Flatten, CompositesCarrySumsToAnyInput) {
  add("cosine-of-sum",
      "[inputs]\nx = { sum = true }\n[outputs]\ny = { wire = \"c\" }\n[blocks]\n"
      "c = { type = \"cosine-of\", in = \"-x\" }\n");
  const FlatDiagram d =
      flat("a = { type = \"reference\" }\nb = { type = \"cosine-of-sum\", in = [\"a\", \"2*b\"] }\n");
  EXPECT_THAT(inputs_of(d, "b.c"), ElementsAre("-1*a + -2*b.c"));
}

/// The convention of the machine holds for the blocks of the file that states it, and for no other.
TEST_F(Flatten, PolarityIsThatOfTheFile) {
  const std::string body =
      "[inputs]\nx = {}\n[outputs]\ny = { wire = \"s\" }\n[blocks]\ns = { type = \"adder\", in = \"x\" }\n";
  add("plain", body);
  add("turned", body + "[machine]\ninverting = true\n");
  const std::string blocks =
      "a = { type = \"adder\", in = \"a\" }\nb = { type = \"plain\", x = \"a\" }\nc = { type = \"turned\", x "
      "= \"a\" }\n";
  const FlatDiagram direct = flat(blocks);
  EXPECT_EQ(block_at(direct, "a").polarity, 1);
  EXPECT_EQ(block_at(direct, "b.s").polarity, 1);
  EXPECT_EQ(block_at(direct, "c.s").polarity, -1);
  const FlatDiagram inverting = flat(blocks, "[machine]\ninverting = true\n");
  EXPECT_EQ(block_at(inverting, "a").polarity, -1);
  EXPECT_EQ(block_at(inverting, "b.s").polarity, 1);
  EXPECT_EQ(block_at(inverting, "c.s").polarity, -1);
}

TEST_F(Flatten, SelectsOutputs) {
  add("pair",
      "[outputs]\nleft = { wire = \"r.x\" }\nright = { wire = \"a\" }\n[blocks]\n"
      "a = { type = \"reference\" }\nr = { type = \"resolver\" }\n");
  const std::string blocks =
      "a = { type = \"reference\" }\nr = { type = \"resolver\" }\nc = { type = \"pair\" }\n";
  EXPECT_THAT(outputs_of(flat(blocks)),
              ElementsAre("a = a", "r.x = r.x", "r.y = r.y", "c.left = c.r.x", "c.right = c.a"));
  const FlatDiagram d = flat(blocks, R"toml([outputs]
"C.x" = { signal = "c.left", scale = -2, unit = "m" }
inside = "c.r.y"
one = "a.out"
)toml");
  EXPECT_THAT(outputs_of(d), ElementsAre("C.x = c.r.x", "inside = c.r.y", "one = a"));
  EXPECT_EQ(d.outputs[0].scale, -2);
  EXPECT_EQ(d.outputs[0].unit, "m");
  EXPECT_EQ(d.outputs[1].unit, "machine unit");
}

class Overrides : public Flatten {
 protected:
  Overrides() {
    add("box",
        "[inputs]\nx = {}\n[outputs]\ny = { wire = \"s\" }\n[parameters]\nk = { default = 2, at_most = 9 }\n"
        "[blocks]\ns = { type = \"servo\", in = \"k*x\", gain = \"k\" }\n");
    add("crate",
        "[inputs]\nx = {}\n[outputs]\ny = { wire = \"b\" }\n[parameters]\nm = { default = 3 }\n"
        "[blocks]\nb = { type = \"box\", x = \"x\", k = \"m\" }\n");
  }

  std::string message(const std::string& path, const std::string& value) const {
    return message_of([&] { flat(kBlocks, "", {{path, value}}); });
  }

  const std::string kBlocks = "a = { type = \"reference\" }\nC = { type = \"crate\", x = \"a\" }\n";
};

TEST_F(Overrides, ReplaceParametersAtAnyDepth) {
  EXPECT_EQ(flat(kBlocks, "", {{"a.value", "3/2"}}).blocks[0].parameters[0], 1.5);

  const FlatDiagram deep = flat(kBlocks, "", {{"C.b.s.bandwidth", "1 kHz"}});
  EXPECT_THAT(block_at(deep, "C.b.s").parameters, ElementsAre(3, 1000, 0.5, 0));

  // A parameter of a composite changes what follows from it.
  const FlatDiagram outer = flat(kBlocks, "", {{"C.m", "4"}});
  EXPECT_THAT(block_at(outer, "C.b.s").parameters, ElementsAre(4, 10, 0.5, 0));
  EXPECT_THAT(inputs_of(outer, "C.b.s"), ElementsAre("4*a"));

  // The replaced one wins over what follows from the composite around it; of two, the last.
  const FlatDiagram both =
      flat(kBlocks, "", {{"C.m", "4"}, {"C.b.k", "6"}, {"C.b.k", "5"}, {"C.b.s.gain", "inf"}});
  EXPECT_THAT(block_at(both, "C.b.s").parameters, ElementsAre(kInfinity, 10, 0.5, 0));
  EXPECT_THAT(inputs_of(both, "C.b.s"), ElementsAre("5*a"));
  EXPECT_EQ(block_at(both, "C.b.s").behaviour, &library_.find("servo")->behaviours[0]);
}

TEST_F(Overrides, SayWhatIsWrong) {
  EXPECT_EQ(message("gain", "1"),
            "set gain=1: 'gain' names no parameter; expected BLOCK.PARAMETER=VALUE or "
            "BLOCK.INPUT[NUMBER]=VALUE");
  EXPECT_EQ(message("x.gain", "1"), "set x.gain=1: there is no block 'x'\n  remedy: known: a, C");
  EXPECT_EQ(message("a", "1"), "set a=1: 'a' is a block, not one of its values; expected a.value");
  EXPECT_EQ(message("C.b", "1"),
            "set C.b=1: 'C.b' is a block, not one of its values; expected one of C.b.k, C.b.x[1]");
  EXPECT_EQ(message("C.bx.k", "1"), "set C.bx.k=1: there is no block 'C.bx'\n  remedy: known: b");
  EXPECT_EQ(message("a.b.k", "1"), "set a.b.k=1: 'a' (reference) has no inner blocks");
  EXPECT_EQ(message("a.valeu", "1"),
            "set a.valeu=1: 'valeu' of block type 'reference' is not a parameter\n  remedy: did you mean "
            "'value'?");
  EXPECT_EQ(
      message("C.b.s.gian", "1"),
      "set C.b.s.gian=1: 'gian' of block type 'servo' is not a parameter\n  remedy: did you mean 'gain'?");
  EXPECT_EQ(message("C.x", "1"),
            "set C.x=1: 'x' of block type 'crate' is an input\n  remedy: only parameters can be set, and "
            "weights of "
            "inputs: 'C.x[1]' is that of the first wire");
  EXPECT_EQ(message("C.b.k", "10"), "set C.b.k=10: the value is 10; expected a number at most 9");
  EXPECT_EQ(message("C.b.s.bandwidth", "3 s"),
            "set C.b.s.bandwidth=3 s: 's' is the wrong unit here; expected a quantity in 'Hz'\n"
            "  remedy: give it in 'Hz', or as a number without a unit");
  EXPECT_EQ(message("a.value", "m"),
            "set a.value=m: 'm' is not a known constant; expected a number, 'pi' or 'inf'");
  EXPECT_EQ(message("a..value", "1"), "set a..value=1: 'a' (reference) has no inner blocks");
}

//  a ──┬──► s (weights 1, −2 of itself, 1.5 of p, 3 of a again) ;   p = a·(−a) ;   C = crate of a
class Weights : public Overrides {
 protected:
  std::vector<std::string> inputs(const std::string& block, const std::vector<ParameterOverride>& overrides) {
    return inputs_of(flat(kWired, "", overrides), block);
  }
  std::string weight_message(const std::string& path, const std::string& value) const {
    return message_of([&] { flat(kWired, "", {{path, value}}); });
  }

  const std::string kWired = R"toml(a = { type = "reference" }
r = { type = "resolver", in = ["a", "-a"] }
s = { type = "adder", in = ["a", "-2*s", "3/2*r.y", "3*a"] }
p = { type = "product", in = ["a", "-r.x"] }
C = { type = "crate", x = "a" }
empty = { type = "adder", in = [] }
)toml";
};

TEST_F(Weights, AreSetByNumberOrBySignal) {
  EXPECT_THAT(inputs("s", {}), ElementsAre("1*a + -2*s + 1.5*r.y + 3*a"));
  EXPECT_THAT(inputs("s", {{"s.in[2]", "-1/4"}}), ElementsAre("1*a + -0.25*s + 1.5*r.y + 3*a"));
  EXPECT_THAT(inputs("s", {{"s.in[s]", "7"}}), ElementsAre("1*a + 7*s + 1.5*r.y + 3*a"));
  EXPECT_THAT(inputs("s", {{"s.in[r.y]", "0"}}), ElementsAre("1*a + -2*s + 0*r.y + 3*a"));
  EXPECT_THAT(inputs("s", {{"s.in[4]", "2"}, {"s.in[1]", "5"}, {"s.in[4]", "6"}}),
              ElementsAre("5*a + -2*s + 1.5*r.y + 6*a"))
      << "of two, the last";
}

TEST_F(Weights, OfSeveralInputsAreThoseOfTheListOrOfTheInput) {
  EXPECT_THAT(inputs("p", {{"p.in[2]", "3"}}), ElementsAre("1*a", "3*r.x"));
  EXPECT_THAT(inputs("p", {{"p.y[1]", "3"}}), ElementsAre("1*a", "3*r.x"));
  EXPECT_THAT(inputs("p", {{"p.in[r.x]", "3"}}), ElementsAre("1*a", "3*r.x"));
}

TEST_F(Weights, InsideCompositesAreThoseOfOneBlock) {
  // The inner weight k = 2 follows from the composite; a replaced one does not.
  EXPECT_THAT(inputs("C.b.s", {}), ElementsAre("3*a"));
  EXPECT_THAT(inputs("C.b.s", {{"C.b.s.in[1]", "0.5"}, {"C.m", "4"}}), ElementsAre("0.5*a"));
  EXPECT_THAT(inputs("C.b.s", {{"C.b.s.in[x]", "0.5"}}), ElementsAre("0.5*a"));
  EXPECT_THAT(inputs("C.b.s", {{"C.x[1]", "-1"}}), ElementsAre("-3*a")) << "into the composite";
}

TEST_F(Weights, SayWhatIsWrong) {
  EXPECT_EQ(weight_message("s.in[5]", "1"),
            "set s.in[5]=1: input 's.in' has no wire 5; expected a number from 1 to 4");
  EXPECT_EQ(weight_message("s.in[0]", "1"),
            "set s.in[0]=1: input 's.in' has no wire 0; expected a number from 1 to 4");
  EXPECT_EQ(weight_message("s.in[99999999999999999999]", "1"),
            "set s.in[99999999999999999999]=1: input 's.in' has no wire 99999999999999999999; expected a "
            "number from 1 to 4");
  EXPECT_EQ(weight_message("C.x[2]", "1"), "set C.x[2]=1: input 'C.x' has no wire 2; expected 1");
  EXPECT_EQ(weight_message("s.in[r.z]", "1"),
            "set s.in[r.z]=1: no wire of input 's.in' comes from 'r.z'\n  remedy: did you mean 'r.y'?");
  EXPECT_EQ(weight_message("s.in[a]", "1"),
            "set s.in[a]=1: 2 wires of input 's.in' come from 'a'; expected one of [1], [4]");
  EXPECT_EQ(weight_message("s.in[]", "1"),
            "set s.in[]=1: 's.in[]' names no wire; expected a number or a signal in brackets, such as "
            "'s.in[1]'");
  EXPECT_EQ(weight_message("s.in[1", "1"),
            "set s.in[1=1: 's.in[1' names no wire; expected a number or a signal in brackets, such as "
            "'s.in[1]'");
  EXPECT_EQ(weight_message("s.inn[1]", "1"),
            "set s.inn[1]=1: 'inn' of block type 'adder' is not an input\n  remedy: did you mean 'in'?");
  EXPECT_EQ(weight_message("a.value[1]", "1"),
            "set a.value[1]=1: 'value' of block type 'reference' is a parameter, which has no weights\n"
            "  remedy: 'a.value' sets it");
  EXPECT_EQ(weight_message("empty.in[1]", "1"),
            "set empty.in[1]=1: nothing is wired to input 'empty.in'; expected an input with a wire");
  EXPECT_EQ(weight_message("q.in[1]", "1"),
            "set q.in[1]=1: there is no block 'q'\n  remedy: known: a, r, s, "
            "p, C, empty");
  EXPECT_EQ(weight_message("in[1]", "1"),
            "set in[1]=1: 'in[1]' names no parameter; expected BLOCK.PARAMETER=VALUE or "
            "BLOCK.INPUT[NUMBER]=VALUE");
  EXPECT_EQ(weight_message("s.in[1]", "inf"), "set s.in[1]=inf: the weight is inf; expected a finite number");
  EXPECT_THAT(weight_message("s.in[1]", "2 m"), HasSubstr("set s.in[1]=2 m: 'm' is the wrong unit here"));
}

/// A chain of blocks, each of which is fed by itself and the one before.
Diagram chain(int length) {
  Diagram diagram;
  for (int i = 0; i < length; ++i) {
    const std::string name = "b" + std::to_string(i);
    const std::string before = "b" + std::to_string(i == 0 ? 0 : i - 1);
    diagram.blocks.push_back({name, "adder", "", "", {wire_setting("in", {{2, before}, {-1, name}})}, {}});
  }
  return diagram;
}

/// How long it takes is measured in tests/bench.
TEST_F(Flatten, TakesThousandsOfBlocks) {
  const Diagram large = chain(8'000);
  const FlatDiagram d = flatten(large, library_);
  EXPECT_EQ(d.blocks.size(), 8'000U);
  EXPECT_EQ(input_text(d, d.blocks.back().inputs[0]), "2*b7998 + -1*b7999");
}

// The column of time is no name for an output: said where it is named, or at the block that has it.
TEST(FlatOutputs, AreNotCalledAsTheColumnOfTime) {
  const BlockLibrary library = BlockLibrary::shipped();
  const auto message = [&](const std::string& outputs) {
    return message_of([&] {
      flatten(parse_diagram("format = \"oblique-diagram/1\"\n[blocks]\nx = { type = \"constant\" }\n"
                            "t = { type = \"constant\" }\n" +
                                outputs,
                            "d.toml"),
              library);
    });
  };
  EXPECT_EQ(message(""),
            "d.toml:4:1: an output is called 't', which is the column of time; expected another name\n"
            "  remedy: name it in [outputs]");
  EXPECT_EQ(message("[outputs]\nt = \"x\"\n"),
            "d.toml:6:5: an output is called 't', which is the column of time; expected another name");
}

}  // namespace
}  // namespace oblique::diagram
