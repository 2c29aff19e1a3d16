// SPDX-License-Identifier: MIT
#include <oblique/network/graph/expression_graph.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include <oblique/text/expression.h>

namespace oblique::network {

int operand_count(Op op) {
  switch (op) {
    case Op::constant:
    case Op::variable:
    case Op::memory:
      return 0;
    case Op::add:
    case Op::subtract:
    case Op::multiply:
    case Op::divide:
    case Op::power:
    case Op::atan2:
    case Op::hypot:
    case Op::noise:
    case Op::noise_slope:
    case Op::gate:
    case Op::less:
    case Op::less_equal:
    case Op::equal:
    case Op::table_slope:
    case Op::table_end:
    case Op::table_begin:
    case Op::table_segment:
      return 2;
    case Op::select:
    case Op::table_value:
      return 3;
    default:
      return 1;
  }
}

double evaluate(Op op, double a, double b) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::power:
      return std::pow(a, b);
    case Op::negate:
      return -a;
    case Op::sin:
      return std::sin(a);
    case Op::cos:
      return std::cos(a);
    case Op::tan:
      return std::tan(a);
    case Op::asin:
      return std::asin(a);
    case Op::acos:
      return std::acos(a);
    case Op::atan:
      return std::atan(a);
    case Op::atan2:
      return std::atan2(a, b);
    case Op::exp:
      return std::exp(a);
    case Op::log:
      return std::log(a);
    case Op::sqrt:
      return std::sqrt(a);
    case Op::hypot:
      return std::hypot(a, b);
    case Op::noise:
      return text::noise(a, b, 0);
    case Op::noise_slope:
      return text::noise(a, b, 1);
    case Op::gate:
      return a == 0 ? 0 : a * b;
    case Op::less:
      return a < b ? 1 : 0;
    case Op::less_equal:
      return a <= b ? 1 : 0;
    case Op::equal:
      return a == b ? 1 : 0;
    default:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double select(double chosen, double b, double c) {
  if (chosen == 1) return b;
  if (chosen == 0) return c;
  return c + chosen * (b - c);
}

std::size_t ExpressionGraph::Hash::operator()(const Key& key) const {
  std::uint64_t h =
      (static_cast<std::uint64_t>(key.a) << 32) ^ key.b ^ (static_cast<std::uint64_t>(key.op) << 58);
  h ^= static_cast<std::uint64_t>(key.c) * 0xD6E8FEB86659FD93ULL;
  h ^= key.bits * 0x9E3779B97F4A7C15ULL;
  h = (h ^ (h >> 31)) * 0xBF58476D1CE4E5B9ULL;
  return static_cast<std::size_t>(h ^ (h >> 29));
}

NodeId ExpressionGraph::intern(const Node& node) {
  Key key{node.op, node.a, node.b, node.c, node.variable};
  if (node.op == Op::constant) key.bits = std::bit_cast<std::uint64_t>(node.value);
  const auto [found, inserted] = index_.try_emplace(key, static_cast<NodeId>(nodes_.size()));
  if (inserted) nodes_.push_back(node);
  return found->second;
}

NodeId ExpressionGraph::constant(double value) {
  Node node;
  node.value = value == 0 ? 0.0 : value;  // one zero, not two
  return intern(node);
}

NodeId ExpressionGraph::variable(std::uint32_t number) {
  Node node;
  node.op = Op::variable;
  node.variable = number;
  node.continuous = true;
  return intern(node);
}

NodeId ExpressionGraph::memory(std::uint32_t number) {
  Node node;
  node.op = Op::memory;
  node.variable = number;
  return intern(node);
}

NodeId ExpressionGraph::simplified(Op op, NodeId a, NodeId b, NodeId c, bool& done) {
  done = true;
  switch (op) {
    case Op::select:
      if (is_constant(a)) return nodes_[a].value != 0 ? b : c;
      if (b == c) return b;
      break;
    case Op::gate:
      if (is_constant(a, 0) || is_constant(b, 0)) return constant(0);
      if (is_constant(b)) return apply(Op::multiply, a, b);
      break;
    case Op::add:
      if (is_constant(a, 0)) return b;
      if (is_constant(b, 0)) return a;
      if (nodes_[b].op == Op::negate) return apply(Op::subtract, a, nodes_[b].a);
      if (nodes_[a].op == Op::negate) return apply(Op::subtract, b, nodes_[a].a);
      break;
    case Op::subtract:
      if (is_constant(b, 0)) return a;
      if (is_constant(a, 0)) return apply(Op::negate, b);
      if (a == b) return constant(0);
      if (nodes_[b].op == Op::negate) return apply(Op::add, a, nodes_[b].a);
      break;
    case Op::multiply:
      if (is_constant(a, 0) || is_constant(b, 0)) return constant(0);
      if (is_constant(a, 1)) return b;
      if (is_constant(b, 1)) return a;
      if (is_constant(a, -1)) return apply(Op::negate, b);
      if (is_constant(b, -1)) return apply(Op::negate, a);
      if (nodes_[a].op == Op::negate) return apply(Op::negate, apply(Op::multiply, nodes_[a].a, b));
      if (nodes_[b].op == Op::negate) return apply(Op::negate, apply(Op::multiply, a, nodes_[b].a));
      if (is_constant(a) && nodes_[b].op == Op::multiply && is_constant(nodes_[b].a)) {
        return apply(Op::multiply, constant(nodes_[a].value * nodes_[nodes_[b].a].value), nodes_[b].b);
      }
      break;
    case Op::divide:
      if (is_constant(b, 1)) return a;
      if (is_constant(a, 0)) return a;
      break;
    case Op::power:
      if (is_constant(b, 0)) return constant(1);
      if (is_constant(b, 1)) return a;
      if (is_constant(b, 2)) return apply(Op::multiply, a, a);
      break;
    case Op::negate:
      if (nodes_[a].op == Op::negate) return nodes_[a].a;
      if (nodes_[a].op == Op::subtract) return apply(Op::subtract, nodes_[a].b, nodes_[a].a);
      break;
    default:
      break;
  }
  done = false;
  return 0;
}

NodeId ExpressionGraph::apply(Op op, NodeId a, NodeId b, NodeId c) {
  const int operands = operand_count(op);
  if (operands < 2) b = 0;
  if (operands < 3) c = 0;
  const bool has_value = op < Op::table_value && op != Op::select;  // of constants; tables come with the tape
  if (has_value && is_constant(a) && (operands < 2 || is_constant(b))) {
    return constant(evaluate(op, nodes_[a].value, nodes_[b].value));
  }
  // A product keeps its constant in front and a commutative pair has one order, so that equal ones meet.
  const bool commutative = op == Op::add || op == Op::multiply || op == Op::hypot;
  if (commutative && !is_constant(a) && (is_constant(b) || b < a)) std::swap(a, b);
  bool done = false;
  const NodeId simple = simplified(op, a, b, c, done);
  if (done) return simple;
  Node node;
  node.op = op;
  node.a = a;
  node.b = b;
  node.c = c;
  for (int i = 0; i < operands; ++i) node.continuous = node.continuous || nodes_[node.operand(i)].continuous;
  return intern(node);
}

/// Below a `select` that is closed the derivative is 0, even where the branch has no value there.
NodeId ExpressionGraph::passed_on(NodeId adjoint, NodeId id, int operand) {
  const Node node = nodes_[id];  // a copy: new nodes may move the array
  if (node.op == Op::select && operand > 0) {
    return operand == 1 ? apply(Op::select, node.a, adjoint, constant(0))
                        : apply(Op::select, node.a, constant(0), adjoint);
  }
  const NodeId slope = partial(id, operand);
  const Op by = nodes_[adjoint].op;
  const bool gated = by == Op::select || by == Op::gate;
  return apply(gated && !has_value_everywhere(id, slope) ? Op::gate : Op::multiply, adjoint, slope);
}

bool ExpressionGraph::has_value_everywhere(NodeId id, NodeId slope) const {
  const Op op = nodes_[id].op;
  return op == Op::add || op == Op::subtract || op == Op::negate || is_constant(slope);
}

NodeId ExpressionGraph::partial(NodeId id, int operand) {
  const Node node = nodes_[id];  // a copy: new nodes may move the array
  const NodeId a = node.a, b = node.b;
  const bool first = operand == 0;
  switch (node.op) {
    case Op::add:
      return constant(1);
    case Op::subtract:
      return constant(first ? 1 : -1);
    case Op::multiply:
      return first ? b : a;
    case Op::divide: {
      const NodeId inverse = apply(Op::divide, constant(1), b);
      return first ? inverse : apply(Op::negate, apply(Op::multiply, id, inverse));
    }
    case Op::power: {
      if (first) return apply(Op::multiply, b, apply(Op::power, a, apply(Op::subtract, b, constant(1))));
      return apply(Op::multiply, id, apply(Op::log, a));
    }
    case Op::negate:
      return constant(-1);
    case Op::sin:
      return apply(Op::cos, a);
    case Op::cos:
      return apply(Op::negate, apply(Op::sin, a));
    case Op::tan:
      return apply(Op::add, constant(1), apply(Op::multiply, id, id));
    case Op::asin:
    case Op::acos: {
      const NodeId root = apply(Op::sqrt, apply(Op::subtract, constant(1), apply(Op::multiply, a, a)));
      return apply(Op::divide, constant(node.op == Op::asin ? 1 : -1), root);
    }
    case Op::atan:
      return apply(Op::divide, constant(1), apply(Op::add, constant(1), apply(Op::multiply, a, a)));
    case Op::atan2: {
      const NodeId square = apply(Op::add, apply(Op::multiply, a, a), apply(Op::multiply, b, b));
      return first ? apply(Op::divide, b, square) : apply(Op::negate, apply(Op::divide, a, square));
    }
    case Op::exp:
      return id;
    case Op::log:
      return apply(Op::divide, constant(1), a);
    case Op::sqrt:
      return apply(Op::divide, constant(0.5), id);
    case Op::hypot:
      return apply(Op::divide, first ? a : b, id);
    case Op::noise:
      return first ? apply(Op::noise_slope, a, b) : constant(0);
    case Op::table_value:
      return first ? apply(Op::table_slope, b, node.c) : constant(0);
    default:  // switches, steps and tables: nothing but events changes them; of `noise_slope` nothing is
              // asked
      break;
  }
  return constant(0);
}

std::vector<std::pair<std::uint32_t, NodeId>> ExpressionGraph::gradient(NodeId root) {
  // Operands have smaller indices than their users, so a descending walk meets every user before its
  // operands.
  std::map<NodeId, NodeId, std::greater<>> adjoints{{root, constant(1)}};
  std::vector<std::pair<std::uint32_t, NodeId>> partials;
  while (!adjoints.empty()) {
    const auto [id, adjoint] = *adjoints.begin();
    adjoints.erase(adjoints.begin());
    const Node node = nodes_[id];
    if (node.op == Op::variable) {
      if (!is_constant(adjoint, 0)) partials.emplace_back(node.variable, adjoint);
      continue;
    }
    for (int operand = 0; operand < operand_count(node.op); ++operand) {
      const NodeId child = node.operand(operand);
      if (!nodes_[child].continuous) continue;
      const NodeId contribution = passed_on(adjoint, id, operand);
      const auto [found, inserted] = adjoints.try_emplace(child, contribution);
      if (!inserted) found->second = apply(Op::add, found->second, contribution);
    }
  }
  std::sort(partials.begin(), partials.end());
  return partials;
}

}  // namespace oblique::network
