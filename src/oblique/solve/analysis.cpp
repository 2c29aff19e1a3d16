// SPDX-License-Identifier: MIT
#include <oblique/solve/analysis.h>

#include <algorithm>
#include <cmath>

namespace oblique {

Analysis analyse(const Program& program, const FlatDiagram& diagram, RunOptions options,
                 std::size_t most_instants) {
  Analysis analysis;
  const auto rows = static_cast<std::size_t>(options.samples);
  const std::size_t shown = std::min(rows, most_instants);
  std::size_t row = 0;
  options.watch_overloads = true;
  options.on_sample = [&](double t, std::span<const double> states, std::span<const double> memories) {
    const std::size_t taken = analysis.instants.size();
    const std::size_t wanted = shown < 2 ? 0 : taken * (rows - 1) / (shown - 1);
    if (row++ == wanted && taken < shown)
      analysis.instants.push_back({t, {states.begin(), states.end()}, {memories.begin(), memories.end()}});
  };
  try {
    analysis.run = run(program, diagram, options);
  } catch (const SolveError& error) {
    analysis.failure = error;
  }

  analysis.fastest_slopes.assign(program.n_states(), 0);
  if (analysis.instants.empty()) return analysis;  // it did not even start
  const SignalFlow flow(diagram, program);
  analysis.stability = judge_stability(program, flow, analysis.instants);
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
