// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/expression.h>

namespace oblique::cli {

/// A table for people: text cells, numbers aligned to the right.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : rows_{std::move(header)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// Lines with two blanks between columns; cells of `left_columns` first columns are aligned to the left.
  std::string text(std::size_t left_columns = 0) const;

  /// The header and the other rows.
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// Up to `most` row numbers of `rows`, evenly spread, the first and the last among them.
std::vector<std::size_t> spread_rows(std::size_t rows, std::size_t most);

/// How many columns of `width` characters a table may have on this terminal (110 characters where there is
/// none).
std::size_t columns_that_fit(std::size_t width);

/// Characters in a line of this terminal, or `otherwise` where stdout is none.
std::size_t terminal_width(std::size_t otherwise);

/// Whether stdout is a terminal that wants colours (NO_COLOR).
bool stdout_has_colours();

/// "0.0125", "1.2e-07": six significant digits; empty for what is not a number. A value that is rounding
/// beside `scale`, the size of its neighbours, is shown as 0.
std::string short_number(double value, double scale = 0);

/// "1 block", "3 blocks".
std::string count(std::size_t n, std::string_view one, std::string_view many);

/// Writes results to stdout, `visible`: nothing that stands in a file commands the terminal.
void print(std::string_view text);

/// The same of a text whose colours are escapes of our own.
void print_coloured(std::string_view text);

/// Keeps the number of stdout taken where the caller has closed it, so that no file is opened in its place.
void keep_stdout();

/// Whether everything printed so far has reached stdout.
bool results_are_written();

/// Writes anything else to stderr, `visible`.
void note(std::string_view text);

/// Writes an error to stderr, "error:" in red where that is a terminal that wants colours (NO_COLOR).
void print_error(std::string_view text);

/// The word before it, for those who write the text themselves with `note`; takes no memory.
void print_error_mark();

/// A line on stderr that shows how far work of more than a second has come; nothing where stderr is no
/// terminal.
class Progress {
 public:
  explicit Progress(std::string what) : what_(std::move(what)) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void show(double fraction);

 private:
  std::string what_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = begin_;
  bool shown_ = false;
};

/// A quantity given as an option, in `unit`. Throws ReadError that names the option.
double quantity_option(const std::string& option, const std::string& text, std::string_view unit);

}  // namespace oblique::cli
