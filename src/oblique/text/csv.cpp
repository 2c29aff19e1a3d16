// SPDX-License-Identifier: MIT
#include <oblique/text/csv.h>

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

namespace oblique {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

struct Cell {
  std::string text;
  int column = 1;  ///< of its first character
};

std::vector<Cell> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  while (true) {
    std::size_t end = at;
    bool quoted = false;
    while (end < line.size() && (quoted || line[end] != ',')) quoted = quoted != (line[end++] == '"');
    std::string_view text = trimmed(line.substr(at, end - at));
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    cells.push_back({std::string(text), static_cast<int>(at) + 1});
    if (end >= line.size()) return cells;
    at = end + 1;
  }
}

[[noreturn]] void fail(const std::string& file, int line, int column, std::string what,
                       std::string expected) {
  throw ReadError(Diagnostic{{file, {line, column}}, std::move(what), std::move(expected), {}});
}

}  // namespace

const std::vector<double>* CsvTable::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

CsvTable parse_csv(std::string_view text, const std::string& file) {
  CsvTable table;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<Cell> cells = cells_of(line);
    if (table.names.empty()) {
      for (const Cell& cell : cells) table.names.push_back(cell.text);
      table.columns.resize(cells.size());
      continue;
    }
    if (cells.size() != table.names.size()) {
      fail(file, number, 1, fmt::format("the line has {} cells", cells.size()),
           fmt::format("{}, as the line of names has", table.names.size()));
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string& cell = cells[c].text;
      double value = 0;
      const auto [rest, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || rest != cell.data() + cell.size() || cell.empty())
        fail(file, number, cells[c].column, fmt::format("'{}' is no number", cell), "a number in every cell");
      table.columns[c].push_back(value);
    }
  }
  if (table.names.empty()) fail(file, 1, 1, "the file is empty", "a line of names, then lines of numbers");
  return table;
}

}  // namespace oblique
