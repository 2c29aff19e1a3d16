// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace oblique::report {

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

/// "0.0125", "1.2e-07": six significant digits; empty for what is not a number. A value that is rounding
/// beside `scale`, the size of its neighbours, is shown as 0.
std::string short_number(double value, double scale = 0);

/// "1 block", "3 blocks".
std::string count(std::size_t n, std::string_view one, std::string_view many);

}  // namespace oblique::report
