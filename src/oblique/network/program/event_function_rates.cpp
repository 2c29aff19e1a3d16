// SPDX-License-Identifier: MIT
#include <oblique/network/program/event_function_rates.h>

#include <algorithm>

#include <oblique/network/program/tangents.h>

namespace oblique::network {
namespace {

/// d variable/dt: of states and unknowns a number that is put in, as if it were a discrete state.
NodeId rate_of(Compilation& c, std::uint32_t variable) {
  if (variable == 0) return c.network.graph.constant(1);
  if (c.is_unknown(variable)) c.loop_rates.try_emplace(c.loop_of_unknown[c.unknown_of(variable)]);
  return c.network.graph.discrete_state(static_cast<std::uint32_t>(c.network.discrete_states.size()) +
                                        variable - 1);
}

/// d/dt of what has this gradient. The unknowns of one loop may be left out.
NodeId total_derivative(Compilation& c, const Compilation::Gradient& gradient, std::size_t without_loop) {
  ExpressionGraph& graph = c.network.graph;
  NodeId sum = graph.constant(0);
  for (const auto& [variable, derivative] : gradient) {
    NodeId term = derivative;
    if (variable != 0) {
      if (c.is_unknown(variable) && c.loop_of_unknown[c.unknown_of(variable)] == without_loop) continue;
      term = graph.apply(Op::multiply, derivative, rate_of(c, variable));
    }
    sum = graph.apply(Op::add, sum, term);
  }
  return sum;
}

/// Arguments of periodic functions below an event function that do not follow the time alone, which is seen
/// otherwise.
void find_phases(Compilation& c, Tangents& rates) {
  const ExpressionGraph& graph = c.network.graph;
  std::vector<NodeId> pending, arguments;
  for (const Switch& s : c.network.switches) pending.push_back(s.event_function);
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

void differentiate_event_functions(Compilation& c) {
  Tangents rates(c.network.graph, [&c](std::uint32_t variable) { return rate_of(c, variable); });
  for (const Switch& s : c.network.switches) c.event_function_rates.push_back(rates.of(s.event_function));
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
  std::vector<NodeId> roots = c.event_function_rates;
  roots.insert(roots.end(), c.phase_rates.begin(), c.phase_rates.end());
  for (const auto& [loop, rates] : c.loop_rates) roots.insert(roots.end(), rates.begin(), rates.end());
  return roots;
}

void write_rates(Compilation& c) {
  const ExpressionGraph& graph = c.network.graph;
  const std::size_t first_unknown_rate = c.network.discrete_states.size() + c.network.states.size();
  std::vector<std::uint32_t> after(graph.size(), 0);  ///< of a node: 1 + the last loop whose rates it needs
  std::vector<std::vector<NodeId>> pending(c.network.loops.size() + 1);
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    if (node.op == Op::discrete_state && node.variable >= first_unknown_rate)
      after[id] = c.loop_of_unknown[node.variable - first_unknown_rate] + 1;
    for (int i = 0; i < operand_count(node.op); ++i) after[id] = std::max(after[id], after[node.operand(i)]);
    const bool done = c.for_derivatives.nodes[id] || c.for_event_functions.nodes[id];
    if (c.for_rates.nodes[id] && !done) pending[after[id]].push_back(id);
  }
  std::vector<NodeId> segment = std::move(pending[0]);
  const auto flush = [&] {
    std::sort(segment.begin(), segment.end());
    ProgramCode::RateStep& step = c.code.rate_steps.emplace_back();
    step.segment = c.writer->write(segment);
    segment.clear();
  };
  for (const auto& [loop, rates] : c.loop_rates) {
    flush();
    ProgramCode::RateStep& step = c.code.rate_steps.back();
    step.loop = static_cast<std::uint32_t>(loop);
    for (const NodeId rate : rates) step.right_sides.push_back(c.writer->slot(rate));
    for (const std::size_t u : c.network.loops[loop].unknowns)
      step.rates.push_back(static_cast<std::uint32_t>(c.network.n_variables() + first_unknown_rate + u));
    segment = std::move(pending[loop + 1]);
  }
  flush();
  for (const NodeId rate : c.event_function_rates)
    c.code.event_function_rate_slots.push_back(c.writer->slot(rate));
  for (const NodeId rate : c.phase_rates) c.code.phase_rate_slots.push_back(c.writer->slot(rate));
}

}  // namespace oblique::network
