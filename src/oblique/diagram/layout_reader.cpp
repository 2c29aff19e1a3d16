// SPDX-License-Identifier: MIT
#include <oblique/diagram/layout_reader.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

/// Far beyond any drawing, and a picture that large can still be written.
constexpr double kFarthest = 10000;

std::optional<BlockPlace> read_place(const std::string& file, const text::Entry& entry,
                                     text::Diagnostics& diagnostics) {
  const std::string subject = fmt::format("place of '{}' in [layout]", entry.key);
  const auto refuse = [&](text::SourcePosition position, const std::string& what) {
    diagnostics.add({{file, position},
                     fmt::format("{} {}", subject, what),
                     fmt::format("[x, y], two numbers from -{0} to {0}", kFarthest),
                     {}});
    return std::nullopt;
  };
  if (entry.value.kind != text::Value::Kind::array)
    return refuse(entry.value.position, fmt::format("is {}", text::kind_name(entry.value.kind)));
  if (entry.value.elements.size() != 2)
    return refuse(entry.value.position, fmt::format("is a list of {}", entry.value.elements.size()));
  double at[2] = {0, 0};
  for (std::size_t k = 0; k < 2; ++k) {
    const text::Value& element = entry.value.elements[k];
    const auto number = text::read_quantity(file, element, "1", subject, diagnostics);
    if (!number) return std::nullopt;
    if (!(std::abs(*number) <= kFarthest)) return refuse(element.position, fmt::format("has {}", *number));
    at[k] = *number;
  }
  return BlockPlace{entry.key, at[0], at[1], {file, entry.position}};
}

}  // namespace

std::vector<BlockPlace> read_layout(const std::string& file, const text::Value& table,
                                    const std::vector<BlockInstance>& blocks,
                                    text::Diagnostics& diagnostics) {
  std::vector<std::string> names;
  names.reserve(blocks.size());
  for (const BlockInstance& block : blocks) names.push_back(block.name);
  std::vector<BlockPlace> places;
  for (const text::Entry& entry : table.entries) {
    if (std::find(names.begin(), names.end(), entry.key) == names.end()) {
      diagnostics.add({{file, entry.position},
                       fmt::format("[layout] gives a place to '{}', and there is no such block", entry.key),
                       "the name of a block of this file",
                       text::suggest(entry.key, names)});
      continue;
    }
    if (auto place = read_place(file, entry, diagnostics)) places.push_back(std::move(*place));
  }
  return places;
}

}  // namespace oblique::diagram
