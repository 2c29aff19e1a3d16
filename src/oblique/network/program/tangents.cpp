// SPDX-License-Identifier: MIT
#include <oblique/network/program/tangents.h>

#include <utility>

namespace oblique::network {

Tangents::Tangents(ExpressionGraph& graph, Rates rates) : graph_(graph), rates_(std::move(rates)) {}

bool Tangents::may_move(NodeId id) const {
  return graph_[id].continuous || rates_.discrete_state || rates_.parameter;
}

NodeId Tangents::of(NodeId root) {
  known_.resize(graph_.size(), kUnknown);
  branches_.resize(graph_.size(), false);
  std::vector<NodeId> pending{root};
  while (!pending.empty()) {
    const NodeId id = pending.back();
    const std::size_t before = pending.size();
    if (known_[id] == kUnknown && may_move(id)) {
      const Node node = graph_.with_operands(id);
      for (int i = 0; i < operand_count(node.op); ++i) {
        if (known_[node.operand(i)] == kUnknown) pending.push_back(node.operand(i));
      }
    }
    if (pending.size() > before) continue;  // and comes back
    pending.pop_back();
    if (known_[id] == kUnknown) differentiate(id);
  }
  return known_[root];
}

/// The operands are known. Below a `select` that is closed nothing moves, even where the derivative of what
/// reads it is no number.
void Tangents::differentiate(NodeId id) {
  const Node node = graph_.with_operands(id);
  const auto leaf = [&](const RateOf& rate_of, std::uint32_t number) {
    known_[id] = rate_of ? rate_of(number) : graph_.constant(0);
  };
  if (!may_move(id)) return leaf({}, 0);
  if (node.op == Op::variable) return leaf(rates_.variable, node.variable);
  if (node.op == Op::discrete_state) return leaf(rates_.discrete_state, node.variable);
  if (node.op == Op::constant) {
    const ConstantFormula* const formula = graph_.formula_of(id);
    return formula == nullptr ? leaf({}, 0) : leaf(rates_.parameter, formula->parameter);
  }
  bool branches = node.op == Op::select;
  for (int i = 0; i < operand_count(node.op); ++i) branches = branches || branches_[node.operand(i)];
  branches_[id] = branches;
  if (node.op == Op::select) {
    known_[id] = graph_.apply(Op::select, node.a, known_[node.b], known_[node.c]);
    return;
  }
  NodeId sum = graph_.constant(0);
  for (int i = 0; i < operand_count(node.op); ++i) {
    const NodeId tangent = known_[node.operand(i)];
    if (graph_.is_constant(tangent, 0)) continue;
    const NodeId derivative = graph_.partial(id, i);
    const Op by = branches && !graph_.has_value_everywhere(id, derivative) ? Op::gate : Op::multiply;
    sum = graph_.apply(Op::add, sum, graph_.apply(by, tangent, derivative));
  }
  known_[id] = sum;
}

}  // namespace oblique::network
