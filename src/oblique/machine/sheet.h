// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace oblique::machine {

/// A table for a machine room, of cells as they are read.
struct Sheet {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// The sheet as comma-separated values (RFC 4180), the columns' names first.
std::string to_csv(const Sheet& sheet);

}  // namespace oblique::machine
