// SPDX-License-Identifier: MIT
// A diagram in scaled signals gives what it gave, and stays within the machine unit.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/diagram/rescale.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::shipped_blocks;

Run watched(const network::Program& program, const diagram::FlatDiagram& flat, double until) {
  RunOptions options;
  options.until = until;
  options.tolerance = 1e-10;
  options.samples = 201;
  options.watch_overloads = true;
  return run(program, flat, options);
}

struct Rescaled {
  std::string text;
  double difference = 0;  ///< of an output, relative to its size
  std::vector<OverloadRecord> overloads;
};

Rescaled rescaled(const Compiled& made, double until,
                  const diagram::BlockLibrary& library = shipped_blocks()) {
  const diagram::FlatDiagram free = diagram::without_saturation(made.flat);  // how far the signals want to go
  const auto before = watched(network::Program(network::assemble(free)), free, until);
  std::vector<double> peaks;
  for (const Peak& peak : before.peaks) peaks.push_back(peak.value);
  const diagram::Diagram scaled =
      diagram::rescale(made.diagram, made.flat, diagram::propose_scaling(made.flat, peaks), library);
  Rescaled result;
  result.text = diagram::write_diagram(scaled);
  // By way of the file, as a user has it.
  const diagram::FlatDiagram flat = diagram::flatten(diagram::parse_diagram(result.text, "s.toml"), library);
  const auto after = watched(network::Program(network::assemble(flat)), flat, until);
  result.overloads = after.overloads;
  for (std::size_t c = 1; c < before.trajectory.columns().size(); ++c) {
    EXPECT_EQ(before.trajectory.columns()[c].name, after.trajectory.columns()[c].name);
    double size = 0, difference = 0;
    for (std::size_t r = 0; r < before.trajectory.rows(); ++r) {
      size = std::max(size, std::abs(before.trajectory.at(r, c)));
      difference = std::max(difference, std::abs(before.trajectory.at(r, c) - after.trajectory.at(r, c)));
    }
    result.difference = std::max(result.difference, difference / size);
  }
  return result;
}

// Blocks keep their names and places; where a composite had a place, its parts have none.
TEST(Rescale, KeepsPlacesOfBlocks) {
  const auto layout_after = [](const std::string& blocks, const std::vector<diagram::BlockPlace>& layout) {
    diagram::Diagram diagram = diagram::parse_diagram(
        "format = \"oblique-diagram/1\"\n[blocks]\none = { type = \"constant\" }\n" + blocks, "d");
    diagram.layout = layout;
    const diagram::FlatDiagram flat = diagram::flatten(diagram, shipped_blocks());
    std::size_t signals = 0;
    for (const diagram::FlatBlock& block : flat.blocks) signals += block.definition->outputs.size();
    const std::vector<double> peaks(signals, 0.5);
    return diagram::rescale(diagram, flat, diagram::propose_scaling(flat, peaks), shipped_blocks()).layout;
  };
  const std::vector<diagram::BlockPlace> sum{{"a", 3, 4, {}}};
  EXPECT_EQ(layout_after("a = { type = \"summer\", in = \"one\" }\n", sum), sum);
  EXPECT_EQ(layout_after("a = { type = \"divider\", numerator = \"one\", denominator = \"one\" }\n", sum),
            std::vector<diagram::BlockPlace>{});
}

// A solver's tolerance of 1e-10 a step over some thousand steps.
constexpr double kSame = 1e-7;

TEST(Rescale, AnOscillatorOfManyUnits) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["v"], initial = 30, label = "displacement" }
v = { type = "integrator", in = ["-4*x", "-0.1*v"] }
)toml");
  const Rescaled result = rescaled(made, 5);
  EXPECT_LT(result.difference, kSame);
  EXPECT_TRUE(result.overloads.empty());
  // 30 → 0.6 at a scale of 1/50, v reaches nearly 60 and takes 1/100.
  EXPECT_THAT(result.text, HasSubstr("in = \"2*v\", initial = 0.6 }"));
  EXPECT_THAT(result.text, HasSubstr("in = [\"-2*x\", \"-0.1*v\"] }"));
  EXPECT_THAT(result.text, HasSubstr("label = \"displacement\""));
  EXPECT_THAT(result.text, HasSubstr("v = { signal = \"v\", scale = 100"));
}

