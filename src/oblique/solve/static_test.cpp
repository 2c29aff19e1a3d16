// SPDX-License-Identifier: MIT
#include <oblique/solve/static_test.h>

#include <string_view>
#include <unordered_map>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/operating_point/settling.h>
#include <oblique/solve/operating_point/singular_start.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {

namespace {

void set_modes(const network::Program& program, network::Workspace& workspace, diagram::OperatingMode mode) {
  for (const std::uint32_t state : program.mode_states())
    workspace.set_discrete_state(state, static_cast<double>(mode));
}

/// Charges the capacitors that are charged through a resistor in initial condition, and only then: what moves
/// there, and otherwise than it would in operation.
void charge(const network::Program& program, network::Workspace& workspace, std::vector<double>& states) {
  std::vector<double> charging(program.n_states()), operating(program.n_states());
  set_modes(program, workspace, diagram::OperatingMode::operate);
  const bool operates = program.derivatives(0, states.data(), operating.data(), workspace);
  set_modes(program, workspace, diagram::OperatingMode::initial);
  if (!operates || !program.derivatives(0, states.data(), charging.data(), workspace)) return;
  StateGroups moving;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (charging[i] != 0 && charging[i] != operating[i] && !program.states()[i].at_rest)
      moving.push_back({i});
  }
  if (!moving.empty()) settle(program, workspace, 0, moving, states);
}

}  // namespace

std::vector<StaticReading> static_test(const network::Program& program, const std::string& file) {
  network::Workspace workspace(program);
  std::vector<double> states = program.start();
  set_modes(program, workspace, diagram::OperatingMode::initial);
  Switching switching(program, workspace, 1, 0, 0, file);
  switching.start(
      0, states, [&] { bring_to_rest(program, workspace, 0, states, file); }, true);
  charge(program, workspace, states);
  std::vector<double> outputs(program.n_signals()), derivatives(program.n_states());
  const bool has_outputs = switching.signals(0, states.data(), outputs.data()) ||
                           (hold_singular_start(program, workspace, 0, states, 1) &&
                            switching.signals(0, states.data(), outputs.data()));
  // What the integrators would do with their inputs: the first moment of "operate".
  set_modes(program, workspace, diagram::OperatingMode::operate);
  if (!has_outputs || !switching.derivatives(0, states.data(), derivatives.data())) {
    throw loop_error(program, workspace.trouble(), 0, file);
  }

  std::unordered_map<std::string_view, std::size_t> index;
  std::vector<StaticReading> readings;
  for (std::size_t s = 0; s < program.n_signals(); ++s) {
    index.emplace(program.signal_names()[s], s);
    readings.push_back({program.signal_names()[s], outputs[s], {}, false});
  }
  for (std::size_t i = 0; i < program.n_states(); ++i) {
    const network::State& state = program.states()[i];
    const auto found = index.find(state.name);
    if (found == index.end()) readings.push_back({state.name, states[i], {}, false});
    StaticReading& reading = found == index.end() ? readings.back() : readings[found->second];
    reading.derivative = derivatives[i];
    reading.at_rest = state.at_rest;
  }
  return readings;
}

}  // namespace oblique::solve
