// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <span>

#include <oblique/network/graph/expression_graph.h>
#include <oblique/text/noise.h>
#include <oblique/text/operations.h>

namespace oblique::testing {

/// The value of a node by plain recursion, from the meaning of the operations and nothing of the library but
/// its noise, which noise_test holds.
inline double naive_value(const network::ExpressionGraph& graph, network::NodeId id,
                          std::span<const double> variables) {
  const network::Node& node = graph[id];
  if (node.op == network::Op::constant) return node.value;
  if (node.op == network::Op::variable) return variables[node.variable];
  const double a = naive_value(graph, node.a, variables);
  const bool binary = node.op == network::Op::add || node.op == network::Op::subtract ||
                      node.op == network::Op::multiply || node.op == network::Op::divide ||
                      node.op == network::Op::power || node.op == network::Op::atan2 ||
                      node.op == network::Op::hypot || node.op == network::Op::noise ||
                      node.op == network::Op::noise_derivative;
  const double b = binary ? naive_value(graph, node.b, variables) : 0;
  // clang-format off
  switch (node.op) {
    case network::Op::add: return a + b;
    case network::Op::subtract: return a - b;
    case network::Op::multiply: return a * b;
    case network::Op::divide: return a / b;
    case network::Op::power: return std::pow(a, b);
    case network::Op::negate: return -a;
    case network::Op::sin: return std::sin(a);
    case network::Op::cos: return std::cos(a);
    case network::Op::tan: return std::tan(a);
    case network::Op::asin: return std::asin(a);
    case network::Op::acos: return std::acos(a);
    case network::Op::atan: return std::atan(a);
    case network::Op::atan2: return std::atan2(a, b);
    case network::Op::exp: return std::exp(a);
    case network::Op::log: return std::log(a);
    case network::Op::sqrt: return std::sqrt(a);
    case network::Op::hypot: return std::hypot(a, b);
    case network::Op::noise: return text::noise(a, b, 0);
    case network::Op::noise_derivative: return text::noise(a, b, 1);
    default: return std::numeric_limits<double>::quiet_NaN();  // the graph's own
  }
  // clang-format on
}

}  // namespace oblique::testing
