// SPDX-License-Identifier: MIT
#include <oblique/network/program/program_compiler.h>

#include <algorithm>

namespace oblique::network {

ProgramCompiler::ProgramCompiler(Program& program, Network network)
    : program_(program), network_(std::move(network)) {
  loop_of_unknown_.resize(network_.unknowns.size());
  place_in_loop_.resize(network_.unknowns.size());
  for (std::size_t l = 0; l < network_.loops.size(); ++l) {
    const auto& unknowns = network_.loops[l].unknowns;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      loop_of_unknown_[unknowns[i]] = static_cast<std::uint32_t>(l);
      place_in_loop_[unknowns[i]] = static_cast<std::uint32_t>(i);
    }
  }
}

void ProgramCompiler::compile() {
  program_.switch_structure_ = find_switch_structure(network_);
  differentiate();
  find_positions();
  differentiate_surfaces();
  find_sources();
  find_levels();
  find_needs();
  write_tapes();
  find_sensitivities();
  lay_out_jacobian();
  program_.tape_ = writer_->instructions();
  program_.initial_slots_ = writer_->initial_slots();
  program_.first_memory_ = network_.n_variables();
  program_.first_rate_ = program_.first_memory_ + network_.memories.size();
  program_.memories_ = std::move(network_.memories);
  program_.switches_ = std::move(network_.switches);
  program_.events_ = std::move(network_.events);
  program_.mode_memories_ = std::move(network_.mode_memories);
  program_.states_ = std::move(network_.states);
  program_.unknowns_ = std::move(network_.unknowns);
  program_.loops_ = std::move(network_.loops);
  program_.signal_names_ = std::move(network_.signal_names);
  program_.first_signal_ = std::move(network_.first_signal);
}

void ProgramCompiler::differentiate() {
  for (const State& state : network_.states)
    state_gradients_.push_back(network_.graph.gradient(state.derivative));
  for (const Unknown& unknown : network_.unknowns) {
    residual_gradients_.push_back(network_.graph.gradient(unknown.residual));
  }
}

void ProgramCompiler::find_levels() {
  const ExpressionGraph& graph = network_.graph;
  levels_.assign(graph.size(), 0);
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    for (int i = 0; i < operand_count(node.op); ++i)
      levels_[id] = std::max(levels_[id], levels_[node.operand(i)]);
    if (node.op == Op::variable && is_unknown(node.variable)) {
      levels_[id] = loop_of_unknown_[unknown_of(node.variable)] + 1;
    }
  }
}

void ProgramCompiler::require_loop(std::size_t loop, Needs& needs, std::vector<NodeId>& pending) const {
  if (needs.loops[loop]) return;
  needs.loops[loop] = true;
  for (const std::size_t u : network_.loops[loop].unknowns) {
    pending.push_back(network_.unknowns[u].residual);
    for (const auto& [variable, node] : residual_gradients_[u]) {
      if (is_unknown(variable) && loop_of_unknown_[unknown_of(variable)] == loop) pending.push_back(node);
    }
  }
}

void ProgramCompiler::close_over(NodeId root, Needs& needs) const {
  std::vector<NodeId> pending{root};
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    if (needs.nodes[id]) continue;
    needs.nodes[id] = true;
    const Node& node = network_.graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) pending.push_back(node.operand(i));
    if (node.op == Op::variable && is_unknown(node.variable)) {
      require_loop(loop_of_unknown_[unknown_of(node.variable)], needs, pending);
    }
  }
}

void ProgramCompiler::find_needs() {
  const Needs none{std::vector<bool>(network_.graph.size()), std::vector<bool>(network_.loops.size())};
  for_derivatives_ = for_surfaces_ = for_jacobian_ = for_signals_ = for_rates_ = for_sources_ = none;
  for (const State& state : network_.states) close_over(state.derivative, for_derivatives_);
  for (const NodeId root : surface_roots()) close_over(root, for_surfaces_);
  for (const NodeId root : signal_roots()) close_over(root, for_signals_);
  for (const NodeId root : rate_roots()) close_over(root, for_rates_);
  for (const NodeId root : source_roots()) close_over(root, for_sources_);
  for (const Gradient& gradient : state_gradients_) {
    for (const auto& [variable, node] : gradient) close_over(node, for_jacobian_);
  }
  for (std::size_t u = 0; u < network_.unknowns.size(); ++u) {
    if (!for_derivatives_.loops[loop_of_unknown_[u]]) continue;
    for (const auto& [variable, node] : residual_gradients_[u]) close_over(node, for_jacobian_);
  }
}

