// SPDX-License-Identifier: MIT
#include <oblique/report/study/effects.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <oblique/report/study/study_chart.h>

namespace oblique::report {
namespace {

/// The measure y = 3a − b on a grid, with a row that failed.
StudyResult plane(bool grid) {
  StudyResult result;
  result.columns = {{"a"}, {"b"}, {"y"}};
  result.n_varied = 2;
  result.logarithmic = {false, false};
  result.grid = grid;
  for (const double a : {0.0, 1.0, 2.0}) {
    for (const double b : {0.0, 10.0}) result.done.rows.push_back({0, {a, b, 3 * a - b}, ""});
  }
  return result;
}

TEST(Effects, OfAGridAreRangesOfMeans) {
  const std::vector<Effect> effects = effects_of(plane(true), 0);
  ASSERT_EQ(effects.size(), 2U);
  EXPECT_EQ(effects[0].name, 1U);  // b: the means 3 and −7
  EXPECT_DOUBLE_EQ(effects[0].low, -7);
  EXPECT_EQ(effects[0].low_at, 10);
  EXPECT_DOUBLE_EQ(effects[0].high, 3);
  EXPECT_EQ(effects[0].high_at, 0);
  EXPECT_DOUBLE_EQ(effects[1].size(), 6);
  EXPECT_DOUBLE_EQ(mean_of(plane(true), 0), -2);
}

// Of a monotonous function of one name the ranks agree; Spearman's coefficient of 1, 2, 3, 4, 5 with
// 2, 1, 4, 3, 5 is 1 − 6·4/(5·24) = 0.8.
TEST(Effects, OfPointsAreRankCorrelations) {
  StudyResult result;
  result.columns = {{"a"}, {"b"}, {"y"}};
  result.n_varied = 2;
  result.logarithmic = {false, false};
  result.grid = false;
  const double other[]{2, 1, 4, 3, 5};
  for (int k = 0; k < 5; ++k) result.done.rows.push_back({0, {double(k), -other[k], std::exp(k)}, ""});
  result.done.rows.push_back({5, {9, 9, std::nan("")}, "failed"});
  const std::vector<Effect> effects = effects_of(result, 0);
  EXPECT_EQ(effects[0].name, 0U);
  EXPECT_NEAR(effects[0].high, 1, 1e-15);
  EXPECT_NEAR(effects[1].low, -0.8, 1e-15);
  EXPECT_EQ(effects[1].high, 0);
  EXPECT_EQ(effects_text(result), "y by  rank correlation\na                1.000\nb               -0.800\n");
}

TEST(Study, IsDrawnAsAMapOfAGridAndAsEffectsOfPoints) {
  const auto has = [](const draw::Picture& picture, const std::string& id) {
    return std::any_of(picture.marks.begin(), picture.marks.end(),
                       [&](const draw::Mark& mark) { return mark.id == id; });
  };
  EXPECT_TRUE(has(picture_of(plane(true)), "cell-0-2-1"));
  EXPECT_TRUE(has(picture_of(plane(false)), "bar-0-1"));
  const draw::Chart chart = chart_of(plane(true));  // for the terminal: a curve for each b
  ASSERT_EQ(chart.panels.front().curves.size(), 2U);
  EXPECT_EQ(chart.panels.front().curves[1].points[2], Eigen::Vector2d(2, -4));
}

// 1 … 1000: 5 % are up to 50, half up to 500; as many in each class.
TEST(Study, IsDrawnAsAHistogramWhereElementsScatter) {
  StudyResult result;
  result.columns = {{"y"}};
  for (int k = 0; k < 1000; ++k) result.done.rows.push_back({0, {k + 1.0}, ""});
  const draw::Panel panel = chart_of(result).panels.front();
  ASSERT_EQ(panel.curves.size(), 4U);
  EXPECT_EQ(panel.curves[1].points[0].x(), 50);
  EXPECT_EQ(panel.curves[2].points[0].x(), 500);
  EXPECT_EQ(panel.curves[3].name, "95 %: 950");
  double machines = 0;
  const auto& steps = panel.curves[0].points;
  for (std::size_t k = 1; k + 1 < steps.size(); k += 2) machines += steps[k].y();
  EXPECT_EQ(machines, 1000);
}

// Over one varied number: where elements scatter on a grid, the median of each place is a dotted line with a
// band; drawn points without a grid are marks.
TEST(Study, IsDrawnAsALineOverAGridAndAsMarksWithoutOne) {
  StudyResult result;
  result.columns = {{"a"}, {"y"}};
  result.n_varied = 1;
  result.logarithmic = {false};
  result.drawn = 3;
  for (const double a : {0.0, 1.0}) {
    for (const double y : {1.0, 2.0, 3.0}) result.done.rows.push_back({0, {a, a + y}, ""});
  }
  for (const bool grid : {true, false}) {
    result.grid = grid;
    const draw::Panel panel = chart_of(result).panels.front();
    const auto middle = std::find_if(panel.curves.begin(), panel.curves.end(), [](const draw::Curve& curve) {
      return curve.style != draw::Curve::Style::band;
    });
    ASSERT_NE(middle, panel.curves.end());
    EXPECT_EQ(middle->name, grid ? "median" : "");
    EXPECT_EQ(middle->style, grid ? draw::Curve::Style::dotted_line : draw::Curve::Style::marks);
    EXPECT_EQ(middle->points.at(1), Eigen::Vector2d(1, 3));
  }
}

}  // namespace
}  // namespace oblique::report
