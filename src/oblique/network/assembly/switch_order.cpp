// SPDX-License-Identifier: MIT
// The part of ProgramCompiler that puts switches in the order in which their positions follow from each
// other, and finds between what they choose.
#include <algorithm>

#include <oblique/network/graph/dependency_order.h>
#include <oblique/network/program/program_compiler.h>

namespace oblique::network {

/// The position of each switch that an evaluation may come to is a node, whether anything reads it or not.
void ProgramCompiler::find_positions() {
  for (const Switch& s : network_.switches) positions_.push_back(network_.graph.memory(s.memory));
}

/// What must be known before a switch can be decided.
std::vector<NodeId> ProgramCompiler::grounds_of(std::size_t s) const {
  const Switch& made = network_.switches[s];
  return {made.surface, compared_side(made), surface_rates_[s]};
}

/// The nodes below the surfaces of `ordered`, each after what it needs: also the positions of `ordered`,
/// after their grounds. Several that need each other are one step.
std::vector<OrderStep> ProgramCompiler::order_of_positions(const std::vector<bool>& ordered) const {
  const ExpressionGraph& graph = network_.graph;
  std::vector<std::uint32_t> switch_at(graph.size(), kNoSwitch);
  std::vector<bool> needed(graph.size(), false);
  for (std::size_t s = 0; s < positions_.size(); ++s) {
    if (!ordered[s]) continue;
    switch_at[positions_[s]] = static_cast<std::uint32_t>(s);
    needed[positions_[s]] = true;
    for (const NodeId ground : grounds_of(s)) needed[ground] = true;
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
    if (switch_at[id] != kNoSwitch) rows[id] = grounds_of(switch_at[id]);
  }
  for (const auto& row : rows) dependencies.add_row(row);
  std::vector<OrderStep> steps = dependency_order(dependencies, std::vector<bool>(graph.size(), true));
  std::erase_if(steps, [&](const OrderStep& step) { return !needed[step.tears.front()]; });
  return steps;
}

/// Leaves out what follows from algebraic loops, and what depends on its own position.
void ProgramCompiler::write_switch_order() {
  const ExpressionGraph& graph = network_.graph;
  std::vector<bool>& ordered = program_.is_ordered_;
  for (std::size_t s = 0; s < positions_.size(); ++s) {
    const std::vector<NodeId> grounds = grounds_of(s);
    ordered.push_back(
        std::all_of(grounds.begin(), grounds.end(), [&](NodeId id) { return levels_[id] == 0; }));
  }
  std::vector<std::uint32_t> switch_at(graph.size(), kNoSwitch);
  for (std::size_t s = 0; s < positions_.size(); ++s)
    switch_at[positions_[s]] = static_cast<std::uint32_t>(s);
  for (const OrderStep& step : order_of_positions(ordered)) {
    if (step.tears.size() == 1) continue;
    for (const NodeId id : step.tears) {
      if (switch_at[id] != kNoSwitch) ordered[switch_at[id]] = false;
    }
  }
  std::vector<NodeId> stretch;
  for (const OrderStep& step : order_of_positions(ordered)) {
    const NodeId id = step.tears.front();
    if (operand_count(graph[id].op) > 0) stretch.push_back(id);
    if (switch_at[id] == kNoSwitch || !ordered[switch_at[id]]) continue;
    program_.switch_order_.push_back({writer_->write(stretch), switch_at[id]});
    stretch.clear();
  }
}

/// Of each switch the two pieces between which each `select` chooses by its position, as far as the equations
/// read them; nothing where its position is read in another way.
void ProgramCompiler::write_pieces() {
  const ExpressionGraph& graph = network_.graph;
  Needs read{std::vector<bool>(graph.size()), std::vector<bool>(network_.loops.size())};
  for (const State& state : network_.states) close_over(state.derivative, read);
  for (const Switch& s : network_.switches) close_over(s.surface, read);
  // Of a node the switch whose position it is, or 1 − its position.
  std::vector<std::uint32_t> chooses(graph.size(), kNoSwitch);
  std::vector<bool> otherwise(positions_.size(), false);
  program_.pieces_.resize(positions_.size());
  for (std::size_t s = 0; s < positions_.size(); ++s) chooses[positions_[s]] = static_cast<std::uint32_t>(s);
  const auto read_by = [&](NodeId id) {
    if (chooses[id] != kNoSwitch) otherwise[chooses[id]] = true;
  };
  for (NodeId id = 0; id < graph.size(); ++id) {
    if (!read.nodes[id]) continue;
    const Node& node = graph[id];
    const bool inverse = node.op == Op::subtract && graph.is_constant(node.a, 1);
    if (inverse && chooses[node.b] != kNoSwitch) {
      chooses[id] = chooses[node.b];
      continue;
    }
    for (int i = 0; i < operand_count(node.op); ++i) {
      const std::uint32_t s = chooses[node.operand(i)];
      if (node.op == Op::select && i == 0 && s != kNoSwitch) {
        program_.pieces_[s].emplace_back(writer_->slot(node.b), writer_->slot(node.c));
      } else {
        read_by(node.operand(i));
      }
    }
  }
  for (const State& state : network_.states) read_by(state.derivative);
  for (const Switch& s : network_.switches) read_by(s.surface);
  // What makes events is told by the position itself.
  std::vector<NodeId> pending = network_.phase_ends;
  for (const Event& event : network_.events) pending.push_back(event.condition);
  std::vector<bool> seen(graph.size(), false);
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    if (seen[id]) continue;
    seen[id] = true;
    read_by(id);
    for (int i = 0; i < operand_count(graph[id].op); ++i) pending.push_back(graph[id].operand(i));
  }
  program_.has_pieces_.resize(positions_.size());
  for (std::size_t s = 0; s < positions_.size(); ++s) program_.has_pieces_[s] = !otherwise[s];
}

}  // namespace oblique::network