/// One side of the comparison: where the two are equal, the magnitude of both.
NodeId ProgramCompiler::compared_side(const Switch& s) const {
  const Node& node = network_.graph[s.surface];
  return node.op == Op::subtract || node.op == Op::add ? node.b : s.surface;
}

/// What tells of events: surfaces, rates of known times, conditions.
std::vector<NodeId> ProgramCompiler::surface_roots() const {
  std::vector<NodeId> roots = network_.phase_ends;
  for (const Switch& s : network_.switches) {
    roots.push_back(s.surface);
    roots.push_back(compared_side(s));
    if (s.rate) roots.push_back(*s.rate);
  }
  for (const Event& event : network_.events) roots.push_back(event.condition);
  return roots;
}

/// The signals, and what events make of them.
std::vector<NodeId> ProgramCompiler::signal_roots() const {
  std::vector<NodeId> roots = network_.signals;
  for (const Event& event : network_.events) {
    for (const Event::Action& action : event.actions) roots.push_back(action.value);
  }
  for (const State& state : network_.states) {
    if (state.start_node) roots.push_back(*state.start_node);
  }
  return roots;
}

std::vector<std::uint32_t> ProgramCompiler::count_uses() const {
  std::vector<std::uint32_t> uses(network_.graph.size(), 0);
  for (NodeId id = 0; id < network_.graph.size(); ++id) {
    if (!for_derivatives_.nodes[id] && !for_surfaces_.nodes[id] && !for_signals_.nodes[id] &&
        !for_jacobian_.nodes[id] && !for_rates_.nodes[id] && !for_sources_.nodes[id]) {
      continue;
    }
    const Node& node = network_.graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) ++uses[node.operand(i)];
  }
  for (const State& state : network_.states) ++uses[state.derivative];
  for (const Unknown& unknown : network_.unknowns) ++uses[unknown.residual];
  for (const auto& roots : {surface_roots(), signal_roots(), rate_roots(), source_roots()}) {
    for (const NodeId root : roots) ++uses[root];
  }
  for (const auto* gradients : {&state_gradients_, &residual_gradients_}) {
    for (const Gradient& gradient : *gradients) {
      for (const auto& [variable, node] : gradient) ++uses[node];
    }
  }
  return uses;
}

void ProgramCompiler::write_tapes() {
  const bool with_rates = !network_.switches.empty();
  const std::size_t n_rates = with_rates ? network_.states.size() + network_.unknowns.size() : 0;
  writer_.emplace(network_.graph, network_.n_variables(), network_.memories.size() + n_rates, network_.tables,
                  count_uses());
  program_.loop_codes_.resize(network_.loops.size());
  in_body_.assign(network_.graph.size(), false);
  const Needs nothing{std::vector<bool>(network_.graph.size()), std::vector<bool>(network_.loops.size())};
  program_.derivative_steps_ = write_steps(for_derivatives_, nothing);
  program_.surface_steps_ = write_steps(for_surfaces_, for_derivatives_);
  Needs done = for_derivatives_;
  for (std::size_t i = 0; i < done.nodes.size(); ++i) done.nodes[i] = done.nodes[i] || for_surfaces_.nodes[i];
  for (std::size_t i = 0; i < done.loops.size(); ++i) done.loops[i] = done.loops[i] || for_surfaces_.loops[i];
  program_.signal_steps_ = write_steps(for_signals_, done);

  std::vector<NodeId> rest;
  for (NodeId id = 0; id < network_.graph.size(); ++id) {
    if (for_jacobian_.nodes[id] && !for_derivatives_.nodes[id]) rest.push_back(id);
  }
  program_.jacobian_stretch_ = writer_->write(rest);
  for (const State& state : network_.states) {
    program_.derivative_slots_.push_back(writer_->slot(state.derivative));
  }
  for (const NodeId signal : network_.signals) program_.signal_slots_.push_back(writer_->slot(signal));
  write_events();
  write_rates();
  write_sources();
  write_switch_order();
  write_pieces();
}

