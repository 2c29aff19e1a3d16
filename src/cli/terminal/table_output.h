// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <oblique/text/table_file.h>

namespace oblique::cli {

/// Checks what -o and --columns say, each empty where it is not given, before the work is done. Throws
/// ReadError.
void check_table_output(const std::string& file, const std::vector<std::string>& columns);

/// Which columns of a table are written, and in which order: what --columns says.
class ColumnChoice {
 public:
  /// Those of `all` with these `names`; all of them where none is named. Throws ReadError for a name that is
  /// not among them.
  ColumnChoice(std::vector<text::TableColumn> all, const std::vector<std::string>& names);

  const std::vector<text::TableColumn>& columns() const { return columns_; }
  /// Where they stand in a row of the whole table; empty: all of them, as they stand there.
  const std::vector<std::size_t>& indices() const { return indices_; }
  /// Columns of the whole table.
  std::size_t width() const { return width_; }

 private:
  std::vector<text::TableColumn> columns_;
  std::vector<std::size_t> indices_;
  std::size_t width_;
};

/// The table that -o asks for, row by row.
class TableOutput {
 public:
  /// Throws as TableFile does. The choice must outlive the table.
  TableOutput(const std::filesystem::path& path, const ColumnChoice& choice, std::size_t rows);
  /// Appends rows with all columns, chosen or not, one after the other.
  void add(std::span<const double> rows);
  /// Completes the file and says so on stderr.
  void finish();

 private:
  std::filesystem::path path_;
  const ColumnChoice& choice_;
  text::TableFile file_;
  std::vector<double> row_;
};

}  // namespace oblique::cli
