// SPDX-License-Identifier: MIT
#include <oblique/network/program/program_compiler.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <oblique/network/program/compilation.h>
#include <oblique/network/program/event_function_rates.h>
#include <oblique/network/program/jacobian_layout.h>
#include <oblique/network/program/sources.h>
#include <oblique/network/program/switch_order.h>

namespace oblique::network {
namespace {

void differentiate(Compilation& c) {
  for (const State& state : c.network.states)
    c.state_gradients.push_back(c.network.graph.gradient(state.derivative));
  for (const Unknown& unknown : c.network.unknowns) {
    c.residual_gradients.push_back(c.network.graph.gradient(unknown.residual));
  }
}

void find_levels(Compilation& c) {
  const ExpressionGraph& graph = c.network.graph;
  c.levels.assign(graph.size(), 0);
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    for (int i = 0; i < operand_count(node.op); ++i)
      c.levels[id] = std::max(c.levels[id], c.levels[node.operand(i)]);
    if (node.op == Op::variable && c.is_unknown(node.variable)) {
      c.levels[id] = c.loop_of_unknown[c.unknown_of(node.variable)] + 1;
    }
  }
}

/// What tells of events: event functions, rates of known times, conditions.
std::vector<NodeId> event_function_roots(const Compilation& c) {
  std::vector<NodeId> roots = c.network.phase_ends;
  for (const Switch& s : c.network.switches) {
    roots.push_back(s.event_function);
    roots.push_back(c.compared_side(s));
    if (s.rate) roots.push_back(*s.rate);
  }
  for (const Event& event : c.network.events) roots.push_back(event.condition);
  return roots;
}

/// The signals, and what events make of them.
std::vector<NodeId> signal_roots(const Compilation& c) {
  std::vector<NodeId> roots = c.network.signals;
  for (const Event& event : c.network.events) {
    for (const Event::Action& action : event.actions) roots.push_back(action.value);
  }
  for (const State& state : c.network.states) {
    if (state.start_node) roots.push_back(*state.start_node);
  }
  return roots;
}

void find_needs(Compilation& c) {
  c.for_derivatives = c.for_event_functions = c.for_jacobian = c.for_signals = c.for_rates = c.for_sources =
      c.no_needs();
  for (const State& state : c.network.states) c.close_over(state.derivative, c.for_derivatives);
  for (const NodeId root : event_function_roots(c)) c.close_over(root, c.for_event_functions);
  for (const NodeId root : signal_roots(c)) c.close_over(root, c.for_signals);
  for (const NodeId root : rate_roots(c)) c.close_over(root, c.for_rates);
  for (const NodeId root : source_roots(c)) c.close_over(root, c.for_sources);
  for (const Compilation::Gradient& gradient : c.state_gradients) {
    for (const auto& [variable, node] : gradient) c.close_over(node, c.for_jacobian);
  }
  for (std::size_t u = 0; u < c.network.unknowns.size(); ++u) {
    if (!c.for_derivatives.loops[c.loop_of_unknown[u]]) continue;
    for (const auto& [variable, node] : c.residual_gradients[u]) c.close_over(node, c.for_jacobian);
  }
}

std::vector<std::uint32_t> count_uses(const Compilation& c) {
  std::vector<std::uint32_t> uses(c.network.graph.size(), 0);
  for (NodeId id = 0; id < c.network.graph.size(); ++id) {
    if (!c.for_derivatives.nodes[id] && !c.for_event_functions.nodes[id] && !c.for_signals.nodes[id] &&
        !c.for_jacobian.nodes[id] && !c.for_rates.nodes[id] && !c.for_sources.nodes[id]) {
      continue;
    }
    const Node& node = c.network.graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) ++uses[node.operand(i)];
  }
  for (const State& state : c.network.states) ++uses[state.derivative];
  for (const Unknown& unknown : c.network.unknowns) ++uses[unknown.residual];
  for (const auto& roots : {event_function_roots(c), signal_roots(c), rate_roots(c), source_roots(c)}) {
    for (const NodeId root : roots) ++uses[root];
  }
  for (const auto* gradients : {&c.state_gradients, &c.residual_gradients}) {
    for (const Compilation::Gradient& gradient : *gradients) {
      for (const auto& [variable, node] : gradient) ++uses[node];
    }
  }
  return uses;
}

