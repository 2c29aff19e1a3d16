// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <span>

#include <oblique/network/expression_graph.h>

namespace oblique::testing {

/// The value of a node by plain recursion, from the meaning of the operations and nothing of the library.
inline double naive_value(const ExpressionGraph& graph, NodeId id, std::span<const double> variables) {
  const Node& node = graph[id];
  if (node.op == Op::constant) return node.value;
  if (node.op == Op::variable) return variables[node.variable];
  const double a = naive_value(graph, node.a, variables);
  const bool binary = node.op == Op::add || node.op == Op::subtract || node.op == Op::multiply ||
                      node.op == Op::divide || node.op == Op::power || node.op == Op::atan2 ||
                      node.op == Op::hypot;
  const double b = binary ? naive_value(graph, node.b, variables) : 0;
  // clang-format off
  switch (node.op) {
    case Op::add: return a + b;
    case Op::subtract: return a - b;
    case Op::multiply: return a * b;
    case Op::divide: return a / b;
    case Op::power: return std::pow(a, b);
    case Op::negate: return -a;
    case Op::sin: return std::sin(a);
    case Op::cos: return std::cos(a);
    case Op::tan: return std::tan(a);
    case Op::asin: return std::asin(a);
    case Op::acos: return std::acos(a);
    case Op::atan: return std::atan(a);
    case Op::atan2: return std::atan2(a, b);
    case Op::exp: return std::exp(a);
    case Op::log: return std::log(a);
    case Op::sqrt: return std::sqrt(a);
    case Op::hypot: return std::hypot(a, b);
    default: return std::numeric_limits<double>::quiet_NaN();
  }
  // clang-format on
}

}  // namespace oblique::testing
