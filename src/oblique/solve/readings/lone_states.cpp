// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/lone_states.h>

#include <algorithm>
#include <cstdint>

namespace oblique::solve {
namespace {

std::optional<std::size_t> lone_state_below(const network::SwitchStructure& structure, network::NodeId node) {
  constexpr std::uint32_t kNone = network::SwitchStructure::kNone;
  constexpr std::size_t kMostNodes = 100;  // of a short expression: a long one reads more
  std::optional<std::size_t> found;
  std::vector<std::uint32_t> nodes{static_cast<std::uint32_t>(node)};
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::uint32_t id = nodes[k];
    if (nodes.size() > kMostNodes || structure.switch_at[id] != kNone ||
        structure.discrete_state_at[id] != kNone || structure.loop_at[id] != kNone)
      return std::nullopt;
    if (const std::uint32_t state = structure.state_at[id]; state != kNone) {
      if (found && *found != state) return std::nullopt;
      found = state;
    }
    for (std::uint32_t o = structure.first_operand[id]; o < structure.first_operand[id + 1]; ++o)
      nodes.push_back(structure.operands[o]);
  }
  return found;
}

}  // namespace

std::vector<std::optional<std::size_t>> lone_states(const network::Program& program) {
  const network::SwitchStructure& structure = program.switch_structure();
  std::vector<std::optional<std::size_t>> found;
  for (const std::vector<std::uint32_t>& members : structure.members)
    found.push_back(lone_state_below(structure, structure.event_functions[members.front()]));
  return found;
}

}  // namespace oblique::solve
