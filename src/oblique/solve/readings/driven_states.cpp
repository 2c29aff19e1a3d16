// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/driven_states.h>

namespace oblique::solve {

std::vector<bool> driven_states(const network::Program& program, std::span<const std::uint32_t> units,
                                double t, std::span<const double> x, network::Workspace workspace) {
  const std::size_t n = program.n_states();
  std::vector<double> here(n), there(n);
  if (!program.derivatives(t, x.data(), here.data(), workspace)) return std::vector<bool>(n, true);
  std::vector<bool> driven(n, false);
  std::vector<std::size_t> found;
  const network::SwitchStructure& structure = program.switch_structure();
  std::vector<bool> slides(structure.unit.size(), false);
  for (const std::uint32_t unit : units) {
    for (const std::uint32_t s : structure.members[unit]) slides[s] = true;
  }
  const std::vector<bool> follows = structure.followers_of(slides);
  for (std::size_t s = 0; s < slides.size(); ++s) {
    if (!slides[s] && !follows[s]) continue;
    const std::uint32_t discrete_state = program.switches()[s].discrete_state;
    const double position = workspace.discrete_state(discrete_state);
    workspace.set_discrete_state(discrete_state, 1 - position);
    const bool known = program.derivatives(t, x.data(), there.data(), workspace);
    workspace.set_discrete_state(discrete_state, position);
    if (!known) return std::vector<bool>(n, true);
    for (std::size_t i = 0; i < n; ++i) {
      if (driven[i] || there[i] == here[i]) continue;
      driven[i] = true;
      found.push_back(i);
    }
  }
  const network::SparsePattern& pattern = program.jacobian_pattern();
  while (!found.empty()) {
    const std::size_t column = found.back();
    found.pop_back();
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto row = static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)]);
      if (driven[row]) continue;
      driven[row] = true;
      found.push_back(row);
    }
  }
  return driven;
}

}  // namespace oblique::solve
