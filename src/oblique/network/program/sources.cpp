// SPDX-License-Identifier: MIT
#include <oblique/network/program/sources.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include <oblique/network/program/tangents.h>

namespace oblique::network {
namespace {

/// How a node depends on the time.
enum class Follows : std::uint8_t {
  nothing,        ///< but events
  time_linearly,  ///< between events a straight line
  time,
  states,
};

/// `clocks` are the states that go along a straight line between events.
Follows follows_of(const ExpressionGraph& graph, const Node& node, const std::vector<bool>& clocks,
                   const std::vector<Follows>& known) {
  if (node.op == Op::variable) {
    const bool linear = node.variable == 0 || (node.variable <= clocks.size() && clocks[node.variable - 1]);
    return linear ? Follows::time_linearly : Follows::states;
  }
  if (!node.continuous) return Follows::nothing;
  std::array<Follows, 3> operands{};
  Follows most = Follows::nothing;
  for (int i = 0; i < operand_count(node.op); ++i) {
    operands[static_cast<std::size_t>(i)] = known[node.operand(i)];
    most = std::max(most, operands[static_cast<std::size_t>(i)]);
  }
  if (most != Follows::time_linearly) return most;
  switch (node.op) {
    case Op::add:
    case Op::subtract:
    case Op::negate:
    case Op::table_value:  // within a segment, which events move along
      return most;
    case Op::multiply:
      return std::min(operands[0], operands[1]) == Follows::nothing ? most : Follows::time;
    case Op::divide:
      return operands[1] == Follows::nothing ? most : Follows::time;
    case Op::select:
      return graph[node.a].continuous ? Follows::time : most;
    default:  // whatever there is besides bends a straight line
      return Follows::time;
  }
}

/// The largest parts of the equations made by functions that can be next to nothing here and a peak there, of
/// states that a solver follows (of sums, products, sines and cosines of those it sees what they do).
void find_peaks(Compilation& c, const std::vector<bool>& acts, const std::vector<bool>& clocks,
                const std::function<bool(NodeId)>& follows_states) {
  const ExpressionGraph& graph = c.network.graph;
  std::vector<bool> by_unknowns(graph.size()), covered(graph.size()), reached(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    by_unknowns[id] = node.op == Op::variable && c.is_unknown(node.variable);
    for (int i = 0; i < operand_count(node.op); ++i)
      by_unknowns[id] = by_unknowns[id] || by_unknowns[node.operand(i)];
  }
  const auto makes_peaks = [&](const Node& node) {
    const auto operation = smooth_operation(node.op);
    if (!operation) return false;
    const text::OperationInfo& info = text::info_of(*operation);
    return info.is(text::kPeaks) || (info.is(text::kPeaksByDivisor) && follows_states(node.b));
  };
  for (auto id = static_cast<NodeId>(graph.size()); id-- > 0;) {
    const Node& node = graph[id];
    const bool peak = acts[id] && !covered[id] && follows_states(id) && !by_unknowns[id] && makes_peaks(node);
    if (peak) c.sources.push_back({id, id, true, true, std::nullopt});
    for (int i = 0; i < operand_count(node.op); ++i) {
      const NodeId child = node.operand(i);
      covered[child] = covered[child] || covered[id] || peak;
      reached[child] = reached[child] || reached[id] || peak;
    }
    const bool state = node.op == Op::variable && c.is_state(node.variable);
    if (state && reached[id] && !clocks[c.state_of(node.variable)])
      c.code.source_states.push_back(c.state_of(node.variable));
  }
}

/// The rates of the arguments of sines and cosines; nothing where an acting source bends otherwise.
std::optional<std::vector<NodeId>> turning_rates(const Compilation& c, const std::vector<bool>& acts,
                                                 const std::vector<Follows>& follows, Tangents& derivatives) {
  const ExpressionGraph& graph = c.network.graph;
  if (!c.sources.empty()) return std::nullopt;  // by states
  std::vector<NodeId> rates;
  for (NodeId id = 0; id < acts.size(); ++id) {
    if (!acts[id] || follows[id] != Follows::time) continue;
    const Node node = graph[id];  // a copy: new nodes may move the array
    switch (node.op) {
      case Op::add:
      case Op::subtract:
      case Op::negate:
      case Op::multiply:
        break;
      case Op::divide:
        if (follows[node.b] != Follows::nothing) return std::nullopt;
        break;
      case Op::sin:
      case Op::cos: {
        if (follows[node.a] != Follows::time_linearly) return std::nullopt;
        const NodeId rate = derivatives.of(node.a);
        if (!graph.is_constant(rate)) return std::nullopt;
        rates.push_back(rate);
        break;
      }
      default:
        return std::nullopt;
    }
  }
  return rates;
}

}  // namespace

void find_sources(Compilation& c) {
  ExpressionGraph& graph = c.network.graph;
  const std::size_t size = graph.size();
  std::vector<Follows> follows(size);
  std::vector<bool> clocks(c.network.states.size(), false);
  const auto find_follows = [&] {
    for (NodeId id = 0; id < size; ++id) follows[id] = follows_of(graph, graph[id], clocks, follows);
  };
  find_follows();
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    clocks[i] = follows[c.network.states[i].derivative] == Follows::nothing;
    if (clocks[i]) c.code.source_states.push_back(i);
  }
  c.code.n_clocks = c.code.source_states.size();
  find_follows();
  std::vector<bool> is_root(size), acts(size), needed(size);
  std::vector<NodeId> acting, others = c.network.signals;
  for (const State& state : c.network.states) acting.push_back(state.derivative);
  for (const Unknown& unknown : c.network.unknowns) acting.push_back(unknown.residual);
  for (const Switch& s : c.network.switches) acting.push_back(s.event_function);
  for (const auto* roots : {&acting, &others}) {
    for (const NodeId root : *roots) {
      is_root[root] = needed[root] = true;
      acts[root] = acts[root] || roots == &acting;
    }
  }
  for (auto id = static_cast<NodeId>(size); id-- > 0;) {
    if (!needed[id]) continue;
    const Node& node = graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) {
      const NodeId child = node.operand(i);
      needed[child] = true;
      acts[child] = acts[child] || acts[id];
      if (follows[id] == Follows::states && follows[child] == Follows::time) is_root[child] = true;
    }
  }
  find_peaks(c, acts, clocks, [&](NodeId id) { return follows[id] == Follows::states; });
  Tangents derivatives(graph, [&](std::uint32_t variable) {
    return variable == 0 ? graph.constant(1) : c.network.states[variable - 1].derivative;
  });
  c.turning_rates = turning_rates(c, acts, follows, derivatives);
  std::map<NodeId, std::size_t> source_of;
  for (NodeId id = 0; id < size; ++id) {
    if (!is_root[id] || follows[id] != Follows::time) continue;
    source_of.emplace(id, c.sources.size());
    c.sources.push_back({id, derivatives.of(id), acts[id], false, std::nullopt});
  }
  for (std::size_t s = 0; s < c.network.switches.size(); ++s) {
    const auto same = source_of.find(c.network.switches[s].event_function);
    if (same == source_of.end()) continue;
    std::optional<std::uint32_t>& index = c.sources[same->second].switch_index;
    if (!index) index = static_cast<std::uint32_t>(s);
  }
}

std::vector<NodeId> source_roots(const Compilation& c) {
  std::vector<NodeId> roots;
  for (const Compilation::FoundSource& source : c.sources) {
    roots.push_back(source.value);
    roots.push_back(source.derivative);
  }
  return roots;
}

void write_sources(Compilation& c) {
  std::vector<NodeId> nodes;
  for (NodeId id = 0; id < c.network.graph.size(); ++id) {
    if (c.for_sources.nodes[id]) nodes.push_back(id);
  }
  c.code.source_segment = c.writer->write(nodes);
  if (c.turning_rates) {
    c.code.turning_rate_slots.emplace();
    for (const NodeId rate : *c.turning_rates) c.code.turning_rate_slots->push_back(c.writer->slot(rate));
  }
  for (const Compilation::FoundSource& source : c.sources)
    c.code.sources.push_back({c.writer->slot(source.value), c.writer->slot(source.derivative), source.acts,
                              source.by_states, source.switch_index});
}

}  // namespace oblique::network
