// SPDX-License-Identifier: MIT
#include <oblique/network/program/switch_order.h>

#include <algorithm>

#include <oblique/network/graph/dependency_order.h>

namespace oblique::network {
namespace {

/// What must be known before a switch can be decided.
std::vector<NodeId> grounds_of(const Compilation& c, std::size_t s) {
  const Switch& made = c.network.switches[s];
  return {made.event_function, c.compared_side(made), c.event_function_rates[s]};
}

/// The nodes below the event functions of `ordered`, each after what it needs: also the positions of
/// `ordered`, after their grounds. Several that need each other are one step.
std::vector<OrderStep> order_of_positions(const Compilation& c, const std::vector<bool>& ordered) {
  const ExpressionGraph& graph = c.network.graph;
  std::vector<std::uint32_t> switch_at(graph.size(), SwitchStructure::kNone);
  std::vector<bool> needed(graph.size(), false);
  for (std::size_t s = 0; s < c.positions.size(); ++s) {
    if (!ordered[s]) continue;
    switch_at[c.positions[s]] = static_cast<std::uint32_t>(s);
    needed[c.positions[s]] = true;
    for (const NodeId ground : grounds_of(c, s)) needed[ground] = true;
  }
  Dependencies dependencies;
  std::vector<std::vector<std::uint32_t>> rows(graph.size());
  for (auto id = static_cast<NodeId>(graph.size()); id-- > 0;) {
    if (!needed[id]) continue;
    const Node& node = graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) {
      needed[node.operand(i)] = true;
      rows[id].push_back(node.operand(i));
    }
    if (switch_at[id] != SwitchStructure::kNone) rows[id] = grounds_of(c, switch_at[id]);
  }
  for (const auto& row : rows) dependencies.add_row(row);
  std::vector<OrderStep> steps = dependency_order(dependencies, std::vector<bool>(graph.size(), true));
  std::erase_if(steps, [&](const OrderStep& step) { return !needed[step.tears.front()]; });
  return steps;
}

}  // namespace

void find_positions(Compilation& c) {
  for (const Switch& s : c.network.switches)
    c.positions.push_back(c.network.graph.discrete_state(s.discrete_state));
}

void write_switch_order(Compilation& c) {
  const ExpressionGraph& graph = c.network.graph;
  std::vector<bool>& ordered = c.code.is_ordered;
  for (std::size_t s = 0; s < c.positions.size(); ++s) {
    const std::vector<NodeId> grounds = grounds_of(c, s);
    ordered.push_back(
        std::all_of(grounds.begin(), grounds.end(), [&](NodeId id) { return c.levels[id] == 0; }));
  }
  std::vector<std::uint32_t> switch_at(graph.size(), SwitchStructure::kNone);
  for (std::size_t s = 0; s < c.positions.size(); ++s)
    switch_at[c.positions[s]] = static_cast<std::uint32_t>(s);
  for (const OrderStep& step : order_of_positions(c, ordered)) {
    if (step.tears.size() == 1) continue;
    for (const NodeId id : step.tears) {
      if (switch_at[id] != SwitchStructure::kNone) ordered[switch_at[id]] = false;
    }
  }
  std::vector<NodeId> segment;
  for (const OrderStep& step : order_of_positions(c, ordered)) {
    const NodeId id = step.tears.front();
    if (operand_count(graph[id].op) > 0) segment.push_back(id);
    if (switch_at[id] == SwitchStructure::kNone || !ordered[switch_at[id]]) continue;
    c.code.switch_order.push_back({c.writer->write(segment), switch_at[id]});
    segment.clear();
  }
}

void write_pieces(Compilation& c) {
  const ExpressionGraph& graph = c.network.graph;
  Compilation::Needs read{std::vector<bool>(graph.size()), std::vector<bool>(c.network.loops.size())};
  for (const State& state : c.network.states) c.close_over(state.derivative, read);
  for (const Switch& s : c.network.switches) c.close_over(s.event_function, read);
  // Of a node the switch whose position it is, or 1 − its position.
  std::vector<std::uint32_t> chooses(graph.size(), SwitchStructure::kNone);
  std::vector<bool> otherwise(c.positions.size(), false);
  c.code.pieces.resize(c.positions.size());
  for (std::size_t s = 0; s < c.positions.size(); ++s)
    chooses[c.positions[s]] = static_cast<std::uint32_t>(s);
  const auto read_by = [&](NodeId id) {
    if (chooses[id] != SwitchStructure::kNone) otherwise[chooses[id]] = true;
  };
  for (NodeId id = 0; id < graph.size(); ++id) {
    if (!read.nodes[id]) continue;
    const Node& node = graph[id];
    const bool inverse = node.op == Op::subtract && graph.is_constant(node.a, 1);
    if (inverse && chooses[node.b] != SwitchStructure::kNone) {
      chooses[id] = chooses[node.b];
      continue;
    }
    for (int i = 0; i < operand_count(node.op); ++i) {
      const std::uint32_t s = chooses[node.operand(i)];
      if (node.op == Op::select && i == 0 && s != SwitchStructure::kNone) {
        c.code.pieces[s].emplace_back(c.writer->slot(node.b), c.writer->slot(node.c));
      } else {
        read_by(node.operand(i));
      }
    }
  }
  for (const State& state : c.network.states) read_by(state.derivative);
  for (const Switch& s : c.network.switches) read_by(s.event_function);
  // What makes events is told by the position itself.
  std::vector<NodeId> pending = c.network.phase_ends;
  for (const Event& event : c.network.events) pending.push_back(event.condition);
  std::vector<bool> seen(graph.size(), false);
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    if (seen[id]) continue;
    seen[id] = true;
    read_by(id);
    for (int i = 0; i < operand_count(graph[id].op); ++i) pending.push_back(graph[id].operand(i));
  }
  c.code.has_pieces.resize(c.positions.size());
  for (std::size_t s = 0; s < c.positions.size(); ++s) c.code.has_pieces[s] = !otherwise[s];
}

}  // namespace oblique::network
