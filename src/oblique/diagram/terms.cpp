// SPDX-License-Identifier: MIT
#include <oblique/diagram/terms.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/diagram/names.h>
#include <oblique/text/expression_parser.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram::wiring {
namespace {

using Kind = text::Expression::Kind;

bool is_number_name(std::string_view name) {
  return name == "pi" || name == "inf";
}

bool is_own_parameter(const Scope& scope, std::string_view name) {
  return scope.composite != nullptr && scope.composite->find_parameter(name).has_value();
}

bool depends_on_parameters(const text::Expression& expression) {
  const auto names = names_in(expression);
  return std::any_of(names.begin(), names.end(),
                     [](const text::Expression* e) { return !is_number_name(e->name); });
}

/// Replaces the signal in a product by 1, which leaves its weight; false where it is no plain factor.
bool take_signal_out(text::Expression& expression, int column) {
  switch (expression.kind) {
    case Kind::name:
      if (expression.column != column || is_number_name(expression.name)) return false;
      expression.kind = Kind::number;
      expression.number = 1;
      expression.name.clear();
      return true;
    case Kind::negate:
    case Kind::divide:
      return take_signal_out(expression.operands[0], column);
    case Kind::multiply:
      return take_signal_out(expression.operands[0], column) ||
             take_signal_out(expression.operands[1], column);
    default:
      return false;
  }
}

Constant fold(text::Expression expression, double factor) {
  if (depends_on_parameters(expression)) return {factor, std::move(expression)};
  return {factor * text::evaluate(expression), std::nullopt};
}

}  // namespace

std::optional<Term> read_term(const Scope& scope, const text::Value& value, const std::string& subject,
                              text::Diagnostics& diagnostics) {
  const auto report = [&](int column, std::string what, std::string expected, std::string remedy) {
    diagnostics.add({{scope.file, position_in(value, column)},
                     fmt::format("{}: {}", subject, what),
                     std::move(expected),
                     std::move(remedy)});
    return std::nullopt;
  };
  if (value.kind == text::Value::Kind::number) {
    diagnostics.add({{scope.file, value.position},
                     fmt::format("{} is given the number {}", subject, value.number),
                     "the name of a signal",
                     "a fixed value comes from a block that gives a constant"});
    return std::nullopt;
  }
  text::Expression expression;
  try {
    expression = text::parse_expression(value.text);
  } catch (const text::ExpressionError& error) {
    diagnostics.add(text::to_diagnostic(error, scope.file, value, subject));
    return std::nullopt;
  }
  std::vector<const text::Expression*> signals;
  for (const text::Expression* const name : names_in(expression)) {
    if (!is_number_name(name->name) && !is_own_parameter(scope, name->name)) signals.push_back(name);
  }
  if (signals.empty()) {
    return report(1, fmt::format("'{}' names no signal", value.text), "[sign][weight*]signal",
                  "a fixed value comes from a block that gives a constant");
  }
  std::optional<Source> source;
  bool all_known = true;
  for (const text::Expression* const signal : signals) {
    source = find_signal(scope, signal->name, position_in(value, signal->column), subject, diagnostics);
    all_known = all_known && source;
  }
  if (!all_known) return std::nullopt;
  if (signals.size() > 1) {
    std::vector<std::string> names;
    names.reserve(signals.size());
    for (const text::Expression* const signal : signals) names.push_back(signal->name);
    return report(
        1, fmt::format("'{}' names {} signals ({})", value.text, signals.size(), fmt::join(names, ", ")),
        "[sign][weight*]signal with one signal",
        R"(a sum is a list, ["a", "-2*b"]; a product takes a block that multiplies)");
  }
  const std::string name = signals.front()->name;
  const int column = signals.front()->column;
  if (!take_signal_out(expression, column)) {
    return report(column, fmt::format("'{}' is no plain factor of '{}'", name, value.text),
                  "[sign][weight*]signal, such as '-2*a' or 'a/3'",
                  "functions of a signal take a block of their own");
  }
  Term term{fold(std::move(expression), 1), std::move(*source), name, position_in(value, column)};
  if (!term.weight.expression && !std::isfinite(term.weight.number)) {
    return report(1, fmt::format("the weight of '{}' is {}", name, describe_number(term.weight.number)),
                  "a finite number", {});
  }
  return term;
}

std::optional<Constant> read_parameter(const Scope& scope, const text::Value& value,
                                       const ParameterDefinition& parameter, const std::string& subject,
                                       text::Diagnostics& diagnostics) {
  const text::Place place{scope.file, value.position};
  if (value.kind == text::Value::Kind::array || value.kind == text::Value::Kind::table) {
    diagnostics.add(
        {place,
         fmt::format("{} is a {}", subject, value.kind == text::Value::Kind::array ? "list" : "table"),
         fmt::format("a number or a quantity in '{}'", parameter.unit),
         {}});
    return std::nullopt;
  }
  if (value.kind == text::Value::Kind::number) {
    const std::size_t before = diagnostics.size();
    check_range(parameter, value.number, subject, place, {}, diagnostics);
    return diagnostics.size() == before ? std::optional(Constant{value.number, {}}) : std::nullopt;
  }
  try {
    std::size_t rest = 0;
    text::Expression expression = text::parse_expression_prefix(value.text, rest);
    for (const text::Expression* const name : names_in(expression)) {
      if (is_number_name(name->name) || is_own_parameter(scope, name->name)) continue;
      std::vector<std::string> known;
      if (scope.composite != nullptr) {
        for (const ParameterDefinition& own : scope.composite->parameters) known.push_back(own.name);
      }
      const bool signal = scope.index.contains(name->name);
      diagnostics.add(
          {{scope.file, position_in(value, name->column)},
           fmt::format("{}: '{}' is {}", subject, name->name, signal ? "a signal" : "no known constant"),
           fmt::format("a number or a quantity in '{}'", parameter.unit),
           signal ? "signals go to inputs, not to parameters" : text::suggest(name->name, known)});
      return std::nullopt;
    }
    // Whatever value the names have: in a message the text before the unit counts as a number.
    Constant constant = fold(std::move(expression),
                             text::unit_factor(value.text, rest, unit_on(scope.machine, parameter.unit),
                                               [](std::string_view) { return 1.0; }));
    if (constant.expression) return constant;
    const std::size_t before = diagnostics.size();
    check_range(parameter, constant.number, subject, place, {}, diagnostics);
    return diagnostics.size() == before ? std::optional(std::move(constant)) : std::nullopt;
  } catch (const text::ExpressionError& error) {
    diagnostics.add(text::to_diagnostic(error, scope.file, value, subject));
    return std::nullopt;
  }
}

void check_range(const ParameterDefinition& parameter, double value, const std::string& subject,
                 const text::Place& place, const std::string& remedy, text::Diagnostics& diagnostics) {
  if (parameter.allows(value)) return;
  diagnostics.add(
      {place, fmt::format("{} is {}", subject, describe_number(value)), parameter.range(), remedy});
}

}  // namespace oblique::diagram::wiring
