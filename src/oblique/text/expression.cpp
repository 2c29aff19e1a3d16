// SPDX-License-Identifier: MIT
#include <oblique/text/expression.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <oblique/text/expression_grammar.h>

namespace oblique::text {

bool Expression::operator==(const Expression& other) const {
  return kind == other.kind && name == other.name && operands == other.operands &&
         (kind != Kind::number || number == other.number) &&
         (kind != Kind::call || function == other.function);
}

std::optional<Operation> smooth_operation(const Expression& e) {
  using Kind = Expression::Kind;
  switch (e.kind) {
    case Kind::add:
      return Operation::add;
    case Kind::subtract:
      return Operation::subtract;
    case Kind::multiply:
      return Operation::multiply;
    case Kind::divide:
      return Operation::divide;
    case Kind::power:
      return Operation::power;
    case Kind::negate:
      return Operation::negate;
    case Kind::call:
      return smooth_operation(e.function);
    case Kind::number:
    case Kind::name:
    case Kind::less:
    case Kind::less_equal:
    case Kind::greater:
    case Kind::greater_equal:
    case Kind::equal:
    case Kind::not_equal:
    case Kind::logical_and:
    case Kind::logical_or:
    case Kind::logical_not:
      break;
  }
  return std::nullopt;
}

double evaluate(const Expression& e, const NameLookup& lookup) {
  using Kind = Expression::Kind;
  if (e.kind == Kind::number) return e.number;
  if (e.kind == Kind::name) {
    if (e.name == "pi") return std::numbers::pi;
    if (e.name == "inf") return std::numeric_limits<double>::infinity();
    if (lookup) {
      if (const auto value = lookup(e.name)) return *value;
    }
    const FunctionInfo* const function = find_function(e.name);
    throw ExpressionError{
        e.column, fmt::format("'{}' is not a known constant", e.name),
        lookup ? "" : "a number, 'pi' or 'inf'",
        function == nullptr ? "" : fmt::format("a function needs its argument: {}(…)", e.name)};
  }
  std::vector<double> v;
  v.reserve(e.operands.size());
  for (const Expression& operand : e.operands) v.push_back(evaluate(operand, lookup));
  switch (e.kind) {
    case Kind::call:
      return evaluate(e.function, v);
    case Kind::negate:
    case Kind::add:
    case Kind::subtract:
    case Kind::multiply:
    case Kind::divide:
    case Kind::power:
      return evaluate(*smooth_operation(e), v.front(), v.back());
    case Kind::less:
      return v[0] < v[1] ? 1 : 0;
    case Kind::less_equal:
      return v[0] <= v[1] ? 1 : 0;
    case Kind::greater:
      return v[0] > v[1] ? 1 : 0;
    case Kind::greater_equal:
      return v[0] >= v[1] ? 1 : 0;
    case Kind::equal:
      return v[0] == v[1] ? 1 : 0;
    case Kind::not_equal:
      return v[0] != v[1] ? 1 : 0;
    case Kind::logical_and:
      return v[0] != 0 && v[1] != 0 ? 1 : 0;
    case Kind::logical_or:
      return v[0] != 0 || v[1] != 0 ? 1 : 0;
    case Kind::logical_not:
      return v[0] == 0 ? 1 : 0;
    case Kind::number:
    case Kind::name:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

bool is_identifier(std::string_view text) {
  return !text.empty() && is_letter(text[0]) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace oblique::text
