// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/assembly.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/network/assembly/event_assembly.h>
#include <oblique/network/assembly/mode_assembly.h>
#include <oblique/network/assembly/switch_assembly.h>
#include <oblique/network/assembly/table_assembly.h>
#include <oblique/network/graph/expression_builder.h>

namespace oblique::network {
namespace {

/// The names of one block's equations.
class BlockContext final : public ExpressionContext {
 public:
  BlockContext(Assembly& assembly, std::size_t block) : assembly_(assembly), block_(block) {}

  NodeId node_of_name(std::string_view name) override { return assembly_.node_of(block_, name); }

  Change change_of(std::string_view name) const override {
    const diagram::FlatBlock& flat = assembly_.diagram.blocks[block_];
    if (const auto input = flat.definition->find_input(name))
      return flat.inputs[*input].terms.empty() ? Change::never : Change::always;
    if (assembly_.quantity_of(block_, name) != kNone || name == "time") return Change::always;
    if (flat.definition->find_memory(name)) {
      const bool constant =
          !assembly_.first_discrete_state.empty() && assembly_.first_discrete_state[block_] == kNone;
      return constant ? Change::never : Change::with_events;
    }
    if (mode_node(assembly_, block_, name)) return Change::with_events;
    return Change::never;
  }

  NodeId greater(const text::Expression& left, const text::Expression& right, Turning turning) override {
    return switch_of(assembly_, block_, left, right, turning);
  }

  NodeId interpolated(const text::Expression& call) override {
    return network::interpolated(assembly_, block_, call);
  }

  double weights(const text::Expression& call) const override {
    const diagram::FlatBlock& flat = assembly_.diagram.blocks[block_];
    const auto input = flat.definition->find_input(call.operands[0].name);
    if (!input)
      throw text::ExpressionError{call.column, "weights() takes an input", "the name of an input", {}};
    double sum = 0;
    for (const diagram::FlatTerm& term : flat.inputs[*input].terms) sum += std::abs(term.weight);
    return sum;
  }

 private:
  Assembly& assembly_;
  std::size_t block_;
};

std::optional<double> constant_of(const diagram::FlatBlock& block, std::string_view name) {
  if (name == "polarity") return block.polarity;
  if (const auto parameter = block.definition->find_parameter(name)) return block.parameters[*parameter];
  if (const auto input = block.definition->find_input(name); input && block.inputs[*input].terms.empty())
    return block.inputs[*input].constant;
  if (name == "in_operate") return 1;  // where there is a timeline, these are asked for earlier
  if (name == "in_initial" || name == "in_hold") return 0;
  return std::nullopt;
}

NodeId sum_of(Assembly& a, const diagram::FlatInput& input) {
  ExpressionGraph& graph = a.network.graph;
  NodeId sum = graph.constant(input.constant);
  for (const diagram::FlatTerm& term : input.terms) {
    const NodeId signal = a.quantities[a.quantity_of(term.signal)].node;
    sum = graph.apply(Op::add, sum, graph.apply(Op::multiply, graph.constant(term.weight), signal));
  }
  return sum;
}

}  // namespace

const diagram::FlatBlock& Assembly::block_of(const Quantity& quantity) const {
  return diagram.blocks[quantity.block];
}

std::string Assembly::name_of(const Quantity& quantity) const {
  const diagram::FlatBlock& block = block_of(quantity);
  const auto output = block.definition->find_output(quantity.equation->target);
  if (output) return diagram.signal_name({quantity.block, *output});
  return block.path + "." + quantity.equation->target;
}

std::uint32_t Assembly::quantity_of(std::size_t block, std::string_view target) const {
  for (std::uint32_t q = first_quantity[block]; q < first_quantity[block + 1]; ++q) {
    if (quantities[q].equation->target == target) return q;
  }
  return kNone;
}

std::uint32_t Assembly::quantity_of(diagram::SignalRef signal) const {
  return quantity_of(signal.block, diagram.blocks[signal.block].definition->outputs[signal.output].name);
}

const diagram::StartRule& Assembly::start_of(const Quantity& quantity) const {
  const auto& starts = block_of(quantity).definition->starts;
  return *std::find_if(starts.begin(), starts.end(), [&](const diagram::StartRule& rule) {
    return rule.target == quantity.equation->target;
  });
}

std::uint32_t Assembly::new_discrete_state(std::string name, double start) {
  network.discrete_states.push_back({std::move(name), start});
  return static_cast<std::uint32_t>(network.discrete_states.size() - 1);
}

bool Assembly::is_constant(std::size_t block, const text::Expression& expression) {
  const BlockContext context(*this, block);
  return change_of(expression, context) == ExpressionContext::Change::never;
}

std::optional<double> Assembly::constant_value(std::size_t block, const text::Expression& expression) {
  if (!is_constant(block, expression)) return std::nullopt;
  return network.graph[built_operand(block, expression)].value;
}

NodeId Assembly::node_of(std::size_t block, std::string_view name) {
  const diagram::FlatBlock& flat = diagram.blocks[block];
  if (const auto input = flat.definition->find_input(name)) return sum_of(*this, flat.inputs[*input]);
  if (const std::uint32_t own = quantity_of(block, name); own != kNone) return quantities[own].node;
  if (name == "time") return network.graph.variable(0);
  if (const auto discrete_state = flat.definition->find_memory(name))
    return discrete_state_node(*this, block, *discrete_state);
  if (const auto mode = mode_node(*this, block, name)) return *mode;
  return network.graph.constant(constant_of(flat, name).value());  // parse_block admits no other names
}

NodeId Assembly::built(std::size_t block, const text::Expression& expression, const text::Place& place,
                       const std::string& what) {
  try {
    return built_operand(block, expression);
  } catch (const text::ExpressionError& error) {
    diagnostics.add({place, fmt::format("{} of '{}': {}", what, diagram.blocks[block].path, error.what),
                     error.expected, error.remedy});
    return network.graph.constant(0);
  }
}

NodeId Assembly::built_operand(std::size_t block, const text::Expression& expression) {
  BlockContext context(*this, block);
  return build_expression(network.graph, expression, context);
}

}  // namespace oblique::network