void write_events(Compilation& c) {
  TapeWriter& writer = *c.writer;
  for (const Switch& s : c.network.switches) {
    c.code.event_function_slots.push_back(writer.slot(s.event_function));
    c.code.compared_slots.push_back(writer.slot(c.compared_side(s)));
    c.code.rate_slots.push_back(s.rate ? std::optional(writer.slot(*s.rate)) : std::nullopt);
  }
  for (const Event& event : c.network.events) {
    ProgramCode::EventSlots& slots = c.code.event_slots.emplace_back();
    slots.condition = writer.slot(event.condition);
    for (const Event::Action& action : event.actions) slots.values.push_back(writer.slot(action.value));
  }
  for (const State& state : c.network.states) {
    c.code.start_slots.push_back(state.start_node ? std::optional(writer.slot(*state.start_node))
                                                  : std::nullopt);
  }
  for (const NodeId end : c.network.phase_ends) c.code.phase_end_slots.push_back(writer.slot(end));
}

/// Writes those of `nodes` that the loop's residuals and Jacobian need as its body, and gives back the
/// others.
std::vector<NodeId> write_loop_body(Compilation& c, std::size_t loop, std::vector<NodeId> nodes) {
  LoopCode& code = c.code.loop_codes[loop];
  const Loop& members = c.network.loops[loop];
  TapeWriter& writer = *c.writer;
  const auto level = static_cast<std::uint32_t>(loop + 1);

  std::vector<NodeId> roots;
  code.linear = true;
  for (const std::size_t u : members.unknowns) {
    roots.push_back(c.network.unknowns[u].residual);
    for (const auto& [variable, node] : c.residual_gradients[u]) {
      if (!c.is_unknown(variable) || c.loop_of_unknown[c.unknown_of(variable)] != loop) continue;
      roots.push_back(node);
      code.linear = code.linear && c.levels[node] < level;
    }
  }
  std::vector<NodeId> body;
  while (!roots.empty()) {
    const NodeId id = roots.back();
    roots.pop_back();
    if (c.levels[id] != level || c.in_body[id]) continue;
    c.in_body[id] = true;
    body.push_back(id);
    const Node node = c.network.graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) roots.push_back(node.operand(i));
  }
  std::sort(body.begin(), body.end());
  code.body = writer.write(body);

  for (std::size_t i = 0; i < members.unknowns.size(); ++i) {
    const std::size_t u = members.unknowns[i];
    code.unknown_slots.push_back(c.network.unknown_variable(u));
    code.residual_slots.push_back(writer.slot(c.network.unknowns[u].residual));
    code.natural_scale.push_back(c.network.unknowns[u].torn ? 1.0 : 0.0);
    code.held_by_amplifier.push_back(c.network.unknowns[u].held_by_amplifier);
    for (const auto& [variable, node] : c.residual_gradients[u]) {
      if (!c.is_unknown(variable) || c.loop_of_unknown[c.unknown_of(variable)] != loop) continue;
      code.jacobian.push_back(
          {static_cast<std::uint32_t>(i), c.place_in_loop[c.unknown_of(variable)], writer.slot(node)});
    }
  }
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(), [&](NodeId id) { return c.in_body[id]; }),
              nodes.end());
  return nodes;
}
std::vector<ProgramCode::Step> write_steps(Compilation& c, const Compilation::Needs& wanted,
                                           const Compilation::Needs& done) {
  std::vector<std::vector<NodeId>> by_level(c.network.loops.size() + 1);
  for (NodeId id = 0; id < c.network.graph.size(); ++id) {
    if (wanted.nodes[id] && !done.nodes[id]) by_level[c.levels[id]].push_back(id);
  }
  std::vector<ProgramCode::Step> steps;
  std::vector<NodeId> pending = std::move(by_level[0]);
  const auto flush = [&](std::optional<std::uint32_t> loop) {
    std::sort(pending.begin(), pending.end());
    steps.push_back({c.writer->write(pending), loop});
    pending.clear();
  };
  for (std::size_t l = 0; l < c.network.loops.size(); ++l) {
    std::vector<NodeId>& nodes = by_level[l + 1];
    if (wanted.loops[l] && !done.loops[l]) {
      flush(static_cast<std::uint32_t>(l));
      nodes = write_loop_body(c, l, std::move(nodes));
    }
    pending.insert(pending.end(), nodes.begin(), nodes.end());
  }
  flush(std::nullopt);
  return steps;
}

