// SPDX-License-Identifier: MIT
#include <oblique/report/run_chart.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/text/diagnostic.h>

namespace oblique::report {
namespace {

std::size_t column_named(const std::vector<text::TableColumn>& columns, const char* setting,
                         const std::string& name) {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const text::TableColumn& c) { return c.name == name; });
  if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
  std::vector<std::string> known;
  known.reserve(columns.size());
  for (const text::TableColumn& column : columns) known.push_back(column.name);
  throw text::ReadError(text::Diagnostic{
      {{}, {}, {setting}}, fmt::format("there is no column '{}'", name), {}, text::suggest(name, known)});
}

draw::Axis axis_of(const text::TableColumn& column) {
  return {column.name, column.unit == "1" ? "" : column.unit};
}

/// A column of a run as it is drawn.
std::vector<double> drawn_values(const solve::Trajectory& trajectory, std::size_t column, double rounding) {
  std::vector<double> values;
  for (std::size_t row = 0; row < trajectory.rows(); ++row) values.push_back(trajectory.at(row, column));
  const bool is_zero =
      std::all_of(values.begin(), values.end(), [&](double value) { return std::abs(value) <= rounding; });
  if (is_zero) std::fill(values.begin(), values.end(), 0);
  return values;
}

/// A path is as wide as it is high on paper that is twice as wide as high: it gets more height.
constexpr double kPathHeight = 480;

}  // namespace

DrawnColumns drawn_columns(const std::vector<text::TableColumn>& columns, const RunChartRequest& request) {
  DrawnColumns chosen;
  if (!request.against.empty()) chosen.against = column_named(columns, "against", request.against);
  for (const std::string& name : request.columns) {
    const std::size_t column = column_named(columns, "columns", name);
    if (column != chosen.against && column != 0) chosen.drawn.push_back(column);
  }
  if (chosen.drawn.size() > draw::kMostCurves) {
    throw text::ReadError(text::Diagnostic{{{}, {}, {"columns"}},
                                           fmt::format("{} curves cannot be told apart", chosen.drawn.size()),
                                           fmt::format("at most {}", draw::kMostCurves),
                                           {}});
  }
  if (request.columns.empty()) {
    for (std::size_t c = 1; c < columns.size(); ++c) {
      if (c == chosen.against) continue;
      if (chosen.drawn.size() < draw::kMostCurves) {
        chosen.drawn.push_back(c);
      } else {
        ++chosen.left_out;
      }
    }
  }
  if (chosen.drawn.empty()) {
    throw text::ReadError(
        text::Diagnostic{{},
                         fmt::format("nothing is left to draw against '{}'", columns[chosen.against].name),
                         "other columns",
                         {}});
  }
  return chosen;
}

void ask_for_curves(solve::RunOptions& options, std::size_t n_columns) {
  constexpr std::size_t kMostRows = 20'000, kMostNumbers = 4'000'000;
  const std::size_t rows = std::min(kMostRows, kMostNumbers / n_columns);
  if (rows <= static_cast<std::size_t>(options.samples)) return;
  const double begin = options.from ? options.from->time : 0;
  for (std::size_t row = 0; row <= rows; ++row) {
    const double part = static_cast<double>(row) / static_cast<double>(rows);
    options.extra_times.push_back(row == rows ? options.until : begin + part * (options.until - begin));
  }
  std::sort(options.extra_times.begin(), options.extra_times.end());
  options.extra_times.erase(std::unique(options.extra_times.begin(), options.extra_times.end()),
                            options.extra_times.end());
}

std::vector<double> rounding_of(const diagram::FlatDiagram& diagram, const solve::RunOptions& options) {
  constexpr double kOfUnit = 1e-15;
  const double of_unit = std::min(kOfUnit, options.absolute_tolerance.value_or(kOfUnit));
  std::vector<double> rounding{0};  // of the time
  for (const diagram::FlatOutput& output : diagram.outputs)
    rounding.push_back(of_unit * std::max(std::abs(output.scale), std::abs(output.offset)));
  rounding.resize(1 + diagram.outputs.size() * (1 + options.sensitivity.size()), 0.0);
  return rounding;
}

draw::Chart chart_of(const solve::Run& run, const std::vector<double>& rounding, const DrawnColumns& columns,
                     const std::string& title) {
  const solve::Trajectory& trajectory = run.extra.rows() > run.trajectory.rows() ? run.extra : run.trajectory;
  draw::Chart chart;
  chart.title = title;
  const text::TableColumn& x = trajectory.columns()[columns.against];
  const std::vector<double> xs = drawn_values(trajectory, columns.against, rounding[columns.against]);
  for (const std::size_t c : columns.drawn) {
    const draw::Axis axis = axis_of(trajectory.columns()[c]);
    auto panel = std::find_if(chart.panels.begin(), chart.panels.end(),
                              [&](const draw::Panel& other) { return other.y.unit == axis.unit; });
    if (panel == chart.panels.end()) {
      chart.panels.push_back({axis_of(x), {"", axis.unit}, {}});
      panel = chart.panels.end() - 1;
    }
    draw::Curve curve{axis.name, {}, panel->curves.size()};
    const std::vector<double> ys = drawn_values(trajectory, c, rounding[c]);
    for (std::size_t row = 0; row < xs.size(); ++row) curve.points.emplace_back(xs[row], ys[row]);
    panel->curves.push_back(std::move(curve));
  }
  for (draw::Panel& panel : chart.panels) {
    if (panel.curves.size() == 1) {  // the axis has its name
      panel.y.name = panel.curves.front().name;
      panel.curves.front().name.clear();
    }
    if (columns.against == 0) continue;
    panel.height = kPathHeight;
    panel.equal = panel.y.unit == panel.x.unit;
  }
  return chart;
}

}  // namespace oblique::report
