// SPDX-License-Identifier: MIT
#include <oblique/solve/static_test.h>

#include <string_view>
#include <unordered_map>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/operating_point/singular_start.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {

std::vector<StaticReading> static_test(const network::Program& program, const std::string& file) {
  network::Workspace workspace(program);
  std::vector<double> states = program.start();
  for (const std::uint32_t mode : program.mode_states())
    workspace.set_discrete_state(mode, static_cast<double>(diagram::OperatingMode::initial));
  Switching switching(program, workspace, 1, 0, 0, file);
  switching.start(
      0, states, [&] { bring_to_rest(program, workspace, 0, states, file); }, true);
  std::vector<double> outputs(program.n_signals()), derivatives(program.n_states());
  const bool has_outputs = switching.signals(0, states.data(), outputs.data()) ||
                           (hold_singular_start(program, workspace, 0, states, 1) &&
                            switching.signals(0, states.data(), outputs.data()));
  // What the integrators would do with their inputs: the first moment of "operate".
  for (const std::uint32_t mode : program.mode_states())
    workspace.set_discrete_state(mode, static_cast<double>(diagram::OperatingMode::operate));
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
