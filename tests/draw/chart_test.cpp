// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/chart.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/chart/chart_layout.h>
#include <oblique/draw/picture/scale.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using ::testing::ElementsAre;

constexpr double kHundredth = 0.005;  // coordinates are written to a hundredth of a pixel

const Mark& mark_of(const Picture& picture, const std::string& id) {
  const auto found = std::find_if(picture.marks.begin(), picture.marks.end(),
                                  [&](const Mark& mark) { return mark.id == id; });
  if (found == picture.marks.end()) throw std::runtime_error("no mark " + id);
  return *found;
}

const std::vector<Segment>& segments_of(const Picture& picture, const std::string& id) {
  return std::get<Outline>(mark_of(picture, id).shape).segments;
}

const Box& plot_of(const Picture& picture, int panel = 0) {
  return std::get<Box>(mark_of(picture, "plot-" + std::to_string(panel)).shape);
}

std::vector<Label> labels_of(const Picture& picture) {
  std::vector<Label> labels;
  for (const Mark& mark : picture.marks) {
    if (const auto* label = std::get_if<Label>(&mark.shape)) labels.push_back(*label);
  }
  return labels;
}

std::vector<std::string> labelled(const std::vector<Tick>& ticks) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks) {
    if (!tick.label.empty()) labels.push_back(tick.label);
  }
  return labels;
}

/// A sine over one turn: x from 0 to 2π as it stands, y from −1 to 1 by round numbers.
Chart sine(std::size_t points) {
  Curve curve{"sine", {}};
  for (std::size_t k = 0; k < points; ++k) {
    const double x = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(points - 1);
    curve.points.emplace_back(x, std::sin(x));
  }
  return {"A sine", {{{"t", "s"}, {"", "m"}, {curve}}}};
}

TEST(Chart, PutsPointsWhereTheNumbersSay) {
  const Chart chart = sine(101);
  const Picture picture = draw_chart(chart);
  const Box& plot = plot_of(picture);
  const auto& segments = segments_of(picture, "curve-0-0");
  ASSERT_EQ(segments.size(), 101U);
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const Vector2d& point = chart.panels[0].curves[0].points[k];
    EXPECT_NEAR(segments[k].to.x(), plot.corner.x() + point.x() / (2 * std::numbers::pi) * plot.size.x(),
                kHundredth);
    EXPECT_NEAR(segments[k].to.y(), plot.corner.y() + (1 - point.y()) / 2 * plot.size.y(), kHundredth);
  }
  // the number 1.0 stands at the upper edge of the plot, 6 at its place along the lower one
  for (const Label& label : labels_of(picture)) {
    if (label.text == "1.0") {
      EXPECT_NEAR(label.at.y(), plot.corner.y(), 0.5 * label.size);
    }
    if (label.text == "6") {
      EXPECT_NEAR(label.at.x(), plot.corner.x() + 6 / (2 * std::numbers::pi) * plot.size.x(), kHundredth);
    }
  }
}

// What is shaded is measured from 0, which the axis therefore shows.
TEST(Chart, ShadesFromZero) {
  const auto shows_zero = [](Curve::Style style) {
    const Curve curve{"", {{0, 5}, {1, 6}, {2, 5.5}}, 0, style};
    const auto labels = labels_of(draw_chart({"", {{{"t", "s"}, {"", "m"}, {curve}}}}));
    return std::count_if(labels.begin(), labels.end(),
                         [](const Label& label) { return label.text == "0" || label.text == "0.0"; });
  };
  // One is that of the time.
  EXPECT_EQ(shows_zero(Curve::Style::area), 2);
  EXPECT_EQ(shows_zero(Curve::Style::line), 1);
}

TEST(Chart, TakesLogarithmsOfBothAxes) {
  Curve curve{"", {}, 0, Curve::Style::line};
  for (const double gain : {1e2, 1e3, 1e4, 1e5, 1e6}) curve.points.emplace_back(gain, 3 / gain);
  curve.points.emplace_back(-1, 1);  // has no logarithm
  const Picture picture = draw_chart({"", {{{"gain", "", true}, {"error", "mm", true}, {curve}}}});
  const Box& plot = plot_of(picture);
  const auto& segments = segments_of(picture, "curve-0-0");
  ASSERT_EQ(segments.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) {
    const double decades = static_cast<double>(k);  // of x from 10²; y from 10⁻⁶ to 10⁻¹
    EXPECT_NEAR(segments[k].to.x(), plot.corner.x() + decades / 4 * plot.size.x(), kHundredth);
    EXPECT_NEAR(segments[k].to.y(), plot.corner.y() + (-1 - (std::log10(0.03) - decades)) / 5 * plot.size.y(),
                kHundredth);
  }
}

