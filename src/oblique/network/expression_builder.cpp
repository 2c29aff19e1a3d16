// SPDX-License-Identifier: MIT
#include <oblique/network/expression_builder.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace oblique {
namespace {

/// The graph's operation for a smooth function.
std::optional<Op> smooth_operation(Function function) {
  switch (function) {
    case Function::sin:
      return Op::sin;
    case Function::cos:
      return Op::cos;
    case Function::tan:
      return Op::tan;
    case Function::asin:
      return Op::asin;
    case Function::acos:
      return Op::acos;
    case Function::atan:
      return Op::atan;
    case Function::atan2:
      return Op::atan2;
    case Function::exp:
      return Op::exp;
    case Function::log:
      return Op::log;
    case Function::sqrt:
      return Op::sqrt;
    case Function::hypot:
      return Op::hypot;
    default:
      return std::nullopt;
  }
}

std::optional<Op> smooth_operation(Expression::Kind kind) {
  switch (kind) {
    case Expression::Kind::add:
      return Op::add;
    case Expression::Kind::subtract:
      return Op::subtract;
    case Expression::Kind::multiply:
      return Op::multiply;
    case Expression::Kind::divide:
      return Op::divide;
    case Expression::Kind::power:
      return Op::power;
    case Expression::Kind::negate:
      return Op::negate;
    default:
      return std::nullopt;
  }
}

class Builder {
 public:
  Builder(ExpressionGraph& graph, const std::function<NodeId(std::string_view)>& node_of_name)
      : graph_(graph), node_of_name_(node_of_name) {}

  NodeId build(const Expression& e) {
    using Kind = Expression::Kind;
    if (e.kind == Kind::number) return graph_.constant(e.number);
    if (e.kind == Kind::name) return name(e);
    if (e.kind == Kind::call && e.function == Function::if_) {
      const NodeId condition = build(e.operands[0]);
      if (!graph_.is_constant(condition)) refuse(e, "if");
      return build(e.operands[graph_[condition].value != 0 ? 1 : 2]);
    }
    std::vector<NodeId> operands;
    operands.reserve(e.operands.size());
    for (const Expression& operand : e.operands) operands.push_back(build(operand));
    const auto op = e.kind == Kind::call ? smooth_operation(e.function) : smooth_operation(e.kind);
    if (op) return graph_.apply(*op, operands[0], operands.size() > 1 ? operands[1] : 0);
    return constant_of(e, operands);
  }

 private:
  NodeId name(const Expression& e) {
    if (e.name == "pi") return graph_.constant(std::numbers::pi);
    if (e.name == "inf") return graph_.constant(std::numeric_limits<double>::infinity());
    return node_of_name_(e.name);
  }

  /// What switches, folded to a constant; the operands must be constants.
  NodeId constant_of(const Expression& e, const std::vector<NodeId>& operands) {
    Expression folded = e;
    for (std::size_t i = 0; i < operands.size(); ++i) {
      if (!graph_.is_constant(operands[i])) {
        refuse(e, e.kind == Expression::Kind::call ? functions()[static_cast<std::size_t>(e.function)].name
                                                   : std::string_view("a condition"));
      }
      folded.operands[i] = Expression{};
      folded.operands[i].number = graph_[operands[i]].value;
    }
    return graph_.constant(evaluate(folded));
  }

  [[noreturn]] static void refuse(const Expression& e, std::string_view what) {
    throw ExpressionError{e.column, fmt::format("{} of a varying signal switches inside a step", what),
                          "a smooth function, or constant arguments",
                          "this version has no events: use smooth functions of the signals"};
  }

  ExpressionGraph& graph_;
  const std::function<NodeId(std::string_view)>& node_of_name_;
};

}  // namespace

NodeId build_expression(ExpressionGraph& graph, const Expression& expression,
                        const std::function<NodeId(std::string_view)>& node_of_name) {
  return Builder(graph, node_of_name).build(expression);
}

}  // namespace oblique
