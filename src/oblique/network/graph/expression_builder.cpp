// SPDX-License-Identifier: MIT
#include <oblique/network/graph/expression_builder.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <oblique/text/expression_printer.h>

namespace oblique::network {
namespace {

/// A tree of the operands of an n-ary function: f(a, f(b, …)).
text::Expression call(text::Function function, std::vector<text::Expression> operands) {
  text::Expression e;
  e.kind = text::Expression::Kind::call;
  e.function = function;
  e.operands = std::move(operands);
  return e;
}

text::Expression negative(const text::Expression& of) {
  text::Expression e;
  e.kind = text::Expression::Kind::negate;
  e.operands = {of};
  return e;
}

class Builder {
 public:
  Builder(ExpressionGraph& graph, ExpressionContext& context) : graph_(graph), context_(context) {}

  NodeId build(const text::Expression& e) {
    using Kind = text::Expression::Kind;
    if (e.kind == Kind::number) return graph_.constant(e.number);
    if (e.kind == Kind::name) return name(e);
    if (is_comparison(e.kind) || is_logical(e.kind)) return condition(e);
    if (e.kind == Kind::call) return function(e);
    return smooth(*text::smooth_operation(e), e);
  }

 private:
  using Change = ExpressionContext::Change;

  static bool is_logical(text::Expression::Kind kind) {
    return kind == text::Expression::Kind::logical_and || kind == text::Expression::Kind::logical_or ||
           kind == text::Expression::Kind::logical_not;
  }

  NodeId name(const text::Expression& e) {
    if (e.name == "pi") return graph_.constant(std::numbers::pi);
    if (e.name == "inf") return graph_.constant(std::numeric_limits<double>::infinity());
    return context_.node_of_name(e.name);
  }

  NodeId smooth(text::Operation operation, const text::Expression& e) {
    const NodeId a = build(e.operands[0]);
    return graph_.apply(op_of(operation), a, e.operands.size() > 1 ? build(e.operands[1]) : 0);
  }

  /// Whether only a switch keeps an expression from being negative, as max(x, 0): before it turns over, the
  /// expression goes on a little below zero.
  bool is_kept_positive(const text::Expression& e) {
    bool by_switch = false;
    return is_never_negative(e, by_switch) && by_switch;
  }

  bool is_never_negative(const text::Expression& e, bool& by_switch) {
    using Kind = text::Expression::Kind;
    if (change_of(e, context_) == Change::never) return graph_.value_of_kind(build(e)) >= 0;
    const auto is_nowhere = [&](const text::Expression& part) { return is_never_negative(part, by_switch); };
    if (e.kind == Kind::add || e.kind == Kind::multiply || e.kind == Kind::divide)
      return std::all_of(e.operands.begin(), e.operands.end(), is_nowhere);
    if (e.kind != Kind::call) return false;
    const bool found = e.function == text::Function::abs ||
                       (e.function == text::Function::max &&
                        std::any_of(e.operands.begin(), e.operands.end(), is_nowhere)) ||
                       (e.function == text::Function::clip && is_nowhere(e.operands[1]));
    by_switch = by_switch || found;
    return found;
  }

  NodeId function(const text::Expression& e);

  NodeId choose(NodeId chosen, const text::Expression& a, const text::Expression& b) {
    if (graph_.is_constant(chosen)) return build(graph_.value_of_kind(chosen) != 0 ? a : b);
    const NodeId first = build(a);
    return graph_.apply(Op::select, chosen, first, build(b));
  }

  NodeId extreme(const text::Expression& e) {
    if (e.operands.size() == 1) return build(e.operands[0]);
    const text::Expression& first = e.operands[0];
    text::Expression rest = e.operands[1];
    if (e.operands.size() > 2) rest = call(e.function, {e.operands.begin() + 1, e.operands.end()});
    const bool largest = e.function == text::Function::max;
    return choose(largest ? bend(first, rest) : bend(rest, first), first, rest);
  }

  // --- conditions: nodes that are 1 or 0 and change with events only
  // ---------------------------------------------------------------------------------------------------------

