// SPDX-License-Identifier: MIT
#include <oblique/machine/function_reader.h>

#include <algorithm>
#include <utility>

#include <oblique/diagram/names.h>

namespace oblique::machine {

FunctionReader::FunctionReader(diagram::FlatBlock block)
    : block_(std::move(block)), definition_(*block_.definition), equations_(block_.behaviour->equations) {
  for (diagram::Equation& equation : equations_) write_out_tables(equation.expression);
}

bool FunctionReader::is_function() {
  const auto assigns = [](const diagram::Equation& equation) {
    return equation.kind == diagram::Equation::Kind::assignment;
  };
  if (!definition_.memories.empty() || !std::all_of(equations_.begin(), equations_.end(), assigns))
    return false;
  for (const diagram::Equation& equation : equations_) {
    for (const text::Expression* const name : diagram::names_in(equation.expression)) {
      if (name->name == "time") is_of_time_ = true;
    }
  }
  for (std::size_t i = 0; i < block_.inputs.size(); ++i) {
    if (block_.inputs[i].terms.empty()) continue;
    if (is_of_time_ || input_) return false;
    input_ = i;
  }
  try {  // a mode of operation: no function that is known here
    for (std::size_t k = 0; k < definition_.outputs.size(); ++k) value(k, 0.5);
  } catch (const text::ExpressionError&) {
    return false;
  }
  return true;
}

double FunctionReader::value(std::size_t output, double argument) const {
  return value_of(*assigned(definition_.outputs[output].name), argument);
}

text::Expression FunctionReader::formula(std::size_t output) const {
  return written_out(*assigned(definition_.outputs[output].name));
}

/// Puts the points in the place of a parameter that is a function: table(x, data) is table(x, x1, y1, …).
void FunctionReader::write_out_tables(text::Expression& expression) const {
  for (text::Expression& operand : expression.operands) write_out_tables(operand);
  const bool is_named = expression.kind == text::Expression::Kind::call &&
                        expression.function == text::Function::table && expression.operands.size() == 2;
  if (!is_named) return;
  const auto parameter = definition_.find_parameter(expression.operands[1].name);
  if (!parameter) return;
  const text::PointTable& points = block_.points[*parameter];
  expression.operands.pop_back();
  for (std::size_t k = 0; k < points.x.size(); ++k) {
    for (const double coordinate : {points.x[k], points.y[k]}) {
      text::Expression number;
      number.number = coordinate;
      expression.operands.push_back(std::move(number));
    }
  }
}

/// What an equation says of a name; none: there is none.
const text::Expression* FunctionReader::assigned(std::string_view name) const {
  const auto equation = std::find_if(equations_.begin(), equations_.end(),
                                     [&](const diagram::Equation& e) { return e.target == name; });
  return equation == equations_.end() ? nullptr : &equation->expression;
}

/// Of what neither changes nor is the argument.
std::optional<double> FunctionReader::constant(std::string_view name) const {
  if (name == "polarity") return block_.polarity;
  if (const auto p = definition_.find_parameter(name)) return block_.parameters[*p];
  if (const auto i = definition_.find_input(name); i && i != input_) return block_.inputs[*i].constant;
  return std::nullopt;
}

double FunctionReader::value_of(const text::Expression& expression, double argument) const {
  return text::evaluate(expression, [&](std::string_view name) -> std::optional<double> {
    if (name == "time" || (input_ && definition_.find_input(name) == input_)) return argument;
    if (const auto known = constant(name)) return known;
    const text::Expression* const other = assigned(name);
    return other == nullptr ? std::nullopt : std::optional(value_of(*other, argument));
  });
}

text::Expression FunctionReader::written_out(text::Expression expression) const {
  for (text::Expression& operand : expression.operands) operand = written_out(std::move(operand));
  if (expression.kind != text::Expression::Kind::name) return expression;
  if (const auto known = constant(expression.name)) {
    text::Expression number;
    number.number = *known;
    return number;
  }
  const text::Expression* const other = assigned(expression.name);
  return other == nullptr ? expression : written_out(*other);
}

}  // namespace oblique::machine
