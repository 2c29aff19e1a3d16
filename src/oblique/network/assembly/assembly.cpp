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

  NodeId weights(const text::Expression& call) override {
    const diagram::FlatBlock& flat = assembly_.diagram.blocks[block_];
    const auto input = flat.definition->find_input(call.operands[0].name);
    if (!input)
      throw text::ExpressionError{call.column, "weights() takes an input", "the name of an input", {}};
    ExpressionGraph& graph = assembly_.network.graph;
    NodeId sum = graph.constant(0);
    for (std::size_t k = 0; k < flat.inputs[*input].terms.size(); ++k) {
      const NodeId weight = assembly_.weight(block_, *input, k);
      sum = graph.apply(Op::add, sum, graph.apply(Op::hypot, weight, graph.constant(0)));
    }
    return sum;
  }

 private:
  Assembly& assembly_;
  std::size_t block_;
};

std::optional<double> constant_of(const diagram::FlatBlock& block, std::string_view name) {
  if (name == "polarity") return block.polarity;
  if (const auto input = block.definition->find_input(name); input && block.inputs[*input].terms.empty())
    return block.inputs[*input].constant;
  if (name == "in_operate") return 1;  // where there is a timeline, these are asked for earlier
  if (name == "in_initial" || name == "in_hold") return 0;
  return std::nullopt;
}

NodeId sum_of(Assembly& a, std::size_t block, std::size_t input) {
  ExpressionGraph& graph = a.network.graph;
  const diagram::FlatInput& wired = a.diagram.blocks[block].inputs[input];
  NodeId sum = graph.constant(wired.constant);
  for (std::size_t k = 0; k < wired.terms.size(); ++k) {
    const NodeId signal = a.quantities[a.quantity_of(wired.terms[k].signal)].node;
    sum = graph.apply(Op::add, sum, graph.apply(Op::multiply, a.weight(block, input, k), signal));
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
  // A condition of two never holds where one of them never does.
  if (expression.kind == text::Expression::Kind::logical_and) {
    for (const text::Expression& condition : expression.operands) {
      const auto value = constant_value(block, condition);
      if (value && *value == 0) return 0;
    }
  }
  if (!is_constant(block, expression)) return std::nullopt;
  return network.graph.frozen_value(built_operand(block, expression));
}

void Assembly::decide_cases() {
  for (std::size_t b = 0; b < diagram.blocks.size(); ++b) {
    const diagram::FlatBlock& block = diagram.blocks[b];
    const std::vector<diagram::Behaviour>& cases = block.definition->behaviours;
    const diagram::Behaviour* const chosen =
        block.definition->choose_behaviour(block.parameters, block.polarity);
    for (const diagram::Behaviour& behaviour : cases) {
      if (behaviour.when) network.graph.value_of_kind(built_operand(b, *behaviour.when));
      if (&behaviour == chosen) break;
    }
  }
}

NodeId Assembly::weight(std::size_t block, std::size_t input, std::size_t wire) {
  return network.graph.parameter(numbers.weight(block, input, wire),
                                 diagram.blocks[block].inputs[input].terms[wire].weight);
}

NodeId Assembly::node_of(std::size_t block, std::string_view name) {
  const diagram::FlatBlock& flat = diagram.blocks[block];
  if (const auto input = flat.definition->find_input(name)) return sum_of(*this, block, *input);
  if (const std::uint32_t own = quantity_of(block, name); own != kNone) return quantities[own].node;
  if (name == "time") return network.graph.variable(0);
  if (const auto discrete_state = flat.definition->find_memory(name))
    return discrete_state_node(*this, block, *discrete_state);
  if (const auto mode = mode_node(*this, block, name)) return *mode;
  if (const auto parameter = flat.definition->find_parameter(name))
    return network.graph.parameter(numbers.parameter(block, *parameter), flat.parameters[*parameter]);
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
