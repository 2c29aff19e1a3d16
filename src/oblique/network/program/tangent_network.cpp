// SPDX-License-Identifier: MIT
#include <oblique/network/program/tangent_network.h>

#include <algorithm>
#include <utility>

#include <oblique/network/program/tangents.h>

namespace oblique::network {
namespace {

/// Adds discrete states that hold a part of the direction; the first of them.
std::size_t add_direction(Network& network, std::size_t count) {
  const std::size_t first = network.discrete_states.size();
  network.discrete_states.resize(first + count, DiscreteState{"a direction", 0});
  return first;
}

std::size_t add_signal(Network& network, NodeId node) {
  network.signals.push_back(node);
  network.signal_names.emplace_back("a tangent");
  return network.signals.size() - 1;
}

/// The rate of an unknown is the unknown of an equation that is linear in it.
void add_tangent_of_unknown(Network& network, std::size_t u, Tangents& tangents) {
  Unknown moved;
  moved.name = "a tangent of " + network.unknowns[u].name;
  moved.residual = tangents.of(network.unknowns[u].residual);
  moved.torn = network.unknowns[u].torn;
  moved.place = network.unknowns[u].place;
  network.unknowns.push_back(std::move(moved));
}

/// The same loop of the unknowns that stand `offset` behind its own.
void add_loop(Network& network, std::size_t l, std::size_t offset) {
  Loop moved = network.loops[l];
  for (std::size_t& unknown : moved.unknowns) unknown += offset;
  network.loops.push_back(std::move(moved));
}

void drop_events(Network& network) {
  network.switches.clear();
  network.events.clear();
  network.phase_ends.clear();
  network.mode_states.clear();
}

}  // namespace

TangentNetwork with_tangents(Network made, std::span<const std::uint32_t> parameters) {
  TangentNetwork t;
  t.network = std::move(made);
  Network& network = t.network;
  ExpressionGraph& graph = network.graph;
  const std::size_t n_states = network.states.size(), n_unknowns = network.unknowns.size(),
                    n_signals = network.signals.size(), n_loops = network.loops.size();
  const std::size_t n_discrete_states = network.discrete_states.size();
  t.time = add_direction(network, 1);
  t.first_state = add_direction(network, n_states);
  t.first_discrete_state = add_direction(network, n_discrete_states);
  t.first_parameter = add_direction(network, parameters.size());
  const auto held = [&](std::size_t place) {
    return graph.discrete_state(static_cast<std::uint32_t>(place));
  };

  Tangents::Rates rates;
  rates.variable = [&](std::uint32_t variable) {
    if (variable == 0) return held(t.time);
    if (variable <= n_states) return held(t.first_state + variable - 1);
    return graph.variable(static_cast<std::uint32_t>(variable + n_unknowns));
  };
  rates.discrete_state = [&](std::uint32_t number) {
    return number < n_discrete_states ? held(t.first_discrete_state + number) : graph.constant(0);
  };
  rates.parameter = [&](std::uint32_t number) {
    const auto found = std::find(parameters.begin(), parameters.end(), number);
    if (found == parameters.end()) return graph.constant(0);
    return held(t.first_parameter + static_cast<std::size_t>(found - parameters.begin()));
  };
  Tangents tangents(graph, rates);

  for (std::size_t u = 0; u < n_unknowns; ++u) add_tangent_of_unknown(network, u, tangents);
  for (std::size_t l = 0; l < n_loops; ++l) add_loop(network, l, n_unknowns);
  const auto add_tangent = [&](NodeId node) { return add_signal(network, tangents.of(node)); };
  t.derivatives = network.signals.size();
  for (const State& state : network.states) add_tangent(state.derivative);
  t.signals = network.signals.size();
  for (std::size_t s = 0; s < n_signals; ++s) add_tangent(network.signals[s]);
  t.event_values = network.signals.size();
  for (const Switch& s : network.switches) add_signal(network, s.event_function);
  t.event_functions = network.signals.size();
  for (const Switch& s : network.switches) add_tangent(s.event_function);
  t.starts = network.signals.size();
  for (const State& state : network.states) {
    const auto& start = state.start_node ? state.start_node : state.start_constant;
    add_tangent(start ? *start : graph.constant(0));
  }
  rates.discrete_state = [&](std::uint32_t) { return graph.constant(0); };
  Tangents beside_held(graph, rates);
  for (const Event& event : network.events) {
    std::vector<std::size_t>& actions = t.actions.emplace_back();
    std::vector<bool>& moves = t.actions_move.emplace_back();
    for (const Event::Action& action : event.actions) {
      actions.push_back(add_signal(network, action.value));
      add_tangent(action.value);
      moves.push_back(!graph.is_constant(beside_held.of(action.value), 0));
    }
  }
  drop_events(network);
  return t;
}

ParameterDerivatives with_parameter_derivatives(Network made, std::span<const std::uint32_t> parameters) {
  ParameterDerivatives p;
  p.network = std::move(made);
  Network& network = p.network;
  ExpressionGraph& graph = network.graph;
  const std::size_t n_states = network.states.size(), n_unknowns = network.unknowns.size(),
                    n_loops = network.loops.size();
  network.signals.clear();
  network.signal_names.clear();
  for (std::uint32_t k = 0; k < parameters.size(); ++k) {
    const std::size_t offset = n_unknowns * (k + 1);
    Tangents::Rates rates;
    rates.variable = [&](std::uint32_t variable) {
      return variable <= n_states ? graph.constant(0)
                                  : graph.variable(static_cast<std::uint32_t>(variable + offset));
    };
    rates.parameter = [&](std::uint32_t number) { return graph.constant(number == parameters[k] ? 1 : 0); };
    Tangents tangents(graph, rates);
    for (std::size_t u = 0; u < n_unknowns; ++u) add_tangent_of_unknown(network, u, tangents);
    for (std::size_t l = 0; l < n_loops; ++l) add_loop(network, l, offset);
    for (std::uint32_t i = 0; i < n_states; ++i) {
      const NodeId node = tangents.of(network.states[i].derivative);
      if (graph.is_constant(node, 0)) continue;
      add_signal(network, node);
      p.entries.push_back({i, k});
    }
  }
  drop_events(network);
  return p;
}

}  // namespace oblique::network
