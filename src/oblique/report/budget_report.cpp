// SPDX-License-Identifier: MIT
#include <oblique/report/budget_report.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

constexpr std::size_t kMostShares = 20;

/// The largest shares, with the heads of two columns.
std::string shares_text(const compare::ErrorBudget& budget, const std::string& changes,
                        const std::string& anywhere) {
  Table table({"tolerance of", "±", changes, "share", anywhere});
  const std::size_t shown = std::min(kMostShares, budget.entries.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const compare::BudgetEntry& entry = budget.entries[k];
    table.add({entry.element, fmt::format("{:.3g}", entry.half_width), fmt::format("{:.3e}", entry.error),
               fmt::format("{:.1f} %", 100 * entry.share), fmt::format("{:.3e}", entry.largest)});
  }
  std::string text = table.text(1);
  if (shown == budget.entries.size()) return text;
  double rest = 0;
  for (std::size_t k = shown; k < budget.entries.size(); ++k) rest += budget.entries[k].share;
  return text + fmt::format("({} others together {:.1f} %)\n", budget.entries.size() - shown, 100 * rest);
}

std::string outputs_text(const BudgetReport& report) {
  const compare::ErrorBudget& budget = report.budget;
  return fmt::format(
             "\nError budget: {}, uniform {}; together they change output {} by {:.3e} of its largest value "
             "(root of the mean square), where that is largest, at t = {:.4g} s\n\n",
             count(budget.entries.size(), "tolerance", "tolerances"), report.scatter, budget.point,
             budget.error, budget.drive) +
         shares_text(budget, "changes it by", "at most, anywhere");
}

}  // namespace

std::string to_text(const BudgetReport& report) {
  const compare::ErrorBudget& budget = report.budget;
  if (budget.entries.empty()) return "\nError budget: none of the elements scatters\n";
  if (report.of_outputs) return outputs_text(report);
  const std::string at = report.turning ? fmt::format("{:.4g}°", budget.drive * 180 / std::numbers::pi)
                                        : fmt::format("{:.4g} {}", budget.drive, report.unit);
  std::string text = fmt::format(
      "\nError budget: {}, uniform {}; together they displace point {} by {:.3e} {} (root of the mean "
      "square), "
      "where that is largest, with the drive at {}\n\n",
      count(budget.entries.size(), "tolerance", "tolerances"), report.scatter, budget.point, budget.error,
      report.unit, at);
  return text + shares_text(budget, fmt::format("displaces it by [{}]", report.unit),
                            fmt::format("at most, anywhere [{}]", report.unit));
}

nlohmann::ordered_json to_json(const BudgetReport& report) {
  const compare::ErrorBudget& budget = report.budget;
  nlohmann::ordered_json json{{"error", budget.error},
                              {"point", budget.point},
                              {"drive", budget.drive},
                              {"along", budget.along},
                              {"elements", nlohmann::ordered_json::array()}};
  for (const compare::BudgetEntry& entry : budget.entries) {
    json["elements"].push_back({{"element", entry.element},
                                {"half_width", entry.half_width},
                                {"error", entry.error},
                                {"share", entry.share},
                                {"largest", entry.largest}});
  }
  return json;
}

}  // namespace oblique::report
