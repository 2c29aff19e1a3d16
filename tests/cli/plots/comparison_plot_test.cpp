// SPDX-License-Identifier: MIT
// What compare --plot draws, held against its JSON.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "plot_reading.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

class ComparisonPlot : public PlotTest {};

TEST_F(ComparisonPlot, CompareDrawsErrorsAndTheirSlope) {
  const Svg svg = drawn("compare diagrams/mechanisms/four-bar.toml -o " + file("errors.json"));
  const auto json = nlohmann::json::parse(bytes_of("errors.json"));
  const AlignedBox2d plot = svg.plot(0);
  const auto measured = svg.curve(0, 0), slope = svg.curve(0, 1);
  ASSERT_EQ(measured.size(), json["runs"].size());
  double least = 1e300, greatest = 0;
  for (const auto& run : json["runs"]) {
    least = std::min(least, run["max_error"].get<double>());
    greatest = std::max(greatest, run["max_error"].get<double>());
  }
  const double low = std::floor(std::log10(least)), high = std::ceil(std::log10(greatest));
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double exponent = std::log10(json["runs"][k]["max_error"].get<double>());
    EXPECT_NEAR(measured[k].y(), plot.max().y() - (exponent - low) / (high - low) * plot.sizes().y(), 0.01);
  }
  // one decade of the gain against one of the error
  const double decade_x = (measured[4].x() - measured[0].x()) / 4;
  const double decade_y = plot.sizes().y() / (high - low);
  const Vector2d fall = slope.back() - slope.front();
  EXPECT_NEAR(-fall.y() / decade_y / (fall.x() / decade_x), json["order"].get<double>(), 1e-3);
  bool named = false;
  for (const draw::Label& label : svg.labels()) named = named || label.text == "slope −1.000";
  EXPECT_TRUE(named);
  // the largest error along the turn is the largest error
  double top = 1e300;
  for (const Vector2d& point : svg.curve(1, 0)) top = std::min(top, point.y());
  const AlignedBox2d along = svg.plot(1);
  EXPECT_NEAR((top - along.min().y()) / along.sizes().y() * (high - low), high - std::log10(greatest), 1e-3);
}

TEST_F(ComparisonPlot, MonteCarloIsAHistogram) {
  const Svg svg =
      drawn("compare diagrams/mechanisms/four-bar.toml --monte-carlo 30 --tolerance 0.1% --threads 2 -o " +
            file("runs.json"));
  const auto errors = nlohmann::json::parse(bytes_of("runs.json"))["monte_carlo"]["errors"];
  const auto steps = svg.curve(2, 0);
  // the area under the steps, in runs: each of the 7 classes has as many as fall into it
  const AlignedBox2d plot = svg.plot(2);
  const double width = plot.sizes().x() / 7;
  double area = 0;
  for (std::size_t k = 1; k < steps.size(); ++k)
    area += (steps[k].x() - steps[k - 1].x()) / width * (plot.max().y() - steps[k].y());
  std::vector<double> counts(7, 0);
  double least = 1e300, greatest = 0;
  for (const double error : errors) least = std::min(least, error), greatest = std::max(greatest, error);
  for (const double error : errors)
    counts[std::min<std::size_t>(6, static_cast<std::size_t>((error - least) / (greatest - least) * 7))] += 1;
  const double most = *std::max_element(counts.begin(), counts.end());
  double highest = 1e300;
  for (const Vector2d& point : steps) highest = std::min(highest, point.y());
  EXPECT_NEAR(area / ((plot.max().y() - highest) / most), 30, 0.1);
}

// The numbers of the bands are those of the JSON, where the axes put them: 0 at the bottom, the greatest
// number of the axis at the top.
TEST_F(ComparisonPlot, MonteCarloHasBandsAlongTheTurn) {
  const Svg svg =
      drawn("compare diagrams/mechanisms/four-bar.toml --monte-carlo 30 --tolerance 0.1% --threads 2 -o " +
            file("runs.json"));
  const auto along = nlohmann::json::parse(bytes_of("runs.json"))["monte_carlo"]["along"];
  const AlignedBox2d plot = svg.plot(1);
  double top = 0;
  for (const draw::Label& label : svg.labels()) {
    const bool at_top =
        label.anchor == draw::Anchor::end && std::abs(label.at.y() - 4 - plot.min().y()) < 0.02;
    if (at_top) top = std::stod(label.text);
  }
  ASSERT_GT(top, 0);
  const std::vector<double> drive = along["drive"];
  ASSERT_EQ(drive.size(), 361U);
  const auto expect_at = [&](const Vector2d& point, const char* percent, std::size_t row) {
    const double error = along[percent][row];
    EXPECT_NEAR(point.x(), plot.min().x() + drive[row] / (2 * std::numbers::pi) * plot.sizes().x(), 0.01);
    EXPECT_NEAR(point.y(), plot.max().y() - error / top * plot.sizes().y(), 0.01) << percent;
  };
  const auto wide = svg.curve(1, 0), narrow = svg.curve(1, 1), median = svg.curve(1, 2);
  ASSERT_EQ(wide.size(), 2 * 361U);
  ASSERT_EQ(median.size(), 361U);
  for (std::size_t row = 0; row < 361; ++row) {
    expect_at(wide[row], "97.5", row);
    expect_at(wide[721 - row], "2.5", row);
    expect_at(narrow[row], "75", row);
    expect_at(narrow[721 - row], "25", row);
    expect_at(median[row], "50", row);
  }
}

TEST_F(ComparisonPlot, MethodsHaveTheirColoursAndTheirPanels) {
  const Svg svg = drawn("compare diagrams/mechanisms/four-bar.toml --method triangles,gradient");
  EXPECT_EQ(svg.ink_of(0, 0), svg.ink_of(0, 1));  // a method and its slope
  EXPECT_EQ(svg.ink_of(0, 2), svg.ink_of(0, 3));
  EXPECT_NE(svg.ink_of(0, 0), svg.ink_of(0, 2));
  EXPECT_EQ(svg.curve(1, 4).size(), svg.curve(1, 0).size());  // five gains of triangles, and of gradient
  EXPECT_FALSE(svg.curve(2, 4).empty());
  std::string texts;
  for (const draw::Label& label : svg.labels()) texts += label.text + "\n";
  for (const char* text :
       {"error, triangles", "error, gradient", "a tenth of what the solver's tolerance leaves"})
    EXPECT_THAT(texts, HasSubstr(text));
}

}  // namespace
}  // namespace oblique::test
