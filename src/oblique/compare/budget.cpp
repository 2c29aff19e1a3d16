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

namespace {

/// Outputs whose changes together are one displacement, in parts of `size`.
struct Displaced {
  std::string name;
  std::vector<std::size_t> outputs;
  double size = 1;
};

/// Runs the diagram with the sensitivities to what scatters. `displaced` gives what is looked at, and `drive`
/// where the first drive, or the clock, stands in a row.
template <class DisplacedOf, class DriveOf>
ErrorBudget budget_of(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                      const BudgetOptions& options, int rows, const DisplacedOf& displaced_of,
                      const DriveOf& drive) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  solve::RunOptions how = solve::options_of(diagram.run);
  how.samples = rows;
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
  budget.along.assign(static_cast<std::size_t>(rows), 0);
  if (budget.entries.empty()) return budget;
  const solve::Trajectory run = solve::run(network::Program(network::assemble(flat)), flat, how).trajectory;

  const std::size_t n = budget.entries.size();
  std::vector<double> there(n);
  for (const Displaced& displaced : displaced_of(flat, run)) {
    for (std::size_t row = 0; row < run.rows(); ++row) {
      double sum = 0;
      std::vector<double> each(n);
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t first = 1 + flat.outputs.size() + k;
        for (const std::size_t output : displaced.outputs)
          each[k] = std::hypot(each[k], run.at(row, first + output * n));
        each[k] *= budget.entries[k].half_width / std::numbers::sqrt3 / displaced.size;
        budget.entries[k].largest = std::max(budget.entries[k].largest, each[k]);
        sum += each[k] * each[k];
      }
      budget.along[row] = std::max(budget.along[row], std::sqrt(sum));
      if (!budget.point.empty() && std::sqrt(sum) <= budget.error) continue;
      budget.error = std::sqrt(sum);
      budget.point = displaced.name;
      budget.row = row;
      budget.drive = drive(run, row);
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

}  // namespace

ErrorBudget error_budget(const mechanism::Mechanism& whole, const diagram::Diagram& diagram,
                         const diagram::BlockLibrary& library, const BudgetOptions& options) {
  const mechanism::Mechanism mechanism = patch::within_range(whole);
  const int rows = mechanism::rows_over_motion(mechanism, options.positions);
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, rows);
  const auto points = [&](const diagram::FlatDiagram& flat, const solve::Trajectory&) {
    std::vector<Displaced> found;
    for (const PointOutputs& point : point_outputs(mechanism, flat))
      found.push_back({mechanism.points[point.point].name, {point.x, point.y}, 1});
    return found;
  };
  return budget_of(diagram, library, options, rows, points, [&](const solve::Trajectory&, std::size_t row) {
    return exact.drives.at(row).front().value;
  });
}

ErrorBudget error_budget(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                         const BudgetOptions& options) {
  const auto outputs = [](const diagram::FlatDiagram& flat, const solve::Trajectory& run) {
    std::vector<Displaced> found;
    for (std::size_t k = 0; k < flat.outputs.size(); ++k) {
      if (const double size = largest_of(run, 1 + k); size > 0)
        found.push_back({flat.outputs[k].name, {k}, size});
    }
    return found;
  };
  return budget_of(diagram, library, options, diagram.run.samples, outputs,
                   [](const solve::Trajectory& run, std::size_t row) { return run.at(row, 0); });
}

}  // namespace oblique::compare
