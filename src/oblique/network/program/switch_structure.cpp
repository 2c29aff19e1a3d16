// SPDX-License-Identifier: MIT
#include <oblique/network/program/switch_structure.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace oblique::network {
namespace {

class Finder {
 public:
  explicit Finder(const Network& network)
      : network_(network),
        loop_of_(network.unknowns.size(), 0),
        switch_of_(network.discrete_states.size(), SwitchStructure::kNone) {
    for (std::size_t l = 0; l < network.loops.size(); ++l) {
      for (const std::size_t u : network.loops[l].unknowns) loop_of_[u] = static_cast<std::uint32_t>(l);
    }
    for (std::size_t s = 0; s < network.switches.size(); ++s)
      switch_of_[network.switches[s].discrete_state] = static_cast<std::uint32_t>(s);
  }

  SwitchStructure find() {
    find_units();
    find_operands();
    find_couplings();
    structure_.masks = find_masks(network_);
    find_what_events_read();
    return std::move(structure_);
  }

 private:
  bool is_state(const Node& node) const {
    return node.op == Op::variable && node.variable > 0 && node.variable <= network_.states.size();
  }
  bool is_unknown(const Node& node) const {
    return node.op == Op::variable && node.variable > network_.states.size();
  }
  std::size_t loop_of(const Node& node) const { return loop_of_[node.variable - 1 - network_.states.size()]; }

  /// A sum of multiples of nodes, by node; a constant is a multiple of kNone.
  using Sum = std::map<NodeId, double>;

  /// Adds a multiple of a node to a sum, taken apart as far as it is linear. False where that is too long.
  bool add_to(Sum& sum, NodeId id, double factor, int& left) const {
    const ExpressionGraph& graph = network_.graph;
    const Node& node = graph[id];
    if (--left < 0) return false;
    switch (node.op) {
      case Op::constant:
        sum[SwitchStructure::kNone] += factor * node.value;
        return true;
      case Op::negate:
        return add_to(sum, node.a, -factor, left);
      case Op::add:
        return add_to(sum, node.a, factor, left) && add_to(sum, node.b, factor, left);
      case Op::subtract:
        return add_to(sum, node.a, factor, left) && add_to(sum, node.b, -factor, left);
      case Op::multiply:
        if (graph.is_constant(node.a)) return add_to(sum, node.b, factor * graph[node.a].value, left);
        if (graph.is_constant(node.b)) return add_to(sum, node.a, factor * graph[node.b].value, left);
        break;
      case Op::divide:
        if (graph.is_constant(node.b)) return add_to(sum, node.a, factor / graph[node.b].value, left);
        break;
      default:
        break;
    }
    sum[id] += factor;
    return true;
  }

  /// An event function as a sum of which the first multiple is 1, and whether that turned it round. Multiples
  /// that differ by rounding are one.
  std::pair<std::vector<std::pair<NodeId, double>>, bool> without_factor(NodeId event_function) const {
    constexpr double kRounding = 1e-13;
    constexpr double kSteps = 0x1p40;
    int left = 64;
    Sum sum;
    if (!add_to(sum, event_function, 1, left)) sum = {{event_function, 1.0}};
    double largest = 0;
    for (const auto& [node, factor] : sum) largest = std::max(largest, std::abs(factor));
    std::erase_if(sum, [&](const auto& term) { return std::abs(term.second) <= kRounding * largest; });
    if (sum.empty() || !std::isfinite(largest)) sum = {{event_function, 1.0}};
    const double first = sum.begin()->second;
    std::vector<std::pair<NodeId, double>> terms;
    for (const auto& [node, factor] : sum) {
      int exponent = 0;
      const double digits = std::frexp(factor / first, &exponent);
      terms.emplace_back(node, std::ldexp(std::round(digits * kSteps) / kSteps, exponent));
    }
    return {std::move(terms), first < 0};
  }

