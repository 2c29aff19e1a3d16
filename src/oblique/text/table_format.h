// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/new_file.h>
#include <oblique/text/table_file.h>

namespace oblique::text {

/// How the rows of a table become the bytes of a file; what stands before the rows is written when it is
/// made. Not installed.
class TableFormat {
 public:
  virtual ~TableFormat() = default;
  /// Whole rows, one after the other.
  virtual void add(std::span<const double> rows) = 0;
  /// What stands behind the last row.
  virtual void finish() = 0;
};

/// Makes a format; the columns and the file must outlive it.
using MakeTableFormat = std::unique_ptr<TableFormat>(NewFile& file, const std::vector<TableColumn>& columns,
                                                     std::size_t rows);

/// Numbers as they stand in memory and in the binary formats, least significant byte first.
std::string_view bytes_of(std::span<const double> numbers);

/// `name` or, where that is taken, the first free one of name_1, name_2 …, shortened to `most` characters
/// with its number; it is taken then.
std::string take_name(const std::string& name, std::set<std::string>& taken, std::size_t most);

}  // namespace oblique::text
