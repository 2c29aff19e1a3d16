// SPDX-License-Identifier: MIT
#include <oblique/report/comparison_chart.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include <oblique/draw/picture/scale.h>

namespace oblique::report {
namespace {

constexpr double kBelowFloor = 0.1;
constexpr double kHeight = 220, kLowHeight = 160;  // [px]

/// "triangles", "20 Hz", "triangles, 20 Hz": what tells a series from the others; nothing of a single one.
std::string name_of(const compare::Comparison& comparison, const compare::GainSeries& series) {
  const auto differs = [&](const auto& what) {
    return std::any_of(comparison.series.begin(), comparison.series.end(), what);
  };
  std::string name;
  if (differs([&](const compare::GainSeries& other) { return other.method != series.method; }))
    name = patch::method_name(series.method);
  if (differs([&](const compare::GainSeries& other) { return other.bandwidth != series.bandwidth; }))
    name += fmt::format("{}{:.6g} Hz", name.empty() ? "" : ", ", series.bandwidth);
  return name;
}

/// "−0.998".
std::string signed_text(double value) {
  const std::string size = fmt::format("{:.3f}", std::abs(value));
  return (value < 0 && size != "0.000" ? "−" : "") + size;
}

/// "250", "10⁶".
std::string gain_text(double gain) {
  const double exponent = std::round(std::log10(gain));
  return exponent >= 3 && std::abs(gain / std::pow(10, exponent) - 1) < 1e-12
             ? draw::power_of_ten(static_cast<int>(exponent))
             : fmt::format("{:.6g}", gain);
}

/// Whether the analog mechanism errs by no more than rounding in all of these runs. A logarithmic axis would
/// magnify that; on a linear one it is the constant 0.
bool is_exact(const compare::Comparison& comparison, std::span<const compare::ComparedRun> runs) {
  constexpr double kRounding = 1e-14;  // of the largest link: some units in the last place of coordinates
  return std::all_of(runs.begin(), runs.end(), [&](const compare::ComparedRun& run) {
    return run.max_error <= kRounding * comparison.size;
  });
}

/// The line of the fitted order, through the middle of the runs that it was fitted to, in their colour.
draw::Curve slope_of(const draw::Curve& errors, const compare::GainSeries& series) {
  draw::Curve slope{
      fmt::format("slope {}", signed_text(*series.order)), {}, errors.number, draw::Curve::Style::guide};
  double n = 0, x = 0, y = 0;
  for (const Eigen::Vector2d& point : errors.points) {
    if (!compare::stands_clear(point.y(), series.floor.value_or(0))) continue;
    n += 1;
    x += std::log10(point.x());
    y += std::log10(point.y());
  }
  for (const Eigen::Vector2d& point : errors.points) {
    const double exponent = y / n + *series.order * (std::log10(point.x()) - x / n);
    const double error = std::pow(10, exponent);
    if (error >= series.floor.value_or(0)) slope.points.emplace_back(point.x(), error);
  }
  return slope;
}

draw::Panel convergence_of(const compare::Comparison& comparison) {
  const bool exact = is_exact(comparison, comparison.runs);
  draw::Panel panel{{"gain", "", true}, {"largest error", comparison.unit, !exact}, {}, kHeight};
  for (std::size_t s = 0; s < comparison.series.size(); ++s) {
    const compare::GainSeries& series = comparison.series[s];
    const std::string name = name_of(comparison, series);
    draw::Curve errors{name.empty() ? "measured" : name, {}, s, draw::Curve::Style::dotted_line};
    for (const compare::ComparedRun& run : comparison.runs_of(comparison.series[s]))
      errors.points.emplace_back(run.gain, exact ? 0 : run.max_error);
    std::sort(errors.points.begin(), errors.points.end(),
              [](const auto& a, const auto& b) { return a.x() < b.x(); });
    panel.curves.push_back(std::move(errors));
    if (series.order && !exact) panel.curves.push_back(slope_of(panel.curves.back(), series));
  }
  return panel;
}

/// The axis of the drive, and what one of its units is in those of the numbers.
std::pair<draw::Axis, double> drive_axis(const compare::Comparison& comparison) {
  if (comparison.turning) return {{"drive", "°"}, std::numbers::pi / 180};
  return {{"drive", comparison.unit}, 1};
}

/// The errors of a method and bandwidth along the way, a curve for each gain.
draw::Panel error_along(const compare::Comparison& comparison, std::size_t s) {
  const auto [drive, unit] = drive_axis(comparison);
  const compare::GainSeries& series = comparison.series[s];
  const std::span<const compare::ComparedRun> runs = comparison.runs_of(comparison.series[s]);
  const std::string name = name_of(comparison, series);
  const bool exact = is_exact(comparison, runs);
  draw::Panel panel{drive,
                    {name.empty() ? "error" : "error, " + name, comparison.unit, runs.size() > 1 && !exact},
                    {},
                    comparison.series.size() > 1 ? kLowHeight : kHeight};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const compare::ComparedRun& run = runs[k];
    draw::Curve curve{fmt::format("gain {}", gain_text(run.gain)), {}, k};
    for (std::size_t row = 0; row < run.error_along.size(); ++row) {
      // what is far below that which the tolerance leaves tells nothing, and would stretch the axis
      const bool tells = run.error_along[row] > kBelowFloor * series.floor.value_or(0);
      const double error = tells ? run.error_along[row] : std::numeric_limits<double>::quiet_NaN();
      curve.points.emplace_back(comparison.drive[row] / unit, exact ? 0 : error);
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

/// Whether `error_along` leaves points of a series out.
bool leaves_out(const compare::Comparison& comparison, std::size_t s) {
  const double least = kBelowFloor * comparison.series[s].floor.value_or(0);
  const std::span<const compare::ComparedRun> runs = comparison.runs_of(comparison.series[s]);
  return std::any_of(runs.begin(), runs.end(), [&](const compare::ComparedRun& run) {
    return std::any_of(run.error_along.begin(), run.error_along.end(),
                       [&](double error) { return error <= least; });
  });
}

/// What the panels do not show as it was measured.
std::string note_of(const compare::Comparison& comparison) {
  bool exact = false, left_out = false;
  for (std::size_t s = 0; s < comparison.series.size(); ++s) {
    const bool is_zero = is_exact(comparison, comparison.runs_of(comparison.series[s]));
    exact = exact || is_zero;
    left_out = left_out || (!is_zero && leaves_out(comparison, s));
  }
  std::string note = exact ? "Errors along the way that are no more than rounding are drawn as 0." : "";
  if (!left_out) return note;
  if (exact) note += " ";
  return note +
         "Errors along the way that are less than a tenth of what the solver's tolerance leaves are not "
         "drawn: they tell nothing of the machine.";
}

draw::Panel bands_of(const compare::Comparison& comparison, const MonteCarloReport& report) {
  const auto [drive, unit] = drive_axis(comparison);
  draw::Panel panel{drive, {"error with elements drawn", report.unit}, {}, kLowHeight};
  const auto percentile = [&, unit = unit](double percent) {
    std::vector<Eigen::Vector2d> points;
    const std::vector<double> errors = report.result.percentile_along(percent);
    for (std::size_t row = 0; row < errors.size(); ++row)
      points.emplace_back(report.result.drive[row] / unit, errors[row]);
    return points;
  };
  constexpr std::size_t kWide = 4, kNarrow = 0;  // sky under blue
  const bool several = report.result.errors.size() > 1;
  if (several) {
    panel.curves.push_back(
        {"95 % of the runs", percentile(97.5), kWide, draw::Curve::Style::band, percentile(2.5)});
    panel.curves.push_back(
        {"half of them", percentile(75), kNarrow, draw::Curve::Style::band, percentile(25)});
  }
  panel.curves.push_back({several ? "median" : "the run", percentile(50), draw::Curve::kPlain});
  return panel;
}

draw::Panel histogram_of(const MonteCarloReport& report) {
  std::vector<double> errors;
  for (const std::optional<double>& error : report.result.errors) {
    if (error) errors.push_back(*error);
  }
  draw::Panel panel{{"largest error of a run", report.unit}, {"runs"}, {}, kLowHeight};
  const auto [least, greatest] = std::minmax_element(errors.begin(), errors.end());
  const double low = *least, span = *greatest > low ? *greatest - low : low > 0 ? low : 1;
  // as many classes as make the shape stand out of the noise of counting (Rice's rule)
  const auto classes = static_cast<std::size_t>(std::ceil(2 * std::cbrt(static_cast<double>(errors.size()))));
  std::vector<double> counts(classes, 0);
  for (const double error : errors) {
    const auto place = static_cast<std::size_t>((error - low) / span * static_cast<double>(classes));
    counts[std::min(place, classes - 1)] += 1;
  }
  draw::Curve histogram{fmt::format("{} runs", errors.size()), {}, 0, draw::Curve::Style::area};
  histogram.points.emplace_back(low, 0);
  for (std::size_t k = 0; k < classes; ++k) {
    const double width = span / static_cast<double>(classes);
    histogram.points.emplace_back(low + static_cast<double>(k) * width, counts[k]);
    histogram.points.emplace_back(low + static_cast<double>(k + 1) * width, counts[k]);
  }
  histogram.points.emplace_back(low + span, 0);
  const double most = *std::max_element(counts.begin(), counts.end());
  panel.curves.push_back(std::move(histogram));
  for (const double percent : {50, 95}) {
    const double error = *report.result.percentile(percent);
    draw::Curve line{fmt::format("{:.0f} % up to {:.3g} {}", percent, error, report.unit),
                     {},
                     panel.curves.size(),
                     draw::Curve::Style::guide};
    line.points = {{error, 0}, {error, most}};
    panel.curves.push_back(std::move(line));
  }
  return panel;
}

}  // namespace

draw::Chart chart_of(const compare::Comparison& comparison) {
  draw::Chart chart;
  chart.title = comparison.mechanism + ": patched against exact";
  const bool several = std::any_of(comparison.series.begin(), comparison.series.end(),
                                   [](const compare::GainSeries& series) { return series.n > 1; });
  if (several) chart.panels.push_back(convergence_of(comparison));
  for (std::size_t s = 0; s < comparison.series.size(); ++s)
    chart.panels.push_back(error_along(comparison, s));
  chart.note = note_of(comparison);
  return chart;
}

draw::Chart parts_chart(const compare::Comparison& comparison) {
  const compare::GainSeries& series = comparison.series.front();
  std::vector<compare::ComparedRun> runs(comparison.runs_of(series).begin(),
                                         comparison.runs_of(series).end());
  std::sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.gain < b.gain; });
  const bool exact = is_exact(comparison, runs);
  constexpr double kTall = 300;
  draw::Panel panel{{"gain", "", true}, {"error", comparison.unit, !exact}, {}, kTall};
  using Style = draw::Curve::Style;
  draw::Curve whole{"largest error", {}, 0, Style::dotted_line},
      off{"on another branch", {}, 5, Style::marks};
  draw::Curve at_rest{"static", {}, 1, Style::dotted_line}, lag{"lag", {}, 2, Style::dotted_line},
      solver{"solver", {}, 3, Style::dotted_line};
  const double least = kBelowFloor * series.floor.value_or(0);
  const auto add = [&](draw::Curve& curve, double gain, double part) {
    if (exact || std::abs(part) > least) curve.points.emplace_back(gain, std::abs(part));
  };
  double n = 0, x = 0, y = 0;
  for (const compare::ComparedRun& run : runs) {
    add(run.left_branch ? off : whole, run.gain, exact ? 0 : run.max_error);
    if (run.left_branch || exact) continue;
    if (run.parts) {
      add(at_rest, run.gain, run.parts->at_rest);
      add(lag, run.gain, run.parts->lag);
      add(solver, run.gain, run.parts->solver);
    }
    if (!compare::stands_clear(run.max_error, series.floor.value_or(0))) continue;
    n += 1;
    x += std::log10(run.gain);
    y += std::log10(run.max_error);
  }
  if (!runs.empty()) {
    const double from = runs.front().gain / 3, to = runs.back().gain * 3;
    if (n > 0) {
      draw::Curve order{"order −1", {}, draw::Curve::kPlain, Style::guide};
      for (const double gain : {from, to})
        order.points.emplace_back(gain, std::pow(10, y / n - (std::log10(gain) - x / n)));
      panel.curves.push_back(std::move(order));
    }
    if (series.floor && *series.floor > 0 && !exact) {
      panel.curves.push_back(
          {"left by the tolerance", {{from, *series.floor}, {to, *series.floor}}, 4, Style::guide});
    }
  }
  for (draw::Curve* curve : {&at_rest, &lag, &solver, &off, &whole}) {
    if (!curve->points.empty()) panel.curves.push_back(std::move(*curve));
  }
  draw::Chart chart;
  chart.panels.push_back(std::move(panel));
  return chart;
}

std::vector<draw::Panel> panels_of(const compare::Comparison& comparison, const MonteCarloReport& report) {
  if (!report.result.worst_run) return {};  // all failed
  return {bands_of(comparison, report), histogram_of(report)};
}

}  // namespace oblique::report