TEST(Rescale, ProductsPutTheirFactorIntoTheWeightsTheyFeed) {
  // Lorenz, early: products of 20 and 45.
  const Compiled made(R"toml(x  = { type = "integrator", in = ["-10*x", "10*y"], initial = 1 }
y  = { type = "integrator", in = ["-xz", "28*x", "-y"], initial = 1 }
z  = { type = "integrator", in = ["xy", "-8/3*z"], initial = 20 }
xz = { type = "multiplier", in = ["x", "z"] }
xy = { type = "multiplier", in = ["x", "y"] }
)toml",
                      "[outputs]\nspeed = { signal = \"y\", scale = 2, unit = \"m/s\" }\nx = \"x\"\n");
  const Rescaled result = rescaled(made, 2);
  EXPECT_LT(result.difference, 1e-5);  // chaotic: errors have grown by e^(9 · 1)
  EXPECT_TRUE(result.overloads.empty());
  EXPECT_THAT(result.text, HasSubstr("xz = { type = \"multiplier\", x = \"x\", y = \"z\" }"));
}

TEST(Rescale, CompositesOnInvertingMachinesAreLaidOut) {
  const Compiled made(R"toml(three = { type = "constant", value = 3 }
k     = { type = "crank-generator", rate = 2 }
m     = { type = "multiplier", in = ["three", "k.cos"] }
p     = { type = "summer", in = ["-2*three", "-m"] }
r     = { type = "square-root", in = "p" }
d     = { type = "divider", numerator = "m", denominator = "three" }
v     = { type = "vector-direction", x = "2*m", y = "p" }
)toml",
                      "[machine]\ninverting = true\n");
  const Rescaled result = rescaled(made, 5);
  EXPECT_LT(result.difference, 1e-6);  // through gains of 1e6
  EXPECT_TRUE(result.overloads.empty());
  EXPECT_THAT(result.text, HasSubstr("r_root"));
  EXPECT_THAT(result.text, HasSubstr("reference"));  // the default speed of the crank
}

// The speed of a crank that is open is 1: of the user's blocks that come first in the alphabet the one cannot
// give that, and the other only in a case that is not the usual one.
TEST(Rescale, TakesForReferenceWhatGivesOneMachineUnit) {
  for (const std::string block :
       {"[parameters]\nlevel = { default = 2, at_least = 1.5 }\n[equations]\nout = \"level\"\n",
        "[parameters]\nlevel = { default = 0 }\n[[cases]]\nwhen = \"level > 5\"\n"
        "equations = { out = \"level\" }\n[equations]\nout = \"0*level\"\n"}) {
    const diagram::BlockLibrary library =
        testing::shipped_blocks_and("a-level", "[outputs]\nout = {}\n" + block);
    const Compiled made(
        "k = { type = \"crank-generator\" }\nx = { type = \"integrator\", in = [\"k.cos\"] }\n", "", library);
    const Rescaled result = rescaled(made, 3, library);
    EXPECT_LT(result.difference, 1e-7) << block;
    EXPECT_THAT(result.text, ::testing::Not(HasSubstr("a-level"))) << block;
  }
}

// What the file leaves open, the machine decides anew: the sum that feeds a multiplier and `exact` must not
// become real.
TEST(Rescale, AmplifiersOfAMachineStayAsTheyAre) {
  const diagram::BlockLibrary library =
      testing::shipped_blocks_and("squared-sum",
                                  "summary = \"x\"\n[inputs]\nin = { sum = true, doc = \"x\" "
                                  "}\n[outputs]\nout = { wire = \"m\", doc = \"x\" }\n"
                                  "[blocks]\nm = { type = \"multiplier\", x = \"in\", y = \"in\" }\n");
  const Compiled made(R"toml(u = { type = "constant", value = 3 }
real  = { type = "inverter", in = "u" }
exact = { type = "inverter", in = "u", gain = inf }
p     = { type = "squared-sum", in = ["u", "-2*exact"] }
)toml",
                      "[machine]\nprofile = \"ec-1\"\n", library);
  const Rescaled result = rescaled(made, 1, library);
  EXPECT_LT(result.difference, kSame);
  EXPECT_THAT(result.text, HasSubstr("real  = { type = \"inverter\", in = \"u\" }"));
  EXPECT_THAT(result.text, HasSubstr("exact = { type = \"inverter\", in = \"u\", gain = inf }"));
}

TEST(Rescale, BlocksThatCannotBeScaledKeepTheirSignals) {
  const Compiled made(R"toml(one = { type = "constant", value = 1 }
phi = { type = "integrator", in = ["one"] }
c   = { type = "cosine", in = "phi" }
s   = { type = "summer", in = ["5*c"] }
)toml");
  const Rescaled result = rescaled(made, 6);
  EXPECT_LT(result.difference, kSame);
  EXPECT_TRUE(result.overloads.empty());
  EXPECT_THAT(result.text, HasSubstr("in = \"10*phi\""));
  EXPECT_THAT(result.text, HasSubstr("in = \"c\""));
}