  /// a − b and b − a, x and −x, x and 2 x have one switching surface.
  void find_units() {
    std::map<std::vector<std::pair<NodeId, double>>, std::uint32_t> units;
    for (std::size_t s = 0; s < network_.switches.size(); ++s) {
      auto [key, opposite] = without_factor(network_.switches[s].event_function);
      const auto [found, inserted] =
          units.try_emplace(std::move(key), static_cast<std::uint32_t>(structure_.members.size()));
      if (inserted) structure_.members.emplace_back();
      structure_.members[found->second].push_back(static_cast<std::uint32_t>(s));
      structure_.unit.push_back(found->second);
      structure_.opposite.push_back(opposite);
    }
  }

  void find_what_events_read() {
    structure_.read_by_events.assign(network_.switches.size(), false);
    const auto read = [&](NodeId node) {
      for (const std::uint32_t s : structure_.positions_in(node)) structure_.read_by_events[s] = true;
    };
    for (const Event& event : network_.events) {
      read(event.condition);
      for (const Event::Action& action : event.actions) read(action.value);
    }
    for (const NodeId end : network_.phase_ends) read(end);
  }

  void find_operands() {
    const ExpressionGraph& graph = network_.graph;
    for (const Switch& s : network_.switches) structure_.event_functions.push_back(s.event_function);
    structure_.switch_at.assign(graph.size(), SwitchStructure::kNone);
    structure_.discrete_state_at.assign(graph.size(), SwitchStructure::kNone);
    structure_.loop_at.assign(graph.size(), SwitchStructure::kNone);
    structure_.state_at.assign(graph.size(), SwitchStructure::kNone);
    for (const State& state : network_.states) structure_.derivatives.push_back(state.derivative);
    structure_.n_discrete_states = network_.discrete_states.size();
    // The residuals of a loop stand with the first of its unknowns, and the others lead there.
    std::vector<std::uint32_t> first_unknown(network_.loops.size(), SwitchStructure::kNone);
    structure_.first_operand.push_back(0);
    for (NodeId id = 0; id < graph.size(); ++id) {
      const Node& node = graph[id];
      if (node.op == Op::discrete_state) {
        structure_.discrete_state_at[id] = node.variable;
        structure_.switch_at[id] = switch_of_[node.variable];
      }
      if (is_state(node)) structure_.state_at[id] = node.variable - 1;
      std::vector<std::uint32_t>& operands = structure_.operands;
      for (int i = 0; i < operand_count(node.op); ++i) operands.push_back(node.operand(i));
      if (is_unknown(node)) {
        structure_.loop_at[id] = static_cast<std::uint32_t>(loop_of(node));
        std::uint32_t& first = first_unknown[loop_of(node)];
        if (first == SwitchStructure::kNone) {
          first = id;
          for (const std::size_t u : network_.loops[loop_of(node)].unknowns)
            operands.push_back(network_.unknowns[u].residual);
        } else {
          operands.push_back(first);
        }
      }
      structure_.first_operand.push_back(static_cast<std::uint32_t>(operands.size()));
    }
  }

  /// Goes up the graph with the units below each node: what is no sum couples those of its operands. Loop by
  /// loop, each after those it depends on: first without what its own unknowns bring.
  void find_couplings() {
    const ExpressionGraph& graph = network_.graph;
    std::vector<std::vector<NodeId>> by_level(network_.loops.size() + 1);
    std::vector<std::uint32_t> levels(graph.size(), 0);
    for (NodeId id = 0; id < graph.size(); ++id) {
      const Node& node = graph[id];
      if (is_unknown(node)) levels[id] = static_cast<std::uint32_t>(loop_of(node)) + 1;
      for (int i = 0; i < operand_count(node.op); ++i)
        levels[id] = std::max(levels[id], levels[node.operand(i)]);
      by_level[levels[id]].push_back(id);
    }
    std::vector<std::uint64_t> below(graph.size(), 0);
    std::uint64_t below_loop = 0;
    const auto gather = [&](const std::vector<NodeId>& nodes) {
      for (const NodeId id : nodes) {
        const Node& node = graph[id];
        if (const std::uint32_t s = structure_.switch_at[id]; s != SwitchStructure::kNone)
          below[id] = std::uint64_t{1} << (structure_.unit[s] % 64);
        if (is_unknown(node)) below[id] = below_loop;
        for (int i = 0; i < operand_count(node.op); ++i) below[id] |= below[node.operand(i)];
      }
    };
    for (std::size_t level = 0; level < by_level.size(); ++level) {
      below_loop = 0;
      gather(by_level[level]);
      if (level > 0) {
        for (const std::size_t u : network_.loops[level - 1].unknowns)
          below_loop |= below[network_.unknowns[u].residual];
        couple(below_loop, below_loop);
        gather(by_level[level]);
      }
    }
    for (NodeId id = 0; id < graph.size(); ++id) couple_operands(graph[id], below);
  }

