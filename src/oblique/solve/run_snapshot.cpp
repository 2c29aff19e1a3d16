// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/run_snapshot.h>

namespace oblique::solve {
namespace {

std::vector<double> values_of(const RunState::Named& named) {
  std::vector<double> values;
  values.reserve(named.size());
  for (const auto& [name, value] : named) values.push_back(value);
  return values;
}

/// The values with the names that `items` of a program have.
template <class Items>
RunState::Named named_by(const Items& items, const std::vector<double>& values) {
  RunState::Named named;
  named.reserve(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) named.emplace_back(items[i].name, values[i]);
  return named;
}

}  // namespace

RunSnapshot::RunSnapshot(double t, const RunParts& parts)
    : time_(t),
      states_(parts.states),
      discrete_states_(parts.workspace.discrete_states().begin(), parts.workspace.discrete_states().end()),
      conditions_(parts.switching.conditions()),
      sliding_(parts.switching.sliding()),
      position_(parts.clock.position()) {
  for (std::size_t u = 0; u < parts.program.unknowns().size(); ++u)
    unknowns_.push_back(parts.workspace.unknown(u));
}

RunSnapshot::RunSnapshot(const RunState& state)
    : time_(state.time),
      states_(values_of(state.states)),
      discrete_states_(values_of(state.memories)),
      unknowns_(values_of(state.unknowns)),
      conditions_(state.conditions),
      sliding_(state.sliding),
      position_(state.position) {}

void RunSnapshot::restore_values(const RunParts& parts) const {
  parts.states = states_;
  for (std::size_t u = 0; u < unknowns_.size(); ++u) parts.workspace.set_unknown(u, unknowns_[u]);
}

void RunSnapshot::restore(const RunParts& parts) const {
  restore_values(parts);
  parts.workspace.load_discrete_states(discrete_states_);
  parts.clock.restore(position_);
  parts.switching.restore(conditions_, sliding_);
}

RunState RunSnapshot::named(const network::Program& program) const {
  RunState state;
  state.time = time_;
  state.states = named_by(program.states(), states_);
  state.unknowns = named_by(program.unknowns(), unknowns_);
  state.memories = named_by(program.discrete_states(), discrete_states_);
  state.conditions = conditions_;
  state.sliding = sliding_;
  state.position = position_;
  return state;
}

}  // namespace oblique::solve
