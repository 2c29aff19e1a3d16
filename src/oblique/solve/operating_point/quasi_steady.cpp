// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/quasi_steady.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <unordered_map>

#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>

namespace oblique::solve {

bool is_brought_to_rest(const diagram::BlockDefinition& definition) {
  return std::any_of(definition.starts.begin(), definition.starts.end(),
                     [](const auto& start) { return start.at_rest; });
}

diagram::FlatDiagram with_instant_servos(diagram::FlatDiagram diagram) {
  for (diagram::FlatBlock& block : diagram.blocks) {
    const auto bandwidth = block.definition->find_parameter("bandwidth");
    if (!bandwidth || !is_brought_to_rest(*block.definition)) continue;
    block.parameters[*bandwidth] = std::numeric_limits<double>::infinity();
    block.choose_behaviour();
  }
  return diagram;
}

namespace {

using Values = std::unordered_map<std::string_view, double>;

/// The discrete states of a program in these states: those with a namesake are as it is, and the switches of
/// real amplifiers, which instant ones have not, as their event functions tell.
std::vector<double> discrete_states_of(const network::Program& program, double t,
                                       const std::vector<double>& states, const Values& namesakes,
                                       network::Workspace& workspace) {
  constexpr int kMostRounds = 100;
  workspace.reset_discrete_states();
  for (std::size_t m = 0; m < program.discrete_states().size(); ++m) {
    const auto found = namesakes.find(program.discrete_states()[m].name);
    if (found != namesakes.end()) workspace.set_discrete_state(m, found->second);
  }
  std::vector<double> event_functions(program.switches().size());
  bool turned = true;
  for (int round = 0; turned && round < kMostRounds; ++round) {
    turned = false;
    if (!program.event_functions(t, states.data(), event_functions.data(), workspace)) break;
    for (std::size_t s = 0; s < event_functions.size(); ++s) {
      const std::uint32_t discrete_state = program.switches()[s].discrete_state;
      const double position = event_functions[s] > 0 ? 1 : 0;
      if (namesakes.contains(program.discrete_states()[discrete_state].name) ||
          workspace.discrete_state(discrete_state) == position)
        continue;
      workspace.set_discrete_state(discrete_state, position);
      turned = true;
    }
  }
  return {workspace.discrete_states().begin(), workspace.discrete_states().end()};
}

}  // namespace

std::vector<Instant> quasi_steady_instants(const network::Program& program,
                                           const diagram::FlatDiagram& diagram, RunOptions options,
                                           std::size_t most) {
  const diagram::FlatDiagram instant_servos = with_instant_servos(diagram);
  const network::Program quasi_steady(network::assemble(instant_servos));
  std::vector<Instant> instants;
  collect_instants(options, most, instants);
  run(quasi_steady, instant_servos, options);

  std::unordered_map<std::string_view, std::size_t> signals;
  for (std::size_t s = 0; s < quasi_steady.n_signals(); ++s)
    signals.emplace(quasi_steady.signal_names()[s], s);
  network::Workspace workspace(quasi_steady), real(program);
  std::vector<double> values(quasi_steady.n_signals());
  for (Instant& instant : instants) {
    workspace.load_discrete_states(instant.discrete_states);
    quasi_steady.signals(instant.t, instant.states.data(), values.data(), workspace);
    Values held, discrete_states;
    for (std::size_t i = 0; i < quasi_steady.n_states(); ++i)
      held.emplace(quasi_steady.states()[i].name, instant.states[i]);
    std::vector<double> states(program.n_states());
    for (std::size_t i = 0; i < states.size(); ++i) {
      const std::string& name = program.states()[i].name;
      const auto state = held.find(name);
      states[i] = state != held.end() ? state->second : values[signals.at(name)];
    }
    for (std::size_t m = 0; m < instant.discrete_states.size(); ++m)
      discrete_states.emplace(quasi_steady.discrete_states()[m].name, instant.discrete_states[m]);
    instant.discrete_states = discrete_states_of(program, instant.t, states, discrete_states, real);
    instant.states = std::move(states);
  }
  return instants;
}

void collect_instants(RunOptions& options, std::size_t most, std::vector<Instant>& instants) {
  const auto rows = static_cast<std::size_t>(options.samples);
  const std::size_t shown = std::min(rows, most);
  const auto row = std::make_shared<std::size_t>(0);
  options.on_restart = [&instants, row] {
    instants.clear();
    *row = 0;
  };
  options.on_sample = [&instants, rows, shown, row](double t, std::span<const double> states,
                                                    std::span<const double> discrete_states) {
    const std::size_t taken = instants.size();
    const std::size_t wanted = shown < 2 ? 0 : taken * (rows - 1) / (shown - 1);
    if ((*row)++ == wanted && taken < shown)
      instants.push_back(
          {t, {states.begin(), states.end()}, {discrete_states.begin(), discrete_states.end()}});
  };
}

}  // namespace oblique::solve