TEST(Rescale, ANonLinearBlockWithItsOwnGainIsFedLess) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and(
      "root",
      "summary = \"Twice the root.\"\n[inputs]\nx = { doc = \"x\" }\n[outputs]\nout = { doc = \"out\" }\n"
      "[equations]\nout = \"2*sqrt(x)\"\n");
  const Compiled made(R"toml(u = { type = "constant", value = 9 }
m = { type = "multiplier", in = ["u", "u"] }
g = { type = "root", x = "m" }
n = { type = "multiplier", in = ["g", "m"] }
i = { type = "integrator", in = ["n"] }
)toml",
                      "", library);
  const Rescaled result = rescaled(made, 1, library);
  EXPECT_LT(result.difference, kSame);
  EXPECT_TRUE(result.overloads.empty());
}

// A function keeps its points, a formula its text: neither has a scale.
TEST(Rescale, FunctionsStayWhatTheyAre) {
  const Compiled made(R"toml(u = { type = "time-function", formula = "2 + sin(3*time)", scale = 2 }
x = { type = "integrator", in = ["u"] }
f = { type = "function-generator", in = "x", points = [[-1, 0.5], [2, 0], [9, 0.25]] }
)toml");
  const Rescaled result = rescaled(made, 2);
  EXPECT_LT(result.difference, kSame);
  EXPECT_TRUE(result.overloads.empty());
  EXPECT_THAT(result.text, HasSubstr("formula = \"2 + sin(3*time)\", scale = 0.2 }"));
  EXPECT_THAT(result.text, HasSubstr("points = [[-1, 0.5], [2, 0], [9, 0.25]]"));
}

TEST(Rescale, ARingOfProductsTakesThePeaks) {
  const Compiled made(R"toml(u = { type = "constant", value = 1 }
a = { type = "multiplier", in = ["u", "b"] }
b = { type = "multiplier", in = ["u", "a"] }
)toml");
  const diagram::AmplitudeScaling scaling = diagram::propose_scaling(made.flat, std::vector<double>{1, 4, 4});
  // b is fed from a, which is fed from b: by its peak, 1/5.
  EXPECT_EQ(scaling[1].outputs[0], 0.2);
  EXPECT_EQ(scaling[2].outputs[0], 0.2);
}

// What an inverting block gives with inverted inputs is the same, 0 included: a dead zone is laid out.
TEST(Rescale, AnInvertingDeadZoneStandsOutsideItsComposite) {
  diagram::BlockLibrary library = testing::shipped_blocks_and(
      "dead-zone",
      "summary = \"x\"\n[inputs]\nin = { doc = \"x\" }\n[outputs]\nout = { doc = \"x\" }\n"
      "[equations]\nout = \"polarity*(max(in - 2, 0) + min(in + 2, 0))\"\n");
  library.add(diagram::parse_block(
      "format = \"oblique-block/1\"\ntitle = \"c\"\nsummary = \"c\"\n[inputs]\nin = { doc = \"x\" }\n"
      "[outputs]\nout = { wire = \"s\", doc = \"x\" }\n[blocks]\n"
      "s = { type = \"dead-zone\", in = [\"in\"] }\n",
      "c.toml", "c"));
  const Compiled made("u = { type = \"constant\", value = 0.5 }\nc = { type = \"c\", in = \"u\" }\n",
                      "[machine]\ninverting = true\n", library);
  EXPECT_EQ(testing::message_of<diagram::DiagramError>([&] {
              diagram::rescale(made.diagram, made.flat,
                               diagram::propose_scaling(made.flat, std::vector<double>{1, 1}), library);
            }),
            "");
}

TEST(Rescale, SaysWhatCannotStandOutsideItsComposite) {
  diagram::BlockLibrary library = testing::shipped_blocks_and(
      "shifted",
      "summary = \"x\"\n[inputs]\nin = { sum = true, doc = \"x\" }\n[outputs]\nout = { doc = \"x\" }\n"
      "[equations]\nout = \"polarity*in^2\"\n");
  library.add(diagram::parse_block(
      "format = \"oblique-block/1\"\ntitle = \"c\"\nsummary = \"c\"\n[inputs]\nin = { doc = \"x\" }\n"
      "[outputs]\nout = { wire = \"s\", doc = \"x\" }\n[blocks]\n"
      "s = { type = \"shifted\", in = [\"in\"] }\n",
      "c.toml", "c"));
  const Compiled made("u = { type = \"constant\" }\nc = { type = \"c\", in = \"u\" }\n",
                      "[machine]\ninverting = true\n", library);
  const std::vector<double> peaks{1, 1};
  EXPECT_THAT(testing::message_of<diagram::DiagramError>([&] {
                diagram::rescale(made.diagram, made.flat, diagram::propose_scaling(made.flat, peaks),
                                 library);
              }),
              HasSubstr("'c.s' cannot stand outside its composite"));
}

}  // namespace
}  // namespace oblique::solve
