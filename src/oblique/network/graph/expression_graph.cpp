// SPDX-License-Identifier: MIT
#include <oblique/network/graph/expression_graph.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include <oblique/text/partial_derivative.h>

namespace oblique::network {
namespace {

/// A node as what the table of operations writes derivatives of.
struct Term {
  ExpressionGraph* graph;
  NodeId id;

  Term number(double value) const { return {graph, graph->constant(value)}; }
  Term apply(text::Operation operation, const Term& second) const {
    return {graph, graph->apply(op_of(operation), id, second.id)};
  }
};

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

Op op_of(text::Operation operation) {
  switch (operation) {
#define OBLIQUE_OPERATION(name, ...) \
  case text::Operation::name:        \
    return Op::name;
#include <oblique/text/operations.def>
  }
  return Op::constant;  // there is no other operation
}

std::optional<text::Operation> smooth_operation(Op op) {
  switch (op) {
#define OBLIQUE_OPERATION(name, ...) \
  case Op::name:                     \
    return text::Operation::name;
#include <oblique/text/operations.def>
    case Op::constant:
    case Op::variable:
    case Op::discrete_state:
    case Op::select:
    case Op::gate:
    case Op::less:
    case Op::less_equal:
    case Op::equal:
    case Op::table_value:
    case Op::table_slope:
    case Op::table_end:
    case Op::table_begin:
    case Op::table_segment:
      break;
  }
  return std::nullopt;
}

int operand_count(Op op) {
  switch (op) {
#define OBLIQUE_OPERATION(name, operands, ...) \
  case Op::name:                               \
    return operands;
#include <oblique/text/operations.def>
    case Op::constant:
    case Op::variable:
    case Op::discrete_state:
      break;
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
  }
  return 0;
}

double evaluate(Op op, double a, double b) {
  switch (op) {
#define OBLIQUE_OPERATION(name, ...) \
  case Op::name:                     \
    return text::evaluate(text::Operation::name, a, b);
#include <oblique/text/operations.def>
    case Op::gate:
      return a == 0 ? 0 : a * b;
    case Op::less:
      return a < b ? 1 : 0;
    case Op::less_equal:
      return a <= b ? 1 : 0;
    case Op::equal:
      return a == b ? 1 : 0;
    case Op::constant:
    case Op::variable:
    case Op::discrete_state:
    case Op::select:
    case Op::table_value:
    case Op::table_slope:
    case Op::table_end:
    case Op::table_begin:
    case Op::table_segment:
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
  if (node.op == Op::constant) key.bits = bits_of(node.value);
  const auto [found, inserted] = index_.try_emplace(key, static_cast<NodeId>(nodes_.size()));
  if (inserted) nodes_.push_back(node);
  return found->second;
}

NodeId ExpressionGraph::constant(double value) {
  Node node;
  node.value = value == 0 ? 0.0 : value;  // one zero, not two
  return intern(node);
}

ConstantKind kind_of(double value) {
  if (std::isnan(value)) return ConstantKind::no_number;
  if (std::isinf(value)) return value > 0 ? ConstantKind::infinity : ConstantKind::minus_infinity;
  if (value == 0) return ConstantKind::zero;
  if (value < 0) return value == -1 ? ConstantKind::minus_one : ConstantKind::negative;
  return value == 1 ? ConstantKind::one : value == 2 ? ConstantKind::two : ConstantKind::positive;
}

bool stays(Decided decided, double before, double now) {
  switch (decided) {
    case Decided::nothing:
      return true;
    case Decided::kind:
      return kind_of(before) == kind_of(now);
    case Decided::value:
      break;
  }
  return bits_of(before) == bits_of(now);
}

NodeId ExpressionGraph::intern(const ConstantFormula& formula, double value) {
  const bool leaf = formula.parameter != ConstantFormula::kNoParameter;
  const Key key{formula.op, leaf ? formula.parameter + 1 : formula.a, formula.b, 0, 0};
  const auto [found, inserted] = index_.try_emplace(key, static_cast<NodeId>(nodes_.size()));
  if (!inserted) return found->second;
  formulas_.push_back(formula);
  formulas_.back().node = found->second;
  Node node;
  node.value = value == 0 ? 0.0 : value;
  node.variable = static_cast<std::uint32_t>(formulas_.size());
  nodes_.push_back(node);
  return found->second;
}

NodeId ExpressionGraph::parameter(std::uint32_t number, double value) {
  ConstantFormula formula;
  formula.parameter = number;
  formula.held = held_.contains(number);
  if (formula.held) formula.decided = Decided::nothing;
  return intern(formula, value);
}

NodeId ExpressionGraph::folded(Op op, NodeId a, NodeId b) {
  const double value = evaluate(op, nodes_[a].value, nodes_[b].value);
  const bool follows = nodes_[a].variable != 0 || (operand_count(op) == 2 && nodes_[b].variable != 0);
  if (!follows) return constant(value);
  ConstantFormula formula;
  formula.op = op;
  formula.a = a;
  formula.b = operand_count(op) == 2 ? b : a;
  formula.held = follows_held(a) || follows_held(formula.b);
  if (formula.held) formula.decided = Decided::nothing;
  return intern(formula, value);
}

const ConstantFormula* ExpressionGraph::formula_of(NodeId id) const {
  const Node& node = nodes_[id];
  return node.op == Op::constant && node.variable != 0 ? &formulas_[node.variable - 1] : nullptr;
}

Node ExpressionGraph::with_operands(NodeId id) const {
  Node node = nodes_[id];
  const ConstantFormula* const formula = formula_of(id);
  if (formula == nullptr || formula->op == Op::constant) return node;
  node.op = formula->op;
  node.a = formula->a;
  node.b = formula->b;
  return node;
}

double ExpressionGraph::value_deciding(NodeId id, Decided what) {
  const Node& node = nodes_[id];
  if (node.op == Op::constant && node.variable != 0) {
    Decided& decided = formulas_[node.variable - 1].decided;
    decided = std::max(decided, what);
  }
  return node.value;
}

NodeId ExpressionGraph::variable(std::uint32_t number) {
  Node node;
  node.op = Op::variable;
  node.variable = number;
  node.continuous = true;
  return intern(node);
}

NodeId ExpressionGraph::discrete_state(std::uint32_t number) {
  Node node;
  node.op = Op::discrete_state;
  node.variable = number;
  return intern(node);
}

NodeId ExpressionGraph::simplified(Op op, NodeId a, NodeId b, NodeId c, bool& done) {
  done = true;
  switch (op) {
    case Op::select:
      if (is_constant(a)) return value_of_kind(a) != 0 ? b : c;
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
        return apply(Op::multiply, folded(Op::multiply, a, nodes_[b].a), nodes_[b].b);
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
    default:  // nothing is known of the rest that would make it shorter
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
    return folded(op, a, b);
  }
  // A product keeps its constant in front and a commutative pair has one order, so that equal ones meet.
  const auto smooth = smooth_operation(op);
  const bool commutative = smooth && text::info_of(*smooth).is(text::kCommutative);
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
  const NodeId derivative = partial(id, operand);
  const Op by = nodes_[adjoint].op;
  const bool gated = by == Op::select || by == Op::gate;
  return apply(gated && !has_value_everywhere(id, derivative) ? Op::gate : Op::multiply, adjoint, derivative);
}

bool ExpressionGraph::has_value_everywhere(NodeId id, NodeId derivative) const {
  const Op op = nodes_[id].op;
  return op == Op::add || op == Op::subtract || op == Op::negate || is_constant(derivative);
}

NodeId ExpressionGraph::partial(NodeId id, int operand) {
  const Node node = with_operands(id);  // a copy: new nodes may move the array
  if (const auto operation = smooth_operation(node.op)) {
    return text::partial_derivative(*operation, operand, Term{this, node.a}, Term{this, node.b},
                                    Term{this, id})
        .id;
  }
  if (node.op == Op::table_value && operand == 0) return apply(Op::table_slope, node.b, node.c);
  if (node.op == Op::gate) return operand == 0 ? node.b : node.a;
  return constant(0);  // switches, steps and tables: nothing but events changes them
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
