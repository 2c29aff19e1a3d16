// SPDX-License-Identifier: MIT
#include <oblique/report/study/study_chart.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

constexpr double kHeight = 220;  // [px]

std::vector<double> values_of(const StudyResult& result, std::size_t measure) {
  std::vector<double> values;
  for (std::size_t row = 0; row < result.done.rows.size(); ++row) {
    const double value = result.measure(row, measure);
    if (std::isfinite(value)) values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

/// How many machines have which value, in as many intervals as Freedman and Diaconis would take (1981), with
/// guides at some percentiles.
draw::Panel histogram(const StudyResult& result, std::size_t measure) {
  constexpr double kMostIntervals = 60, kLeastIntervals = 8;
  const text::TableColumn& column = result.columns[result.n_varied + measure];
  draw::Panel panel{{column.name, column.unit}, {"machines"}, {}, kHeight};
  const std::vector<double> values = values_of(result, measure);
  if (values.empty()) return panel;
  const double low = values.front(), high = values.back();
  const double spread = percentile_of(values, 75) - percentile_of(values, 25);
  const double width = 2 * spread / std::cbrt(static_cast<double>(values.size()));
  const double n = high > low && width > 0
                       ? std::clamp(std::ceil((high - low) / width), kLeastIntervals, kMostIntervals)
                       : kLeastIntervals;
  std::vector<double> counts(static_cast<std::size_t>(n), 0);
  for (const double value : values) {
    const double place = high > low ? (value - low) / (high - low) * n : 0;
    counts[static_cast<std::size_t>(std::min(place, n - 1))] += 1;
  }
  draw::Curve steps{"", {}, 0, draw::Curve::Style::area};
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double step = (high - low) / n, left = low + step * static_cast<double>(k);
    if (k == 0) steps.points.emplace_back(left, 0);
    steps.points.emplace_back(left, counts[k]);
    steps.points.emplace_back(left + step, counts[k]);
    if (k + 1 == counts.size()) steps.points.emplace_back(left + step, 0);
  }
  const double most = *std::max_element(counts.begin(), counts.end());
  panel.curves.push_back(std::move(steps));
  std::size_t number = 1;
  for (const double percent : {5.0, 50.0, 95.0}) {
    const double at = percentile_of(values, percent);
    panel.curves.push_back({fmt::format("{:.0f} %: {:.4g}", percent, at),
                            {{at, 0}, {at, most}},
                            number++,
                            draw::Curve::Style::guide});
  }
  return panel;
}

/// A measure over the one varied name.
draw::Panel curve(const StudyResult& result, std::size_t measure) {
  const text::TableColumn &x = result.columns[0], &y = result.columns[1 + measure];
  draw::Panel panel{{x.name, x.unit, result.logarithmic[0]}, {y.name, y.unit}, {}, kHeight};
  std::map<double, std::vector<double>> at;
  for (std::size_t row = 0; row < result.done.rows.size(); ++row) {
    const double value = result.measure(row, measure);
    std::vector<double>& values = at[result.done.rows[row].values[0]];
    if (!std::isnan(value)) values.push_back(value);
  }
  constexpr double kLow = 5, kHigh = 95;
  constexpr std::size_t kFew = 60;  // values that get a dot each
  const bool repeats =
      result.grid && result.drawn > 0 &&
      std::any_of(at.begin(), at.end(), [](const auto& one) { return one.second.size() > 1; });
  draw::Curve middle{repeats ? "median" : "", {}, 0};
  if (at.size() <= kFew) middle.style = draw::Curve::Style::dotted_line;
  if (!result.grid && result.drawn > 0) middle.style = draw::Curve::Style::marks;
  draw::Curve band{"5 % … 95 %", {}, 0, draw::Curve::Style::band};
  bool positive = true;
  double least = INFINITY, greatest = 0;
  for (auto& [value, values] : at) {
    std::sort(values.begin(), values.end());
    const double none = std::nan("");
    middle.points.emplace_back(value, values.empty() ? none : percentile_of(values, 50));
    if (values.empty()) continue;
    band.points.emplace_back(value, percentile_of(values, kLow));
    band.other_edge.emplace_back(value, percentile_of(values, kHigh));
    positive = positive && values.front() > 0;
    least = std::min(least, values.front());
    greatest = std::max(greatest, values.back());
  }
  constexpr double kDecades = 100;  // more between the values: a logarithmic axis
  panel.y.logarithmic = positive && greatest > kDecades * least;
  if (repeats) panel.curves.push_back(std::move(band));
  panel.curves.push_back(std::move(middle));
  return panel;
}

}  // namespace

draw::Chart chart_of(const StudyResult& result) {
  draw::Chart chart;
  chart.title = result.title;
  for (std::size_t k = 0; k < result.n_measures(); ++k) {
    chart.panels.push_back(result.n_varied == 1 ? curve(result, k) : histogram(result, k));
  }
  const auto failed = static_cast<std::size_t>(result.done.count.failed);
  if (failed > 0) {
    chart.note = fmt::format("{} of {} failed and is not drawn.", failed,
                             count(result.done.rows.size(), "machine", "machines"));
  }
  return chart;
}

}  // namespace oblique::report
