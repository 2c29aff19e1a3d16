// SPDX-License-Identifier: MIT
#include <oblique/report/comparison_chart.h>

#include <gtest/gtest.h>

namespace oblique::report {
namespace {

compare::ComparedRun run_of(double gain, patch::PatchMethod method, double error) {
  compare::ComparedRun run;
  run.gain = gain;
  run.method = method;
  run.max_error = error;
  run.error_along = {error, error / 2};
  return run;
}

// Of the first method the run with the lowest gain failed, and was left out.
TEST(ComparisonChart, DrawsTheRunsOfEachSeriesWhereOneIsLeftOut) {
  using patch::PatchMethod;
  compare::Comparison comparison;
  comparison.size = 1;
  comparison.unit = "m";
  comparison.drive = {0, 1};
  comparison.runs = {run_of(1e4, PatchMethod::triangles, 1e-4), run_of(1e3, PatchMethod::gradient, 2e-3),
                     run_of(1e4, PatchMethod::gradient, 2e-4)};
  comparison.series = {{PatchMethod::triangles, 20, 0, 1, {}, {}}, {PatchMethod::gradient, 20, 1, 2, {}, {}}};

  const draw::Chart chart = chart_of(comparison);
  ASSERT_EQ(chart.panels.size(), 3U);
  const std::vector<draw::Curve>& errors = chart.panels[0].curves;
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].points, (std::vector<Eigen::Vector2d>{{1e4, 1e-4}}));
  EXPECT_EQ(errors[1].points, (std::vector<Eigen::Vector2d>{{1e3, 2e-3}, {1e4, 2e-4}}));
  ASSERT_EQ(chart.panels[1].curves.size(), 1U);
  ASSERT_EQ(chart.panels[2].curves.size(), 2U);
  EXPECT_EQ(chart.panels[2].curves[0].points[1].y(), 1e-3);
  EXPECT_EQ(chart.panels[2].curves[1].points[1].y(), 1e-4);
}

}  // namespace
}  // namespace oblique::report
