// SPDX-License-Identifier: MIT
#include <oblique/report/study/study_text.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

std::string with_unit(const text::TableColumn& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

/// The rows that have a value of a measure, the least value first.
std::vector<std::size_t> order_of(const StudyResult& result, std::size_t measure) {
  std::vector<std::size_t> order;
  for (std::size_t row = 0; row < result.done.rows.size(); ++row) {
    if (!std::isnan(result.measure(row, measure))) order.push_back(row);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return result.measure(a, measure) < result.measure(b, measure);
  });
  return order;
}

}  // namespace

std::string machine_text(const StudyResult& result, std::size_t row) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < result.n_varied; ++k) {
    const text::TableColumn& column = result.columns[k];
    const bool told = !column.unit.empty() && column.unit != "machine unit";
    parts.push_back(fmt::format("{} = {:.6g}{}{}", column.name, result.done.rows[row].values[k],
                                told ? " " : "", told ? column.unit : ""));
  }
  if (result.drawn > 0) parts.push_back(fmt::format("machine {}", result.done.rows[row].number));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string rows_text(const StudyResult& result, std::size_t columns_shown) {
  constexpr std::size_t kShown = 10;  // at the beginning, and at the end
  const std::size_t all = result.done.rows.size(), width = result.columns.size();
  const std::size_t shown = std::min(width, columns_shown);
  std::vector<std::string> header;
  for (std::size_t c = 0; c < shown; ++c) header.push_back(with_unit(result.columns[c]));
  Table table(header);
  for (std::size_t row = 0; row < all; ++row) {
    if (all > 2 * kShown && row == kShown) {
      table.add(std::vector<std::string>(shown, "…"));
      row = all - kShown;
    }
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < shown; ++c) cells.push_back(short_number(result.done.rows[row].values[c]));
    table.add(std::move(cells));
  }
  std::string text = table.text();
  if (all > 2 * kShown || shown < width) {
    text += fmt::format("(of {}; -o FILE.csv writes all of them", count(all, "machine", "machines"));
    text += shown < width ? fmt::format(", and {})\n", count(width - shown, "more column", "more columns"))
                          : ")\n";
  }
  return text;
}

std::string summary_text(const StudyResult& result) {
  Table table({"", "least", "median", "greatest", "least at", "greatest at"});
  std::string missing;
  for (std::size_t k = 0; k < result.n_measures(); ++k) {
    const std::vector<std::size_t> order = order_of(result, k);
    const text::TableColumn& column = result.columns[result.n_varied + k];
    if (order.empty()) {
      table.add({with_unit(column), "", "", "", "", ""});
      continue;
    }
    const auto value = [&](std::size_t row) { return fmt::format("{:.6g}", result.measure(row, k)); };
    table.add({with_unit(column), value(order.front()), value(order[(order.size() - 1) / 2]),
               value(order.back()), machine_text(result, order.front()), machine_text(result, order.back())});
    const auto failed = static_cast<std::size_t>(result.done.count.failed);
    if (order.size() + failed < result.done.rows.size()) {
      missing += fmt::format("{} has no value in {} of {}\n", column.name,
                             result.done.rows.size() - failed - order.size(),
                             count(result.done.rows.size(), "machine", "machines"));
    }
  }
  return table.text(1) + missing;
}

