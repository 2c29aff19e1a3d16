// SPDX-License-Identifier: MIT
#include <oblique/network/program/compilation.h>

namespace oblique::network {

Compilation::Compilation(Network made) : network(std::move(made)) {
  loop_of_unknown.resize(network.unknowns.size());
  place_in_loop.resize(network.unknowns.size());
  for (std::size_t l = 0; l < network.loops.size(); ++l) {
    const auto& unknowns = network.loops[l].unknowns;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      loop_of_unknown[unknowns[i]] = static_cast<std::uint32_t>(l);
      place_in_loop[unknowns[i]] = static_cast<std::uint32_t>(i);
    }
  }
}

Compilation::Needs Compilation::no_needs() const {
  return {std::vector<bool>(network.graph.size()), std::vector<bool>(network.loops.size())};
}

void Compilation::require_loop(std::size_t loop, Needs& needs, std::vector<NodeId>& pending) const {
  if (needs.loops[loop]) return;
  needs.loops[loop] = true;
  for (const std::size_t u : network.loops[loop].unknowns) {
    pending.push_back(network.unknowns[u].residual);
    for (const auto& [variable, node] : residual_gradients[u]) {
      if (is_unknown(variable) && loop_of_unknown[unknown_of(variable)] == loop) pending.push_back(node);
    }
  }
}

void Compilation::close_over(NodeId root, Needs& needs) const {
  std::vector<NodeId> pending{root};
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    if (needs.nodes[id]) continue;
    needs.nodes[id] = true;
    const Node& node = network.graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) pending.push_back(node.operand(i));
    if (node.op == Op::variable && is_unknown(node.variable)) {
      require_loop(loop_of_unknown[unknown_of(node.variable)], needs, pending);
    }
  }
}

NodeId Compilation::compared_side(const Switch& s) const {
  const Node& node = network.graph[s.event_function];
  return node.op == Op::subtract || node.op == Op::add ? node.b : s.event_function;
}

}  // namespace oblique::network
