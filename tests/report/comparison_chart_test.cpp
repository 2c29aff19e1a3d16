// SPDX-License-Identifier: MIT
#include <oblique/report/comparison_chart.h>

#include <gmock/gmock.h>
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
  ASSERT_EQ(chart.panels[2].curves[0].points.size(), 2U);  // as many as the run has rows
  EXPECT_EQ(chart.panels[2].curves[0].points[1].y(), 1e-3);
  EXPECT_EQ(chart.panels[2].curves[1].points[1].y(), 1e-4);
}

// Errors 2/gain of which three quarters are static and a quarter lag; the first run is on another branch, the
// last no clearer than what the tolerance leaves.
TEST(ComparisonChart, DrawsThePartsOfTheErrorsAndALineOfOrderOne) {
  compare::Comparison comparison;
  comparison.size = 1;
  comparison.unit = "m";
  for (const double gain : {1e5, 1e3, 1e4, 1e2}) {
    comparison.runs.push_back(run_of(gain, patch::PatchMethod::triangles, 2 / gain));
    comparison.runs.back().parts = compare::ErrorParts{1.5 / gain, -0.5 / gain, 0.9e-6};
  }
  comparison.runs[3].left_branch = 1;
  comparison.series = {{patch::PatchMethod::triangles, 20, 0, 4, 1e-5, {}}};
  const draw::Chart chart = parts_chart(comparison);
  ASSERT_EQ(chart.panels.size(), 1U);
  EXPECT_TRUE(chart.panels[0].x.logarithmic && chart.panels[0].y.logarithmic);
  const auto points_of = [&](const std::string& name) {
    for (const draw::Curve& curve : chart.panels[0].curves) {
      if (curve.name == name) return curve.points;
    }
    return std::vector<Eigen::Vector2d>();
  };
  using Points = std::vector<Eigen::Vector2d>;
  EXPECT_EQ(points_of("largest error"), (Points{{1e3, 2e-3}, {1e4, 2e-4}, {1e5, 2e-5}}));
  EXPECT_EQ(points_of("static"), (Points{{1e3, 1.5e-3}, {1e4, 1.5e-4}, {1e5, 1.5e-5}}));
  EXPECT_EQ(points_of("lag"), (Points{{1e3, 0.5e-3}, {1e4, 0.5e-4}, {1e5, 0.5e-5}}));
  EXPECT_EQ(points_of("solver"), Points{});  // below a tenth of the floor
  EXPECT_EQ(points_of("on another branch"), (Points{{1e2, 2e-2}}));
  const Points order = points_of("order −1");
  ASSERT_EQ(order.size(), 2U);
  for (const Eigen::Vector2d& point : order) EXPECT_NEAR(point.x() * point.y(), 2, 1e-12);
  EXPECT_LT(order[0].x(), 1e2);
  EXPECT_GT(order[1].x(), 1e5);
}

// Errors of 2/gain lie on a line of slope −1, so that it goes through them.
TEST(ComparisonChart, DrawsTheFittedSlopeThroughTheErrors) {
  compare::Comparison comparison;
  comparison.size = 1;
  comparison.unit = "m";
  comparison.drive = {0, 1};
  const std::vector<double> gains{1e2, 1e3, 1e5};
  for (const double gain : gains)
    comparison.runs.push_back(run_of(gain, patch::PatchMethod::triangles, 2 / gain));
  comparison.series = {{patch::PatchMethod::triangles, 20, 0, 3, {}, -1.0}};
  const draw::Chart chart = chart_of(comparison);
  const std::vector<draw::Curve>& curves = chart.panels[0].curves;
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_TRUE(curves[1].name.starts_with("slope")) << curves[1].name;
  ASSERT_EQ(curves[1].points.size(), gains.size());
  for (std::size_t k = 0; k < gains.size(); ++k) {
    EXPECT_EQ(curves[1].points[k].x(), gains[k]);
    EXPECT_NEAR(curves[1].points[k].y() * gains[k], 2, 1e-12);  // roundings of logarithms
  }
}

/// So many drawn machines, of which number k errs by k + 1 in both rows.
MonteCarloReport drawn(std::size_t runs) {
  MonteCarloReport report;
  report.unit = "m";
  report.result.drive = {0, 1};
  report.result.worst_run = runs - 1;
  for (std::size_t k = 0; k < runs; ++k) {
    const double error = static_cast<double>(k + 1);
    report.result.errors.emplace_back(error);
    report.result.along.push_back({error, error});
  }
  return report;
}

// Two are enough for bands, and one is itself.
TEST(ComparisonChart, DrawsBandsOfSeveralRunsAndTheRunOfOne) {
  const auto names = [](const draw::Panel& panel) {
    std::vector<std::string> found;
    for (const draw::Curve& curve : panel.curves) found.push_back(curve.name);
    return found;
  };
  const compare::Comparison comparison;
  EXPECT_EQ(names(panels_of(comparison, drawn(2)).at(0)),
            (std::vector<std::string>{"95 % of the runs", "half of them", "median"}));
  EXPECT_EQ(names(panels_of(comparison, drawn(1)).at(0)), (std::vector<std::string>{"the run"}));
}

// Of a hundred runs with the errors 1 to 100 a percentile is its own rank, the next whole one.
TEST(ComparisonChart, DrawsTheBandsAtTheirPercentiles) {
  const std::vector<draw::Curve> curves = panels_of(compare::Comparison(), drawn(100)).at(0).curves;
  ASSERT_EQ(curves.size(), 3U);
  const auto expect = [](const std::vector<Eigen::Vector2d>& points, double error) {
    ASSERT_EQ(points.size(), 2U);
    for (const Eigen::Vector2d& point : points) EXPECT_EQ(point.y(), error);
  };
  expect(curves[0].points, 98);
  expect(curves[0].other_edge, 3);
  expect(curves[1].points, 75);
  expect(curves[1].other_edge, 25);
  expect(curves[2].points, 50);
}

TEST(MonteCarloReport, ListsWhatASingleRunHasDrawn) {
  MonteCarloReport one = drawn(1);
  one.draws = {{"C.cx.tolerance", 0.25}};
  EXPECT_THAT(to_text(one), ::testing::HasSubstr("C.cx.tolerance   0.25"));
  EXPECT_THAT(to_text(one), ::testing::HasSubstr("\nlargest error with these 1.000e+00 m\n"));
  MonteCarloReport two = drawn(2);
  two.draws = one.draws;
  EXPECT_THAT(to_text(two), ::testing::Not(::testing::HasSubstr("with these")));
}

}  // namespace
}  // namespace oblique::report
