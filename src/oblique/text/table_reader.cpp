// SPDX-License-Identifier: MIT
#include <oblique/text/table_reader.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace oblique::text {

TableReader::TableReader(std::string file, const Value& table, std::string what, Diagnostics& diagnostics)
    : file_(std::move(file)), table_(&table), what_(std::move(what)), diagnostics_(&diagnostics) {
  if (table.kind != Value::Kind::table) {
    diagnostics_->add(
        {place(table.position), fmt::format("{} is {}", what_, kind_name(table.kind)), "a table", {}});
  }
}

const Value* TableReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return table_->find(key);
}

const Value* TableReader::expect(std::string_view key, Value::Kind kind) {
  const Value* const value = find(key);
  if (value == nullptr || value->kind == kind) return value;
  report(key, fmt::format("'{}' of {} is {}", key, what_, kind_name(value->kind)),
         std::string(kind_name(kind)));
  return nullptr;
}

std::optional<std::string> TableReader::string(std::string_view key) {
  const Value* const value = expect(key, Value::Kind::string);
  return value == nullptr ? std::nullopt : std::optional(value->text);
}

std::optional<bool> TableReader::boolean(std::string_view key) {
  const Value* const value = expect(key, Value::Kind::boolean);
  return value == nullptr ? std::nullopt : std::optional(value->boolean);
}

const Value* TableReader::table(std::string_view key) {
  return expect(key, Value::Kind::table);
}

std::optional<double> TableReader::quantity(std::string_view key, std::string_view unit,
                                            const NameLookup& lookup) {
  return quantity(key, parse_unit(unit).value(), lookup);
}

std::optional<double> TableReader::quantity(std::string_view key, const Unit& unit,
                                            const NameLookup& lookup) {
  const Value* const value = find(key);
  if (value == nullptr) return std::nullopt;
  return read_quantity(file_, *value, unit, fmt::format("'{}' of {}", key, what_), *diagnostics_, lookup);
}

std::optional<std::vector<std::string>> TableReader::strings(std::string_view key, bool allow_single) {
  const Value* const value = find(key);
  if (value == nullptr) return std::nullopt;
  if (allow_single && value->kind == Value::Kind::string) return std::vector{value->text};
  const bool all_strings = value->kind == Value::Kind::array &&
                           std::all_of(value->elements.begin(), value->elements.end(),
                                       [](const Value& v) { return v.kind == Value::Kind::string; });
  if (!all_strings) {
    report(key, fmt::format("'{}' of {} is not a list of names", key, what_),
           allow_single ? R"("name" or ["name", …])" : R"(["name", …])");
    return std::nullopt;
  }
  std::vector<std::string> texts;
  for (const Value& element : value->elements) texts.push_back(element.text);
  return texts;
}

std::optional<std::string> TableReader::required_string(std::string_view key, std::string_view expected) {
  auto value = string(key);
  if (!value) report_absent(key, std::string(expected));
  return value;
}

std::optional<double> TableReader::required_quantity(std::string_view key, std::string_view unit) {
  return required_quantity(key, parse_unit(unit).value());
}

std::optional<double> TableReader::required_quantity(std::string_view key, const Unit& unit) {
  auto value = quantity(key, unit);
  if (!value) report_absent(key, fmt::format("a quantity in '{}'", unit.name));
  return value;
}

void TableReader::report_absent(std::string_view key, std::string expected) {
  // What is no table at all has been reported already.
  if (table_->kind != Value::Kind::table || table_->find(key) != nullptr) return;
  report(key, fmt::format("{} has no '{}'", what_, key), std::move(expected));
}

void TableReader::report(std::string_view key, std::string what, std::string expected, Remedy remedy) {
  const Value* const value = table_->find(key);
  diagnostics_->add({place(value != nullptr ? value->position : table_->position), std::move(what),
                     std::move(expected), std::move(remedy)});
}

void TableReader::finish() {
  for (const Entry& entry : table_->entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    diagnostics_->add({place(entry.position),
                       fmt::format("unknown key '{}' in {}", entry.key, what_),
                       {},
                       suggest(entry.key, known_)});
  }
}

