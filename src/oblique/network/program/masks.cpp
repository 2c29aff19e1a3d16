// SPDX-License-Identifier: MIT
#include <oblique/network/program/masks.h>

#include <algorithm>
#include <iterator>
#include <optional>

namespace oblique::network {
namespace {

using Masks = std::vector<Mask>;

/// Goes down the graph from what is read. What masks a node masks it on each way up: on a way through a
/// product of conditions that is what masks the product, or makes the other factor 0.
class Finder {
 public:
  explicit Finder(const Network& network) : graph_(network.graph), masks_(graph_.size()) {
    find_roots(network);
    for (auto id = static_cast<NodeId>(graph_.size()); id-- > 0;) {
      if (!masks_[id]) masks_[id].emplace();  // nobody reads it, so far as is known
      const Node& node = graph_[id];
      for (int i = 0; i < operand_count(node.op); ++i) add_way(node.operand(i), way(id, i));
    }
  }

  const Masks& of(NodeId id) const { return *masks_[id]; }

 private:
  void find_roots(const Network& network) {
    const auto read = [&](NodeId id) { masks_[id].emplace(); };
    for (const State& state : network.states) {
      read(state.derivative);
      if (state.start_node) read(*state.start_node);
    }
    for (const Unknown& unknown : network.unknowns) read(unknown.residual);
    for (const Switch& s : network.switches) {
      read(s.event_function);
      if (s.rate) read(*s.rate);
    }
    for (const Event& event : network.events) {
      read(event.condition);
      for (const Event::Action& action : event.actions) read(action.value);
    }
    for (const NodeId end : network.phase_ends) read(end);
    for (const NodeId signal : network.signals) read(signal);
  }

  /// What masks an operand on its way through a node.
  Masks way(NodeId id, int operand) const {
    const Node& node = graph_[id];
    if (node.continuous) return {};
    if (node.op == Op::subtract) return of(id);
    if (node.op != Op::multiply) return {};
    Masks zero, either;
    add_zeros(node.operand(1 - operand), zero);
    std::sort(zero.begin(), zero.end());
    std::set_union(zero.begin(), zero.end(), of(id).begin(), of(id).end(), std::back_inserter(either));
    return either;
  }

  /// What makes a condition 0 by itself.
  void add_zeros(NodeId id, Masks& zeros) const {
    const Node& node = graph_[id];
    if (node.op == Op::discrete_state) zeros.push_back({node.variable, 0});
    if (node.op == Op::subtract && graph_.is_constant(node.a, 1) && graph_[node.b].op == Op::discrete_state)
      zeros.push_back({graph_[node.b].variable, 1});
    if (node.op != Op::multiply) return;
    add_zeros(node.a, zeros);
    add_zeros(node.b, zeros);
  }

  void add_way(NodeId id, const Masks& way) {
    std::optional<Masks>& known = masks_[id];
    if (!known) {
      known = way;
      return;
    }
    std::erase_if(*known,
                  [&](const Mask& mask) { return !std::binary_search(way.begin(), way.end(), mask); });
  }

  const ExpressionGraph& graph_;
  std::vector<std::optional<Masks>> masks_;  ///< of each node; nothing where no way up has been found yet
};

}  // namespace

std::vector<std::vector<Mask>> find_masks(const Network& network) {
  const Finder finder(network);
  std::vector<Masks> of_discrete_states(network.discrete_states.size()), masks;
  for (NodeId id = 0; id < network.graph.size(); ++id) {
    if (network.graph[id].op == Op::discrete_state)
      of_discrete_states[network.graph[id].variable] = finder.of(id);
  }
  for (const Switch& s : network.switches) masks.push_back(of_discrete_states[s.discrete_state]);
  return masks;
}

bool is_masked(std::span<const Mask> masks, std::span<const double> discrete_states) {
  return std::any_of(masks.begin(), masks.end(),
                     [&](const Mask& mask) { return discrete_states[mask.discrete_state] == mask.value; });
}

}  // namespace oblique::network
