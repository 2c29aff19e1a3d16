// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/equation_names.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace oblique::report {
namespace {

using network::Network;
using network::Node;
using network::NodeId;
using network::Op;

/// Leaves of what stands in place where it is used several times; more than that has an equation of its own.
constexpr double kShortLeaves = 3;

/// Leaves beyond which a signal has an equation of its own though it is used once.
constexpr double kLongLeaves = 24;

struct Multiple {
  std::size_t variable;
  double factor;
};

/// What is a number times a state or an unknown, as behind inverters and coefficients.
std::optional<Multiple> multiple_of_variable(const network::ExpressionGraph& graph, NodeId id) {
  double factor = 1;
  for (;;) {
    const Node& node = graph[id];
    const auto value = [&](NodeId operand) { return graph[operand].value; };
    if (node.op == Op::variable && node.variable != 0) return Multiple{node.variable, factor};
    if (node.op == Op::negate) {
      factor = -factor;
      id = node.a;
    } else if (node.op == Op::multiply && graph.is_constant(node.a)) {
      factor *= value(node.a);
      id = node.b;
    } else if ((node.op == Op::multiply || node.op == Op::divide) && graph.is_constant(node.b)) {
      factor = node.op == Op::divide ? factor / value(node.b) : factor * value(node.b);
      id = node.a;
    } else {
      return std::nullopt;
    }
  }
}

NodeId node_of(const Network& network, const diagram::FlatOutput& output) {
  return network.signals[network.signal_index(output.signal)];
}

void name_variables(const Network& network, const diagram::FlatDiagram& diagram, EquationNames& names) {
  names.variables.push_back({"t", 1});
  for (const network::State& state : network.states) names.variables.push_back({state.name, 1});
  for (const network::Unknown& unknown : network.unknowns) names.variables.push_back({unknown.name, 1});
  std::set<std::size_t> shown;
  for (const diagram::FlatOutput& output : diagram.outputs) {
    const auto part = multiple_of_variable(network.graph, node_of(network, output));
    if (!part || part->factor * output.scale == 0 || output.offset != 0) continue;
    if (shown.insert(part->variable).second)
      names.variables[part->variable] = {output.name, 1 / (part->factor * output.scale)};
  }
}

void name_signals(const Network& network, EquationNames& names) {
  for (std::size_t s = 0; s < network.signals.size(); ++s) {
    const Op op = network.graph[network.signals[s]].op;
    if (op != Op::variable && op != Op::constant && op != Op::discrete_state)
      names.signals.emplace(network.signals[s], Quantity{network.signal_names[s], 1});
  }
}

/// How often each node stands in the equations, once it is reached by them at all.
std::vector<int> count_uses(const Network& network, const diagram::FlatDiagram& diagram,
                            std::vector<bool>& reached) {
  for (const network::State& state : network.states) reached[state.derivative] = true;
  for (const network::Unknown& unknown : network.unknowns) reached[unknown.residual] = true;
  for (const diagram::FlatOutput& output : diagram.outputs) reached[node_of(network, output)] = true;
  std::vector<int> uses(network.graph.size(), 0);
  for (auto id = static_cast<NodeId>(network.graph.size()); id-- > 0;) {
    if (!reached[id]) continue;
    const Node& node = network.graph[id];
    for (int k = 0; k < network::operand_count(node.op); ++k) {
      reached[node.operand(k)] = true;
      ++uses[node.operand(k)];
    }
  }
  return uses;
}

void set_apart(const Network& network, const diagram::FlatDiagram& diagram, EquationNames& names) {
  std::vector<bool> reached(network.graph.size(), false);
  const std::vector<int> uses = count_uses(network, diagram, reached);
  std::vector<double> leaves(network.graph.size(), 1);
  int unnamed = 0;
  for (NodeId id = 0; id < network.graph.size(); ++id) {
    if (!reached[id]) continue;
    const Node& node = network.graph[id];
    double sum = 0;
    for (int k = 0; k < network::operand_count(node.op); ++k) {
      if (network.graph[node.operand(k)].op != Op::constant) sum += leaves[node.operand(k)];
    }
    leaves[id] = std::max(1.0, sum);
    const bool long_enough = uses[id] > 1 ? leaves[id] > kShortLeaves : leaves[id] > kLongLeaves;
    if (!names.signals.contains(id) && uses[id] > 1 && leaves[id] > kLongLeaves)
      names.signals.emplace(id, Quantity{fmt::format("u{}", ++unnamed), 1});
    if (!names.signals.contains(id) || !long_enough) continue;
    names.apart.insert(id);
    leaves[id] = 1;
  }
}

/// The first output of a signal that stands apart gives it its name.
void name_outputs(const Network& network, const diagram::FlatDiagram& diagram, EquationNames& names) {
  std::set<NodeId> named;
  for (const diagram::FlatOutput& output : diagram.outputs) {
    const NodeId id = node_of(network, output);
    const auto part = multiple_of_variable(network.graph, id);
    if (part && output.offset == 0 && names.variables[part->variable].name == output.name) continue;
    if (names.apart.contains(id) && output.offset == 0 && output.scale != 0 && named.insert(id).second) {
      names.signals.at(id) = {output.name, 1 / output.scale};
      names.apart_outputs.push_back(id);
    } else {
      names.other_outputs.push_back({output.name, id, output.scale, output.offset});
    }
  }
}

}  // namespace

EquationNames name_equations(const Network& network, const diagram::FlatDiagram& diagram) {
  EquationNames names;
  name_variables(network, diagram, names);
  name_signals(network, names);
  set_apart(network, diagram, names);
  name_outputs(network, diagram, names);
  return names;
}

}  // namespace oblique::report
