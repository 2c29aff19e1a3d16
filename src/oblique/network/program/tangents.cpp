// SPDX-License-Identifier: MIT
#include <oblique/network/program/tangents.h>

#include <utility>

namespace oblique::network {

Tangents::Tangents(ExpressionGraph& graph, std::function<NodeId(std::uint32_t)> rate_of)
    : graph_(graph), rate_of_(std::move(rate_of)) {}

NodeId Tangents::of(NodeId root) {
  known_.resize(graph_.size(), kUnknown);
  branches_.resize(graph_.size(), false);
  std::vector<NodeId> pending{root};
  while (!pending.empty()) {
    const NodeId id = pending.back();
    const std::size_t before = pending.size();
    if (known_[id] == kUnknown && graph_[id].continuous) {
      const Node& node = graph_[id];
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
  const Node node = graph_[id];  // a copy: new nodes may move the array
  if (!node.continuous) {
    known_[id] = graph_.constant(0);
    return;
  }
  if (node.op == Op::variable) {
    known_[id] = rate_of_(node.variable);
    return;
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
