// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/analysis.h>

#include <algorithm>
#include <cmath>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/quasi_steady.h>

namespace oblique::solve {
namespace {

/// Takes the instants at which the servo loops stand at rest in place of those of the run, where there are
/// any.
void stand(Analysis& analysis, const network::Program& program, const SignalFlow& flow,
           const diagram::FlatDiagram& diagram, const RunOptions& options, std::size_t most_instants) {
  try {
    analysis.instants = quasi_steady_instants(program, diagram, options, most_instants);
    analysis.stability = judge_stability(program, flow, analysis.instants);
    analysis.quasi_steady = true;
  } catch (const SolveError&) {  // they stand nowhere: the run's own instants remain
  }
}

}  // namespace

Analysis analyse(const network::Program& program, const diagram::FlatDiagram& diagram, RunOptions options,
                 std::size_t most_instants) {
  Analysis analysis;
  options.watch_overloads = true;
  RunOptions trial = options;
  std::vector<Instant> rows;  // all of them, where they are few enough to be kept
  constexpr double kMostNumbers = 4e6;
  const auto n_rows = static_cast<std::size_t>(options.samples);
  const bool keep_all = static_cast<double>(n_rows * program.n_states()) <= kMostNumbers;
  collect_instants(trial, keep_all ? n_rows : most_instants, rows);
  try {
    analysis.run = run(program, diagram, trial);
  } catch (const SolveError& error) {
    analysis.failure = error;
  }

  const std::size_t shown = std::min(n_rows, most_instants);
  for (std::size_t k = 0; k < shown; ++k) {
    const std::size_t row = !keep_all ? k : shown < 2 ? 0 : k * (n_rows - 1) / (shown - 1);
    if (row < rows.size()) analysis.instants.push_back(rows[row]);
  }

  analysis.fastest_derivatives.assign(program.n_states(), 0);
  const SignalFlow flow(diagram, program);
  // At an event the disturbance jumps too, which derivatives do not tell.
  std::optional<DisturbanceGrowth> growth;
  if (keep_all && analysis.run && analysis.run->event_count == 0) growth = disturbance_growth(program, rows);
  analysis.stability = judge_stability(program, flow, analysis.instants, growth);
  if (analysis.failure || analysis.stability.grows_from)
    stand(analysis, program, flow, diagram, options, most_instants);
  if (analysis.instants.empty()) return analysis;  // it did not even start
  analysis.loops = explain_loops(program, flow, analysis.instants);
  network::Workspace workspace(program);
  std::vector<double> derivatives(program.n_states());
  for (const Instant& instant : analysis.instants) {
    workspace.load_discrete_states(instant.discrete_states);
    if (!program.derivatives(instant.t, instant.states.data(), derivatives.data(), workspace)) continue;
    for (std::size_t i = 0; i < derivatives.size(); ++i) {
      analysis.fastest_derivatives[i] = std::max(analysis.fastest_derivatives[i], std::abs(derivatives[i]));
    }
  }
  return analysis;
}

}  // namespace oblique::solve
