// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/diagnostic.h>

namespace oblique::text {

/// The name of a column and, where it tells one, its unit: "t [ms]", "t (ms)", "t/ms" and "t in ms" are t in
/// ms. Of "u/V" V is the unit, of "a/b" (where b is none) nothing; in brackets any text is.
struct CsvHeading {
  std::string name;
  std::string unit;
};
CsvHeading split_heading(std::string_view text);

/// A table of numbers under a line of names.
struct CsvTable {
  std::vector<std::string> names;            ///< as they stand, with their units
  std::vector<std::vector<double>> columns;  ///< one for each name

  /// The number of the column of that name, with or without its unit; nothing where there is none, or more
  /// than one.
  std::optional<std::size_t> index_of(std::string_view name) const;
  /// That column, or nothing.
  const std::vector<double>* find(std::string_view name) const;
};

/// Reads numbers in columns as laboratories and spreadsheets write them: separated by tabs, semicolons,
/// commas or spaces, whichever the first line has; with decimal points, or with decimal commas where these
/// separate nothing. Empty lines and lines that begin with '#' are skipped. Where the first line is of
/// numbers the names are those of the last '#' line that has as many, or else "1", "2" …; a line of units
/// below the names is added to them. A byte order mark, and text in Latin-1, do not matter. Throws ReadError
/// with the place of what is no number.
CsvTable parse_csv(std::string_view text, const std::string& file);

}  // namespace oblique::text
