// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>

#include <oblique/network/expression_graph.h>
#include <oblique/text/expression.h>

namespace oblique {

/// Adds an expression to a graph; `node_of_name` gives the nodes of its names (never asked for `pi` and
/// `inf`). Conditions and switching functions (min, sign, …) must have constant arguments and vanish here: of
/// a varying signal they would be a kink inside a step. Throws ExpressionError where one has not.
NodeId build_expression(ExpressionGraph& graph, const Expression& expression,
                        const std::function<NodeId(std::string_view)>& node_of_name);

}  // namespace oblique
