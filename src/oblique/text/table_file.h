// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace oblique::text {

/// A column of a table of numbers.
struct TableColumn {
  std::string name;
  std::string unit{};                 ///< empty: none
  std::vector<std::string> labels{};  ///< words for the values 0, 1, 2 …; formats of text write the word
};

/// What the names of the files end with that a TableFile can write.
inline constexpr std::array<std::string_view, 4> kTableEndings{".csv", ".npy", ".mat", ".json"};

class TableFormat;
class NewFile;

/// Writes a table of numbers row by row, without ever holding it whole; the ending of the file's name decides
/// how:
///
///   .csv   a line of names, a line a row; no value is an empty cell
///   .npy   NumPy: one record a row, with a field of 8 bytes a column that has the column's name
///   .mat   MATLAB, level 4: one column vector a column, named as matlab.lang.makeValidName would name it
///          ("P5.x" is P5_x); equal names get _1, _2 …
///   .json  {"columns": [{"name": …, "unit": …}, …], "rows": [[…], …]}; what is no finite number is null
///
/// Numbers read back to the same bits. The file takes its name in `finish`; where that is never called, or
/// where anything throws, nothing is left behind and an older file of that name stands. A pipe or a device is
/// written to, except in .mat: there the columns stand one after the other, so each block of rows goes to as
/// many places of the file.
///
///   TableFile file("side.npy", {{"t", "s"}, {"side", "m"}}, times.size());
///   for (double t : times) file.add(std::array{t, side(t)});
///   file.finish();
class TableFile {
 public:
  /// A table of `rows` rows; their number stands before them in two of the formats. At least one column.
  /// Throws ReadError where the ending is none of `kTableEndings`, and where the file cannot be written, as
  /// all functions do.
  TableFile(const std::filesystem::path& path, std::vector<TableColumn> columns, std::size_t rows);
  ~TableFile();
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;

  const std::vector<TableColumn>& columns() const { return columns_; }

  /// Appends one row or several, one after the other: `columns().size()` values each, NaN where there is no
  /// value. Throws std::logic_error where that is no whole number of rows, or more than were announced.
  void add(std::span<const double> rows);

  /// Completes the file. Throws std::logic_error where fewer rows were added than were announced.
  void finish();

 private:
  std::vector<TableColumn> columns_;
  std::size_t values_left_;  ///< to be added
  std::unique_ptr<NewFile> file_;
  std::unique_ptr<TableFormat> format_;
};

}  // namespace oblique::text
