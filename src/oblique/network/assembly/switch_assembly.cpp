// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/switch_assembly.h>

#include <oblique/text/expression_printer.h>
#include <algorithm>
#include <utility>

namespace oblique::network {
namespace {

bool follows_time_alone(Assembly& a, NodeId id) {
  const ExpressionGraph& graph = a.network.graph;
  for (auto next = static_cast<NodeId>(a.beside_time.size()); next <= id; ++next) {
    const Node& node = graph[next];
    bool beside = node.op == Op::variable && node.variable != 0;
    for (int i = 0; i < operand_count(node.op); ++i) beside = beside || a.beside_time[node.operand(i)];
    a.beside_time.push_back(beside);
  }
  return graph[id].continuous && !a.beside_time[id];
}

/// d(event function)/dt where nothing but time enters and that rate is constant between events.
std::optional<NodeId> rate_of(Assembly& a, NodeId event_function) {
  if (!follows_time_alone(a, event_function)) return std::nullopt;
  const NodeId rate = a.rates_by_time.of(event_function);
  if (a.network.graph[rate].continuous || a.network.graph.is_constant(rate, 0)) return std::nullopt;
  return rate;
}

}  // namespace

NodeId switch_of(Assembly& a, std::size_t block, const text::Expression& left, const text::Expression& right,
                 Turning turning) {
  std::string text = text::to_string(left) + " > " + text::to_string(right);
  const auto added = a.switch_index.try_emplace(std::pair(block, text), kNone);
  std::uint32_t& discrete_state = added.first->second;
  if (added.second) {
    discrete_state = static_cast<std::uint32_t>(a.network.discrete_states.size());
    a.network.discrete_states.push_back({std::move(text), 0});
    a.pending_switches.push_back(
        {block, left, right, discrete_state, a.diagram.blocks[block].place, turning});
  } else {
    const auto pending =
        std::find_if(a.pending_switches.begin(), a.pending_switches.end(),
                     [&](const Assembly::PendingSwitch& p) { return p.discrete_state == discrete_state; });
    if (pending != a.pending_switches.end()) pending->turning = std::max(pending->turning, turning);
  }
  return a.network.graph.discrete_state(discrete_state);
}

void add_switch(Assembly& a, Switch made) {
  made.rate = rate_of(a, made.event_function);
  a.network.discrete_states[made.discrete_state].name = made.block + ": " + made.comparison;
  a.network.switches.push_back(std::move(made));
}

void define_switches(Assembly& a) {
  std::size_t next = 0;
  while (next < a.pending_switches.size()) {
    const Assembly::PendingSwitch pending = a.pending_switches[next++];
    const NodeId left = a.built(pending.block, pending.left, pending.place, "a comparison");
    const NodeId right = a.built(pending.block, pending.right, pending.place, "a comparison");
    Switch made;
    made.discrete_state = pending.discrete_state;
    made.block = a.diagram.blocks[pending.block].path;
    made.comparison = a.network.discrete_states[pending.discrete_state].name;
    made.event_function = a.network.graph.apply(Op::subtract, left, right);
    made.turning = pending.turning;
    if (const auto& interval = a.diagram.blocks[pending.block].definition->check_interval)
      made.check_interval = a.constant_value(pending.block, *interval).value_or(made.check_interval);
    add_switch(a, std::move(made));
  }
}

}  // namespace oblique::network
