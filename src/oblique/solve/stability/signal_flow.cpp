// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/signal_flow.h>

#include <algorithm>
#include <cmath>

#include <oblique/network/graph/dependency_order.h>
#include <oblique/network/program/program.h>

namespace oblique::solve {
namespace {

/// An expression of a block with the sums of its inputs' weights as numbers.
text::Expression with_weights(text::Expression expression, const diagram::FlatBlock& block) {
  for (text::Expression& operand : expression.operands) operand = with_weights(std::move(operand), block);
  if (expression.kind != text::Expression::Kind::call || expression.function != text::Function::weights)
    return expression;
  text::Expression sum;
  if (const auto input = block.definition->find_input(expression.operands.front().name)) {
    for (const diagram::FlatTerm& term : block.inputs[*input].terms) sum.number += std::abs(term.weight);
  }
  return sum;
}

}  // namespace

SignalFlow::SignalFlow(const diagram::FlatDiagram& diagram, const network::Program& program)
    : diagram_(diagram), program_(program) {
  std::unordered_map<std::string_view, std::size_t> states;
  for (std::size_t i = 0; i < program.n_states(); ++i) states.emplace(program.states()[i].name, i);
  for (std::size_t b = 0; b < diagram.blocks.size(); ++b) {
    first_.push_back(quantities_.size());
    const diagram::FlatBlock& block = diagram.blocks[b];
    for (const diagram::Equation& equation : block.behaviour->equations) {
      const auto output = block.definition->find_output(equation.target);
      std::string name = output ? diagram.signal_name({b, *output}) : block.path + "." + equation.target;
      Quantity quantity{b, &equation, {}};
      if (equation.kind == diagram::Equation::Kind::derivative) {
        if (const auto found = states.find(name); found != states.end()) quantity.state = found->second;
      }
      by_name_.emplace(std::move(name), quantities_.size());
      quantities_.push_back(quantity);
    }
  }
  first_.push_back(quantities_.size());
}

std::optional<std::size_t> SignalFlow::find(std::size_t block, std::string_view target) const {
  for (std::size_t q = first_[block]; q < first_[block + 1]; ++q) {
    if (quantities_[q].equation->target == target) return q;
  }
  return std::nullopt;
}

void SignalFlow::collect_read(std::size_t quantity, const text::Expression& expression,
                              std::vector<std::uint32_t>& row) const {
  for (const text::Expression& operand : expression.operands) collect_read(quantity, operand, row);
  if (expression.kind != text::Expression::Kind::name) return;
  const std::size_t b = quantities_[quantity].block;
  const diagram::FlatBlock& block = diagram_.blocks[b];
  if (const auto input = block.definition->find_input(expression.name)) {
    for (const diagram::FlatTerm& term : block.inputs[*input].terms) {
      const auto& outputs = diagram_.blocks[term.signal.block].definition->outputs;
      const auto source = find(term.signal.block, outputs[term.signal.output].name);
      if (source) row.push_back(static_cast<std::uint32_t>(*source));
    }
  } else if (const auto own = find(b, expression.name)) {
    row.push_back(static_cast<std::uint32_t>(*own));
  }
}

std::vector<std::string> SignalFlow::members_of_loop(const std::vector<std::size_t>& states) const {
  // All other states are held: they read nothing.
  network::Dependencies dependencies;
  std::vector<std::uint32_t> row;
  for (std::size_t q = 0; q < quantities_.size(); ++q) {
    row.clear();
    const Quantity& quantity = quantities_[q];
    const bool dynamic = quantity.equation->kind == diagram::Equation::Kind::derivative;
    const bool moves =
        quantity.state && std::find(states.begin(), states.end(), *quantity.state) != states.end();
    if (!dynamic || moves) collect_read(q, quantity.equation->expression, row);
    dependencies.add_row(row);
  }
  std::vector<std::size_t> blocks;
  for (const network::OrderStep& step :
       network::dependency_order(dependencies, std::vector<bool>(quantities_.size(), true))) {
    const bool ours = std::any_of(step.tears.begin(), step.tears.end(), [&](std::uint32_t q) {
      return quantities_[q].state &&
             std::find(states.begin(), states.end(), *quantities_[q].state) != states.end();
    });
    if (!ours) continue;
    for (const std::uint32_t q : step.tears) blocks.push_back(quantities_[q].block);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  std::vector<std::string> paths;
  paths.reserve(blocks.size());
  for (const std::size_t b : blocks) paths.push_back(diagram_.blocks[b].path);
  return paths;
}

double SignalFlow::input_value(const diagram::FlatInput& input, std::span<const double> signals) const {
  double sum = input.constant;
  for (const diagram::FlatTerm& term : input.terms)
    sum += term.weight * signals[program_.signal_index(term.signal)];
  return sum;
}

std::optional<double> SignalFlow::own_derivative(std::string_view name, double t,
                                                 std::span<const double> signals) const {
  const auto found = by_name_.find(std::string(name));
  if (found == by_name_.end()) return std::nullopt;
  const Quantity& quantity = quantities_[found->second];
  const diagram::FlatBlock& block = diagram_.blocks[quantity.block];
  if (quantity.equation->kind == diagram::Equation::Kind::assignment)
    return -1;  // its residual is (what it gives) − x

  const auto output_value = [&](std::string_view target) -> std::optional<double> {
    const auto output = block.definition->find_output(target);
    if (!output) return std::nullopt;
    return signals[program_.signal_index({quantity.block, *output})];
  };
  const std::string& target = quantity.equation->target;
  const double x = output_value(target).value_or(0);
  const double half_step = 1e-4 * std::max(1.0, std::abs(x));
  const text::Expression equation = with_weights(quantity.equation->expression, block);
  const auto value_at = [&](double own) {
    const text::NameLookup lookup = [&](std::string_view symbol) -> std::optional<double> {
      if (symbol == target) return own;
      if (symbol == "polarity") return block.polarity;
      if (symbol == "time") return t;
      if (symbol == "in_operate") return 1;
      if (symbol == "in_initial" || symbol == "in_hold") return 0;
      if (symbol == "noise") return 0;
      if (const auto p = block.definition->find_parameter(symbol)) return block.parameters[*p];
      if (const auto i = block.definition->find_input(symbol)) return input_value(block.inputs[*i], signals);
      if (const auto output = output_value(symbol)) return output;
      const auto inner = find(quantity.block, symbol);
      if (!inner || quantities_[*inner].equation->kind != diagram::Equation::Kind::assignment)
        return std::nullopt;
      return text::evaluate(with_weights(quantities_[*inner].equation->expression, block), lookup);
    };
    return text::evaluate(equation, lookup);
  };
  try {
    const double derivative = (value_at(x + half_step) - value_at(x - half_step)) / (2 * half_step);
    if (std::isfinite(derivative)) return derivative;
  } catch (const text::ExpressionError&) {
    return std::nullopt;  // it names what is no output and no signal
  }
  return std::nullopt;
}

}  // namespace oblique::solve
