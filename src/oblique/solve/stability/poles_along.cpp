// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/poles_along.h>

#include <oblique/solve/operating_point/ideal_machine.h>

namespace oblique::solve {

std::vector<PoleAt> poles_along(const diagram::FlatDiagram& diagram, const network::Program& program,
                                const std::vector<Instant>& instants) {
  std::vector<PoleAt> poles;
  const std::vector<std::vector<std::size_t>> groups = coupled_groups(program);
  IdealMachine ideal(diagram, program);
  network::Workspace workspace(program);
  for (const Instant& instant : instants) {
    const auto linear = Linearisation::at(program, workspace, instant);
    if (!linear) continue;
    ideal.look_at(instant, workspace);
    for (const std::vector<std::size_t>& group : groups) {
      if (group.size() > kMostStatesForModes) continue;
      const std::vector<Mode> modes = modes_of(linear->block(group), group);
      const auto of_problem = ideal.problem_modes(group, modes);
      for (std::size_t m = 0; m < modes.size(); ++m) {
        poles.push_back(
            {instant.t, modes[m].pole, modes[m].participants.front().state, of_problem[m].has_value()});
      }
    }
  }
  return poles;
}

}  // namespace oblique::solve
