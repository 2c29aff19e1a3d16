// SPDX-License-Identifier: MIT
#include <oblique/solve/analysis.h>

#include <algorithm>
#include <cmath>

#include <oblique/solve/standing.h>

namespace oblique {
namespace {

/// Takes the instants at which the servo loops stand at rest in place of those of the run, where there are
/// any.
void stand(Analysis& analysis, const Program& program, const SignalFlow& flow, const FlatDiagram& diagram,
           const RunOptions& options, std::size_t most_instants) {
  try {
    analysis.instants = standing_instants(program, diagram, options, most_instants);
    analysis.stability = judge_stability(program, flow, analysis.instants);
    analysis.standing = true;
  } catch (const SolveError&) {  // they stand nowhere: the run's own instants remain
  }
}

}  // namespace

Analysis analyse(const Program& program, const FlatDiagram& diagram, RunOptions options,
                 std::size_t most_instants) {
  Analysis analysis;
  options.watch_overloads = true;
  RunOptions trial = options;
  collect_instants(trial, most_instants, analysis.instants);
  try {
    analysis.run = run(program, diagram, trial);
  } catch (const SolveError& error) {
    analysis.failure = error;
  }

  analysis.fastest_slopes.assign(program.n_states(), 0);
  const SignalFlow flow(diagram, program);
  analysis.stability = judge_stability(program, flow, analysis.instants);
  if (analysis.failure || analysis.stability.grows_from)
    stand(analysis, program, flow, diagram, options, most_instants);
  if (analysis.instants.empty()) return analysis;  // it did not even start
  analysis.loops = explain_loops(program, flow, analysis.instants);
  Workspace workspace(program);
  std::vector<double> slopes(program.n_states());
  for (const Instant& instant : analysis.instants) {
    workspace.load_memories(instant.memories);
    if (!program.derivatives(instant.t, instant.states.data(), slopes.data(), workspace)) continue;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      analysis.fastest_slopes[i] = std::max(analysis.fastest_slopes[i], std::abs(slopes[i]));
    }
  }
  return analysis;
}

}  // namespace oblique