/// How the constants on slots follow from parameters.
void write_constants(Compilation& c) {
  const ExpressionGraph& graph = c.network.graph;
  std::unordered_map<NodeId, std::uint32_t> place;
  const auto add = [&](NodeId node, ProgramCode::Constant made) {
    place.emplace(node, static_cast<std::uint32_t>(c.code.constants.size()));
    made.value = graph[node].value;
    made.slot = c.writer->known_slot(node);
    c.code.constants.push_back(made);
  };
  for (const ConstantFormula& formula : graph.formulas()) {
    ProgramCode::Constant made;
    made.parameter = formula.parameter;
    made.decided = formula.decided;
    if (formula.parameter == ConstantFormula::kNoParameter) {
      for (const NodeId operand : {formula.a, formula.b}) {
        if (!place.contains(operand)) add(operand, {});
      }
      made.op = formula.op;
      made.a = place.at(formula.a);
      made.b = place.at(formula.b);
    }
    add(formula.node, made);
  }
}

void write_tapes(Compilation& c) {
  const bool with_rates = !c.network.switches.empty();
  const std::size_t n_rates = with_rates ? c.network.states.size() + c.network.unknowns.size() : 0;
  c.writer.emplace(c.network.graph, c.network.n_variables(), c.network.discrete_states.size() + n_rates,
                   c.network.tables, count_uses(c));
  c.code.loop_codes.resize(c.network.loops.size());
  c.in_body.assign(c.network.graph.size(), false);
  const Compilation::Needs nothing = c.no_needs();
  c.code.derivative_steps = write_steps(c, c.for_derivatives, nothing);
  c.code.event_function_steps = write_steps(c, c.for_event_functions, c.for_derivatives);
  Compilation::Needs done = c.for_derivatives;
  for (std::size_t i = 0; i < done.nodes.size(); ++i)
    done.nodes[i] = done.nodes[i] || c.for_event_functions.nodes[i];
  for (std::size_t i = 0; i < done.loops.size(); ++i)
    done.loops[i] = done.loops[i] || c.for_event_functions.loops[i];
  c.code.signal_steps = write_steps(c, c.for_signals, done);

  std::vector<NodeId> rest;
  for (NodeId id = 0; id < c.network.graph.size(); ++id) {
    if (c.for_jacobian.nodes[id] && !c.for_derivatives.nodes[id]) rest.push_back(id);
  }
  c.code.jacobian_segment = c.writer->write(rest);
  for (const State& state : c.network.states) {
    c.code.derivative_slots.push_back(c.writer->slot(state.derivative));
  }
  for (const NodeId signal : c.network.signals) c.code.signal_slots.push_back(c.writer->slot(signal));
  write_events(c);
  write_rates(c);
  write_sources(c);
  write_switch_order(c);
  write_pieces(c);
  for (const State& state : c.network.states) {
    c.code.fixed_start_slots.push_back(
        state.start_constant ? std::optional(c.writer->slot(*state.start_constant)) : std::nullopt);
  }
}

}  // namespace

ProgramCode compile(Network network) {
  Compilation c(std::move(network));
  c.code.switch_structure = find_switch_structure(c.network);
  differentiate(c);
  find_positions(c);
  differentiate_event_functions(c);
  find_sources(c);
  find_levels(c);
  find_needs(c);
  write_tapes(c);
  lay_out_jacobian(c);
  write_constants(c);
  c.code.n_parameters = c.network.n_parameters;
  c.code.tape = c.writer->instructions();
  c.code.initial_slots = c.writer->initial_slots();
  c.code.first_discrete_state = c.network.n_variables();
  c.code.first_rate = c.code.first_discrete_state + c.network.discrete_states.size();
  c.code.discrete_states = std::move(c.network.discrete_states);
  c.code.switches = std::move(c.network.switches);
  c.code.events = std::move(c.network.events);
  c.code.mode_states = std::move(c.network.mode_states);
  c.code.states = std::move(c.network.states);
  c.code.unknowns = std::move(c.network.unknowns);
  c.code.loops = std::move(c.network.loops);
  c.code.signal_names = std::move(c.network.signal_names);
  c.code.first_signal = std::move(c.network.first_signal);
  return std::move(c.code);
}

}  // namespace oblique::network
