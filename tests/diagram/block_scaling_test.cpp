// SPDX-License-Identifier: MIT
// Which scalings equations allow, worked out by hand from their formulas.
#include <cmath>

#include <gtest/gtest.h>

#include <oblique/diagram/block_scaling.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/diagram/rescale.h>

namespace oblique::diagram {
namespace {

/// The flat block of one definition, by itself, with its default parameters.
struct Lone {
  BlockDefinition definition;
  FlatBlock block;

  explicit Lone(const std::string& text)
      : definition(parse_block("format = \"oblique-block/1\"\ntitle = \"x\"\nsummary = \"x\"\n" + text,
                               "x.toml", "x")) {
    block.path = "x";
    block.definition = &definition;
    block.behaviour = &definition.behaviours.front();
    for (const ParameterDefinition& p : definition.parameters) block.parameters.push_back(p.default_value);
    block.inputs.resize(definition.inputs.size());
    for (FlatInput& input : block.inputs) input.terms.emplace_back();  // fed by a signal: not a constant
  }
  Lone(const Lone&) = delete;
  Lone& operator=(const Lone&) = delete;
  ~Lone() = default;

  BlockScalingRules rules() const { return BlockScalingRules(block); }
};

std::string function_of(const std::string& equation, const std::string& parameters = "") {
  return "[inputs]\nx = { doc = \"x\" }\ny = { doc = \"y\" }\n[outputs]\nout = { doc = \"out\" "
         "}\n[parameters]\n" +
         parameters + "[equations]\nout = \"" + equation + "\"\n";
}

const std::string kLevel = "level = { default = 0.5, unit = \"machine unit\", doc = \"level\" }\n";
const std::string kNumber = "k = { default = 2, unit = \"1\", doc = \"k\" }\n";

TEST(BlockScaling, LinearEquationsScaleAsAWhole) {
  for (const char* equation : {"x - 3*k*y", "x", "0", "abs(x)", "hypot(x, k*y)", "sqrt(x^2 + y^2)", "x^2/y",
                               "x*sin(k)", "0*x + y", "x/k"}) {
    EXPECT_TRUE(Lone(function_of(equation, kNumber)).rules().scales_as_a_whole()) << equation;
  }
  for (const char* equation :
       {"x*y", "x + 1", "cos(x)", "x^2", "sqrt(x)", "atan2(x, y)", "exp(x)*y", "x^y"}) {
    EXPECT_FALSE(Lone(function_of(equation)).rules().scales_as_a_whole()) << equation;
  }
}

TEST(BlockScaling, AParameterInMachineUnitsIsScaledToo) {
  const Lone limited(function_of("x + level", kLevel));
  ASSERT_TRUE(limited.rules().scales_as_a_whole());
  const BlockScaling scaling = limited.rules().whole(0.2);
  EXPECT_EQ(scaling.parameters, std::vector<double>{0.2});
  EXPECT_EQ(scaling.outputs, std::vector<double>{0.2});
  EXPECT_FALSE(Lone(function_of("x + k", kNumber)).rules().scales_as_a_whole());
  EXPECT_EQ(Lone(function_of("x*k", kNumber)).rules().whole(0.2).parameters, std::vector<double>{1});
}

TEST(BlockScaling, APhysicalProductMultipliesTheFactorsOfItsInputs) {
  const auto output = [](const std::string& equation, double x, double y) {
    return Lone(function_of(equation)).rules().from_inputs(std::vector<double>{x, y}).outputs[0];
  };
  EXPECT_EQ(output("x*y", 0.2, 0.5), 0.1);
  EXPECT_EQ(output("x*y*3", 10, 0.5), 5);
  EXPECT_EQ(output("x/y", 0.2, 0.5), 0.4);
  EXPECT_EQ(output("x^2", 0.2, 1), 0.04);
  EXPECT_EQ(output("sqrt(x)", 0.25, 1), 0.5);
  EXPECT_EQ(output("sign(x)", 0.25, 1), 1);
}

TEST(BlockScaling, ForcedInputsStayAsTheyAre) {
  const BlockScaling cosine =
      Lone(function_of("cos(x)*y")).rules().from_inputs(std::vector<double>{0.2, 0.5});
  EXPECT_EQ(cosine.inputs, (std::vector<double>{1, 0.5}));
  EXPECT_EQ(cosine.outputs[0], 0.5);
  // The arc tangent takes any length, but the same in both coordinates.
  const BlockScaling angle =
      Lone(function_of("atan2(y, x)")).rules().from_inputs(std::vector<double>{0.2, 0.5});
  EXPECT_EQ(angle.inputs[0], angle.inputs[1]);
  EXPECT_EQ(angle.outputs[0], 1);
}

TEST(BlockScaling, StatesAndTheirStartsGoTogether) {
  const Lone lag("[inputs]\nx = { doc = \"x\" }\n[outputs]\nout = { doc = \"out\" }\n[parameters]\n" +
                 kLevel +
                 "rate = { default = 1, unit = \"1/s\", doc = \"rate\" }\n"
                 "[equations]\n\"der(out)\" = \"rate*(x - out)\"\n[start]\nout = \"level\"\n");
  ASSERT_TRUE(lag.rules().scales_as_a_whole());
  EXPECT_EQ(lag.rules().whole(0.5).parameters, (std::vector<double>{0.5, 1}));
  const Lone growth(
      "[inputs]\nx = { doc = \"x\" }\n[outputs]\nout = { doc = \"out\" }\n"
      "[equations]\n\"der(out)\" = \"x*out*(1 - out)\"\n[start]\nout = \"0.1\"\n");
  EXPECT_FALSE(growth.rules().scales_as_a_whole());
  EXPECT_EQ(growth.rules().from_inputs(std::vector<double>{0.5}).outputs[0], 1);
}

TEST(ScaleForPeak, GoesInStepsOfOneTwoFive) {
  EXPECT_EQ(scale_for_peak(1), 1);
  EXPECT_EQ(scale_for_peak(1 + 1e-7), 1);
  EXPECT_EQ(scale_for_peak(-1.01), 0.5);
  EXPECT_EQ(scale_for_peak(2), 0.5);
  EXPECT_EQ(scale_for_peak(3.7), 0.2);
  EXPECT_EQ(scale_for_peak(7), 0.1);
  EXPECT_EQ(scale_for_peak(10), 0.1);
  EXPECT_EQ(scale_for_peak(1999), 0.0005);
  EXPECT_EQ(scale_for_peak(0.3), 2);
  EXPECT_EQ(scale_for_peak(0.15), 5);
  EXPECT_EQ(scale_for_peak(0.1), 10);
  EXPECT_EQ(scale_for_peak(0), 1);
}

}  // namespace
}  // namespace oblique::diagram
