// SPDX-License-Identifier: MIT
#include <oblique/text/quantity.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace oblique {
namespace {

constexpr double kPi = std::numbers::pi;

Unit base_unit(std::string_view name, double scale,
               std::initializer_list<std::pair<Unit::Base, int>> powers) {
  Unit unit{std::string(name), scale, {}};
  for (const auto& [base, power] : powers) unit.exponents[base] = power;
  return unit;
}

const std::vector<Unit>& named_units() {
  using U = Unit;
  static const std::vector<Unit> units{
      base_unit("1", 1, {}),
      base_unit("%", 0.01, {}),
      base_unit("m", 1, {{U::length, 1}}),
      base_unit("dm", 0.1, {{U::length, 1}}),
      base_unit("cm", 0.01, {{U::length, 1}}),
      base_unit("mm", 1e-3, {{U::length, 1}}),
      base_unit("um", 1e-6, {{U::length, 1}}),
      base_unit("µm", 1e-6, {{U::length, 1}}),  // the micro sign
      base_unit("μm", 1e-6, {{U::length, 1}}),  // the Greek letter, which looks the same
      base_unit("km", 1e3, {{U::length, 1}}),
      base_unit("in", 0.0254, {{U::length, 1}}),
      base_unit("ft", 0.3048, {{U::length, 1}}),
      base_unit("s", 1, {{U::time, 1}}),
      base_unit("ms", 1e-3, {{U::time, 1}}),
      base_unit("us", 1e-6, {{U::time, 1}}),
      base_unit("µs", 1e-6, {{U::time, 1}}),
      base_unit("μs", 1e-6, {{U::time, 1}}),
      base_unit("min", 60, {{U::time, 1}}),
      base_unit("h", 3600, {{U::time, 1}}),
      base_unit("Hz", 1, {{U::time, -1}}),
      base_unit("kHz", 1e3, {{U::time, -1}}),
      base_unit("MHz", 1e6, {{U::time, -1}}),
      base_unit("rad", 1, {{U::angle, 1}}),
      base_unit("deg", kPi / 180, {{U::angle, 1}}),
      base_unit("°", kPi / 180, {{U::angle, 1}}),
      base_unit("rev", 2 * kPi, {{U::angle, 1}}),
      base_unit("rpm", 2 * kPi / 60, {{U::angle, 1}, {U::time, -1}}),
      base_unit("g", 1e-3, {{U::mass, 1}}),
      base_unit("kg", 1, {{U::mass, 1}}),
      base_unit("V", 1, {{U::voltage, 1}}),
      base_unit("mV", 1e-3, {{U::voltage, 1}}),
      base_unit("uV", 1e-6, {{U::voltage, 1}}),
      base_unit("µV", 1e-6, {{U::voltage, 1}}),
      base_unit("μV", 1e-6, {{U::voltage, 1}}),
      base_unit("machine unit", 1, {{U::signal, 1}}),
  };
  return units;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  text = trim(text);
  Unit unit{std::string(text), 1, {}};
  int sign = 1;
  while (true) {
    const std::size_t end = text.find_first_of("*/");
    std::string_view factor = trim(text.substr(0, end));
    int power = 1;
    if (const std::size_t caret = factor.find('^'); caret != std::string_view::npos) {
      const std::string_view digits = trim(factor.substr(caret + 1));
      if (digits.size() != 1 || digits[0] < '1' || digits[0] > '9') return std::nullopt;
      power = digits[0] - '0';
      factor = trim(factor.substr(0, caret));
    }
    const auto& names = named_units();
    const auto known =
        std::find_if(names.begin(), names.end(), [&](const Unit& u) { return u.name == factor; });
    if (known == names.end()) return std::nullopt;
    unit.scale *= std::pow(known->scale, sign * power);
    for (std::size_t i = 0; i < unit.exponents.size(); ++i)
      unit.exponents[i] += sign * power * known->exponents[i];
    if (end == std::string_view::npos) return unit;
    sign = text[end] == '/' ? -1 : 1;
    text.remove_prefix(end + 1);
  }
}

namespace {

/// True where a number stands at the front of `text`, as in "2 pi".
bool has_value(std::string_view text, const NameLookup& lookup) {
  try {
    std::size_t rest = 0;
    evaluate(parse_expression_prefix(text, rest), lookup);
    return true;
  } catch (const ExpressionError&) {
    return false;
  }
}

/// The units that may stand for `wanted`.
std::vector<std::string> names_like(const Unit& wanted) {
  std::vector<std::string> names{wanted.name};
  for (const Unit& known : named_units()) {
    if (known.same_dimension(wanted) && known.name != wanted.name) names.push_back(known.name);
  }
  return names;
}

}  // namespace

double parse_quantity(std::string_view text, const Unit& wanted, const NameLookup& lookup) {
  std::size_t rest = 0;
  const double number = evaluate(parse_expression_prefix(text, rest), lookup);
  return number * unit_factor(text, rest, wanted, lookup);
}

double unit_factor(std::string_view text, std::size_t rest, const Unit& wanted, const NameLookup& lookup) {
  const std::string_view unit_text = trim(text.substr(rest));
  if (unit_text.empty()) return 1;
  const int column = static_cast<int>(rest) + 1;
  const auto unit = parse_unit(unit_text);
  if (!unit) {
    const std::string number_text(trim(text.substr(0, rest)));
    std::string remedy = has_value(unit_text, lookup)
                             ? fmt::format("a product is written with '*': {}*{}", number_text, unit_text)
                             : suggest(unit_text, names_like(wanted));
    throw ExpressionError{column, fmt::format("there is no unit '{}'", unit_text),
                          fmt::format("a quantity in '{}'", wanted.name), std::move(remedy)};
  }
  if (!unit->same_dimension(wanted)) {
    throw ExpressionError{column, fmt::format("'{}' is the wrong unit here", unit_text),
                          fmt::format("a quantity in '{}'", wanted.name),
                          fmt::format("give it in '{}', or as a number without a unit", wanted.name)};
  }
  return unit->scale / wanted.scale;
}

}  // namespace oblique
