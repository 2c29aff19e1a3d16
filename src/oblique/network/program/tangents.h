// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include <oblique/network/graph/expression_graph.h>

namespace oblique::network {

/// d/ds of nodes where the variables move along a direction s: forward accumulation, in which every node is
/// differentiated once however many roots share it.
class Tangents {
 public:
  /// `rate_of` gives d variable/ds of a variable by its number. `graph` must outlive this; nodes may be added
  /// to it.
  Tangents(ExpressionGraph& graph, std::function<NodeId(std::uint32_t variable)> rate_of);

  /// Adds nodes to the graph, as many as there are nodes below `root` that were not asked for before.
  NodeId of(NodeId root);

 private:
  static constexpr NodeId kUnknown = std::numeric_limits<NodeId>::max();

  void differentiate(NodeId id);

  ExpressionGraph& graph_;
  std::function<NodeId(std::uint32_t)> rate_of_;
  std::vector<NodeId> known_;   ///< of each node
  std::vector<bool> branches_;  ///< of each node: a `select` is below it
};

}  // namespace oblique::network
