// SPDX-License-Identifier: MIT
#include <oblique/network/switch_structure.h>

#include <algorithm>
#include <map>
#include <utility>

namespace oblique {
namespace {

constexpr std::uint32_t kNoSwitch = 0xFFFFFFFFU;

/// What the unknowns of an algebraic loop depend on: all its residuals.
std::vector<std::uint32_t> loops_of_unknowns(const Network& network) {
  std::vector<std::uint32_t> loops(network.unknowns.size(), 0);
  for (std::size_t l = 0; l < network.loops.size(); ++l) {
    for (const std::size_t u : network.loops[l].unknowns) loops[u] = static_cast<std::uint32_t>(l);
  }
  return loops;
}

class Finder {
 public:
  explicit Finder(const Network& network)
      : network_(network),
        loop_of_(loops_of_unknowns(network)),
        switch_of_(network.memories.size(), kNoSwitch),
        seen_(network.graph.size(), 0) {
    for (std::size_t s = 0; s < network.switches.size(); ++s)
      switch_of_[network.switches[s].memory] = static_cast<std::uint32_t>(s);
  }

  SwitchStructure find() {
    find_units();
    for (const Switch& s : network_.switches) structure_.follows.push_back(positions_below(s.surface));
    find_couplings();
    return std::move(structure_);
  }

 private:
  bool is_unknown(const Node& node) const {
    return node.op == Op::variable && node.variable > network_.states.size();
  }
  const Loop& loop_of(const Node& node) const {
    return network_.loops[loop_of_[node.variable - 1 - network_.states.size()]];
  }

  /// a − b and b − a, x and −x are one surface.
  void find_units() {
    std::map<std::pair<NodeId, NodeId>, std::uint32_t> units;
    for (std::size_t s = 0; s < network_.switches.size(); ++s) {
      NodeId id = network_.switches[s].surface;
      bool opposite = false;
      if (network_.graph[id].op == Op::negate) {
        id = network_.graph[id].a;
        opposite = true;
      }
      std::pair<NodeId, NodeId> key{id, id};
      if (const Node& node = network_.graph[id]; node.op == Op::subtract) {
        opposite = opposite != (node.a > node.b);
        key = std::minmax(node.a, node.b);
      }
      const auto [found, inserted] =
          units.try_emplace(key, static_cast<std::uint32_t>(structure_.members.size()));
      if (inserted) structure_.members.emplace_back();
      structure_.members[found->second].push_back(static_cast<std::uint32_t>(s));
      structure_.unit.push_back(found->second);
      structure_.opposite.push_back(opposite);
    }
  }

  std::vector<std::uint32_t> positions_below(NodeId root) {
    ++mark_;
    std::vector<std::uint32_t> found;
    std::vector<NodeId> pending{root};
    while (!pending.empty()) {
      const NodeId id = pending.back();
      pending.pop_back();
      if (seen_[id] == mark_) continue;
      seen_[id] = mark_;
      const Node& node = network_.graph[id];
      if (node.op == Op::memory && switch_of_[node.variable] != kNoSwitch)
        found.push_back(switch_of_[node.variable]);
      for (int i = 0; i < operand_count(node.op); ++i) pending.push_back(node.operand(i));
      if (is_unknown(node)) {
        for (const std::size_t u : loop_of(node).unknowns) pending.push_back(network_.unknowns[u].residual);
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Goes up the graph with the units below each node: what is no sum couples those of its operands.
  void find_couplings() {
    const ExpressionGraph& graph = network_.graph;
    std::vector<std::uint64_t> below(graph.size(), 0);
    std::map<const Loop*, std::uint64_t> below_loop;
    for (NodeId id = 0; id < graph.size(); ++id) {
      const Node& node = graph[id];
      if (node.op == Op::memory && switch_of_[node.variable] != kNoSwitch)
        below[id] = std::uint64_t{1} << (structure_.unit[switch_of_[node.variable]] % 64);
      if (is_unknown(node)) {
        const auto [found, inserted] = below_loop.try_emplace(&loop_of(node), 0);
        if (inserted) {
          for (const std::size_t u : found->first->unknowns) {
            for (const std::uint32_t s : positions_below(network_.unknowns[u].residual))
              found->second |= std::uint64_t{1} << (structure_.unit[s] % 64);
          }
          couple(found->second, found->second);
        }
        below[id] = found->second;
      }
      const int operands = operand_count(node.op);
      for (int i = 0; i < operands; ++i) below[id] |= below[node.operand(i)];
      const bool sum =
          node.op == Op::add || node.op == Op::subtract || node.op == Op::negate ||
          (node.op == Op::multiply && (graph.is_constant(node.a) || graph.is_constant(node.b))) ||
          (node.op == Op::divide && graph.is_constant(node.b));
      if (sum || operands == 0) continue;
      for (int i = 0; i < operands; ++i) {
        const std::uint64_t own = below[node.operand(i)];
        // A product and a choice are linear in each operand, whatever else is not even that.
        if (node.op != Op::multiply && node.op != Op::select && node.op != Op::gate) couple(own, own);
        for (int k = 0; k < i; ++k) couple(own, below[node.operand(k)]);
      }
    }
  }

  void couple(std::uint64_t units, std::uint64_t with) {
    if (units == 0 || with == 0) return;
    for (std::size_t bit = 0; bit < 64; ++bit) {
      if ((units >> bit & 1U) != 0) structure_.coupled[bit] |= with;
      if ((with >> bit & 1U) != 0) structure_.coupled[bit] |= units;
    }
  }

  const Network& network_;
  std::vector<std::uint32_t> loop_of_;
  std::vector<std::uint32_t> switch_of_;  ///< of each memory
  std::vector<std::uint32_t> seen_;
  std::uint32_t mark_ = 0;
  SwitchStructure structure_;
};

}  // namespace

bool SwitchStructure::depends(std::size_t s, std::size_t other) const {
  return std::binary_search(follows[s].begin(), follows[s].end(), static_cast<std::uint32_t>(other));
}

SwitchStructure find_switch_structure(const Network& network) {
  return Finder(network).find();
}

}  // namespace oblique
