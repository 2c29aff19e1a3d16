// SPDX-License-Identifier: MIT
#include <oblique/network/program/sources.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

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

/// A product of more states than this, or of one so many times, is narrow beside what its states do: x^16
/// halves where x falls by a twentieth.
constexpr double kMostFactors = 16;

/// Of each node of how many factors by states its longest product is.
std::vector<double> factors_by_states(const ExpressionGraph& graph,
                                      const std::function<bool(NodeId)>& follows_states) {
  std::vector<double> factors(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    if (!follows_states(id)) continue;
    double most = node.op == Op::variable ? 1 : 0;
    for (int i = 0; i < operand_count(node.op); ++i) most = std::max(most, factors[node.operand(i)]);
    factors[id] = node.op == Op::multiply ? factors[node.a] + factors[node.b] : most;
  }
  return factors;
}

/// Of each node of how many peaks it is a sum or a product, with constants, and of nothing else that moves:
/// two of them may make a peak where each only goes from one level to another.
std::vector<std::size_t> peaks_in(const ExpressionGraph& graph, const std::function<bool(NodeId)>& is_peak,
                                  const std::function<bool(NodeId)>& is_constant) {
  std::vector<std::size_t> peaks(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    if (is_peak(id)) {
      peaks[id] = 1;
      continue;
    }
    const bool combines = node.op == Op::add || node.op == Op::subtract || node.op == Op::negate ||
                          node.op == Op::multiply || (node.op == Op::divide && is_constant(node.b));
    std::size_t sum = 0;
    bool pure = combines;
    for (int i = 0; i < operand_count(node.op) && pure; ++i) {
      pure = peaks[node.operand(i)] > 0 || is_constant(node.operand(i));
      sum += peaks[node.operand(i)];
    }
    peaks[id] = pure ? sum : 0;
  }
  return peaks;
}

/// The largest parts of the equations made by functions that can be next to nothing here and a peak there, of
/// states that a solver follows (of sums, short products, sines and cosines of those it sees what they do);
/// and, besides, the largest that several of them make.
void find_peaks(Compilation& c, const std::vector<bool>& acts, const std::vector<bool>& clocks,
                const std::vector<Follows>& follows) {
  const ExpressionGraph& graph = c.network.graph;
  const auto follows_states = [&](NodeId id) { return follows[id] == Follows::states; };
  std::vector<bool> by_unknowns(graph.size()), covered(graph.size()), reached(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    by_unknowns[id] = node.op == Op::variable && c.is_unknown(node.variable);
    for (int i = 0; i < operand_count(node.op); ++i)
      by_unknowns[id] = by_unknowns[id] || by_unknowns[node.operand(i)];
  }
  const std::vector<double> factors = factors_by_states(graph, follows_states);
  const auto makes_peaks = [&](const Node& node) {
    const auto operation = smooth_operation(node.op);
    if (!operation) return false;
    if (node.op == Op::multiply && factors[node.a] + factors[node.b] > kMostFactors) return true;
    const text::OperationInfo& info = text::info_of(*operation);
    return info.is(text::kPeaks) || (info.is(text::kPeaksByDivisor) && follows_states(node.b));
  };
  const auto can_peak = [&](NodeId id) {
    return follows_states(id) && !by_unknowns[id] && makes_peaks(graph[id]);
  };
  const std::vector<std::size_t> peaks =
      peaks_in(graph, can_peak, [&](NodeId id) { return follows[id] == Follows::nothing; });
  std::vector<bool> together(graph.size());  // with others of which it makes a peak
  for (auto id = static_cast<NodeId>(graph.size()); id-- > 0;) {
    const Node& node = graph[id];
    const bool peak = acts[id] && !covered[id] && can_peak(id);
    const bool makes_one = acts[id] && !covered[id] && !together[id] && peaks[id] > 1;
    if (peak || makes_one) c.sources.push_back({id, id, true, true, std::nullopt, {}});
    for (int i = 0; i < operand_count(node.op); ++i) {
      const NodeId child = node.operand(i);
      covered[child] = covered[child] || covered[id] || peak;
      together[child] = together[child] || together[id] || makes_one;
      reached[child] = reached[child] || reached[id] || peak;
    }
    const bool state = node.op == Op::variable && c.is_state(node.variable);
    if (state && reached[id] && !clocks[c.state_of(node.variable)])
      c.code.source_states.push_back(c.state_of(node.variable));
  }
}