TEST(Chart, ThinsManyPointsAndKeepsExtremes) {
  Chart chart = sine(200'001);
  chart.panels[0].curves[0].points[123'456].y() = 3;   // one point of a spike
  chart.panels[0].curves[0].points[123'457].y() = -2;  // and one of another
  const Picture picture = draw_chart(chart);
  const auto& segments = segments_of(picture, "curve-0-0");
  EXPECT_LT(segments.size(), 6'000U);
  const auto [top, bottom] =
      std::minmax_element(segments.begin(), segments.end(),
                          [](const Segment& a, const Segment& b) { return a.to.y() < b.to.y(); });
  const Box& plot = plot_of(picture);
  EXPECT_NEAR(top->to.y(), plot.corner.y(), kHundredth);                     // 3, of −2 … 3
  EXPECT_NEAR(bottom->to.y(), plot.corner.y() + plot.size.y(), kHundredth);  // −2
}

TEST(Chart, InterruptsTheLineWhereThereIsNoValue) {
  Chart chart = sine(11);
  chart.panels[0].curves[0].points[5].y() = std::numeric_limits<double>::quiet_NaN();
  const Picture picture = draw_chart(chart);
  const auto& segments = segments_of(picture, "curve-0-0");
  ASSERT_EQ(segments.size(), 10U);
  EXPECT_EQ(segments[5].kind, Segment::Kind::move);
  EXPECT_EQ(std::count_if(segments.begin(), segments.end(),
                          [](const Segment& s) { return s.kind == Segment::Kind::move; }),
            2);
}

TEST(Chart, EqualScalesKeepACircleRound) {
  Curve circle{"", {}};
  for (int k = 0; k <= 360; k += 90)
    circle.points.emplace_back(3 * std::cos(k * std::numbers::pi / 180),
                               3 * std::sin(k * std::numbers::pi / 180));
  Panel panel{{"x", "m"}, {"y", "m"}, {circle}};
  panel.equal = true;
  const Picture picture = draw_chart({"", {panel}});
  const auto& segments = segments_of(picture, "curve-0-0");
  const double width = segments[0].to.x() - segments[2].to.x();
  const double height = segments[3].to.y() - segments[1].to.y();
  EXPECT_NEAR(width, height, kHundredth);
  EXPECT_GT(width, 100);
}

/// Names long and many, numbers long.
Chart crowded() {
  Chart chart{
      "A chart with a title that is too long for one line of the picture, so that it goes on in the next "
      "one and does not leave the paper at the right",
      {}};
  for (int p = 0; p < 3; ++p) {
    Panel panel{{"t", "s"}, {p == 2 ? "error" : "", "mm", p == 2}, {}};
    for (std::size_t c = 0; c < 9; ++c) {
      Curve curve{"a curve of number " + std::to_string(c), {}, c};
      for (int k = 0; k < 50; ++k)
        curve.points.emplace_back(1e4 * k, 12'345 * std::exp(std::sin(0.1 * k + static_cast<double>(c))));
      panel.curves.push_back(curve);
    }
    chart.panels.push_back(panel);
  }
  return chart;
}

TEST(Chart, LabelsCoverNothing) {
  const Picture picture = draw_chart(crowded());
  const auto labels = labels_of(picture);
  EXPECT_GT(labels.size(), 40U);
  const Eigen::AlignedBox2d paper(Vector2d(0, 0), Vector2d(picture.width, picture.height));
  for (std::size_t a = 0; a < labels.size(); ++a) {
    const auto extent = extent_of(Mark{labels[a]});
    EXPECT_TRUE(paper.contains(extent)) << labels[a].text;
    for (int p = 0; p < 3; ++p) {
      const Box& plot = plot_of(picture, p);
      const Eigen::AlignedBox2d inside(plot.corner, Vector2d(plot.corner + plot.size));
      EXPECT_FALSE(inside.intersects(extent)) << labels[a].text;
    }
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_FALSE(extent.intersects(extent_of(Mark{labels[b]})))
          << labels[a].text << " and " << labels[b].text;
  }
}

TEST(Chart, SharedAxesShowTheirNumbersOnce) {
  const Picture picture = draw_chart(crowded());
  const auto labels = labels_of(picture);
  EXPECT_EQ(std::count_if(labels.begin(), labels.end(), [](const Label& l) { return l.text == "t [10³ s]"; }),
            1);
}

TEST(Chart, FillsABandBetweenItsEdges) {
  Curve band{"half of them", {{0, 3}, {1, 4}, {2, 3}}, 0, Curve::Style::band, {{0, 1}, {1, 2}, {2, 0}}};
  const Picture picture = draw_chart({"", {{{"x"}, {"y"}, {band}}}});
  const Box& plot = plot_of(picture);
  const auto& segments = segments_of(picture, "curve-0-0");
  const std::vector<Vector2d> round{{0, 3}, {1, 4}, {2, 3}, {2, 0}, {1, 2}, {0, 1}};  // once about it
  ASSERT_EQ(segments.size(), round.size() + 1);
  for (std::size_t k = 0; k < round.size(); ++k) {
    EXPECT_NEAR(segments[k].to.x(), plot.corner.x() + round[k].x() / 2 * plot.size.x(), kHundredth);
    EXPECT_NEAR(segments[k].to.y(), plot.corner.y() + (4 - round[k].y()) / 4 * plot.size.y(), kHundredth);
  }
  EXPECT_EQ(segments.back().kind, Segment::Kind::close);
  const Mark& mark = mark_of(picture, "curve-0-0");
  EXPECT_EQ(mark.fill, Ink::blue);
  EXPECT_EQ(mark.pen.ink, Ink::none);
  EXPECT_LT(mark.opacity, 0.5);  // what lies under it is seen
}

TEST(Chart, StandsPanelsInColumns) {
  Chart chart = sine(11);
  for (int k = 0; k < 5; ++k) chart.panels.push_back(chart.panels.front());
  chart.columns = 3;
  const Picture picture = draw_chart(chart);
  for (int p = 0; p < 6; ++p) {  // the second under the first, the third to the right of the first
    EXPECT_NEAR(plot_of(picture, p).corner.x(), plot_of(picture, p / 2 * 2).corner.x(), kHundredth);
    EXPECT_NEAR(plot_of(picture, p).corner.y(), plot_of(picture, p % 2).corner.y(), kHundredth);
    if (p >= 2) {
      EXPECT_GT(plot_of(picture, p).corner.x(),
                plot_of(picture, p - 2).corner.x() + plot_of(picture, p - 2).size.x());
    }
  }
  EXPECT_GT(plot_of(picture, 1).corner.y(), plot_of(picture, 0).corner.y() + plot_of(picture, 0).size.y());
  const auto labels = labels_of(picture);  // the x axis of each column once
  EXPECT_EQ(std::count_if(labels.begin(), labels.end(), [](const Label& l) { return l.text == "t [s]"; }), 3);
}

// Of a half pixel column the first, the last and the extreme points, in their order; of equally far ones the
// first.
TEST(Thinned, KeepsTheExtremesOfAColumn) {
  const Vector2d first(0.20, 5), least_x(0.10, 5), lowest(0.22, 4), highest(0.24, 6), greatest_x(0.40, 5),
      last(0.30, 5), next(0.60, 5);
  const std::vector<Vector2d> points = {first,       {0.21, 5}, least_x, {0.10, 5.1}, lowest,
                                        {0.23, 4},   {0.25, 5}, highest, {0.26, 6},   greatest_x,
                                        {0.40, 5.1}, {0.27, 5}, last,    next};
  EXPECT_THAT(thinned(points), ElementsAre(first, least_x, lowest, highest, greatest_x, last, next));
}

TEST(Chart, NotesStandUnderIt) {
  Chart chart = sine(11);
  const double height = draw_chart(chart).height;
  chart.note =
      "A note that goes on and on, so that it does not fit into one line of the picture but has to be "
      "broken between its words, and stands under the panels in two";
  const Picture picture = draw_chart(chart);
  const auto labels = labels_of(picture);
  const std::string last = "stands under the panels in two";
  ASSERT_TRUE(labels.back().text.ends_with(last));
  EXPECT_GT(labels.back().at.y(), height - 20);
  EXPECT_LT(extent_of(Mark{labels.back()}).max().y(), picture.height);
}

TEST(Scale, PutsTicksAtRoundNumbers) {
  EXPECT_THAT(labelled(Scale({"angle", "°"}, {0, 360}, false).ticks(8)),
              ElementsAre("0", "45", "90", "135", "180", "225", "270", "315", "360"));
  EXPECT_THAT(labelled(Scale({"x"}, {-0.13, 0.61}, true).ticks(5)),
              ElementsAre("−0.2", "0.0", "0.2", "0.4", "0.6", "0.8"));
  EXPECT_THAT(labelled(Scale({"gain", "", true}, {100, 2e4}, false).ticks(8)),
              ElementsAre("10²", "10³", "10⁴", "10⁵"));
}

TEST(Scale, LeavesOutPowersOfAThousand) {
  const Scale scale({"side", "m"}, {0, 4e-5}, true);
  EXPECT_EQ(scale.title(), "side [10⁻⁶ m]");
  EXPECT_THAT(labelled(scale.ticks(5)), ElementsAre("0", "10", "20", "30", "40"));
  EXPECT_EQ(Scale({"n"}, {0, 5e4}, true).title(), "n [10³]");
  EXPECT_EQ(Scale({"side", "m"}, {0, 0.4}, true).title(), "side [m]");
}

TEST(Scale, HasRoomForConstantsAndForNothing) {
  const Scale constant({"x"}, {5, 5}, true);
  EXPECT_GT(constant.fraction(5), 0.2);
  EXPECT_LT(constant.fraction(5), 0.8);
  EXPECT_DOUBLE_EQ(Scale({"x"}, {0, 0}, true).fraction(0), 0.5);
  EXPECT_FALSE(Scale({"x"}, {}, true).ticks(5).empty());
  EXPECT_FALSE(Scale({"x", "", true}, {0, -1}, true).ticks(5).empty());
}

// What varies by 5e-9 of its size is no constant: it fills the axis. Rounding is below 1e-9 of it.
TEST(Scale, ShowsALittleThatIsMoreThanRounding) {
  EXPECT_NEAR(Scale({"x"}, {1, 1 + 5e-9}, false).fraction(1), 0, 1e-6);
  EXPECT_NEAR(Scale({"x"}, {1, 1 + 5e-10}, false).fraction(1), 0.5, 1e-6);
}

}  // namespace
}  // namespace oblique::draw
