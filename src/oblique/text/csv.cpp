// SPDX-License-Identifier: MIT
#include <oblique/text/csv.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/text/decimal.h>
#include <oblique/text/encoding.h>
#include <oblique/text/expression_grammar.h>
#include <oblique/text/quantity.h>
#include <oblique/text/trimmed.h>

namespace oblique::text {
namespace {

struct Cell {
  std::string text;
  int column = 1;  ///< of its first character
};

/// The cells of a line. The separator ' ' is any number of spaces, of which none stands before a unit in
/// brackets.
std::vector<Cell> cells_of(std::string_view line, char separator) {
  const auto separates = [&](std::size_t at) {
    if (line[at] != separator) return false;
    const std::size_t next = line.find_first_not_of(' ', at);
    return separator != ' ' || (line[next] != '[' && line[next] != '(');
  };
  std::vector<Cell> cells;
  for (std::size_t at = 0;;) {
    std::size_t end = at;
    bool quoted = false;
    while (end < line.size() && (quoted || !separates(end))) quoted = quoted != (line[end++] == '"');
    std::string_view text = trimmed(line.substr(at, end - at));
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    cells.push_back({std::string(text), static_cast<int>(at) + 1});
    if (end >= line.size()) return cells;
    at = separator == ' ' ? line.find_first_not_of(' ', end) : end + 1;
  }
}

/// A number with a point or a comma, and its sign as typesetters have it; nothing for other text.
std::optional<double> number_of(std::string_view cell) {
  std::string text;
  if (const std::size_t minus = minus_at(cell, 0); minus > 0) {
    text = "-";
    cell.remove_prefix(minus);
  } else if (cell.starts_with('+')) {
    cell.remove_prefix(1);
  }
  if (cell.starts_with('-')) return std::nullopt;
  text += cell;
  if (std::count(text.begin(), text.end(), ',') == 1) text[text.find(',')] = '.';
  double value = 0;
  const auto [rest, error] = read_decimal(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

bool all_numbers(const std::vector<Cell>& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const Cell& c) { return number_of(c.text).has_value(); });
}

std::vector<std::string_view> lines_of(std::string_view text) {
  const char end_of_line = text.find('\n') == std::string_view::npos ? '\r' : '\n';
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(end_of_line, at), text.size());
    lines.push_back(trimmed(text.substr(at, end - at)));
    at = end + 1;
  }
  return lines;
}