void ProgramCompiler::write_events() {
  TapeWriter& writer = *writer_;
  for (const Switch& s : network_.switches) {
    program_.surface_slots_.push_back(writer.slot(s.surface));
    program_.compared_slots_.push_back(writer.slot(compared_side(s)));
    program_.rate_slots_.push_back(s.rate ? std::optional(writer.slot(*s.rate)) : std::nullopt);
  }
  for (const Event& event : network_.events) {
    Program::EventSlots& slots = program_.event_slots_.emplace_back();
    slots.condition = writer.slot(event.condition);
    for (const Event::Action& action : event.actions) slots.values.push_back(writer.slot(action.value));
  }
  for (const State& state : network_.states) {
    program_.start_slots_.push_back(state.start_node ? std::optional(writer.slot(*state.start_node))
                                                     : std::nullopt);
  }
  for (const NodeId end : network_.phase_ends) program_.phase_end_slots_.push_back(writer.slot(end));
}

std::vector<Program::Step> ProgramCompiler::write_steps(const Needs& wanted, const Needs& done) {
  std::vector<std::vector<NodeId>> by_level(network_.loops.size() + 1);
  for (NodeId id = 0; id < network_.graph.size(); ++id) {
    if (wanted.nodes[id] && !done.nodes[id]) by_level[levels_[id]].push_back(id);
  }
  std::vector<Program::Step> steps;
  std::vector<NodeId> pending = std::move(by_level[0]);
  const auto flush = [&](std::optional<std::uint32_t> loop) {
    std::sort(pending.begin(), pending.end());
    steps.push_back({writer_->write(pending), loop});
    pending.clear();
  };
  for (std::size_t l = 0; l < network_.loops.size(); ++l) {
    std::vector<NodeId>& nodes = by_level[l + 1];
    if (wanted.loops[l] && !done.loops[l]) {
      flush(static_cast<std::uint32_t>(l));
      nodes = write_loop_body(l, std::move(nodes));
    }
    pending.insert(pending.end(), nodes.begin(), nodes.end());
  }
  flush(std::nullopt);
  return steps;
}

/// Writes those of `nodes` that the loop's residuals and slopes need as its body, and gives back the others.
std::vector<NodeId> ProgramCompiler::write_loop_body(std::size_t loop, std::vector<NodeId> nodes) {
  LoopCode& code = program_.loop_codes_[loop];
  const Loop& members = network_.loops[loop];
  TapeWriter& writer = *writer_;
  const auto level = static_cast<std::uint32_t>(loop + 1);

  std::vector<NodeId> roots;
  code.linear = true;
  for (const std::size_t u : members.unknowns) {
    roots.push_back(network_.unknowns[u].residual);
    for (const auto& [variable, node] : residual_gradients_[u]) {
      if (!is_unknown(variable) || loop_of_unknown_[unknown_of(variable)] != loop) continue;
      roots.push_back(node);
      code.linear = code.linear && levels_[node] < level;
    }
  }
  std::vector<NodeId> body;
  while (!roots.empty()) {
    const NodeId id = roots.back();
    roots.pop_back();
    if (levels_[id] != level || in_body_[id]) continue;
    in_body_[id] = true;
    body.push_back(id);
    const Node node = network_.graph[id];
    for (int i = 0; i < operand_count(node.op); ++i) roots.push_back(node.operand(i));
  }
  std::sort(body.begin(), body.end());
  code.body = writer.write(body);

  for (std::size_t i = 0; i < members.unknowns.size(); ++i) {
    const std::size_t u = members.unknowns[i];
    code.unknown_slots.push_back(network_.unknown_variable(u));
    code.residual_slots.push_back(writer.slot(network_.unknowns[u].residual));
    code.natural_scale.push_back(network_.unknowns[u].torn ? 1.0 : 0.0);
    code.held_by_amplifier.push_back(network_.unknowns[u].held_by_amplifier);
    for (const auto& [variable, node] : residual_gradients_[u]) {
      if (!is_unknown(variable) || loop_of_unknown_[unknown_of(variable)] != loop) continue;
      code.slopes.push_back(
          {static_cast<std::uint32_t>(i), place_in_loop_[unknown_of(variable)], writer.slot(node)});
    }
  }
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(), [&](NodeId id) { return in_body_[id]; }),
              nodes.end());
  return nodes;
}

}  // namespace oblique::network
