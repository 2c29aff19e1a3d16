// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/table_file.h>

namespace oblique::solve {

/// A table of numbers over time; the first column is `t` [s].
class Trajectory {
 public:
  using Column = text::TableColumn;

  Trajectory() = default;
  explicit Trajectory(std::vector<Column> columns) : columns_(std::move(columns)) {}

  const std::vector<Column>& columns() const { return columns_; }
  std::size_t rows() const { return columns_.empty() ? 0 : values_.size() / columns_.size(); }
  /// All of them, row by row.
  std::span<const double> values() const { return values_; }
  double at(std::size_t row, std::size_t column) const { return values_[row * columns_.size() + column]; }
  std::span<const double> row(std::size_t r) const {
    return std::span(values_).subspan(r * columns_.size(), columns_.size());
  }
  std::optional<std::size_t> find(std::string_view column) const;

  /// Adds a row, one value a column.
  void add_row(std::span<const double> row) { values_.insert(values_.end(), row.begin(), row.end()); }

 private:
  std::vector<Column> columns_;
  std::vector<double> values_;
};

}  // namespace oblique::solve
