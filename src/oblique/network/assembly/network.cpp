// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/network.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <oblique/network/assembly/assembler.h>
#include <oblique/text/expression_printer.h>

namespace oblique::network {

Network Assembler::assemble() {
  collect_quantities();
  make_modes();
  find_active_events();
  make_memories();
  make_states();
  for (const OrderStep& step : dependency_order(dependencies_of_algebra(), implicit_marks())) define(step);
  for (Quantity& quantity : quantities_) {
    if (quantity.equation->kind == diagram::Equation::Kind::derivative) {
      network_.states[quantity.variable_index].derivative = finite(quantity, expression_of(quantity));
    }
  }
  collect_signals();
  make_events();
  make_starts();
  define_mode_lines();
  define_phase_ends();
  define_switches();
  define_tables();
  diagnostics_.throw_if_any<NetworkError>();
  return std::move(network_);
}

const diagram::FlatBlock& Assembler::block_of(const Quantity& quantity) const {
  return diagram_.blocks[quantity.block];
}

std::string Assembler::name_of(const Quantity& quantity) const {
  const diagram::FlatBlock& block = block_of(quantity);
  const auto output = block.definition->find_output(quantity.equation->target);
  if (output) return diagram_.signal_name({quantity.block, *output});
  return block.path + "." + quantity.equation->target;
}

std::uint32_t Assembler::quantity_of(std::size_t block, std::string_view target) const {
  for (std::uint32_t q = first_quantity_[block]; q < first_quantity_[block + 1]; ++q) {
    if (quantities_[q].equation->target == target) return q;
  }
  return kNone;
}

std::uint32_t Assembler::quantity_of(diagram::SignalRef signal) const {
  return quantity_of(signal.block, diagram_.blocks[signal.block].definition->outputs[signal.output].name);
}

void Assembler::collect_quantities() {
  first_quantity_.reserve(diagram_.blocks.size() + 1);
  for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
    first_quantity_.push_back(static_cast<std::uint32_t>(quantities_.size()));
    for (const diagram::Equation& equation : diagram_.blocks[b].behaviour->equations)
      quantities_.push_back({b, &equation});
  }
  first_quantity_.push_back(static_cast<std::uint32_t>(quantities_.size()));
}

void Assembler::make_states() {
  for (Quantity& quantity : quantities_) {
    if (quantity.equation->kind != diagram::Equation::Kind::derivative) continue;
    const diagram::StartRule& rule = start_of(quantity);
    quantity.variable_index = static_cast<std::uint32_t>(network_.states.size());
    const BlockContext context(*this, quantity.block);
    const bool fixed = change_of(rule.value, context) == ExpressionContext::Change::never;
    const double start = fixed ? start_value(quantity, rule) : 0;
    network_.states.push_back({name_of(quantity), start, rule.at_rest, 0, block_of(quantity).tolerance, {}});
    quantity.node = network_.graph.variable(network_.state_variable(quantity.variable_index));
  }
}

const diagram::StartRule& Assembler::start_of(const Quantity& quantity) const {
  const auto& starts = block_of(quantity).definition->starts;
  return *std::find_if(starts.begin(), starts.end(), [&](const diagram::StartRule& rule) {
    return rule.target == quantity.equation->target;
  });
}

double Assembler::start_value(const Quantity& quantity, const diagram::StartRule& rule) {
  const diagram::FlatBlock& block = block_of(quantity);
  const double value = constant_value(quantity.block, rule.value).value_or(0);
  if (!std::isfinite(value)) {
    diagnostics_.add({block.place, fmt::format("'{}' would start at {}", name_of(quantity), value),
                      "a finite start value", "give the block another 'initial'"});
  }
  return value;
}

std::optional<double> Assembler::constant_of(const diagram::FlatBlock& block, std::string_view name) {
  if (name == "polarity") return block.polarity;
  if (const auto parameter = block.definition->find_parameter(name)) return block.parameters[*parameter];
  if (const auto input = block.definition->find_input(name); input && block.inputs[*input].terms.empty())
    return block.inputs[*input].constant;
  if (name == "in_operate") return 1;  // where there is a timeline, these are asked for earlier
  if (name == "in_initial" || name == "in_hold") return 0;
  return std::nullopt;
}

/// The value of an expression that never changes; nothing for another.
std::optional<double> Assembler::constant_value(std::size_t block, const text::Expression& expression) {
  BlockContext context(*this, block);
  if (change_of(expression, context) != ExpressionContext::Change::never) return std::nullopt;
  return network_.graph[build_expression(network_.graph, expression, context)].value;
}

NodeId Assembler::built(std::size_t block, const text::Expression& expression, const text::Place& place,
                        const std::string& what) {
  BlockContext context(*this, block);
  try {
    return build_expression(network_.graph, expression, context);
  } catch (const text::ExpressionError& error) {
    diagnostics_.add({place, fmt::format("{} of '{}': {}", what, diagram_.blocks[block].path, error.what),
                      error.expected, error.remedy});
    return network_.graph.constant(0);
  }
}

bool Assembler::is_algebraic(std::uint32_t q) const {
  return quantities_[q].equation->kind != diagram::Equation::Kind::derivative;
}

std::vector<bool> Assembler::implicit_marks() const {
  std::vector<bool> marks(quantities_.size());
  for (std::size_t q = 0; q < marks.size(); ++q) {
    marks[q] = quantities_[q].equation->kind == diagram::Equation::Kind::implicit;
  }
  return marks;
}

