// SPDX-License-Identifier: MIT
#include <oblique/text/quantity.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <oblique/text/decimal_comma.h>
#include <oblique/text/expression_grammar.h>
#include <oblique/text/expression_parser.h>

namespace oblique::text {
namespace {

constexpr double kPi = std::numbers::pi;

Unit base_unit(std::string_view name, double scale,
               std::initializer_list<std::pair<Unit::Base, int>> powers) {
  Unit unit;
  unit.name = name;
  unit.scale = scale;
  for (const auto& [base, power] : powers) unit.exponents[base] = power;
  return unit;
}

Unit frequency(std::string_view name, double scale) {
  Unit unit = base_unit(name, scale, {{Unit::time, -1}});
  unit.counts_turns = true;
  return unit;
}

bool is_frequency(const Unit& unit) {
  return unit.same_dimension(frequency("Hz", 1));
}

bool is_angular_velocity(const Unit& unit) {
  return unit.same_dimension(base_unit("rad/s", 1, {{Unit::angle, 1}, {Unit::time, -1}}));
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
      base_unit("ns", 1e-9, {{U::time, 1}}),
      base_unit("us", 1e-6, {{U::time, 1}}),
      base_unit("µs", 1e-6, {{U::time, 1}}),
      base_unit("μs", 1e-6, {{U::time, 1}}),
      base_unit("min", 60, {{U::time, 1}}),
      base_unit("h", 3600, {{U::time, 1}}),
      base_unit("d", 86400, {{U::time, 1}}),
      frequency("Hz", 1),
      frequency("mHz", 1e-3),
      frequency("kHz", 1e3),
      frequency("MHz", 1e6),
      base_unit("rad", 1, {{U::angle, 1}}),
      base_unit("mrad", 1e-3, {{U::angle, 1}}),
      base_unit("deg", kPi / 180, {{U::angle, 1}}),
      base_unit("°", kPi / 180, {{U::angle, 1}}),
      base_unit("º", kPi / 180, {{U::angle, 1}}),  // the ordinal sign, which looks the same
      base_unit("rev", 2 * kPi, {{U::angle, 1}}),
      base_unit("rpm", 2 * kPi / 60, {{U::angle, 1}, {U::time, -1}}),
      base_unit("g", 1e-3, {{U::mass, 1}}),
      base_unit("kg", 1, {{U::mass, 1}}),
      base_unit("V", 1, {{U::voltage, 1}}),
      base_unit("kV", 1e3, {{U::voltage, 1}}),
      base_unit("mV", 1e-3, {{U::voltage, 1}}),
      base_unit("uV", 1e-6, {{U::voltage, 1}}),
      base_unit("µV", 1e-6, {{U::voltage, 1}}),
      base_unit("μV", 1e-6, {{U::voltage, 1}}),
      base_unit("machine unit", 1, {{U::signal, 1}}),
  };
  return units;
}

std::string_view trim(std::string_view text) {
  while (!text.empty()) {
    const std::size_t space = space_at(text, 0);
    if (space == 0) break;
    text.remove_prefix(space);
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  text = trim(text);
  Unit unit;
  unit.name = text;
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
    if (unit.name == factor) unit.counts_turns = known->counts_turns;
    unit.scale *= std::pow(known->scale, sign * power);
    for (std::size_t i = 0; i < unit.exponents.size(); ++i)
      unit.exponents[i] += sign * power * known->exponents[i];
    if (end == std::string_view::npos) {
      // The speed of a shaft: of what is counted by the minute, turns are meant.
      unit.counts_turns = unit.counts_turns || unit.name == "1/min";
      return unit;
    }
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

/// What a message says is expected.
std::string expectation(const Unit& wanted) {
  return wanted.name == "1" ? "a number without a unit" : fmt::format("a quantity in '{}'", wanted.name);
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

std::optional<double> factor_between(const Unit& unit, const Unit& wanted) {
  const double factor = unit.scale / wanted.scale;
  if (unit.same_dimension(wanted)) return factor;
  if (wanted.counts_turns && is_angular_velocity(unit)) return factor / (2 * kPi);
  if (unit.counts_turns && is_angular_velocity(wanted)) return factor * 2 * kPi;
  const int power = wanted.exponents[Unit::signal];
  if (power == 0 || unit.exponents[Unit::signal] != 0) return std::nullopt;
  Unit signal = unit;  // its volts, or its percent, taken as machine units
  signal.exponents[Unit::signal] = power;
  signal.exponents[Unit::voltage] = 0;
  if (!signal.same_dimension(wanted)) return std::nullopt;
  if (unit.exponents[Unit::voltage] == 0) return factor;
  if (unit.exponents[Unit::voltage] != power || !wanted.volts) return std::nullopt;
  return factor / std::pow(*wanted.volts, power);
}

std::string with_unit_of(std::string_view quantity, std::string_view other) {
  const auto unit_of = [](std::string_view text) {
    std::size_t rest = 0;
    parse_expression_prefix(text, rest);
    return trim(text.substr(rest));
  };
  try {
    const std::string_view unit = unit_of(other);
    if (!unit.empty() && unit_of(quantity).empty()) return fmt::format("{} {}", quantity, unit);
  } catch (const ExpressionError&) {
    // no quantity: whoever reads it says so
  }
  return std::string(quantity);
}

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
    if (is_decimal_comma(unit_text, 0)) throw decimal_comma(text, rest);
    const std::string number_text(trim(text.substr(0, rest)));
    std::string remedy = has_value(unit_text, lookup)
                             ? fmt::format("a product is written with '*': {}*{}", number_text, unit_text)
                             : suggest(unit_text, names_like(wanted));
    throw ExpressionError{column, fmt::format("there is no unit '{}'", unit_text), expectation(wanted),
                          std::move(remedy)};
  }
  if (const auto factor = factor_between(*unit, wanted)) return *factor;
  std::string what = fmt::format("'{}' is the wrong unit here", unit_text);
  std::string remedy = wanted.name == "1"
                           ? "leave the unit out"
                           : fmt::format("give it in '{}', or as a number without a unit", wanted.name);
  if (unit->exponents[Unit::voltage] != 0 && wanted.exponents[Unit::signal] != 0 && !wanted.machine.empty()) {
    what = fmt::format("'{}' is a voltage, and the unit of the machine '{}' is no known voltage", unit_text,
                       wanted.machine);
    remedy =
        "name the machine, profile = \"ec-1\" in [machine], or divide by its greatest voltage: 30 V of 60 V "
        "are "
        "0.5";
  } else if (is_frequency(*unit) && is_angular_velocity(wanted)) {
    remedy = "of radians give it in 'rad/s', of turns in 'Hz' or 'rpm'";
  }
  throw ExpressionError{column, std::move(what), expectation(wanted), std::move(remedy)};
}

}  // namespace oblique::text
