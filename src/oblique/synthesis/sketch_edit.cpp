// SPDX-License-Identifier: MIT
#include <oblique/synthesis/sketch_edit.h>

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <oblique/synthesis/text_edit.h>

namespace oblique::synthesis {
namespace {

std::string entry_of(const mechanism::Mechanism& mechanism, const mechanism::SketchPoint& sketched) {
  return fmt::format("{} = [{:.6g}, {:.6g}]", mechanism.points[sketched.point].name, sketched.position.x(),
                     sketched.position.y());
}

/// Behind the last byte of the line that `at` is in.
std::size_t end_of_line(std::string_view text, std::size_t at) {
  std::size_t end = std::min(text.find('\n', at), text.size());
  if (end > at && end < text.size() && text[end - 1] == '\r') --end;
  return end;
}

/// Behind the bracket that closes a pair of coordinates, after the last of them.
std::size_t end_of_pair(std::string_view text, const text::Value& pair) {
  return std::min(text.find(']', range_of(text, pair.elements.back()).end), text.size() - 1) + 1;
}

}  // namespace

std::string with_sketch(const std::string& text, const mechanism::Mechanism& mechanism,
                        const std::vector<mechanism::SketchPoint>& points, NewPoints new_points) {
  const text::Document document = text::parse_document(text, mechanism.file);
  const text::Value* const sketch = document.root.find("sketch");
  std::vector<Replacement> replacements;
  std::vector<std::string> added;
  for (const mechanism::SketchPoint& sketched : points) {
    const text::Value* const pair =
        sketch == nullptr ? nullptr : sketch->find(mechanism.points[sketched.point].name);
    if (pair == nullptr) {
      if (new_points == NewPoints::add) added.push_back(entry_of(mechanism, sketched));
      continue;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      replacements.push_back({range_of(text, pair->elements[i]),
                              fmt::format("{:.6g}", sketched.position[static_cast<Eigen::Index>(i)])});
    }
  }
  if (added.empty()) return replace_ranges(text, std::move(replacements));
  const bool carriage_returns = text.find("\r\n") != std::string::npos;
  const std::string line_end = carriage_returns ? "\r\n" : "\n";
  std::string lines;
  if (sketch == nullptr || sketch->entries.empty()) {
    // An empty [sketch] has no place that is known, and its header must not come twice.
    if (sketch != nullptr) {
      const std::size_t header = text.find("[sketch]");
      if (header == std::string::npos) return replace_ranges(text, std::move(replacements));
      for (const std::string& entry : added) lines += line_end + entry;
      const std::size_t at = end_of_line(text, header);
      replacements.push_back({{at, at}, lines});
    } else {
      lines = (text.ends_with('\n') ? "" : line_end) + line_end + "[sketch]" + line_end;
      for (const std::string& entry : added) lines += entry + line_end;
      replacements.push_back({{text.size(), text.size()}, lines});
    }
    return replace_ranges(text, std::move(replacements));
  }
  const text::Entry& last = *std::max_element(
      sketch->entries.begin(), sketch->entries.end(), [](const text::Entry& a, const text::Entry& b) {
        return a.position.line != b.position.line ? a.position.line < b.position.line
                                                  : a.position.column < b.position.column;
      });
  const std::size_t behind = end_of_pair(text, last.value);
  // Within braces entries are parted by commas; else each has a line of its own.
  const std::size_t next = text.find_first_not_of(" \t", behind);
  const bool in_braces = next != std::string::npos && text[next] == '}';
  for (const std::string& entry : added) lines += (in_braces ? ", " : line_end) + entry;
  const std::size_t at = in_braces ? behind : end_of_line(text, behind);
  replacements.push_back({{at, at}, lines});
  return replace_ranges(text, std::move(replacements));
}

}  // namespace oblique::synthesis
