// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include <oblique/network/assembly/network.h>
#include <oblique/network/graph/expression_graph.h>
#include <oblique/text/expression.h>

namespace oblique::network {

/// What the names of an expression mean: the block around it.
class ExpressionContext {
 public:
  virtual ~ExpressionContext() = default;

  /// The node of a name (never asked for `pi` and `inf`).
  virtual NodeId node_of_name(std::string_view name) = 0;
  /// When the value of a name can change: at no time, with events, at any time.
  enum class Change { never, with_events, always };
  virtual Change change_of(std::string_view name) const = 0;
  /// A switch: the discrete state that is 1 where left > right, else 0. At least one side changes at any
  /// time.
  virtual NodeId greater(const text::Expression& left, const text::Expression& right, Turning turning) = 0;
  /// The function through points: the parameter that holds them, or numbers.
  virtual NodeId interpolated(const text::Expression& call) = 0;
  /// Sum of the magnitudes of the weights at an input: a constant.
  virtual NodeId weights(const text::Expression& call) = 0;
};

/// How an expression changes: as the quickest of its names.
ExpressionContext::Change change_of(const text::Expression& expression, const ExpressionContext& context);

/// Adds an expression to a graph. What switches with a signal is put together from switches of the context
/// and the smooth pieces on both sides, each of which goes on past the switch. Throws ExpressionError.
NodeId build_expression(ExpressionGraph& graph, const text::Expression& expression,
                        ExpressionContext& context);

/// Whether an expression only decides something: a switch hides the values of its operands, so that nothing
/// algebraic passes through it.
inline bool is_comparison(text::Expression::Kind kind) {
  return kind >= text::Expression::Kind::less && kind <= text::Expression::Kind::not_equal;
}

}  // namespace oblique::network
