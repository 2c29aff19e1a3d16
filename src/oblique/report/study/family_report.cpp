// SPDX-License-Identifier: MIT
#include <oblique/report/study/family_report.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/ensemble/study/study.h>
#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

constexpr double kPathHeight = 440;  // [px]

/// The first run that did not fail.
const solve::Run& good_run(const ensemble::Family& family) {
  for (const ensemble::FamilyRun& one : family.runs) {
    if (one.failure.empty()) return one.run;
  }
  throw ensemble::StudyError(text::Diagnostic{
      {}, fmt::format("all runs failed; with {}: {}", family.label(0), family.runs.front().failure), {}, {}});
}

/// "side (c.gain = 100)".
std::string name_in_table(const ensemble::Family& family, const std::string& output, std::size_t run) {
  return fmt::format("{} ({})", output, family.label(run));
}

}  // namespace

solve::Trajectory table_of(const ensemble::Family& family, const std::vector<text::TableColumn>& columns) {
  const solve::Trajectory& times = good_run(family).trajectory;
  std::vector<text::TableColumn> all{columns.front()};
  for (std::size_t k = 0; k < family.runs.size(); ++k) {
    for (std::size_t c = 1; c < columns.size(); ++c)
      all.push_back({name_in_table(family, columns[c].name, k), columns[c].unit});
  }
  solve::Trajectory table(all);
  std::vector<double> row;
  for (std::size_t r = 0; r < times.rows(); ++r) {
    row.assign(1, times.at(r, 0));
    for (const ensemble::FamilyRun& one : family.runs) {
      for (std::size_t c = 1; c < columns.size(); ++c)
        row.push_back(r < one.run.trajectory.rows() ? one.run.trajectory.at(r, c) : std::nan(""));
    }
    table.add_row(row);
  }
  return table;
}

std::vector<std::string> names_in_table(const ensemble::Family& family,
                                        const std::vector<text::TableColumn>& columns,
                                        const std::vector<std::string>& names) {
  std::vector<std::string> chosen;
  for (const std::string& name : names) {
    const bool is_output = std::any_of(columns.begin() + 1, columns.end(),
                                       [&](const text::TableColumn& column) { return column.name == name; });
    if (!is_output) chosen.push_back(name);
    for (std::size_t k = 0; is_output && k < family.runs.size(); ++k)
      chosen.push_back(name_in_table(family, name, k));
  }
  return chosen;
}

draw::Chart chart_of(const ensemble::Family& family, const std::vector<text::TableColumn>& columns,
                     const std::vector<double>& rounding, const DrawnColumns& drawn,
                     const std::string& title) {
  draw::Chart chart;
  chart.title = title;
  const std::vector<std::size_t> shown = spread_rows(family.runs.size(), draw::kMostCurves);
  for (const std::size_t c : drawn.drawn) {
    const text::TableColumn &x = columns[drawn.against], &y = columns[c];
    draw::Panel panel{{x.name, x.unit == "machine unit" ? "" : x.unit},
                      {y.name, y.unit == "machine unit" ? "" : y.unit},
                      {}};
    if (drawn.against != 0) {
      panel.height = kPathHeight;
      panel.equal = x.unit == y.unit;
    }
    for (const std::size_t k : shown) {
      const solve::Run& run = family.runs[k].run;
      const solve::Trajectory& rows = run.extra.rows() > run.trajectory.rows() ? run.extra : run.trajectory;
      const auto value = [&](std::size_t row, std::size_t column) {
        const double found = rows.at(row, column);
        return std::abs(found) <= rounding[column] ? 0 : found;
      };
      draw::Curve curve{family.label(k), {}, panel.curves.size()};
      for (std::size_t row = 0; row < rows.rows(); ++row)
        curve.points.emplace_back(value(row, drawn.against), value(row, c));
      panel.curves.push_back(std::move(curve));
    }
    chart.panels.push_back(std::move(panel));
  }
  if (shown.size() < family.runs.size())
    chart.note = fmt::format("{} of {} values are drawn.", shown.size(), family.runs.size());
  return chart;
}

}  // namespace oblique::report
