// SPDX-License-Identifier: MIT
#include <oblique/solve/events/position_effects.h>

#include <algorithm>
#include <vector>

#include <oblique/solve/events/self_consistent.h>
#include <oblique/solve/events/sliding_mode.h>

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

std::vector<std::vector<std::size_t>> find_setters(const network::Program& program) {
  const network::SwitchStructure& structure = program.switch_structure();
  std::vector<std::vector<std::size_t>> setters(structure.members.size());
  for (std::size_t e = 0; e < program.events().size(); ++e) {
    const network::Event& event = program.events()[e];
    const bool sets_states = std::any_of(event.actions.begin(), event.actions.end(),
                                         [](const auto& action) { return action.on_state; });
    if (!sets_states || event.repeats) continue;
    std::vector<std::uint32_t> pending = structure.positions_in(event.condition);
    std::vector<bool> leads(structure.unit.size(), false);
    while (!pending.empty()) {
      const std::uint32_t s = pending.back();
      pending.pop_back();
      if (leads[s]) continue;
      leads[s] = true;
      std::vector<std::size_t>& of_unit = setters[structure.unit[s]];
      if (of_unit.empty() || of_unit.back() != e) of_unit.push_back(e);
      for (const std::uint32_t below : structure.positions_below(s)) pending.push_back(below);
    }
  }
  return setters;
}

bool sets_off_a_jump(const network::Program& program, const network::Workspace& workspace,
                     const Thresholds& thresholds, const std::vector<std::size_t>& setters,
                     const Announced& announced, std::uint32_t s, double t, std::span<const double> x) {
  if (setters.empty()) return false;
  network::Workspace trial = workspace;
  std::vector<double> signals(program.n_signals()), values(program.switches().size());
  const auto now = program.signals(t, x.data(), signals.data(), trial);
  if (!now) return false;
  std::vector<bool> held, placed(values.size(), false);
  for (const std::size_t e : setters) held.push_back(now->condition(e));
  const network::SwitchStructure& structure = program.switch_structure();
  for (const std::uint32_t m : structure.members[structure.unit[s]]) {
    placed[m] = true;
    if (announced[m]) trial.set_discrete_state(program.switches()[m].discrete_state, *announced[m]);
  }
  if (!place_others(program, trial, thresholds, placed, t, x, values)) return false;
  const auto then = program.signals(t, x.data(), signals.data(), trial);
  if (!then) return false;
  std::vector<double> jumped(x.begin(), x.end());
  for (std::size_t k = 0; k < setters.size(); ++k) {
    const std::size_t e = setters[k];
    if (held[k] || !then->condition(e)) continue;
    const auto& actions = program.events()[e].actions;
    for (std::size_t a = 0; a < actions.size(); ++a) {
      if (actions[a].on_state) jumped[actions[a].index] = then->action_value(e, a);
    }
  }
  return program.event_functions(t, jumped.data(), values.data(), trial) &&
         std::abs(values[s]) > std::max(SlidingMode::drift(), thresholds[s]);
}

}  // namespace oblique::solve
