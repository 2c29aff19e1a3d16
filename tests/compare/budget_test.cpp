// SPDX-License-Identifier: MIT
// Error budgets against a closed form, differences of runs, and the spread of drawn machines.
#include <oblique/compare/budget.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/ensemble/study/scatter.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

#include "../support/compiled.h"
#include "crank.h"

namespace oblique::compare {
namespace {

using ::testing::SizeIs;

// B = 2 ((1 + e) cos φ, (1 + f) sin φ), each coordinate a summer: e displaces it by 2 |cos φ| w/√3, f by
// 2 |sin φ| w/√3, and both by 2 w/√3 wherever the crank stands.
TEST(ErrorBudget, OfACrank) {
  const mechanism::Mechanism crank = testing::crank();
  BudgetOptions options;
  options.scatters = {{"summer", "tolerance", 0.01, ""}};
  const ErrorBudget budget = error_budget(crank, patch::patch(crank, {}), testing::shipped_blocks(), options);
  ASSERT_THAT(budget.entries, SizeIs(3));  // B.x, B.y, and one that holds the crank's amplitude
  const double both = 2 * 0.01 / std::numbers::sqrt3;
  constexpr double kRelative = 1e-6;  // a hundred times the tolerance of the run
  EXPECT_EQ(budget.point, "B");
  for (const double error : budget.along) EXPECT_NEAR(error, both, kRelative * both);
  const double c = std::cos(budget.drive), s = std::sin(budget.drive);
  EXPECT_NEAR(budget.entries[0].share, std::max(c * c, s * s), kRelative);
  EXPECT_NEAR(budget.entries[0].share + budget.entries[1].share, 1, 1e-12);
  int of_coordinates = 0;
  for (const BudgetEntry& entry : budget.entries) {
    EXPECT_EQ(entry.half_width, 0.01);
    EXPECT_NEAR(entry.error, both * std::sqrt(entry.share), 1e-12);
    if (entry.element.starts_with("crank")) {
      EXPECT_LT(entry.largest, 1e-9) << "the amplitude is held whatever its own error is";
      continue;
    }
    EXPECT_NEAR(entry.largest, both, 1e-3 * both);  // of 361 rows one is within half a degree of the axis
    ++of_coordinates;
  }
  EXPECT_EQ(of_coordinates, 2);
}

// x′ = −(1 + a)/(1 + b) x on a machine of which both scatter by w: each moves x by t e⁻ᵗ w/√3, which is
// largest at t = 1.
TEST(ErrorBudget, OfAnIntegratorWhoseResistorAndCapacitorScatter) {
  constexpr double kWidth = 1e-3;
  const diagram::Diagram decay = diagram::parse_diagram(
      "format = \"oblique-diagram/1\"\n[run]\nuntil = 2\n[blocks]\n"
      "x = { type = \"integrator\", in = \"-x\", initial = 1 }\n",
      "decay.toml");
  BudgetOptions options;
  options.positions = 41;
  options.scatters = {{"integrator", "tolerance", kWidth, ""},
                      {"integrator", "capacitor_tolerance", kWidth, ""}};
  const ErrorBudget budget = error_budget(decay, testing::shipped_blocks(), options);
  ASSERT_THAT(budget.entries, SizeIs(2));
  const double each = std::exp(-1) * kWidth / std::numbers::sqrt3;
  constexpr double kRelative = 1e-6;  // a hundred times the tolerance of the run
  for (const BudgetEntry& entry : budget.entries) EXPECT_NEAR(entry.largest, each, kRelative * each);
  EXPECT_NEAR(budget.error, std::sqrt(2) * each, kRelative * each);
}

/// C of a four-bar with some of its parameters changed, in a row of its run.
struct FourBar {
  mechanism::Mechanism mechanism =
      mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml");
  diagram::Diagram diagram = patch::patch(mechanism, {});
  diagram::FlatDiagram flat = diagram::flatten(diagram, testing::shipped_blocks());

  std::pair<double, double> place(const diagram::FlatDiagram& changed, std::size_t row,
                                  double tolerance) const {
    solve::RunOptions how = solve::options_of(diagram.run);
    how.samples = 361;
    how.tolerance = tolerance;
    const solve::Run run = solve::run(network::Program(network::assemble(changed)), changed, how);
    return {run.trajectory.at(row, *run.trajectory.find("C.x")),
            run.trajectory.at(row, *run.trajectory.find("C.y"))};
  }

  std::pair<std::size_t, std::size_t> find(const std::string& element) const {
    for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
      const std::string& path = flat.blocks[b].path;
      if (element.starts_with(path + "."))
        if (const auto parameter = flat.blocks[b].definition->find_parameter(element.substr(path.size() + 1)))
          return {b, *parameter};
    }
    throw std::out_of_range(element);
  }
};

TEST(ErrorBudget, AgreesWithDifferencesAndWithDrawnMachines) {
  const FourBar bar;
  constexpr double kWidth = 1e-3;
  BudgetOptions options;
  options.scatters = ensemble::scatters_of_tolerance(testing::shipped_blocks(), kWidth);
  const ErrorBudget budget = error_budget(bar.mechanism, bar.diagram, testing::shipped_blocks(), options);
  ASSERT_EQ(budget.point, "C");
  ASSERT_GT(budget.entries.size(), 20U);
  double shares = 0;
  for (const BudgetEntry& entry : budget.entries) shares += entry.share;
  EXPECT_NEAR(shares, 1, 1e-12);

  // Central differences over a tenth of a thousandth: 1e-10 of the run over it is 1e-6, of the curvature
  // less.
  constexpr double kStep = 1e-4, kOfRun = 1e-10;
  for (std::size_t k = 0; k < budget.entries.size(); k += 3) {
    const auto [block, parameter] = bar.find(budget.entries[k].element);
    const double nominal = bar.flat.blocks[block].parameters[parameter];
    const auto at = [&](double value) {
      diagram::FlatDiagram changed = bar.flat;
      ensemble::apply_draws({{block, parameter, value}}, changed);
      return bar.place(changed, budget.row, kOfRun);
    };
    const auto [above_x, above_y] = at(nominal + kStep);
    const auto [below_x, below_y] = at(nominal - kStep);
    const double displaced = std::hypot(above_x - below_x, above_y - below_y) / (2 * kStep);
    EXPECT_NEAR(budget.entries[k].error, displaced * kWidth / std::numbers::sqrt3, 1e-4 * budget.error)
        << budget.entries[k].element;
  }

  // The mean square of what 400 drawn machines do is known to some 6 %, for two coordinates and a sum that
  // is nearly normal: √(2/400) at the most.
  constexpr int kMachines = 400;
  const auto [x, y] = bar.place(bar.flat, budget.row, 1e-8);
  double sum = 0;
  for (int run = 0; run < kMachines; ++run) {
    diagram::FlatDiagram drawn = bar.flat;
    ensemble::apply_draws(ensemble::draw(drawn, options.scatters, {7, static_cast<std::uint64_t>(run)}),
                          drawn);
    const auto [drawn_x, drawn_y] = bar.place(drawn, budget.row, 1e-6);
    sum += (drawn_x - x) * (drawn_x - x) + (drawn_y - y) * (drawn_y - y);
  }
  EXPECT_NEAR(sum / kMachines / (budget.error * budget.error), 1, 3 * std::sqrt(2.0 / kMachines));
}

}  // namespace
}  // namespace oblique::compare
