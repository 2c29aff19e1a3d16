// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_expressions.h>

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include <oblique/diagram/names.h>
#include <oblique/text/expression_parser.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

/// As much as one text may hold: whoever walks an expression does so by recursion, and names that double each
/// other would soon fill the memory.
constexpr std::size_t kMostOperators = 1000;

std::size_t operators_in(const text::Expression& expression) {
  return std::accumulate(expression.operands.begin(), expression.operands.end(),
                         std::size_t{expression.operands.empty() ? 0U : 1U},
                         [](std::size_t n, const text::Expression& e) { return n + operators_in(e); });
}

void set_column(text::Expression& expression, int column) {
  expression.column = column;
  for (text::Expression& operand : expression.operands) set_column(operand, column);
}

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return name == "pi" || name == "inf" || std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void BlockExpressions::read_lets(const text::Value& table, const std::vector<std::string>& known) {
  for (const text::Entry& entry : table.entries) later_lets_.insert(entry.key);
  for (const text::Entry& entry : table.entries) {
    if (!is_free(entry.key, {definition_.file, entry.position})) continue;
    const std::string what = fmt::format("'{}' of [let]", entry.key);
    auto expression = read(entry.value, what);
    if (expression && resolve(*expression, entry.value, what, known)) {
      lets_.emplace(entry.key, std::move(*expression));
    } else {
      broken_lets_.insert(entry.key);
    }
    later_lets_.erase(entry.key);
  }
}

bool BlockExpressions::is_free(const std::string& name, text::Place place) const {
  if (!check_name(name, "an expression of [let]", place, diagnostics_)) return false;
  if (!definition_.find_input(name) && !definition_.find_output(name) && !definition_.find_parameter(name))
    return true;
  diagnostics_.add({std::move(place),
                    fmt::format("the name '{}' is used twice", name),
                    "different names for inputs, outputs, parameters and [let]",
                    {}});
  return false;
}

std::optional<text::Expression> BlockExpressions::read(const text::Value& value,
                                                       const std::string& what) const {
  if (value.kind == text::Value::Kind::number) {
    text::Expression number;
    number.number = value.number;
    number.column = 1;
    return number;
  }
  if (value.kind != text::Value::Kind::string) {
    diagnostics_.add({{definition_.file, value.position},
                      fmt::format("{} is {}", what, text::kind_name(value.kind)),
                      "a number or an expression",
                      {}});
    return std::nullopt;
  }
  try {
    return text::parse_expression(value.text);
  } catch (const text::ExpressionError& error) {
    diagnostics_.add(text::to_diagnostic(error, definition_.file, value, what));
    return std::nullopt;
  }
}

bool BlockExpressions::resolve(text::Expression& expression, const text::Value& value,
                               const std::string& what, const std::vector<std::string>& known) const {
  bool good = true;
  const auto report = [&](int column, std::string found, std::string expected, std::string remedy) {
    diagnostics_.add({{definition_.file, position_in(value, column)},
                      fmt::format("{}: {}", what, found),
                      std::move(expected),
                      std::move(remedy)});
    good = false;
  };
  for (const text::Expression* const name : names_in(expression)) {
    if (is_in(known, name->name)) continue;
    if (broken_lets_.contains(name->name)) {
      good = false;
      continue;
    }
    const auto let = lets_.find(name->name);
    if (let == lets_.end()) {
      std::vector<std::string> all = known;
      for (const auto& [other, expression_of_it] : lets_) all.push_back(other);
      const bool is_later = later_lets_.contains(name->name);
      report(name->column, fmt::format("there is no name '{}'{}", name->name, is_later ? " yet" : ""), {},
             is_later ? "[let] names what stands above: put it there" : text::suggest(name->name, all));
      continue;
    }
    const auto inner = names_in(let->second);
    const auto unknown = std::find_if(inner.begin(), inner.end(),
                                      [&](const text::Expression* e) { return !is_in(known, e->name); });
    if (unknown == inner.end()) continue;
    report(name->column, fmt::format("'{}' of [let] names '{}'", name->name, (*unknown)->name),
           "what may be named here", fmt::format("there is no '{}' here", (*unknown)->name));
  }
  if (!good) return false;
  put_in(expression);
  if (const std::size_t operators = operators_in(expression); operators > kMostOperators) {
    report(1, fmt::format("with [let] put in it has {} operators", operators),
           fmt::format("at most {}", kMostOperators), "make it an equation with a name of its own");
  }
  return good;
}

/// Columns become those of the names: messages about the equation then point there.
void BlockExpressions::put_in(text::Expression& expression) const {
  if (expression.kind == text::Expression::Kind::name) {
    const auto let = lets_.find(expression.name);
    if (let == lets_.end()) return;
    const int column = expression.column;
    expression = let->second;
    set_column(expression, column);
    return;
  }
  for (text::Expression& operand : expression.operands) put_in(operand);
}

}  // namespace oblique::diagram
