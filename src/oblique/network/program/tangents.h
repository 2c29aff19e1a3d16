// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <oblique/network/graph/expression_graph.h>

namespace oblique::network {

/// d/ds of nodes where the variables move along a direction s: forward accumulation, in which every node is
/// differentiated once however many roots share it.
class Tangents {
 public:
  /// d/ds of a variable, and of what else moves, by their numbers; where there is no function it stands
  /// still.
  using RateOf = std::function<NodeId(std::uint32_t number)>;
  struct Rates {
    RateOf variable, discrete_state, parameter;
  };

  /// `graph` must outlive this; nodes may be added to it.
  Tangents(ExpressionGraph& graph, Rates rates);
  Tangents(ExpressionGraph& graph, RateOf rate_of_variable)
      : Tangents(graph, Rates{std::move(rate_of_variable), {}, {}}) {}

  /// Adds nodes to the graph, as many as there are nodes below `root` that were not asked for before.
  NodeId of(NodeId root);

 private:
  static constexpr NodeId kUnknown = std::numeric_limits<NodeId>::max();

  void differentiate(NodeId id);
  bool may_move(NodeId id) const;

  ExpressionGraph& graph_;
  Rates rates_;
  std::vector<NodeId> known_;   ///< of each node
  std::vector<bool> branches_;  ///< of each node: a `select` is below it
};

}  // namespace oblique::network
