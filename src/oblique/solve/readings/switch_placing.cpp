// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/switch_placing.h>

#include <cmath>
#include <utility>

namespace oblique::solve {

SwitchPlacing::SwitchPlacing(const network::Program& program, std::vector<std::uint32_t> switches)
    : program_(program),
      switches_(std::move(switches)),
      roundings_(program),
      event_functions_(program.switches().size()),
      signals_(program.n_signals()) {
  for (const std::uint32_t s : switches_) {
    const network::Switch& made = program.switches()[s];
    discrete_states_.push_back(made.discrete_state);
    if (!made.moves_along) continue;
    tables_.push_back(*made.moves_along);
    discrete_states_.push_back(program.events()[*made.moves_along].actions.front().index);
  }
}

bool SwitchPlacing::place(double t, const double* x, network::Workspace& workspace,
                          const Thresholds* thresholds) {
  const std::size_t most = 2 * discrete_states_.size() + 100;  // a table moves from line to line
  for (std::size_t round = 0; round <= most; ++round) {
    if (switches_.empty()) return true;
    const auto before = program_.event_functions(t, x, event_functions_.data(), workspace);
    if (!before) return false;
    std::vector<double> sizes;
    for (const std::uint32_t s : switches_) sizes.push_back(before->compared_size(s));
    bool turned = false;
    for (std::size_t k = 0; k < switches_.size(); ++k) {
      const std::uint32_t s = switches_[k];
      const network::Switch& made = program_.switches()[s];
      const double rounding = roundings_.rounding_of(s, sizes[k]);
      const bool is_at_level =
          std::abs(event_functions_[s]) <= rounding && made.turning == network::Turning::jumps;
      const double stays = thresholds != nullptr ? (*thresholds)[s] : rounding;
      if (std::abs(event_functions_[s]) <= stays && !is_at_level) continue;
      const std::uint32_t discrete_state = made.discrete_state;
      const double position = event_functions_[s] > 0 && !is_at_level ? 1 : 0;
      turned = turned || workspace.discrete_state(discrete_state) != position;
      workspace.set_discrete_state(discrete_state, position);
    }
    const auto here = program_.signals(t, x, signals_.data(), workspace);
    if (!here) return false;
    std::vector<std::pair<std::uint32_t, double>> segments;
    for (const std::size_t event : tables_) {
      if (here->condition(event))
        segments.emplace_back(program_.events()[event].actions.front().index, here->action_value(event, 0));
    }
    for (const auto& [segment, value] : segments) workspace.set_discrete_state(segment, value);
    if (!turned && segments.empty()) return true;
  }
  return false;
}

}  // namespace oblique::solve
