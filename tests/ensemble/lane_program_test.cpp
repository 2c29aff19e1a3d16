// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_program.h>

#include <gtest/gtest.h>

#include <oblique/network/assembly/parameter_numbers.h>

#include "../support/compiled.h"

namespace oblique::ensemble {
namespace {

std::string why_not(std::string_view blocks, const std::vector<std::string>& names = {},
                    solve::RunOptions options = {}) {
  const testing::Compiled compiled(blocks, "\n[outputs]\nx = \"x\"\n");
  std::vector<std::uint32_t> varied;
  for (const std::string& name : names)
    varied.push_back(network::find_parameter(compiled.flat, network::ParameterNumbers(compiled.flat), name)
                         .value()
                         .number);
  const LaneCompilation compilation = compile_for_lanes(compiled.flat, varied, options);
  EXPECT_EQ(compilation.program == nullptr, !compilation.why_not.empty());
  return compilation.why_not;
}

TEST(LaneProgram, TakesWhatIsSmooth) {
  EXPECT_EQ(why_not("x = { type = \"integrator\", in = [\"-1*x\"], initial = 1 }", {"x.in[1]"}), "");
}

TEST(LaneProgram, SaysWhatItDoesNotTake) {
  EXPECT_EQ(why_not("x = { type = \"constant\", value = 1 }"), "the diagram has no states");
  EXPECT_EQ(why_not(R"(
      one = { type = "constant" }
      r = { type = "relay", in = "x" }
      x = { type = "integrator", in = ["-1*r"], initial = 1 })"),
            "the diagram has switches or events");
  EXPECT_EQ(why_not(R"(
      bend = { type = "arc-tangent", in = "x" }
      x = { type = "integrator", in = ["-1*bend"], initial = 1 })"),
            "a function of the time or of states may hide a peak in a step");
  EXPECT_EQ(why_not(R"(
      x = { type = "integrator", in = ["5*square"], initial = 1 }
      square = { type = "squarer", in = "x" })")
                .substr(0, 45),
            "the typical machine: the run stopped at t = 0");
}

TEST(LaneProgram, TakesNoOptionsThatNeedASolverOfOneMachine) {
  solve::RunOptions options;
  options.extremes = true;
  EXPECT_NE(why_not("x = { type = \"integrator\", in = [\"-1*x\"], initial = 1 }", {}, options), "");
}

}  // namespace
}  // namespace oblique::ensemble
