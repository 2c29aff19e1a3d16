// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/report/mechanism_check.h>
#include <oblique/report/text_table.h>

namespace oblique::report {

/// A table of what was found.
struct CheckTable {
  std::string title;
  Table table;
  std::size_t left_columns = 0;  ///< the first columns, which hold words
  std::string explanation;       ///< of its numbers, a sentence
};
std::vector<CheckTable> tables_of(const MechanismCheck& check);

}  // namespace oblique::report
