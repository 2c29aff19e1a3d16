// SPDX-License-Identifier: MIT
#include <oblique/network/program/surface_rates.h>

#include <algorithm>

#include <oblique/network/program/tangents.h>

namespace oblique::network {
namespace {

/// d variable/dt: of states and unknowns a number that is put in, as if it were a memory.
NodeId rate_of(Compilation& c, std::uint32_t variable) {
  if (variable == 0) return c.network.graph.constant(1);
  if (c.is_unknown(variable)) c.loop_rates.try_emplace(c.loop_of_unknown[c.unknown_of(variable)]);
  return c.network.graph.memory(static_cast<std::uint32_t>(c.network.memories.size()) + variable - 1);
}

/// d/dt of what has this gradient. The unknowns of one loop may be left out.
NodeId total_derivative(Compilation& c, const Compilation::Gradient& gradient, std::size_t without_loop) {
  ExpressionGraph& graph = c.network.graph;
  NodeId sum = graph.constant(0);
  for (const auto& [variable, slope] : gradient) {
    NodeId term = slope;
    if (variable != 0) {
      if (c.is_unknown(variable) && c.loop_of_unknown[c.unknown_of(variable)] == without_loop) continue;
      term = graph.apply(Op::multiply, slope, rate_of(c, variable));
    }
    sum = graph.apply(Op::add, sum, term);
  }
  return sum;
}

/// Arguments of periodic functions below a surface that do not follow the time alone, which is seen
/// otherwise.
void find_phases(Compilation& c, Tangents& rates) {
  const ExpressionGraph& graph = c.network.graph;
  std::vector<NodeId> pending, arguments;
  for (const Switch& s : c.network.switches) pending.push_back(s.surface);
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
  for (const NodeId argument : arguments) c.phase_rates.push_back(rates.of(argument));
}

}  // namespace

void differentiate_surfaces(Compilation& c) {
  Tangents rates(c.network.graph, [&c](std::uint32_t variable) { return rate_of(c, variable); });
  for (const Switch& s : c.network.switches) c.surface_rates.push_back(rates.of(s.surface));
  find_phases(c, rates);
  // A loop's rates may need those of loops before it.
  for (std::size_t l = c.network.loops.size(); l-- > 0;) {
    const auto found = c.loop_rates.find(l);
    if (found == c.loop_rates.end()) continue;
    std::vector<NodeId> right_sides;
    for (const std::size_t u : c.network.loops[l].unknowns)
      right_sides.push_back(total_derivative(c, c.residual_gradients[u], l));
    found->second = std::move(right_sides);
  }
}

std::vector<NodeId> rate_roots(const Compilation& c) {
  std::vector<NodeId> roots = c.surface_rates;
  roots.insert(roots.end(), c.phase_rates.begin(), c.phase_rates.end());
  for (const auto& [loop, rates] : c.loop_rates) roots.insert(roots.end(), rates.begin(), rates.end());
  return roots;
}

void write_rates(Compilation& c) {
  const ExpressionGraph& graph = c.network.graph;
  const std::size_t first_unknown_rate = c.network.memories.size() + c.network.states.size();
  std::vector<std::uint32_t> after(graph.size(), 0);  ///< of a node: 1 + the last loop whose rates it needs
  std::vector<std::vector<NodeId>> pending(c.network.loops.size() + 1);
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    if (node.op == Op::memory && node.variable >= first_unknown_rate)
      after[id] = c.loop_of_unknown[node.variable - first_unknown_rate] + 1;
    for (int i = 0; i < operand_count(node.op); ++i) after[id] = std::max(after[id], after[node.operand(i)]);
    const bool done = c.for_derivatives.nodes[id] || c.for_surfaces.nodes[id];
    if (c.for_rates.nodes[id] && !done) pending[after[id]].push_back(id);
  }
  std::vector<NodeId> stretch = std::move(pending[0]);
  const auto flush = [&] {
    std::sort(stretch.begin(), stretch.end());
    ProgramCode::RateStep& step = c.code.rate_steps.emplace_back();
    step.stretch = c.writer->write(stretch);
    stretch.clear();
  };
  for (const auto& [loop, rates] : c.loop_rates) {
    flush();
    ProgramCode::RateStep& step = c.code.rate_steps.back();
    step.loop = static_cast<std::uint32_t>(loop);
    for (const NodeId rate : rates) step.right_sides.push_back(c.writer->slot(rate));
    for (const std::size_t u : c.network.loops[loop].unknowns)
      step.rates.push_back(static_cast<std::uint32_t>(c.network.n_variables() + first_unknown_rate + u));
    stretch = std::move(pending[loop + 1]);
  }
  flush();
  for (const NodeId rate : c.surface_rates) c.code.surface_rate_slots.push_back(c.writer->slot(rate));
  for (const NodeId rate : c.phase_rates) c.code.phase_rate_slots.push_back(c.writer->slot(rate));
}

}  // namespace oblique::network
