// SPDX-License-Identifier: MIT
// Problems of textbooks on analog computation, written in their own units (millimetres, heads, metres,
// moles a litre, days, kilohertz), put onto machines: what they give there, and how well the machine is used.
#include <oblique/commission/diagram_on_machine.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>
#include <oblique/solve/run.h>

#include "../support/compiled.h"
#include "textbook_problems.h"

namespace oblique::commission {
namespace {

using testing::Problem;
using testing::shipped_blocks;
using testing::Truth;

diagram::Diagram diagram_of(const Problem& problem) {
  std::string text = fmt::format("format = \"oblique-diagram/1\"\n[run]\nuntil = {}\n[blocks]{}[outputs]\n",
                                 problem.until, problem.blocks);
  std::string expect = "[expect]\n";
  for (const Truth& truth : problem.truths) {
    const std::string line = fmt::format("{0} = \"{0}\"\n", truth.output);
    if (text.find("\n" + line) == std::string::npos) text += line;
    // What the solver's tolerance of 1e-8 a step gathers, and the servo amplifiers' gain of 1e6 leaves.
    expect += fmt::format("\"{} at {}\" = {{ value = {:.17g}, within = {} }}\n", truth.output, truth.time,
                          truth.value, 1e-5 * truth.size);
  }
  return diagram::parse_diagram(text + expect, "problem.toml");
}

std::vector<report::ExpectationResult> results_of(const diagram::Diagram& diagram) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, shipped_blocks());
  solve::RunOptions options = solve::options_of(diagram.run);
  report::ask_for_expectations(diagram, options);
  const solve::Run run = solve::run(network::Program(network::assemble(flat)), flat, options);
  return report::check_expectations(diagram, run);
}

using Placed = std::tuple<Problem, std::string>;

class TextbookDiagram : public ::testing::TestWithParam<Placed> {};
INSTANTIATE_TEST_SUITE_P(DiagramOnMachine, TextbookDiagram,
                         ::testing::Combine(::testing::ValuesIn(testing::kTextbookProblems),
                                            ::testing::Values("tr-10", "model-1")),
                         [](const auto& tested) {
                           std::string name =
                               std::string(std::get<0>(tested.param).name) + "_" + std::get<1>(tested.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(TextbookDiagram, GivesTheTruthAndUsesTheMachine) {
  const auto& [problem, machine] = GetParam();
  if (machine == "tr-10" && !problem.on_tr10) return;
  const diagram::Diagram diagram = diagram_of(problem);
  const DiagramOnMachine placed = put_on_machine(diagram, shipped_blocks(), *diagram::find_machine(machine));
  EXPECT_EQ(placed.failure, "");
  EXPECT_TRUE(placed.overloads.empty()) << placed.overloads.front().signal;
  if (placed.loops) {
    EXPECT_TRUE(placed.loops->well_damped()) << fault_of(*placed.loops);
  }

  diagram::Diagram ideal = placed.made.diagram;
  ideal.machine.profile = "ideal";
  for (const report::ExpectationResult& result : results_of(ideal))
    EXPECT_TRUE(result.met) << result.expectation.text << " = " << result.actual;
  const std::vector<report::ExpectationResult> real = results_of(placed.made.diagram);
  for (std::size_t k = 0; k < real.size(); ++k) {
    const Truth& truth = problem.truths[k];
    EXPECT_NEAR(real[k].actual, truth.value, (machine == "tr-10" ? *problem.on_tr10 : 1e-5) * truth.size)
        << real[k].expectation.text;
  }

  const diagram::FlatDiagram flat = diagram::flatten(placed.made.diagram, shipped_blocks());
  for (const diagram::FlatBlock& block : flat.blocks) {
    if (const auto setting = block.definition->find_parameter("setting")) {
      EXPECT_GE(block.parameters[*setting], problem.least_setting) << block.path;
      EXPECT_LE(block.parameters[*setting], 1) << block.path;
    }
    // No wire goes to more than two inputs of one element.
    for (const diagram::FlatInput& input : block.inputs) {
      for (const diagram::FlatTerm& term : input.terms) {
        const auto is_same = [&](const diagram::FlatTerm& other) {
          return other.signal == term.signal && other.weight == term.weight;
        };
        EXPECT_LE(std::count_if(input.terms.begin(), input.terms.end(), is_same), 2) << block.path;
      }
    }
  }
  for (const machine::SignalScale& scale : placed.made.scales) {
    const auto of_scale = [&](const diagram::FlatBlock& block) { return block.path == scale.signal; };
    const auto block = std::find_if(flat.blocks.begin(), flat.blocks.end(), of_scale);
    ASSERT_NE(block, flat.blocks.end());
    EXPECT_LE(scale.largest, 1 + 1e-5) << scale.signal;
    // What a multiplier gives is the product of two signals, whose peaks may lie apart.
    if (block->definition->role != diagram::Role::multiplier) {
      EXPECT_GE(scale.largest, problem.least_signal) << scale.signal;
    }
  }
}

}  // namespace
}  // namespace oblique::commission