  NodeId condition(const text::Expression& e) {
    using Kind = text::Expression::Kind;
    const auto one = [&] { return graph_.constant(1); };
    switch (e.kind) {
      case Kind::logical_and:
        return graph_.apply(Op::multiply, condition(e.operands[0]), condition(e.operands[1]));
      case Kind::logical_or: {
        const NodeId neither =
            graph_.apply(Op::multiply, inverse(condition(e.operands[0])), inverse(condition(e.operands[1])));
        return inverse(neither);
      }
      case Kind::logical_not:
        return inverse(condition(e.operands[0]));
      case Kind::greater:
        return greater(e.operands[0], e.operands[1]);
      case Kind::less:
        return greater(e.operands[1], e.operands[0]);
      case Kind::greater_equal:
        return inverse(greater(e.operands[1], e.operands[0]));
      case Kind::less_equal:
        return inverse(greater(e.operands[0], e.operands[1]));
      case Kind::equal:
      case Kind::not_equal: {
        if (change_of(e, context_) == Change::always) refuse_equality(e);
        const NodeId same = graph_.apply(Op::equal, build(e.operands[0]), build(e.operands[1]));
        return e.kind == Kind::equal ? same : inverse(same);
      }
      default:
        break;
    }
    if (change_of(e, context_) == Change::always) refuse_number(e);
    return graph_.apply(Op::subtract, one(), graph_.apply(Op::equal, build(e), graph_.constant(0)));
  }

  NodeId inverse(NodeId condition) { return graph_.apply(Op::subtract, graph_.constant(1), condition); }

  /// A switch between two pieces that meet where it turns over.
  NodeId bend(const text::Expression& left, const text::Expression& right) {
    return greater(left, right, Turning::bends);
  }

  NodeId greater(const text::Expression& left, const text::Expression& right,
                 Turning turning = Turning::jumps) {
    const Change changes = std::max(change_of(left, context_), change_of(right, context_));
    if (changes != Change::always) return graph_.apply(Op::less, build(right), build(left));
    // Nothing that changes is beyond infinity.
    for (const text::Expression* const side : {&left, &right}) {
      if (change_of(*side, context_) != Change::never) continue;
      const double value = graph_.value_of_kind(build(*side));
      if (std::isinf(value)) return graph_.constant((side == &left) == (value > 0) ? 1 : 0);
    }
    return context_.greater(left, right, turning);
  }

  static text::Expression zero() { return {}; }

  /// a < b ? x : y of constants: which it is their kinds decide.
  NodeId where_less(NodeId a, NodeId b, NodeId x, NodeId y) {
    return graph_.value_of_kind(graph_.apply(Op::less, a, b)) == 1 ? x : y;
  }
  NodeId smaller(NodeId a, NodeId b) { return where_less(b, a, b, a); }
  NodeId larger(NodeId a, NodeId b) { return where_less(a, b, b, a); }

  /// What would switch if its operands were no constants.
  NodeId constant_of(const text::Expression& e) {
    std::vector<NodeId> x;
    for (const text::Expression& operand : e.operands) x.push_back(build(operand));
    const NodeId zero = graph_.constant(0), one = graph_.constant(1);
    switch (e.function) {
      case text::Function::abs:
        return graph_.apply(Op::hypot, x[0], zero);  // for which the sign decides nothing
      case text::Function::sign:
        return where_less(zero, x[0], one, where_less(x[0], zero, graph_.constant(-1), zero));
      case text::Function::step:
        return where_less(x[0], zero, zero, one);
      case text::Function::min:
      case text::Function::max: {
        NodeId extreme = x[0];
        for (const NodeId other : x)
          extreme = e.function == text::Function::min ? smaller(extreme, other) : larger(extreme, other);
        return extreme;
      }
      case text::Function::clip:
        return larger(x[1], smaller(x[0], x[2]));
      case text::Function::deadzone:
        return where_less(
            x[1], x[0], graph_.apply(Op::subtract, x[0], x[1]),
            where_less(x[0], graph_.apply(Op::negate, x[1]), graph_.apply(Op::add, x[0], x[1]), zero));
      default:
        break;
    }
    text::Expression folded = e;
    for (std::size_t i = 0; i < x.size(); ++i) {
      folded.operands[i] = text::Expression{};
      folded.operands[i].number = graph_.frozen_value(x[i]);
    }
    return graph_.constant(text::evaluate(folded));
  }

