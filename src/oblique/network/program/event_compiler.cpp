// SPDX-License-Identifier: MIT
// The part of ProgramCompiler that prepares the search for events: how quickly surfaces move, and what the
// time alone does.
#include <algorithm>
#include <array>

#include <oblique/network/program/program_compiler.h>

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

}  // namespace

/// d variable/dt: of states and unknowns a number that is put in, as if it were a memory.
NodeId ProgramCompiler::rate_of(std::uint32_t variable) {
  if (variable == 0) return network_.graph.constant(1);
  if (is_unknown(variable)) loop_rates_.try_emplace(loop_of_unknown_[unknown_of(variable)]);
  return network_.graph.memory(static_cast<std::uint32_t>(network_.memories.size()) + variable - 1);
}

/// d/dt of what has this gradient. The unknowns of one loop may be left out.
NodeId ProgramCompiler::total_derivative(const Gradient& gradient, std::size_t without_loop) {
  ExpressionGraph& graph = network_.graph;
  NodeId sum = graph.constant(0);
  for (const auto& [variable, slope] : gradient) {
    NodeId term = slope;
    if (variable != 0) {
      if (is_unknown(variable) && loop_of_unknown_[unknown_of(variable)] == without_loop) continue;
      term = graph.apply(Op::multiply, slope, rate_of(variable));
    }
    sum = graph.apply(Op::add, sum, term);
  }
  return sum;
}

void ProgramCompiler::differentiate_surfaces() {
  Tangents rates(network_.graph, [this](std::uint32_t variable) { return rate_of(variable); });
  for (const Switch& s : network_.switches) surface_rates_.push_back(rates.of(s.surface));
  find_phases(rates);
  // A loop's rates may need those of loops before it.
  for (std::size_t l = network_.loops.size(); l-- > 0;) {
    const auto found = loop_rates_.find(l);
    if (found == loop_rates_.end()) continue;
    std::vector<NodeId> right_sides;
    for (const std::size_t u : network_.loops[l].unknowns)
      right_sides.push_back(total_derivative(residual_gradients_[u], l));
    found->second = std::move(right_sides);
  }
}

/// Arguments of periodic functions below a surface that do not follow the time alone, which is seen
/// otherwise.
void ProgramCompiler::find_phases(Tangents& rates) {
  const ExpressionGraph& graph = network_.graph;
  std::vector<NodeId> pending, arguments;
  for (const Switch& s : network_.switches) pending.push_back(s.surface);
  std::vector<bool> seen(graph.size());
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    if (seen[id]) continue;
    seen[id] = true;
    const Node& node = graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) pending.push_back(node.operand(i));
    const auto operation = smooth_operation(node.op);
    const bool periodic = operation && text::info_of(*operation).is(text::kPeriodic);
    if (periodic && graph[node.a].continuous) arguments.push_back(node.a);
  }
  for (const NodeId argument : arguments) phase_rates_.push_back(rates.of(argument));
}

/// The largest parts of the equations made by functions that can be next to nothing here and a peak there, of
/// states that a solver follows (of sums, products, sines and cosines of those it sees what they do).
void ProgramCompiler::find_peaks(const std::vector<bool>& acts, const std::vector<bool>& clocks,
                                 const std::function<bool(NodeId)>& follows_states) {
  const ExpressionGraph& graph = network_.graph;
  std::vector<bool> by_unknowns(graph.size()), covered(graph.size()), reached(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    by_unknowns[id] = node.op == Op::variable && is_unknown(node.variable);
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
    if (peak) sources_.push_back({id, id, true, true, std::nullopt});
    for (int i = 0; i < operand_count(node.op); ++i) {
      const NodeId child = node.operand(i);
      covered[child] = covered[child] || covered[id] || peak;
      reached[child] = reached[child] || reached[id] || peak;
    }
    const bool state = node.op == Op::variable && is_state(node.variable);
    if (state && reached[id] && !clocks[state_of(node.variable)])
      program_.source_states_.push_back(state_of(node.variable));
  }
}

