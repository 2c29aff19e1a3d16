// SPDX-License-Identifier: MIT
#include <oblique/diagram/names.h>

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/diagram.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

constexpr std::array<std::string_view, 10> kReserved{
    "time", "polarity", "in_initial", "in_operate", "in_hold", "pi", "inf", "and", "or", "not"};

bool is_list_of(const text::Value& value, text::Value::Kind kind) {
  return value.kind == text::Value::Kind::array &&
         std::all_of(value.elements.begin(), value.elements.end(),
                     [&](const text::Value& element) { return element.kind == kind; });
}

/// A number, a signal or several, or points.
bool can_be_setting(const text::Value& value) {
  return value.kind == text::Value::Kind::number || value.kind == text::Value::Kind::string ||
         value.kind == text::Value::Kind::table || is_list_of(value, text::Value::Kind::string) ||
         is_list_of(value, text::Value::Kind::array);
}

BlockInstance read_block(const std::string& file, const text::Entry& entry, text::Diagnostics& diagnostics) {
  BlockInstance block;
  block.name = entry.key;
  block.place = {file, entry.position};
  text::TableReader reader(file, entry.value, fmt::format("block '{}'", entry.key), diagnostics);
  if (entry.value.kind != text::Value::Kind::table) return block;
  block.type = reader.required_string("type", "the name of a block type").value_or("");
  block.label = reader.string("label").value_or("");
  for (const text::Entry& setting : entry.value.entries) {
    if (setting.key == "type" || setting.key == "label") continue;
    if (can_be_setting(setting.value)) {
      block.settings.push_back(setting);
      continue;
    }
    diagnostics.add(
        {{file, setting.value.position},
         fmt::format("'{}.{}' is {}", entry.key, setting.key, text::kind_name(setting.value.kind)),
         "a number, a string or a list of strings",
         R"(an input takes "signal" or ["signal", …], a parameter a number or a quantity)"});
  }
  return block;
}

void collect_names(const text::Expression& expression, std::vector<const text::Expression*>& names) {
  if (expression.kind == text::Expression::Kind::name) names.push_back(&expression);
  for (const text::Expression& operand : expression.operands) collect_names(operand, names);
}

}  // namespace

bool is_reserved(std::string_view name) {
  return std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end();
}

bool check_name(std::string_view name, std::string_view what, const text::Place& place,
                text::Diagnostics& diagnostics) {
  if (!text::is_identifier(name)) {
    diagnostics.add({place,
                     fmt::format("'{}' cannot be the name of {}", name, what),
                     "letters, digits and '_', with a letter or '_' first",
                     {}});
    return false;
  }
  if (is_reserved(name)) {
    diagnostics.add({place,
                     fmt::format("'{}' cannot be the name of {}: it is reserved", name, what),
                     fmt::format("another name than {}", fmt::join(kReserved, ", ")),
                     {}});
    return false;
  }
  return true;
}

std::vector<BlockInstance> read_blocks(const std::string& file, const text::Value& table,
                                       text::Diagnostics& diagnostics) {
  std::vector<BlockInstance> blocks;
  blocks.reserve(table.entries.size());
  for (const text::Entry& entry : table.entries) {
    check_name(entry.key, "a block", {file, entry.position}, diagnostics);
    blocks.push_back(read_block(file, entry, diagnostics));
  }
  if (blocks.empty())
    diagnostics.add({{file, table.position}, "[blocks] is empty", "at least one block", {}});
  return blocks;
}

std::vector<const text::Expression*> names_in(const text::Expression& expression) {
  std::vector<const text::Expression*> names;
  collect_names(expression, names);
  return names;
}

text::SourcePosition position_in(const text::Value& value, int column) {
  if (value.kind != text::Value::Kind::string) return value.position;
  return text::to_diagnostic({column, {}, {}, {}}, {}, value, {}).place.position;
}

}  // namespace oblique::diagram