std::string order_text(const StudyResult& result) {
  if (!result.grid || result.drawn > 0) return {};
  constexpr double kNone = 0.02;  // no order is told of what hardly changes
  std::string text;
  for (std::size_t name = 0; name < result.n_varied; ++name) {
    if (!result.logarithmic[name]) continue;
    // rows that differ in this name alone stand side by side
    std::vector<std::size_t> rows(result.done.rows.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    const auto values = [&](std::size_t row) -> const std::vector<double>& {
      return result.done.rows[row].values;
    };
    // the first name in whose value two rows differ, this one last; n_varied where there is none.
    const auto difference = [&](std::size_t a, std::size_t b) {
      for (std::size_t other = 0; other < result.n_varied; ++other)
        if (other != name && values(a)[other] != values(b)[other]) return other;
      return values(a)[name] != values(b)[name] ? name : result.n_varied;
    };
    std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
      const std::size_t other = difference(a, b);
      return other < result.n_varied && values(a)[other] < values(b)[other];
    });
    for (std::size_t k = 0; k < result.n_measures(); ++k) {
      std::vector<double> orders;
      bool has_orders = true;
      for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
        if (difference(rows[i], rows[i + 1]) != name) continue;
        const double step = std::log(values(rows[i + 1])[name] / values(rows[i])[name]);
        if (!(step > 0)) continue;
        const double ratio = result.measure(rows[i + 1], k) / result.measure(rows[i], k);
        has_orders = has_orders && ratio > 0 && std::isfinite(ratio);
        orders.push_back(std::log(ratio) / step);
      }
      if (!has_orders || orders.size() < 2) continue;
      std::sort(orders.begin(), orders.end());
      if (std::max(std::abs(orders.front()), std::abs(orders.back())) < kNone) continue;
      text += fmt::format("{} goes as {}^{:.2f}, from {:.2f} to {:.2f} between neighbours\n",
                          result.columns[result.n_varied + k].name, result.columns[name].name,
                          percentile_of(orders, 50), orders.front(), orders.back());
    }
  }
  return text;
}

std::string count_text(const StudyResult& result) {
  const ensemble::EnsembleCount& count_of = result.done.count;
  std::vector<std::string> reasons;
  for (const auto& [reason, machines] : count_of.reasons)
    reasons.push_back(count_of.reasons.size() == 1 ? reason : fmt::format("{}: {}", reason, machines));
  std::string text = count(result.done.rows.size(), "machine", "machines");
  if (count_of.by_cvodes == 0) {
    text += ", all in lanes\n";
  } else if (count_of.in_lanes == 0) {
    text += fmt::format(", all by CVODES ({})\n", fmt::join(reasons, "; "));
  } else {
    text += fmt::format(": {} in lanes, {} by CVODES ({})\n", count_of.in_lanes, count_of.by_cvodes,
                        fmt::join(reasons, "; "));
  }
  const auto row_of = [&](std::uint64_t number) {
    const auto found = std::find_if(result.done.rows.begin(), result.done.rows.end(),
                                    [&](const ensemble::StudyRow& row) { return row.number == number; });
    return static_cast<std::size_t>(found - result.done.rows.begin());
  };
  if (count_of.first_warned) {
    text += fmt::format("warning of {} of {}; the first, {}: {}\n", count_of.warned,
                        count(result.done.rows.size(), "machine", "machines"),
                        machine_text(result, row_of(count_of.first_warned->first)),
                        count_of.first_warned->second);
  }
  text += coarse_text(count_of);
  if (count_of.failed == 0) return text;
  const auto first = std::find_if(result.done.rows.begin(), result.done.rows.end(),
                                  [](const ensemble::StudyRow& row) { return !row.failure.empty(); });
  const auto row = static_cast<std::size_t>(first - result.done.rows.begin());
  const std::string which = machine_text(result, row);
  return text + fmt::format("FAILED {} of {}, without values; the first, {}: {}\n", count_of.failed,
                            count(result.done.rows.size(), "machine", "machines"), which, first->failure);
}

std::string coarse_text(const ensemble::EnsembleCount& count_of) {
  if (count_of.coarse == 0) return {};
  return fmt::format(
      "note: in {} the rows are few for what is measured: between them a signal bends, and a measure may err "
      "by {:.2g} % "
      "of the largest value; more rows mend it\n",
      count(count_of.coarse, "machine", "machines"), 100 * count_of.doubt);
}

double percentile_of(const std::vector<double>& ascending, double percent) {
  const double rank = std::ceil(percent / 100 * static_cast<double>(ascending.size()));
  return ascending[static_cast<std::size_t>(
      std::clamp(rank - 1, 0.0, static_cast<double>(ascending.size()) - 1))];
}

}  // namespace oblique::report