/// The largest parts of the equations that follow the time alone, and not linearly. An integrator of what
/// only events change is a clock, and tells the time as well.
void ProgramCompiler::find_sources() {
  ExpressionGraph& graph = network_.graph;
  const std::size_t size = graph.size();
  std::vector<Follows> follows(size);
  std::vector<bool> clocks(network_.states.size(), false);
  const auto find_follows = [&] {
    for (NodeId id = 0; id < size; ++id) follows[id] = follows_of(graph, graph[id], clocks, follows);
  };
  find_follows();
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    clocks[i] = follows[network_.states[i].derivative] == Follows::nothing;
    if (clocks[i]) program_.source_states_.push_back(i);
  }
  program_.n_clocks_ = program_.source_states_.size();
  find_follows();
  std::vector<bool> is_root(size), acts(size), needed(size);
  std::vector<NodeId> acting, others = network_.signals;
  for (const State& state : network_.states) acting.push_back(state.derivative);
  for (const Unknown& unknown : network_.unknowns) acting.push_back(unknown.residual);
  for (const Switch& s : network_.switches) acting.push_back(s.surface);
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
  find_peaks(acts, clocks, [&](NodeId id) { return follows[id] == Follows::states; });
  Tangents slopes(graph, [&](std::uint32_t variable) {
    return variable == 0 ? graph.constant(1) : network_.states[variable - 1].derivative;
  });
  std::map<NodeId, std::size_t> source_of;
  for (NodeId id = 0; id < size; ++id) {
    if (!is_root[id] || follows[id] != Follows::time) continue;
    source_of.emplace(id, sources_.size());
    sources_.push_back({id, slopes.of(id), acts[id], false, std::nullopt});
  }
  for (std::size_t s = 0; s < network_.switches.size(); ++s) {
    const auto same = source_of.find(network_.switches[s].surface);
    if (same == source_of.end()) continue;
    std::optional<std::uint32_t>& index = sources_[same->second].switch_index;
    if (!index) index = static_cast<std::uint32_t>(s);
  }
}

std::vector<NodeId> ProgramCompiler::rate_roots() const {
  std::vector<NodeId> roots = surface_rates_;
  roots.insert(roots.end(), phase_rates_.begin(), phase_rates_.end());
  for (const auto& [loop, rates] : loop_rates_) roots.insert(roots.end(), rates.begin(), rates.end());
  return roots;
}

std::vector<NodeId> ProgramCompiler::source_roots() const {
  std::vector<NodeId> roots;
  for (const FoundSource& source : sources_) {
    roots.push_back(source.value);
    roots.push_back(source.slope);
  }
  return roots;
}

/// In the order of the loops: what needs no rate of their unknowns, then loop by loop those rates and what
/// they are needed for.
void ProgramCompiler::write_rates() {
  const ExpressionGraph& graph = network_.graph;
  const std::size_t first_unknown_rate = network_.memories.size() + network_.states.size();
  std::vector<std::uint32_t> after(graph.size(), 0);  ///< of a node: 1 + the last loop whose rates it needs
  std::vector<std::vector<NodeId>> pending(network_.loops.size() + 1);
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    if (node.op == Op::memory && node.variable >= first_unknown_rate)
      after[id] = loop_of_unknown_[node.variable - first_unknown_rate] + 1;
    for (int i = 0; i < operand_count(node.op); ++i) after[id] = std::max(after[id], after[node.operand(i)]);
    const bool done = for_derivatives_.nodes[id] || for_surfaces_.nodes[id];
    if (for_rates_.nodes[id] && !done) pending[after[id]].push_back(id);
  }
  std::vector<NodeId> stretch = std::move(pending[0]);
  const auto flush = [&] {
    std::sort(stretch.begin(), stretch.end());
    Program::RateStep& step = program_.rate_steps_.emplace_back();
    step.stretch = writer_->write(stretch);
    stretch.clear();
  };
  for (const auto& [loop, rates] : loop_rates_) {
    flush();
    Program::RateStep& step = program_.rate_steps_.back();
    step.loop = static_cast<std::uint32_t>(loop);
    for (const NodeId rate : rates) step.right_sides.push_back(writer_->slot(rate));
    for (const std::size_t u : network_.loops[loop].unknowns)
      step.rates.push_back(static_cast<std::uint32_t>(network_.n_variables() + first_unknown_rate + u));
    stretch = std::move(pending[loop + 1]);
  }
  flush();
  for (const NodeId rate : surface_rates_) program_.surface_rate_slots_.push_back(writer_->slot(rate));
  for (const NodeId rate : phase_rates_) program_.phase_rate_slots_.push_back(writer_->slot(rate));
}

void ProgramCompiler::write_sources() {
  std::vector<NodeId> nodes;
  for (NodeId id = 0; id < network_.graph.size(); ++id) {
    if (for_sources_.nodes[id]) nodes.push_back(id);
  }
  program_.source_stretch_ = writer_->write(nodes);
  for (const FoundSource& source : sources_)
    program_.sources_.push_back({writer_->slot(source.value), writer_->slot(source.slope), source.acts,
                                 source.by_states, source.switch_index});
}

}  // namespace oblique::network
