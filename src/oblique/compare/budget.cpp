// SPDX-License-Identifier: MIT
#include <oblique/compare/budget.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <oblique/compare/patched_run.h>
#include <oblique/diagram/flatten.h>
#include <oblique/ensemble/study/scatter.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

namespace oblique::compare {

ErrorBudget error_budget(const mechanism::Mechanism& whole, const diagram::Diagram& diagram,
                         const diagram::BlockLibrary& library, const BudgetOptions& options) {
  const mechanism::Mechanism mechanism = patch::within_range(whole);
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, options.positions);
  solve::RunOptions how = solve::options_of(diagram.run);
  how.samples = options.positions;
  how.progress = options.progress;
  ErrorBudget budget;
  for (const diagram::FlatBlock& block : flat.blocks) {
    for (const diagram::BlockFigure& scatter : options.scatters) {
      const auto parameter = scatter.acts_on(*block.definition);
      if (!parameter) continue;
      budget.entries.push_back(
          {block.path + "." + block.definition->parameters[*parameter].name, scatter.value});
      how.sensitivity.push_back(budget.entries.back().element);
    }
  }
  budget.along.assign(static_cast<std::size_t>(options.positions), 0);
  if (budget.entries.empty()) return budget;
  const solve::Trajectory run = solve::run(network::Program(network::assemble(flat)), flat, how).trajectory;

  const std::size_t n = budget.entries.size();
  /// The displacement that an element makes of a point in a row.
  const auto displaced = [&](const PointOutputs& point, std::size_t row, std::size_t k) {
    const std::size_t first = 1 + flat.outputs.size() + k;
    return std::hypot(run.at(row, first + point.x * n), run.at(row, first + point.y * n)) *
           budget.entries[k].half_width / std::numbers::sqrt3;
  };
  std::vector<double> there(n);
  for (const PointOutputs& point : point_outputs(mechanism, flat)) {
    for (std::size_t row = 0; row < run.rows(); ++row) {
      double sum = 0;
      std::vector<double> each(n);
      for (std::size_t k = 0; k < n; ++k) {
        each[k] = displaced(point, row, k);
        budget.entries[k].largest = std::max(budget.entries[k].largest, each[k]);
        sum += each[k] * each[k];
      }
      budget.along[row] = std::max(budget.along[row], std::sqrt(sum));
      if (!budget.point.empty() && std::sqrt(sum) <= budget.error) continue;
      budget.error = std::sqrt(sum);
      budget.point = mechanism.points[point.point].name;
      budget.row = row;
      budget.drive = exact.drives.at(row).front().value;
      there = std::move(each);
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    budget.entries[k].error = there[k];
    budget.entries[k].share = budget.error > 0 ? there[k] * there[k] / (budget.error * budget.error) : 0;
  }
  std::stable_sort(budget.entries.begin(), budget.entries.end(),
                   [](const BudgetEntry& a, const BudgetEntry& b) { return a.share > b.share; });
  return budget;
}

}  // namespace oblique::compare
