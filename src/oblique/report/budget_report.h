// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <oblique/compare/budget.h>

namespace oblique::report {

/// Whose tolerances the errors come from, for people and with its words.
struct BudgetReport {
  compare::ErrorBudget budget;
  std::string unit;         ///< of lengths
  bool turning = true;      ///< the first drive turns a link
  std::string scatter;      ///< "within ±0.1%", "as those of EMU-10 scatter"
  bool of_outputs = false;  ///< of a diagram: errors are parts of the largest value of an output
};

std::string to_text(const BudgetReport& report);

/// The same for `--json` (docs/trust.md).
nlohmann::ordered_json to_json(const BudgetReport& report);

}  // namespace oblique::report
