// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/network.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::message_of;
using testing::shipped_blocks_and;

/// What `assemble` says about a block with these tables, wired to an integrator.
std::string refusal_of(const std::string& tables) {
  const diagram::BlockLibrary library =
      shipped_blocks_and("odd", "[inputs]\nin = {}\n[outputs]\nout = {}\n" + tables);
  const std::string text = testing::diagram_text(
      "o = { type = \"odd\", in = \"x\" }\nx = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n");
  return message_of<NetworkError>(
      [&] { assemble(diagram::flatten(diagram::parse_diagram(text, "d.toml"), library)); });
}

double derivative_at(const Compiled& made, double x) {
  Workspace workspace(made.program);
  double derivative = 0;
  EXPECT_TRUE(made.program.derivatives(0, &x, &derivative, workspace));
  return derivative;
}

// Whatever switches is refused where its argument varies, and only there.

TEST(Network, RefusesASignalAsACondition) {
  EXPECT_EQ(refusal_of("[equations]\nout = \"if(sin(in), in, 1)\"\n"),
            "odd.toml:8:7: equation of 'o': 'sin(in)' varies and is no condition; "
            "expected a comparison, such as 'x > 0.5'");
}

TEST(Network, RefusesATableWithoutWholePoints) {
  const std::string message =
      ": table() has an incomplete point; expected table(x, x1, y1, x2, y2, …), or table(x, points) with a "
      "parameter of kind points";
  EXPECT_EQ(refusal_of("[equations]\nout = \"table(in, in)\"\n"), "odd.toml:8:7: equation of 'o'" + message);
  EXPECT_EQ(refusal_of("[parameters]\nk = { default = 2 }\n[equations]\nout = \"table(in, k)\"\n"),
            "odd.toml:10:7: equation of 'o'" + message);
}

TEST(Network, RefusesThatSignalsAreEqual) {
  EXPECT_EQ(refusal_of("[equations]\nout = \"if(in == 1, in, 1)\"\n"),
            "odd.toml:8:7: equation of 'o': a varying signal equals another only at single instants; "
            "expected '<' or '>' of signals; '==' of parameters and memories");
}

TEST(Network, FoldsSwitchingFunctionsOfConstants) {
  const diagram::BlockLibrary library = shipped_blocks_and("odd", R"toml([inputs]
in = {}
[outputs]
out = {}
[parameters]
p = { default = -3 }
[equations]
out = "if(p < 0 and abs(p) == 3, max(p, 2)*in, min(in, 0))"
)toml");
  const Compiled made("o = { type = \"odd\", in = \"x\" }\nx = { type = \"integrator\", in = [\"o\"] }\n", "",
                      library);
  EXPECT_EQ(derivative_at(made, 0.5), 1.0);
}

TEST(Network, RefusesAnEquationThatIsNeverFinite) {
  EXPECT_EQ(refusal_of("[parameters]\np = { default = 0 }\n[equations]\nout = \"1/p\"\n"),
            "d.toml:3:1: 'o' is inf whatever the signals are; expected a finite value\n"
            "  remedy: check the parameters in '1/p'");
  EXPECT_EQ(refusal_of("[parameters]\np = { default = 0 }\n[equations]\nout = \"in + log(p - 1)\"\n"), "")
      << "it depends on a signal: found out when it runs";
}

TEST(Network, RefusesAStartThatIsNotFinite) {
  EXPECT_EQ(
      refusal_of(
          "[parameters]\np = { default = 0 }\n[equations]\n\"der(out)\" = \"in\"\n[start]\nout = \"1/p\"\n"),
      "d.toml:3:1: 'o' would start at inf; expected a finite start value\n"
      "  remedy: give the block another 'initial'");
}

TEST(Network, ReportsAllFindingsTogether) {
  const diagram::BlockLibrary library =
      shipped_blocks_and("odd",
                         "[inputs]\nin = {}\n[outputs]\na = {}\nb = {}\n[equations]\na = \"if(in, 1, 2)\"\nb "
                         "= \"if(in == 1, 1, 2)\"\n");
  const std::string text = testing::diagram_text(
      "o = { type = \"odd\", in = \"x\" }\nx = { type = \"integrator\", in = [\"-x\"] }\n");
  try {
    assemble(diagram::flatten(diagram::parse_diagram(text, "d.toml"), library));
    FAIL() << "nothing was refused";
  } catch (const NetworkError& error) {
    EXPECT_EQ(error.diagnostics().size(), 2U);
  }
}

// Direct feed-through is a matter of paths, and only after flattening.

constexpr const char* kTwoPaths = R"([inputs]
a = {}
b = {}
[outputs]
fast = { wire = "double" }
slow = { wire = "store" }
[blocks]
double = { type = "summer", in = ["2*a"] }
store = { type = "integrator", in = ["b"], initial = 1 }
)";

