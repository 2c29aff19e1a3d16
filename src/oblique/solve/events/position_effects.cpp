// SPDX-License-Identifier: MIT
#include <oblique/solve/events/position_effects.h>

#include <algorithm>
#include <vector>

namespace oblique::solve {
namespace {

/// Whether some value that `evaluate` gives is another with the switches of a unit turned over.
template <class Evaluate>
bool changes(const network::Program& program, network::Workspace& workspace, std::uint32_t unit,
             std::size_t n_values, const Evaluate& evaluate) {
  const std::vector<double> positions(workspace.discrete_states().begin(), workspace.discrete_states().end());
  std::vector<double> here(n_values), there(n_values);
  const bool known = evaluate(here);
  for (const std::uint32_t s : program.switch_structure().members[unit]) {
    const std::uint32_t discrete_state = program.switches()[s].discrete_state;
    workspace.set_discrete_state(discrete_state, 1 - workspace.discrete_state(discrete_state));
  }
  const bool known_there = evaluate(there);
  workspace.load_discrete_states(positions);
  return known && known_there && !std::equal(here.begin(), here.end(), there.begin(), [](double a, double b) {
           return !differ(a, b);
         });
}

}  // namespace

bool changes_signals(const network::Program& program, network::Workspace& workspace, std::uint32_t unit,
                     double t, std::span<const double> x) {
  return changes(program, workspace, unit, program.n_signals(), [&](std::vector<double>& signals) {
    return program.signals(t, x.data(), signals.data(), workspace).has_value();
  });
}

bool changes_rates(const network::Program& program, network::Workspace& workspace, std::uint32_t unit,
                   double t, std::span<const double> x) {
  return changes(program, workspace, unit, x.size(), [&](std::vector<double>& rates) {
    return program.derivatives(t, x.data(), rates.data(), workspace);
  });
}

std::optional<std::uint32_t> idle_on_side(const network::Program& program, network::Workspace& workspace,
                                          std::uint32_t unit, bool above, double t,
                                          std::span<const double> x) {
  const network::SwitchStructure& structure = program.switch_structure();
  const auto& members = structure.members[unit];
  const std::vector<double> positions(workspace.discrete_states().begin(), workspace.discrete_states().end());
  std::vector<double> event_functions(program.switches().size()), rates(event_functions.size()),
      derivatives(program.n_states());
  const auto rate = [&]() -> std::optional<double> {
    const auto here = program.event_functions(t, x.data(), event_functions.data(), workspace);
    if (!here) return std::nullopt;
    here->derivatives(derivatives.data());
    here->event_function_rates(derivatives.data(), rates.data());
    return rates[members.front()];
  };
  const auto put_on = [&](bool upper) {
    for (const std::uint32_t s : members)
      workspace.set_discrete_state(program.switches()[s].discrete_state,
                                   upper != structure.opposite[s] ? 1 : 0);
  };
  put_on(!above);
  const std::optional<double> other = rate();
  put_on(above);
  const std::optional<double> resting = rate();
  const bool is_held = resting && other && differ(*resting, *other);  // and does not just touch its level
  std::optional<std::uint32_t> found;
  for (const std::uint32_t s : members) {
    const network::Switch& made = program.switches()[s];
    if (!is_held || found || above == structure.opposite[s] || made.turning != network::Turning::jumps)
      continue;
    workspace.set_discrete_state(made.discrete_state, 0);
    const std::optional<double> without = rate();
    if (without && !differ(*resting, *without)) found = s;
    workspace.set_discrete_state(made.discrete_state, 1);
  }
  workspace.load_discrete_states(positions);
  return found;
}

}  // namespace oblique::solve