class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& file) : lines_(lines_of(text)), file_(file) {}

  CsvTable read() {
    for (at_ = 0; at_ < lines_.size(); ++at_) {
      const std::string_view line = lines_[at_];
      if (line.empty()) continue;
      if (line.front() == '#') {
        comment_ = trimmed(line.substr(1));
      } else if (!table_.names.empty()) {
        read_row(cells_of(line, separator_));
      } else if (line.starts_with("sep=") && line.size() == 5) {  // how a spreadsheet is told
        separator_ = line.back();
      } else {
        read_names(line);
      }
    }
    at_ = 0;
    if (table_.names.empty()) fail(1, "the file is empty", "a line of names, then lines of numbers");
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(int column, std::string what, std::string expected, std::string remedy = {}) const {
    throw ReadError(Diagnostic{{file_, {static_cast<int>(at_) + 1, column}},
                               std::move(what),
                               std::move(expected),
                               std::move(remedy)});
  }

  /// The first of tab, semicolon and comma that a line has outside quotes; else spaces, where the next line
  /// has as many numbers, or the line is of numbers itself.
  char separator_of(std::string_view line) const {
    for (const char separator : {'\t', ';', ','}) {
      if (cells_of(line, separator).size() > 1) return separator;
    }
    const std::vector<Cell> words = cells_of(line, ' ');
    const std::vector<Cell> next = cells_of(lines_[std::min(at_ + 1, lines_.size() - 1)], ' ');
    const bool same = next.size() == words.size() && all_numbers(next);
    return words.size() > 1 && (same || all_numbers(words)) ? ' ' : ',';
  }

  void read_names(std::string_view line) {
    if (separator_ == 0) separator_ = separator_of(line);
    std::vector<Cell> cells = cells_of(line, separator_);
    ends_open_ = cells.size() > 1 && cells.back().text.empty();
    if (ends_open_) cells.pop_back();
    table_.columns.resize(cells.size());
    if (!all_numbers(cells)) {
      for (const Cell& cell : cells) table_.names.push_back(cell.text);
      return;
    }
    const std::vector<Cell> above = cells_of(comment_, separator_of(comment_));
    for (std::size_t c = 0; c < cells.size(); ++c) {
      table_.names.push_back(above.size() == cells.size() && !comment_.empty() ? above[c].text
                                                                               : fmt::format("{}", c + 1));
      table_.columns[c].push_back(number(cells[c]));
    }
  }

  void read_row(std::vector<Cell> cells) {
    const std::size_t wanted = table_.names.size();
    if (ends_open_ && cells.size() == wanted + 1 && cells.back().text.empty()) cells.pop_back();
    if (cells.size() != wanted) {
      fail(1, fmt::format("the line has {} cells", cells.size()),
           fmt::format("{}, as the line of names has", wanted),
           separator_ == ',' && cells.size() == 2 * wanted
               ? "numbers with decimal commas stand in quotes, or between semicolons or tabs"
               : "");
    }
    if (table_.columns[0].empty() && read_units(cells)) return;
    for (std::size_t c = 0; c < cells.size(); ++c) table_.columns[c].push_back(number(cells[c]));
  }

  /// Adds a line of units, below the line of names, to these. False where the line is another.
  bool read_units(const std::vector<Cell>& cells) {
    std::vector<std::string> names;
    bool any = false;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::string_view unit = cells[c].text;
      if (unit.size() > 2 && (unit.front() == '[' || unit.front() == '('))
        unit = unit.substr(1, unit.size() - 2);
      const bool none = unit.empty() || unit == "-" || unit == "1";
      if (!none && !parse_unit(unit)) return false;
      any = any || !none;
      names.push_back(none ? table_.names[c] : fmt::format("{} [{}]", table_.names[c], unit));
    }
    if (any) table_.names = std::move(names);
    return any;
  }

  double number(const Cell& cell) {
    const auto value = number_of(cell.text);
    const bool comma = cell.text.find(',') != std::string::npos;
    const bool point = cell.text.find('.') != std::string::npos;
    const bool both = (comma && point) || (comma && points_) || (point && commas_);
    if (!value && !both)
      fail(cell.column, fmt::format("'{}' is no number", cell.text), "a number in every cell");
    if (both) {
      fail(cell.column,
           fmt::format("'{}' leaves open whether the point or the comma begins the decimals", cell.text),
           "one of the two in the numbers of a file", "write thousands without marks between them");
    }
    commas_ = commas_ || comma;
    points_ = points_ || point;
    return *value;
  }

  std::vector<std::string_view> lines_;
  const std::string& file_;
  std::size_t at_ = 0;  ///< of `lines_`
  CsvTable table_;
  std::string_view comment_;              ///< the last one
  char separator_ = 0;                    ///< 0: not yet known
  bool ends_open_ = false;                ///< each line ends with a separator
  bool commas_ = false, points_ = false;  ///< have been seen in numbers
};

}  // namespace

CsvHeading split_heading(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && (text.back() == ']' || text.back() == ')')) {
    const std::size_t open = text.rfind(text.back() == ']' ? '[' : '(');
    if (open != std::string_view::npos && open > 0 && text[open - 1] != '/')
      return {std::string(trimmed(text.substr(0, open))),
              std::string(trimmed(text.substr(open + 1, text.size() - open - 2)))};
  }
  for (const std::string_view sign : {"/", " in ", ", "}) {
    const std::size_t at = text.find(sign);
    if (at == std::string_view::npos || at == 0) continue;
    std::string_view unit = trimmed(text.substr(at + sign.size()));
    if (unit.starts_with('(') && unit.ends_with(')')) unit = unit.substr(1, unit.size() - 2);
    if (parse_unit(unit)) return {std::string(trimmed(text.substr(0, at))), std::string(unit)};
  }
  return {std::string(text), {}};
}

std::optional<std::size_t> CsvTable::index_of(std::string_view name) const {
  const auto exact = std::find(names.begin(), names.end(), name);
  if (exact != names.end()) return static_cast<std::size_t>(exact - names.begin());
  std::optional<std::size_t> found;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (split_heading(names[c]).name != name) continue;
    if (found) return std::nullopt;
    found = c;
  }
  return found;
}

const std::vector<double>* CsvTable::find(std::string_view name) const {
  const auto index = index_of(name);
  return index ? &columns[*index] : nullptr;
}

CsvTable parse_csv(std::string_view text, const std::string& file) {
  text = without_byte_order_mark(text, file);
  if (is_utf8(text)) return CsvReader(text, file).read();
  return CsvReader(utf8_of_latin1(text), file).read();
}

}  // namespace oblique::text