//        ┌──────────── p ───────────┐
//   ┌─▶ a ──▶ double (direct) ──▶ fast ──┐
//   │┌▶ b ──▶ store (∫) ───────▶ slow ─┐ │
//   ││  └──────────────────────────┘   │ │
//   │└─────────────────────────────────┼─┘
//   └──────────────────────────────────┘
// Block by block p feeds through to itself; path by path the only way round leads through the integrator.

TEST(FeedThrough, OfACompositeIsDecidedPathByPath) {
  const diagram::BlockLibrary library = shipped_blocks_and("two-paths", kTwoPaths);
  const Compiled made("p = { type = \"two-paths\", a = \"p.slow\", b = \"p.fast\" }\n", "", library);
  EXPECT_THAT(made.program.loops(), IsEmpty());
  EXPECT_EQ(derivative_at(made, 0.5), 1.0);  // d slow/dt = fast = 2 slow
}

TEST(FeedThrough, FindsTheLoopThatIsThere) {
  const diagram::BlockLibrary library = shipped_blocks_and("two-paths", kTwoPaths);
  const Compiled made(
      "p = { type = \"two-paths\", a = \"s\", b = \"p.fast\" }\n"
      "s = { type = \"summer\", in = [\"-p.fast\", \"p.slow\"] }\n",
      "", library);
  ASSERT_EQ(made.program.loops().size(), 1U);
  EXPECT_THAT(made.program.loops()[0].members, ElementsAre("p.double", "s"));
  EXPECT_DOUBLE_EQ(derivative_at(made, 0.6), 0.4);  // fast = 2 s, s = slow − fast
}

TEST(FeedThrough, OfTwoOutputsOfOneBlockIsApart) {
  // u = a and v = b: wiring u to b closes no loop, although it leads from the block to itself.
  const diagram::BlockLibrary library = shipped_blocks_and(
      "pair", "[inputs]\na = {}\nb = {}\n[outputs]\nu = {}\nv = {}\n[equations]\nu = \"3*a\"\nv = \"b\"\n");
  const Compiled made(
      "p = { type = \"pair\", a = \"x\", b = \"p.u\" }\nx = { type = \"integrator\", in = [\"p.v\"] }\n", "",
      library);
  EXPECT_THAT(made.program.loops(), IsEmpty());
  EXPECT_EQ(derivative_at(made, 0.5), 1.5);
}

TEST(FeedThrough, EndsAtAServoAmplifierOfFiniteBandwidth) {
  const auto loops = [](const std::string& bandwidth) {
    return Compiled("q = { type = \"servo-amplifier\", in = [\"2*q\", \"-x\"], bandwidth = " + bandwidth +
                    " }\nx = { type = \"integrator\", in = [\"q\"] }\n")
        .program.loops()
        .size();
  };
  EXPECT_EQ(loops("\"10 Hz\""), 0U);
  EXPECT_EQ(loops("inf"), 1U);
}

// So that loops which need it can be solved before anything else is known.
TEST(Network, TakesAnInitialValueFromTheReferenceForANumber) {
  const Compiled made(
      "one = { type = \"constant\" }\n"
      "p = { type = \"potentiometer\", in = \"one\", setting = 0.25 }\n"
      "x = { type = \"integrator\", in = [\"x\"], start = \"p\", initial = 0.125 }\n");
  EXPECT_EQ(made.program.start()[0], 0.375);
  EXPECT_FALSE(made.program.states()[0].start_node.has_value());
}

// Machines whose summers and integrators invert.

TEST(Polarity, TurnsSummersAndIntegratorsOnly) {
  const std::string blocks =
      "s = { type = \"summer\", in = [\"2*x\", \"i\"] }\n"
      "i = { type = \"inverter\", in = \"x\" }\n"
      "x = { type = \"integrator\", in = [\"s\"], initial = 0.25 }\n";
  const Compiled plain(blocks), turned(blocks, "[machine]\ninverting = true\n");
  EXPECT_EQ(derivative_at(plain, 0.5), 0.5);
  EXPECT_EQ(derivative_at(turned, 0.5), 0.5);  // −(−(2x − x)): once by the summer, once by the integrator
  Workspace workspace(turned.program);
  const double x = 0.5;
  std::vector<double> signals(3);
  ASSERT_TRUE(turned.program.signals(0, &x, signals.data(), workspace));
  EXPECT_EQ(signals[turned.signal("s")], -0.5);
  EXPECT_EQ(signals[turned.signal("i")], -0.5);
  EXPECT_EQ(turned.program.start()[0], 0.25);
}

TEST(Polarity, TurnsALoneIntegrator) {
  const Compiled made("x = { type = \"integrator\", in = [\"3*x\"] }\n", "[machine]\ninverting = true\n");
  EXPECT_EQ(derivative_at(made, 1), -3.0);
}

}  // namespace
}  // namespace oblique::network