/// Of each node whether it is a function of what moves other than a sum of it: only then bounds tell more of
/// an event function than the cubic that a search draws through it.
std::vector<bool> bent_nodes(const ExpressionGraph& graph, const std::vector<Follows>& follows) {
  std::vector<bool> bent(follows.size());
  const auto moves = [&](NodeId id) { return follows[id] != Follows::nothing; };
  for (NodeId id = 0; id < bent.size(); ++id) {
    const Node& node = graph[id];
    if (!moves(id) || node.op == Op::variable) continue;
    for (int i = 0; i < operand_count(node.op); ++i) bent[id] = bent[id] || bent[node.operand(i)];
    switch (node.op) {
      case Op::add:
      case Op::subtract:
      case Op::negate:
      case Op::select:
      case Op::gate:
      case Op::table_value:
        break;
      case Op::multiply:
        bent[id] = bent[id] || (moves(node.a) && moves(node.b));
        break;
      case Op::divide:
        bent[id] = bent[id] || moves(node.b);
        break;
      default:
        bent[id] = true;
    }
  }
  return bent;
}

/// Notes what masks the comparisons among the sources.
void mask_comparisons(Compilation& c) {
  std::set<std::uint32_t> looked_at;
  for (const Compilation::FoundSource& source : c.sources) {
    if (source.switch_index) looked_at.insert(c.network.switches[*source.switch_index].discrete_state);
  }
  for (Compilation::FoundSource& source : c.sources) {
    if (!source.switch_index) continue;
    source.masks = c.code.switch_structure.masks[*source.switch_index];
    std::erase_if(source.masks, [&](const Mask& mask) { return looked_at.contains(mask.discrete_state); });
  }
}

/// The event functions of switches that read states, and bend: a peak of the time, or a valley of the states,
/// that leads over a level and back may be far smaller than what it stands on.
void find_bent_comparisons(Compilation& c, const std::vector<Follows>& follows) {
  const ExpressionGraph& graph = c.network.graph;
  const std::vector<bool> bent = bent_nodes(graph, follows);
  std::set<std::size_t> known(c.code.source_states.begin(), c.code.source_states.end());
  for (std::uint32_t s = 0; s < c.network.switches.size(); ++s) {
    const NodeId root = c.network.switches[s].event_function;
    if (follows[root] != Follows::states || !bent[root]) continue;
    std::vector<std::size_t> states;
    bool by_unknowns = false;
    std::vector<bool> seen(root + 1);
    seen[root] = true;
    for (NodeId id = root + 1; id-- > 0 && !by_unknowns;) {
      if (!seen[id]) continue;
      const Node& node = graph[id];
      for (int i = 0; i < operand_count(node.op); ++i) seen[node.operand(i)] = true;
      if (node.op != Op::variable) continue;
      by_unknowns = c.is_unknown(node.variable);
      if (c.is_state(node.variable)) states.push_back(c.state_of(node.variable));
    }
    if (by_unknowns) continue;
    for (const std::size_t state : states) {
      if (known.insert(state).second) c.code.source_states.push_back(state);
    }
    c.sources.push_back({root, root, true, true, s, {}});
  }
  mask_comparisons(c);
}

/// Bounds of what follows the time through sums, products, sines and cosines: of its magnitude, and of how
/// fast it goes [1/s]. Both are constants, or nothing where there is none.
class TimeBounds {
 public:
  TimeBounds(Compilation& c, const std::vector<Follows>& follows, Tangents& derivatives)
      : graph_(c.network.graph), follows_(follows), derivatives_(derivatives), known_(follows.size()) {}

  struct Bounds {
    std::optional<NodeId> size, rate;
  };

  /// Of a node whose operands were asked for before, as all do that bend.
  const Bounds& of(NodeId id) {
    std::optional<Bounds>& known = known_[id];
    if (!known) known = found(id, graph_[id]);
    return *known;
  }

 private:
  NodeId magnitude(NodeId constant) { return graph_.apply(Op::hypot, constant, graph_.constant(0)); }
  std::optional<NodeId> combined(Op op, std::optional<NodeId> a, std::optional<NodeId> b) {
    if (!a || !b) return std::nullopt;
    return graph_.apply(op, *a, *b);
  }

  Bounds found(NodeId id, Node node) {  // a copy: new nodes may move the array
    if (graph_.is_constant(id)) return {magnitude(id), graph_.constant(0)};
    if (follows_[id] == Follows::time_linearly) {
      const NodeId rate = derivatives_.of(id);
      if (!graph_.is_constant(rate)) return {};
      return {std::nullopt, magnitude(rate)};
    }
    if (follows_[id] != Follows::time) return {};
    switch (node.op) {
      case Op::add:
      case Op::subtract: {
        const Bounds a = of(node.a), b = of(node.b);
        return {combined(Op::add, a.size, b.size), combined(Op::add, a.rate, b.rate)};
      }
      case Op::negate:
        return of(node.a);
      case Op::multiply: {
        const Bounds a = of(node.a), b = of(node.b);
        return {combined(Op::multiply, a.size, b.size),
                combined(Op::add, combined(Op::multiply, a.size, b.rate),
                         combined(Op::multiply, a.rate, b.size))};
      }
      case Op::divide: {
        if (!graph_.is_constant(node.b)) return {};
        const Bounds a = of(node.a);
        const NodeId divisor = magnitude(node.b);
        return {combined(Op::divide, a.size, divisor), combined(Op::divide, a.rate, divisor)};
      }
      case Op::sin:
      case Op::cos:
        return {graph_.constant(1), of(node.a).rate};
      default:
        return {};
    }
  }