std::optional<double> read_quantity(const std::string& file, const Value& value, std::string_view unit,
                                    const std::string& what, Diagnostics& diagnostics,
                                    const NameLookup& lookup) {
  return read_quantity(file, value, parse_unit(unit).value(), what, diagnostics, lookup);
}

std::optional<double> read_quantity(const std::string& file, const Value& value, const Unit& unit,
                                    const std::string& what, Diagnostics& diagnostics,
                                    const NameLookup& lookup) {
  double number = 0;
  if (value.kind == Value::Kind::number) {
    number = value.number;
  } else if (value.kind == Value::Kind::string) {
    try {
      number = parse_quantity(value.text, unit, lookup);
    } catch (const ExpressionError& error) {
      diagnostics.add(to_diagnostic(error, file, value, what));
      return std::nullopt;
    }
  } else {
    diagnostics.add({{file, value.position},
                     fmt::format("{} is {}", what, kind_name(value.kind)),
                     fmt::format("a number or a quantity in '{}'", unit.name),
                     {}});
    return std::nullopt;
  }
  if (std::isnan(number)) {
    diagnostics.add(
        {{file, value.position}, fmt::format("{} has no value (not a number)", what), "a number", {}});
    return std::nullopt;
  }
  return number;
}

Diagnostic to_diagnostic(const ExpressionError& error, const std::string& file, const Value& string_value,
                         const std::string& what) {
  SourcePosition at = string_value.position;
  const std::string_view text = string_value.text;
  if (text.find('\n') == std::string_view::npos) {
    // The text starts after its quote; columns count characters, not bytes.
    const std::string_view before = text.substr(0, static_cast<std::size_t>(std::max(error.column - 1, 0)));
    const auto continuations = std::count_if(
        before.begin(), before.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; });
    at.column += error.column - static_cast<int>(continuations);
  }
  return {{file, at}, fmt::format("{}: {}", what, error.what), error.expected, error.remedy};
}

std::optional<ExpectedValue> read_expected_value(TableReader& reader, const Unit& unit) {
  const auto value = reader.required_quantity("value", unit);
  const auto within = reader.required_quantity("within", unit);
  if (value && !std::isfinite(*value)) {
    reader.report("value", fmt::format("'value' of {} is infinite", reader.what()), "a finite number");
  }
  if (within && !(*within > 0 && std::isfinite(*within))) {
    reader.report("within", fmt::format("'within' of {} is {}", reader.what(), *within),
                  "a finite number above 0");
  }
  reader.finish();
  if (!value || !within) return std::nullopt;
  return ExpectedValue{*value, *within};
}

bool check_format(TableReader& reader, std::string_view expected) {
  struct Kind {
    std::string_view format;
    Remedy remedy;
  };
  const std::array<Kind, 6> kinds{
      {{"oblique-diagram/1",
        {"this is a diagram: ", Action{"run"}, ", ", Action{"check"}, " and ", Action{"draw"}, " take it"}},
       {"oblique-mechanism/1",
        {"this is a mechanism: ", Action{"solve"}, ", ", Action{"compare"}, " and ", Action{"draw"},
         " take it, ", Action{"patch"}, " makes a diagram of it"}},
       {"oblique-ensemble/1", {"this is a plan of an ensemble: ", Action{"ensemble run"}, " takes it"}},
       {"oblique-block/1", {"this is a block: its folder belongs among the ", Setting{"blocks"}}},
       {"oblique-machine/1", "this is a machine's profile"},
       {"oblique-state/1",
        {"this is the state of a run: ", Action{"run"}, " goes on with it as ", Setting{"from"}}}}};
  const auto format = reader.required_string("format", fmt::format("format = \"{}\"", expected));
  if (!format || *format == expected) return true;
  const auto* const kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const Kind& known) { return known.format == *format; });
  reader.report(
      "format", fmt::format("the format is '{}'", *format), fmt::format("'{}'", expected),
      kind != kinds.end()
          ? kind->remedy
          : "a diagram is oblique-diagram/1, a mechanism oblique-mechanism/1, a block oblique-block/1");
  return kind == kinds.end();
}

}  // namespace oblique::text
