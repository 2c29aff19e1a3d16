// SPDX-License-Identifier: MIT
#include <oblique/text/expression.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <oblique/text/expression_grammar.h>

namespace oblique::text {
namespace {

constexpr std::size_t kAny = 1000;

constexpr std::array<FunctionInfo, 22> kFunctions{{
    {Function::sin, "sin", 1, 1, false, "sine of an angle in radians"},
    {Function::cos, "cos", 1, 1, false, "cosine of an angle in radians"},
    {Function::tan, "tan", 1, 1, false, "tangent of an angle in radians"},
    {Function::asin, "asin", 1, 1, false, "arc sine, in [-pi/2, pi/2]"},
    {Function::acos, "acos", 1, 1, false, "arc cosine, in [0, pi]"},
    {Function::atan, "atan", 1, 1, false, "arc tangent, in (-pi/2, pi/2)"},
    {Function::atan2, "atan2", 2, 2, false, "atan2(y, x): angle of the vector (x, y)"},
    {Function::exp, "exp", 1, 1, false, "exponential"},
    {Function::log, "log", 1, 1, false, "natural logarithm"},
    {Function::sqrt, "sqrt", 1, 1, false, "square root"},
    {Function::abs, "abs", 1, 1, true, "absolute value"},
    {Function::min, "min", 1, kAny, true, "smallest argument"},
    {Function::max, "max", 1, kAny, true, "largest argument"},
    {Function::hypot, "hypot", 2, 2, false, "hypot(x, y): length of the vector (x, y)"},
    {Function::sign, "sign", 1, 1, true, "1 above zero, else -1; of a constant 0 it is 0"},
    {Function::clip, "clip", 3, 3, true, "clip(x, low, high): x held between low and high"},
    {Function::deadzone, "deadzone", 2, 2, true, "deadzone(x, w): 0 within ±w, shifted by w outside"},
    {Function::step, "step", 1, 1, true, "1 above zero, else 0; of a constant 0 it is 1"},
    {Function::table, "table", 2, kAny, true,
     "table(x, x1, y1, x2, y2, …) or table(x, points): straight lines through the points"},
    {Function::if_, "if", 3, 3, true, "if(condition, a, b): a where the condition holds, else b"},
    {Function::noise, "noise", 2, 2, false, "noise(x, seed): smooth random function of x, 1 rms"},
    {Function::weights, "weights", 1, 1, false,
     "weights(in): sum of the magnitudes of the weights at an input"},
}};

double interpolate(std::span<const double> table) {
  const double x = table[0];
  const std::size_t points = (table.size() - 1) / 2;
  if (points < 2) return std::numeric_limits<double>::quiet_NaN();
  std::size_t right = 1;
  while (right + 1 < points && table[1 + 2 * right] <= x) ++right;
  const double x1 = table[2 * right - 1], y1 = table[2 * right];
  const double x2 = table[2 * right + 1], y2 = table[2 * right + 2];
  return y1 + (y2 - y1) * (x - x1) / (x2 - x1);
}

}  // namespace

std::span<const FunctionInfo> functions() {
  return kFunctions;
}

const FunctionInfo* find_function(std::string_view name) {
  const auto* const found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                         [&](const FunctionInfo& f) { return f.name == name; });
  return found == kFunctions.end() ? nullptr : found;
}

const BinaryOperator* operator_of(Expression::Kind kind) {
  const auto* const found = std::find_if(kBinaryOperators.begin(), kBinaryOperators.end(),
                                         [&](const BinaryOperator& op) { return op.kind == kind; });
  return found == kBinaryOperators.end() ? nullptr : found;
}

bool Expression::operator==(const Expression& other) const {
  return kind == other.kind && name == other.name && operands == other.operands &&
         (kind != Kind::number || number == other.number) &&
         (kind != Kind::call || function == other.function);
}

double evaluate(Function function, std::span<const double> a) {
  switch (function) {
    case Function::sin:
      return std::sin(a[0]);
    case Function::cos:
      return std::cos(a[0]);
    case Function::tan:
      return std::tan(a[0]);
    case Function::asin:
      return std::asin(a[0]);
    case Function::acos:
      return std::acos(a[0]);
    case Function::atan:
      return std::atan(a[0]);
    case Function::atan2:
      return std::atan2(a[0], a[1]);
    case Function::exp:
      return std::exp(a[0]);
    case Function::log:
      return std::log(a[0]);
    case Function::sqrt:
      return std::sqrt(a[0]);
    case Function::abs:
      return std::abs(a[0]);
    case Function::min:
      return *std::min_element(a.begin(), a.end());
    case Function::max:
      return *std::max_element(a.begin(), a.end());
    case Function::hypot:
      return std::hypot(a[0], a[1]);
    case Function::sign:
      return a[0] > 0 ? 1 : a[0] < 0 ? -1 : 0;
    case Function::clip:
      return std::max(a[1], std::min(a[0], a[2]));
    case Function::deadzone:
      return a[0] > a[1] ? a[0] - a[1] : a[0] < -a[1] ? a[0] + a[1] : 0;
    case Function::step:
      return a[0] < 0 ? 0 : 1;
    case Function::table:
      return interpolate(a);
    case Function::if_:
      return a[0] != 0 ? a[1] : a[2];
    case Function::noise:
      return noise(a[0], a[1]);
    case Function::weights:  // of an input, which only a diagram has
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
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
      return -v[0];
    case Kind::add:
      return v[0] + v[1];
    case Kind::subtract:
      return v[0] - v[1];
    case Kind::multiply:
      return v[0] * v[1];
    case Kind::divide:
      return v[0] / v[1];
    case Kind::power:
      return std::pow(v[0], v[1]);
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