  void couple_operands(const Node& node, const std::vector<std::uint64_t>& below) {
    const ExpressionGraph& graph = network_.graph;
    const bool sum = node.op == Op::add || node.op == Op::subtract || node.op == Op::negate ||
                     (node.op == Op::multiply && (graph.is_constant(node.a) || graph.is_constant(node.b))) ||
                     (node.op == Op::divide && graph.is_constant(node.b));
    if (sum) return;
    for (int i = 0; i < operand_count(node.op); ++i) {
      const std::uint64_t own = below[node.operand(i)];
      // A product and a choice are linear in each operand, whatever else is not even that.
      if (node.op != Op::multiply && node.op != Op::select && node.op != Op::gate) couple(own, own);
      for (int k = 0; k < i; ++k) couple(own, below[node.operand(k)]);
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
  std::vector<std::uint32_t> loop_of_;    ///< of each unknown
  std::vector<std::uint32_t> switch_of_;  ///< of each discrete state
  SwitchStructure structure_;
};

/// Visits nodes, and all below them, each once.
class Descent {
 public:
  explicit Descent(const SwitchStructure& structure)
      : structure_(structure), seen_(structure.switch_at.size(), false) {}

  void add(NodeId node) {
    if (!seen_[node]) pending_.push_back(node);
    seen_[node] = true;
  }

  template <class Visit>
  void run(const Visit& visit) {
    while (!pending_.empty()) {
      const NodeId id = pending_.back();
      pending_.pop_back();
      visit(id);
      for (std::uint32_t k = structure_.first_operand[id]; k < structure_.first_operand[id + 1]; ++k)
        add(structure_.operands[k]);
    }
  }

 private:
  const SwitchStructure& structure_;
  std::vector<bool> seen_;
  std::vector<NodeId> pending_;
};

/// All nodes below `root`, itself included.
template <class Visit>
void visit_below(const SwitchStructure& structure, NodeId root, const Visit& visit) {
  Descent descent(structure);
  descent.add(root);
  descent.run(visit);
}

}  // namespace

std::vector<std::uint32_t> SwitchStructure::positions_in(NodeId node) const {
  std::vector<std::uint32_t> found;
  visit_below(*this, node, [&](NodeId id) {
    if (switch_at[id] != kNone) found.push_back(switch_at[id]);
  });
  std::sort(found.begin(), found.end());
  return found;
}

bool SwitchStructure::depends(std::size_t s, std::size_t other) const {
  bool found = false;
  visit_below(*this, event_functions[s], [&](NodeId id) { found = found || switch_at[id] == other; });
  return found;
}

std::vector<bool> SwitchStructure::followers_of_loop(std::size_t loop) const {
  std::vector<bool> direct(event_functions.size(), false);
  for (std::size_t s = 0; s < direct.size(); ++s) {
    bool found = false;
    visit_below(*this, event_functions[s], [&](NodeId id) { found = found || loop_at[id] == loop; });
    direct[s] = found;
  }
  std::vector<bool> follows = followers_of(direct);
  for (std::size_t s = 0; s < direct.size(); ++s) follows[s] = follows[s] || direct[s];
  return follows;
}

std::vector<bool> SwitchStructure::discrete_states_below_loop(std::size_t loop) const {
  std::vector<bool> below(n_discrete_states, false);
  const auto unknown = std::find(loop_at.begin(), loop_at.end(), loop);
  if (unknown == loop_at.end()) return below;
  visit_below(*this, static_cast<NodeId>(unknown - loop_at.begin()), [&](NodeId id) {
    if (discrete_state_at[id] != kNone) below[discrete_state_at[id]] = true;
  });
  return below;
}

SwitchStructure::Ancestry SwitchStructure::ancestry(std::uint32_t of_unit,
                                                    const std::vector<Event>& events) const {
  // What the events that act on each state and each discrete state are made of.
  std::vector<std::vector<NodeId>> on_states(derivatives.size()), on_discrete_states(n_discrete_states);
  const auto add_actions = [&](const Event& event, NodeId condition) {
    for (const Event::Action& action : event.actions) {
      auto& nodes = action.on_state ? on_states[action.index] : on_discrete_states[action.index];
      nodes.insert(nodes.end(), {condition, action.value});
    }
  };
  for (const Event& event : events) {
    add_actions(event, event.condition);
    if (event.piling_up) add_actions(events[*event.piling_up], event.condition);
  }
  Ancestry found{std::vector<bool>(derivatives.size(), false), std::vector<bool>(n_discrete_states, false)};
  Descent descent(*this);
  const auto add = [&](const std::vector<NodeId>& nodes) {
    for (const NodeId node : nodes) descent.add(node);
  };
  for (const std::uint32_t s : members[of_unit]) descent.add(event_functions[s]);
  descent.run([&](NodeId id) {
    if (const std::uint32_t state = state_at[id]; state != kNone) {
      found.states[state] = true;
      descent.add(derivatives[state]);
      add(on_states[state]);
    }
    if (const std::uint32_t kept = discrete_state_at[id]; kept != kNone) {
      found.discrete_states[kept] = true;
      add(on_discrete_states[kept]);
    }
    if (switch_at[id] != kNone) descent.add(event_functions[switch_at[id]]);
  });
  return found;
}

std::vector<bool> SwitchStructure::followers_of(const std::vector<bool>& these) const {
  // What is read by whom: the operands turned round, and positions that read their event functions.
  const std::size_t size = switch_at.size();
  std::vector<std::uint32_t> first_reader(size + 2, 0), readers(operands.size() + event_functions.size());
  std::vector<NodeId> position_of(event_functions.size(), kNone);
  for (NodeId id = 0; id < size; ++id) {
    if (switch_at[id] != kNone) position_of[switch_at[id]] = id;
  }
  for (const NodeId operand : operands) ++first_reader[operand + 2];
  for (std::size_t i = 2; i < first_reader.size(); ++i) first_reader[i] += first_reader[i - 1];
  for (NodeId id = 0; id < size; ++id) {
    for (std::uint32_t k = first_operand[id]; k < first_operand[id + 1]; ++k)
      readers[first_reader[operands[k] + 1]++] = id;
  }
  std::vector<std::vector<std::uint32_t>> switches_on(size);  // those with this node as their event function
  for (std::uint32_t s = 0; s < event_functions.size(); ++s) switches_on[event_functions[s]].push_back(s);

  std::vector<bool> seen(size, false), follows(event_functions.size(), false);
  std::vector<NodeId> pending;
  const auto reach = [&](NodeId id) {
    if (id == kNone || seen[id]) return;
    seen[id] = true;
    pending.push_back(id);
  };
  for (std::size_t s = 0; s < event_functions.size(); ++s) {
    if (these[s]) reach(position_of[s]);
  }
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    for (const std::uint32_t s : switches_on[id]) {
      follows[s] = true;
      reach(position_of[s]);
    }
    for (std::uint32_t k = first_reader[id]; k < first_reader[id + 1]; ++k) reach(readers[k]);
  }
  return follows;
}

SwitchStructure find_switch_structure(const Network& network) {
  return Finder(network).find();
}

}  // namespace oblique::network