/// States need nothing: their rows are empty, which also keeps them out of every loop.
Dependencies Assembler::dependencies_of_algebra() const {
  Dependencies dependencies;
  std::vector<std::uint32_t> row;
  for (std::uint32_t q = 0; q < quantities_.size(); ++q) {
    row.clear();
    if (is_algebraic(q)) collect_needed(quantities_[q].block, quantities_[q].equation->expression, row);
    dependencies.add_row(row);
  }
  return dependencies;
}

/// What is compared is not needed: a switch keeps its position until an event turns it over.
void Assembler::collect_needed(std::size_t block, const text::Expression& e,
                               std::vector<std::uint32_t>& row) const {
  if (is_comparison(e.kind)) return;
  for (const text::Expression& operand : e.operands) collect_needed(block, operand, row);
  if (e.kind != text::Expression::Kind::name) return;
  const diagram::FlatBlock& flat = diagram_.blocks[block];
  if (const auto input = flat.definition->find_input(e.name)) {
    for (const diagram::FlatTerm& term : flat.inputs[*input].terms) {
      const std::uint32_t other = quantity_of(term.signal);
      if (is_algebraic(other)) row.push_back(other);
    }
  } else if (const std::uint32_t own = quantity_of(block, e.name); own != kNone && is_algebraic(own)) {
    row.push_back(own);
  }
}

void Assembler::define(const OrderStep& step) {
  if (step.tears.empty()) {
    for (const std::uint32_t q : step.inner) {
      if (is_algebraic(q)) quantities_[q].node = finite(quantities_[q], expression_of(quantities_[q]));
    }
    return;
  }
  Loop& loop = network_.loops.emplace_back();
  for (const std::uint32_t q : step.tears) {
    Quantity& quantity = quantities_[q];
    const bool torn = quantity.equation->kind == diagram::Equation::Kind::assignment;
    quantity.variable_index = static_cast<std::uint32_t>(network_.unknowns.size());
    const double guess = torn ? 0.0 : start_value(quantity, start_of(quantity));
    const bool held = !torn && start_of(quantity).at_rest;
    loop.unknowns.push_back(network_.unknowns.size());
    network_.unknowns.push_back({name_of(quantity), guess, 0, torn, block_of(quantity).place, held});
    quantity.node = network_.graph.variable(network_.unknown_variable(quantity.variable_index));
  }
  for (const std::uint32_t q : step.inner) quantities_[q].node = expression_of(quantities_[q]);
  for (const std::uint32_t q : step.tears) {
    Quantity& quantity = quantities_[q];
    Unknown& unknown = network_.unknowns[quantity.variable_index];
    unknown.residual = finite(quantity, expression_of(quantity));
    if (unknown.torn) unknown.residual = network_.graph.apply(Op::subtract, unknown.residual, quantity.node);
  }
  name_members(step, loop);
}

void Assembler::name_members(const OrderStep& step, Loop& loop) const {
  std::vector<std::size_t> blocks;
  for (const auto* part : {&step.tears, &step.inner}) {
    for (const std::uint32_t q : *part) blocks.push_back(quantities_[q].block);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  for (const std::size_t b : blocks) loop.members.push_back(diagram_.blocks[b].path);
}

NodeId Assembler::finite(const Quantity& quantity, NodeId node) {
  const ExpressionGraph& graph = network_.graph;
  if (graph.is_constant(node) && !std::isfinite(graph[node].value)) {
    diagnostics_.add(
        {block_of(quantity).place,
         fmt::format("'{}' is {} whatever the signals are", name_of(quantity), graph[node].value),
         "a finite value",
         fmt::format("check the parameters in '{}'", text::to_string(quantity.equation->expression))});
  }
  return node;
}

void Assembler::collect_signals() {
  for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
    network_.first_signal.push_back(network_.signals.size());
    for (std::size_t output = 0; output < diagram_.blocks[b].definition->outputs.size(); ++output) {
      network_.signals.push_back(quantities_[quantity_of({b, output})].node);
      network_.signal_names.push_back(diagram_.signal_name({b, output}));
    }
  }
}

NodeId Assembler::expression_of(const Quantity& quantity) {
  const diagram::Equation& equation = *quantity.equation;
  BlockContext context(*this, quantity.block);
  try {
    return build_expression(network_.graph, equation.expression, context);
  } catch (const text::ExpressionError& error) {
    diagnostics_.add({equation.place, fmt::format("equation of '{}': {}", name_of(quantity), error.what),
                      error.expected, error.remedy});
    return network_.graph.constant(0);
  }
}

NodeId Assembler::node_of(std::size_t block, std::string_view name) {
  const diagram::FlatBlock& flat = diagram_.blocks[block];
  if (const auto input = flat.definition->find_input(name)) return sum_of(flat.inputs[*input]);
  if (const std::uint32_t own = quantity_of(block, name); own != kNone) return quantities_[own].node;
  if (name == "time") return network_.graph.variable(0);
  if (const auto memory = flat.definition->find_memory(name)) return memory_node(block, *memory);
  if (const auto mode = mode_node(block, name)) return *mode;
  return network_.graph.constant(constant_of(flat, name).value());  // parse_block admits no other names
}

NodeId Assembler::sum_of(const diagram::FlatInput& input) {
  ExpressionGraph& graph = network_.graph;
  NodeId sum = graph.constant(input.constant);
  for (const diagram::FlatTerm& term : input.terms) {
    const NodeId signal = quantities_[quantity_of(term.signal)].node;
    sum = graph.apply(Op::add, sum, graph.apply(Op::multiply, graph.constant(term.weight), signal));
  }
  return sum;
}

Network assemble(const diagram::FlatDiagram& diagram) {
  return Assembler(diagram).assemble();
}

}  // namespace oblique::network
