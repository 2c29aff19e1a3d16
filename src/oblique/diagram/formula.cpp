// SPDX-License-Identifier: MIT
#include <oblique/diagram/formula.h>

#include <fmt/format.h>

#include <oblique/diagram/names.h>
#include <oblique/text/expression_parser.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

void put_in(text::Expression& expression, const std::map<std::string, text::Expression>& formulas) {
  if (expression.kind == text::Expression::Kind::name) {
    if (const auto found = formulas.find(expression.name); found != formulas.end())
      expression = found->second;
    return;
  }
  for (text::Expression& operand : expression.operands) put_in(operand, formulas);
}

}  // namespace

std::optional<text::Expression> read_formula(const std::string& file, const text::Value& value,
                                             const std::string& subject, text::Diagnostics& diagnostics) {
  if (value.kind == text::Value::Kind::number) {
    text::Expression number;
    number.number = value.number;
    return number;
  }
  if (value.kind != text::Value::Kind::string) {
    diagnostics.add({{file, value.position},
                     fmt::format("{} is {}", subject, text::kind_name(value.kind)),
                     "an expression of time, such as \"2 + sin(3*time)\"",
                     {}});
    return std::nullopt;
  }
  try {
    text::Expression formula = text::parse_expression(value.text);
    bool known = true;
    for (const text::Expression* const name : names_in(formula)) {
      if (name->name == "time" || name->name == "pi" || name->name == "inf") continue;
      diagnostics.add({{file, position_in(value, name->column)},
                       fmt::format("{}: there is no '{}' in a formula", subject, name->name),
                       "numbers, pi, time and functions of them",
                       {}});
      known = false;
    }
    return known ? std::optional(std::move(formula)) : std::nullopt;
  } catch (const text::ExpressionError& error) {
    diagnostics.add(text::to_diagnostic(error, file, value, subject));
    return std::nullopt;
  }
}

Behaviour with_formulas(const Behaviour& behaviour, const std::map<std::string, text::Expression>& formulas) {
  Behaviour written = behaviour;
  for (Equation& equation : written.equations) put_in(equation.expression, formulas);
  return written;
}

}  // namespace oblique::diagram
