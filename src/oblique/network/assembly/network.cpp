// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/network.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/network/assembly/assembly.h>
#include <oblique/network/assembly/event_assembly.h>
#include <oblique/network/assembly/mode_assembly.h>
#include <oblique/network/assembly/switch_assembly.h>
#include <oblique/network/assembly/table_assembly.h>
#include <oblique/network/graph/dependency_order.h>
#include <oblique/network/graph/expression_builder.h>
#include <oblique/text/expression_printer.h>

namespace oblique::network {
namespace {

void collect_quantities(Assembly& a) {
  a.first_quantity.reserve(a.diagram.blocks.size() + 1);
  for (std::size_t b = 0; b < a.diagram.blocks.size(); ++b) {
    a.first_quantity.push_back(static_cast<std::uint32_t>(a.quantities.size()));
    for (const diagram::Equation& equation : a.diagram.blocks[b].behaviour->equations)
      a.quantities.push_back({b, &equation});
  }
  a.first_quantity.push_back(static_cast<std::uint32_t>(a.quantities.size()));
}

void require_finite_start(Assembly& a, const Quantity& quantity, double value) {
  if (std::isfinite(value)) return;
  a.diagnostics.add({a.block_of(quantity).place,
                     fmt::format("'{}' would start at {}", a.name_of(quantity), value),
                     "a finite start value", "give the block another 'initial'"});
}

/// Where the search for an unknown begins.
double guess_of(Assembly& a, const Quantity& quantity) {
  const double value = a.constant_value(quantity.block, a.start_of(quantity).value).value_or(0);
  require_finite_start(a, quantity, value);
  return value;
}

void start_at(const Assembly& a, State& state, NodeId constant) {
  state.start = a.network.graph[constant].value;
  state.start_constant = constant;
}

void make_states(Assembly& a) {
  for (Quantity& quantity : a.quantities) {
    if (quantity.equation->kind != diagram::Equation::Kind::derivative) continue;
    const diagram::StartRule& rule = a.start_of(quantity);
    quantity.variable_index = static_cast<std::uint32_t>(a.network.states.size());
    State& state = a.network.states.emplace_back();
    state.name = a.name_of(quantity);
    state.at_rest = rule.at_rest;
    state.tolerance = a.block_of(quantity).tolerance;
    if (a.is_constant(quantity.block, rule.value)) {
      start_at(a, state, a.built_operand(quantity.block, rule.value));
      require_finite_start(a, quantity, state.start);
    }
    quantity.node = a.network.graph.variable(a.network.state_variable(quantity.variable_index));
  }
}

bool is_algebraic(const Assembly& a, std::uint32_t q) {
  return a.quantities[q].equation->kind != diagram::Equation::Kind::derivative;
}

std::vector<bool> implicit_marks(const Assembly& a) {
  std::vector<bool> marks(a.quantities.size());
  for (std::size_t q = 0; q < marks.size(); ++q) {
    marks[q] = a.quantities[q].equation->kind == diagram::Equation::Kind::implicit;
  }
  return marks;
}

/// What is compared is not needed: a switch keeps its position until an event turns it over.
void collect_needed(const Assembly& a, std::size_t block, const text::Expression& e,
                    std::vector<std::uint32_t>& row) {
  if (is_comparison(e.kind)) return;
  for (const text::Expression& operand : e.operands) collect_needed(a, block, operand, row);
  if (e.kind != text::Expression::Kind::name) return;
  const diagram::FlatBlock& flat = a.diagram.blocks[block];
  if (const auto input = flat.definition->find_input(e.name)) {
    for (const diagram::FlatTerm& term : flat.inputs[*input].terms) {
      const std::uint32_t other = a.quantity_of(term.signal);
      if (is_algebraic(a, other)) row.push_back(other);
    }
  } else if (const std::uint32_t own = a.quantity_of(block, e.name); own != kNone && is_algebraic(a, own)) {
    row.push_back(own);
  }
}

/// States need nothing: their rows are empty, which also keeps them out of every loop.
Dependencies dependencies_of_algebra(const Assembly& a) {
  Dependencies dependencies;
  std::vector<std::uint32_t> row;
  for (std::uint32_t q = 0; q < a.quantities.size(); ++q) {
    row.clear();
    if (is_algebraic(a, q))
      collect_needed(a, a.quantities[q].block, a.quantities[q].equation->expression, row);
    dependencies.add_row(row);
  }
  return dependencies;
}

NodeId finite(Assembly& a, const Quantity& quantity, NodeId node) {
  const ExpressionGraph& graph = a.network.graph;
  if (graph.is_constant(node) && !std::isfinite(graph[node].value)) {
    a.diagnostics.add(
        {a.block_of(quantity).place,
         fmt::format("'{}' is {} whatever the signals are", a.name_of(quantity), graph[node].value),
         "a finite value",
         fmt::format("check the parameters in '{}'", text::to_string(quantity.equation->expression))});
  }
  return node;
}

NodeId expression_of(Assembly& a, const Quantity& quantity) {
  const diagram::Equation& equation = *quantity.equation;
  try {
    return a.built_operand(quantity.block, equation.expression);
  } catch (const text::ExpressionError& error) {
    a.diagnostics.add({equation.place, fmt::format("equation of '{}': {}", a.name_of(quantity), error.what),
                       error.expected, error.remedy});
    return a.network.graph.constant(0);
  }
}

void name_members(const Assembly& a, const OrderStep& step, Loop& loop) {
  std::vector<std::size_t> blocks;
  for (const auto* part : {&step.tears, &step.inner}) {
    for (const std::uint32_t q : *part) blocks.push_back(a.quantities[q].block);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  for (const std::size_t b : blocks) loop.members.push_back(a.diagram.blocks[b].path);
}

void define(Assembly& a, const OrderStep& step) {
  if (step.tears.empty()) {
    for (const std::uint32_t q : step.inner) {
      if (is_algebraic(a, q))
        a.quantities[q].node = finite(a, a.quantities[q], expression_of(a, a.quantities[q]));
    }
    return;
  }
  Loop& loop = a.network.loops.emplace_back();
  for (const std::uint32_t q : step.tears) {
    Quantity& quantity = a.quantities[q];
    const bool torn = quantity.equation->kind == diagram::Equation::Kind::assignment;
    quantity.variable_index = static_cast<std::uint32_t>(a.network.unknowns.size());
    const double guess = torn ? 0.0 : guess_of(a, quantity);
    const bool held = !torn && a.start_of(quantity).at_rest;
    loop.unknowns.push_back(a.network.unknowns.size());
    a.network.unknowns.push_back({a.name_of(quantity), guess, 0, torn, a.block_of(quantity).place, held});
    quantity.node = a.network.graph.variable(a.network.unknown_variable(quantity.variable_index));
  }
  for (const std::uint32_t q : step.inner) a.quantities[q].node = expression_of(a, a.quantities[q]);
  for (const std::uint32_t q : step.tears) {
    Quantity& quantity = a.quantities[q];
    Unknown& unknown = a.network.unknowns[quantity.variable_index];
    unknown.residual = finite(a, quantity, expression_of(a, quantity));
    if (unknown.torn) unknown.residual = a.network.graph.apply(Op::subtract, unknown.residual, quantity.node);
  }
  name_members(a, step, loop);
}

void collect_signals(Assembly& a) {
  for (std::size_t b = 0; b < a.diagram.blocks.size(); ++b) {
    a.network.first_signal.push_back(a.network.signals.size());
    for (std::size_t output = 0; output < a.diagram.blocks[b].definition->outputs.size(); ++output) {
      a.network.signals.push_back(a.quantities[a.quantity_of({b, output})].node);
      a.network.signal_names.push_back(a.diagram.signal_name({b, output}));
    }
  }
}

void make_starts(Assembly& a) {
  for (const Quantity& quantity : a.quantities) {
    if (quantity.equation->kind != diagram::Equation::Kind::derivative) continue;
    const diagram::StartRule& rule = a.start_of(quantity);
    if (a.is_constant(quantity.block, rule.value)) continue;
    const NodeId value = a.built(quantity.block, rule.value, quantity.equation->place, "the start value");
    State& state = a.network.states[quantity.variable_index];
    // A potentiometer at the reference gives a number: loops can be solved with it from the beginning.
    if (a.network.graph.is_constant(value)) {
      start_at(a, state, value);
    } else {
      state.start_node = value;
    }
  }
}

}  // namespace

Network assemble(const diagram::FlatDiagram& diagram, std::span<const std::uint32_t> held) {
  Assembly a(diagram);
  a.network.graph = ExpressionGraph({held.begin(), held.end()});
  collect_quantities(a);
  make_modes(a);
  find_active_events(a);
  make_discrete_states(a);
  make_states(a);
  for (const OrderStep& step : dependency_order(dependencies_of_algebra(a), implicit_marks(a)))
    define(a, step);
  for (Quantity& quantity : a.quantities) {
    if (quantity.equation->kind == diagram::Equation::Kind::derivative) {
      a.network.states[quantity.variable_index].derivative = finite(a, quantity, expression_of(a, quantity));
    }
  }
  collect_signals(a);
  make_events(a);
  make_starts(a);
  define_mode_lines(a);
  define_phase_ends(a);
  define_switches(a);
  define_tables(a);
  if (!held.empty()) a.decide_cases();
  a.diagnostics.throw_if_any<NetworkError>();
  a.network.n_parameters = a.numbers.size();
  return std::move(a.network);
}

}  // namespace oblique::network