  ExpressionGraph& graph_;
  const std::vector<Follows>& follows_;
  Tangents& derivatives_;
  std::vector<std::optional<Bounds>> known_;
};

/// How fast the arguments of sines and cosines go at most; nothing where an acting source bends otherwise, or
/// there is no bound.
std::optional<std::vector<NodeId>> turning_rates(Compilation& c, const std::vector<bool>& acts,
                                                 const std::vector<Follows>& follows, Tangents& derivatives) {
  const ExpressionGraph& graph = c.network.graph;
  if (!c.sources.empty()) return std::nullopt;  // by states
  TimeBounds bounds(c, follows, derivatives);
  std::vector<NodeId> rates;
  for (NodeId id = 0; id < acts.size(); ++id) {
    if (!acts[id] || follows[id] != Follows::time) continue;
    const Node node = graph[id];
    const bool turns = node.op == Op::sin || node.op == Op::cos;
    const bool smooth = turns || node.op == Op::add || node.op == Op::subtract || node.op == Op::negate ||
                        node.op == Op::multiply ||
                        (node.op == Op::divide && follows[node.b] == Follows::nothing);
    if (!smooth) return std::nullopt;
    const TimeBounds::Bounds own = bounds.of(id);
    if (node.op == Op::multiply && follows[node.a] != Follows::nothing &&
        follows[node.b] != Follows::nothing) {
      // a power of a sine is narrow: it goes as fast as its bound of the rate says, beside its size
      if (!own.size || !own.rate) return std::nullopt;
      rates.push_back(c.network.graph.apply(Op::divide, *own.rate, *own.size));
    }
    if (!turns) continue;
    const std::optional<NodeId> rate = bounds.of(node.a).rate;
    if (!rate) return std::nullopt;
    rates.push_back(*rate);
  }
  return rates;
}

/// Whether one of these nodes depends on an unknown of a loop. Of each node `asked` is the last loop for
/// which this was asked.
bool any_depends_on_loop(const Compilation& c, std::vector<NodeId> left, std::size_t loop,
                         std::vector<std::optional<std::size_t>>& asked) {
  while (!left.empty()) {
    const NodeId id = left.back();
    left.pop_back();
    if (std::exchange(asked[id], loop) == loop) continue;
    const Node node = c.network.graph[id];
    if (node.op == Op::variable && c.is_unknown(node.variable) &&
        c.loop_of_unknown[c.unknown_of(node.variable)] == loop)
      return true;
    for (int i = 0; i < operand_count(node.op); ++i) left.push_back(node.operand(i));
  }
  return false;
}

/// The nodes on which the solution of a loop that is not linear depends, through other loops too.
std::vector<bool> nodes_below_branches(const Compilation& c) {
  std::vector<NodeId> left;
  std::vector<std::optional<std::size_t>> asked(c.network.graph.size());
  for (std::size_t loop = 0; loop < c.network.loops.size(); ++loop) {
    std::vector<NodeId> residuals, slopes;
    for (const std::size_t u : c.network.loops[loop].unknowns) {
      residuals.push_back(c.network.unknowns[u].residual);
      for (const auto& [variable, slope] : c.residual_gradients[u]) {
        if (c.is_unknown(variable) && c.loop_of_unknown[c.unknown_of(variable)] == loop)
          slopes.push_back(slope);
      }
    }
    if (any_depends_on_loop(c, std::move(slopes), loop, asked))
      left.insert(left.end(), residuals.begin(), residuals.end());
  }
  std::vector<bool> found(c.network.graph.size());
  while (!left.empty()) {
    const NodeId id = left.back();
    left.pop_back();
    if (found[id]) continue;
    found[id] = true;
    const Node node = c.network.graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) left.push_back(node.operand(i));
    if (node.op == Op::variable && c.is_unknown(node.variable))
      left.push_back(c.network.unknowns[c.unknown_of(node.variable)].residual);
  }
  return found;
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
  find_peaks(c, acts, clocks, follows);
  Tangents derivatives(graph, [&](std::uint32_t variable) {
    return variable == 0 ? graph.constant(1) : c.network.states[variable - 1].derivative;
  });
  c.turning_rates = turning_rates(c, acts, follows, derivatives);
  find_bent_comparisons(c, follows);
  const std::vector<bool> below_branches = nodes_below_branches(c);
  std::map<NodeId, std::size_t> source_of;
  for (NodeId id = 0; id < size; ++id) {
    if (!is_root[id] || follows[id] != Follows::time) continue;
    source_of.emplace(id, c.sources.size());
    c.sources.push_back({id, derivatives.of(id), acts[id], false, std::nullopt, {}, below_branches[id]});
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
                              source.by_states, source.switch_index, source.masks, source.on_branch});
}

}  // namespace oblique::network