  [[noreturn]] static void refuse_equality(const text::Expression& e) {
    throw text::ExpressionError{e.column,
                                "a varying signal equals another only at single instants",
                                "'<' or '>' of signals; '==' of parameters and memories",
                                {}};
  }

  [[noreturn]] static void refuse_number(const text::Expression& e) {
    throw text::ExpressionError{e.column,
                                fmt::format("'{}' varies and is no condition", text::to_string(e)),
                                "a comparison, such as 'x > 0.5'",
                                {}};
  }

  ExpressionGraph& graph_;
  ExpressionContext& context_;
};

NodeId Builder::function(const text::Expression& e) {
  if (e.function == text::Function::sqrt && is_kept_positive(e.operands[0]))
    return graph_.apply(Op::sqrt, graph_.apply(Op::hypot, build(e.operands[0]), graph_.constant(0)));
  if (const auto operation = text::smooth_operation(e.function)) return smooth(*operation, e);
  if (e.function == text::Function::weights) return context_.weights(e);
  if (e.function == text::Function::table &&
      (e.operands.size() == 2 || change_of(e, context_) != Change::never))
    return context_.interpolated(e);
  if (change_of(e, context_) == Change::never && e.function != text::Function::if_) return constant_of(e);
  const std::vector<text::Expression>& x = e.operands;
  switch (e.function) {
    case text::Function::abs: {
      const NodeId positive = bend(x[0], zero());
      const NodeId inner = build(x[0]);  // once: magnitudes may stand in magnitudes
      return graph_.apply(Op::select, positive, inner, graph_.apply(Op::negate, inner));
    }
    case text::Function::sign:
      return graph_.apply(Op::select, greater(x[0], zero()), graph_.constant(1), graph_.constant(-1));
    case text::Function::step:
      return greater(x[0], zero());
    case text::Function::min:
    case text::Function::max:
      return extreme(e);
    case text::Function::clip:
      return graph_.apply(Op::select, greater(x[0], x[2], Turning::limits), build(x[2]),
                          choose(greater(x[1], x[0], Turning::limits), x[1], x[0]));
    case text::Function::deadzone: {
      const NodeId above = bend(x[0], x[1]), below = bend(negative(x[1]), x[0]);
      const NodeId inner = build(x[0]), width = build(x[1]);
      return graph_.apply(
          Op::select, above, graph_.apply(Op::subtract, inner, width),
          graph_.apply(Op::select, below, graph_.apply(Op::add, inner, width), graph_.constant(0)));
    }
    case text::Function::if_:
      return choose(condition(x[0]), x[1], x[2]);
    case text::Function::table:
    case text::Function::weights:
      break;  // done above, as are the smooth ones
#define OBLIQUE_FUNCTION(name, ...) \
  case text::Function::name:        \
    break;
#include <oblique/text/operations.def>
  }
  return constant_of(e);
}

}  // namespace

ExpressionContext::Change change_of(const text::Expression& expression, const ExpressionContext& context) {
  using Change = ExpressionContext::Change;
  if (expression.kind == text::Expression::Kind::number) return Change::never;
  if (expression.kind == text::Expression::Kind::name) {
    const bool number = expression.name == "pi" || expression.name == "inf";
    return number ? Change::never : context.change_of(expression.name);
  }
  if (expression.kind == text::Expression::Kind::call && expression.function == text::Function::weights)
    return Change::never;
  Change most = Change::never;
  for (const text::Expression& operand : expression.operands)
    most = std::max(most, change_of(operand, context));
  return most;
}

NodeId build_expression(ExpressionGraph& graph, const text::Expression& expression,
                        ExpressionContext& context) {
  return Builder(graph, context).build(expression);
}

}  // namespace oblique::network
