// SPDX-License-Identifier: MIT
#include <oblique/report/study/study_chart.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <oblique/draw/chart/effect_bars.h>
#include <oblique/draw/chart/heat_map.h>
#include <oblique/report/study/effects.h>
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

/// Whether values are above 0 and so far apart that a logarithmic axis shows them better.
bool wants_decades(const std::vector<double>& values) {
  constexpr double kApart = 100;
  double least = INFINITY, greatest = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  return least > 0 && greatest > kApart * least;
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
  std::vector<double> all;
  for (auto& [value, values] : at) {
    std::sort(values.begin(), values.end());
    const double none = std::nan("");
    middle.points.emplace_back(value, values.empty() ? none : percentile_of(values, 50));
    if (values.empty()) continue;
    band.points.emplace_back(value, percentile_of(values, kLow));
    band.other_edge.emplace_back(value, percentile_of(values, kHigh));
    all.insert(all.end(), values.begin(), values.end());
  }
  panel.y.logarithmic = wants_decades(all);
  if (repeats) panel.curves.push_back(std::move(band));
  panel.curves.push_back(std::move(middle));
  return panel;
}

/// The values of a varied name, ascending.
std::vector<double> levels_of(const StudyResult& result, std::size_t name) {
  std::vector<double> levels;
  for (const ensemble::StudyRow& row : result.done.rows) levels.push_back(row.values[name]);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

/// Of machines of the same two values the median of a measure, of each second value all first ones; "not a
/// number" where there is none.
std::vector<double> medians(const StudyResult& result, std::size_t measure, const std::vector<double>& xs,
                            const std::vector<double>& ys) {
  std::vector<std::vector<double>> found(xs.size() * ys.size());
  for (std::size_t row = 0; row < result.done.rows.size(); ++row) {
    const std::vector<double>& values = result.done.rows[row].values;
    const auto i = std::lower_bound(xs.begin(), xs.end(), values[0]) - xs.begin();
    const auto j = std::lower_bound(ys.begin(), ys.end(), values[1]) - ys.begin();
    const double value = result.measure(row, measure);
    if (!std::isnan(value))
      found[static_cast<std::size_t>(j) * xs.size() + static_cast<std::size_t>(i)].push_back(value);
  }
  std::vector<double> middles;
  for (std::vector<double>& values : found) {
    std::sort(values.begin(), values.end());
    middles.push_back(values.empty() ? std::nan("") : percentile_of(values, 50));
  }
  return middles;
}

/// A measure over the first varied name, a curve for each value of the second one, or for some of them.
draw::Panel family(const StudyResult& result, std::size_t measure) {
  constexpr std::size_t kMost = 7;
  const text::TableColumn &x = result.columns[0], &along = result.columns[1],
                          &y = result.columns[2 + measure];
  draw::Panel panel{{x.name, x.unit, result.logarithmic[0]}, {y.name, y.unit}, {}, kHeight};
  const std::vector<double> xs = levels_of(result, 0), ys = levels_of(result, 1);
  const std::vector<double> values = medians(result, measure, xs, ys);
  panel.y.logarithmic = wants_decades(values);
  for (const std::size_t j : spread_rows(ys.size(), kMost)) {
    draw::Curve curve{
        fmt::format("{} = {:.4g}{}{}", along.name, ys[j], along.unit.empty() ? "" : " ", along.unit),
        {},
        panel.curves.size()};
    for (std::size_t i = 0; i < xs.size(); ++i) curve.points.emplace_back(xs[i], values[j * xs.size() + i]);
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

std::string note_of(const StudyResult& result) {
  const auto failed = static_cast<std::size_t>(result.done.count.failed);
  if (failed == 0) return {};
  return fmt::format("{} of {} failed and {} not drawn.", failed,
                     count(result.done.rows.size(), "machine", "machines"), failed == 1 ? "is" : "are");
}

draw::Picture maps_of(const StudyResult& result, const std::vector<double>& xs,
                      const std::vector<double>& ys) {
  std::vector<draw::HeatMap> maps;
  for (std::size_t k = 0; k < result.n_measures(); ++k) {
    const text::TableColumn &x = result.columns[0], &y = result.columns[1], &value = result.columns[2 + k];
    draw::HeatMap map{{x.name, x.unit, result.logarithmic[0]},
                      {y.name, y.unit, result.logarithmic[1]},
                      {value.name, value.unit},
                      xs,
                      ys,
                      medians(result, k, xs, ys)};
    map.value.logarithmic = wants_decades(map.values);
    maps.push_back(std::move(map));
  }
  return draw::draw_heat_maps(result.title, maps, note_of(result));
}

draw::Picture effects_picture(const StudyResult& result) {
  std::vector<draw::EffectBars> panels;
  for (std::size_t k = 0; k < result.n_measures(); ++k) {
    const text::TableColumn& column = result.columns[result.n_varied + k];
    draw::EffectBars panel;
    panel.axis = result.grid ? draw::Axis{"mean of " + column.name, column.unit}
                             : draw::Axis{"rank correlation with " + column.name};
    panel.middle = result.grid ? mean_of(result, k) : 0;
    for (const Effect& effect : effects_of(result, k)) {
      const auto label = [&](double at) { return result.grid ? fmt::format("{:.4g}", at) : std::string(); };
      panel.bars.push_back({result.columns[effect.name].name, effect.low, effect.high, label(effect.low_at),
                            label(effect.high_at)});
    }
    panels.push_back(std::move(panel));
  }
  return draw::draw_effect_bars(result.title, panels, note_of(result));
}

}  // namespace

draw::Picture picture_of(const StudyResult& result) {
  if (result.n_varied == 2 && result.grid) {
    const std::vector<double> xs = levels_of(result, 0), ys = levels_of(result, 1);
    if (xs.size() > 1 && ys.size() > 1) return maps_of(result, xs, ys);
  }
  return result.n_varied >= 2 ? effects_picture(result) : draw::draw_chart(chart_of(result));
}

draw::Chart chart_of(const StudyResult& result) {
  draw::Chart chart;
  chart.title = result.title;
  for (std::size_t k = 0; k < result.n_measures(); ++k) {
    chart.panels.push_back(result.n_varied == 1   ? curve(result, k)
                           : result.n_varied == 2 ? family(result, k)
                                                  : histogram(result, k));
  }
  chart.note = note_of(result);
  return chart;
}

}  // namespace oblique::report
