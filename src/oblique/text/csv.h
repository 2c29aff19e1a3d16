// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/diagnostic.h>

namespace oblique {

/// A table of numbers under a line of names.
struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  ///< one for each name

  /// A column, or nothing.
  const std::vector<double>* find(std::string_view name) const;
};

/// Reads comma-separated numbers (RFC 4180 without line breaks inside quotes); empty lines and lines that
/// begin with
/// '#' are skipped. Throws ReadError with the line of what is no number.
CsvTable parse_csv(std::string_view text, const std::string& file);

}  // namespace oblique
