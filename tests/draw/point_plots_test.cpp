// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/point_plots.h>

#include <cmath>

#include <gtest/gtest.h>

#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

/// The end of a crank of 80 at 100 rad/s: x = 80 cos φ, v = −8000 sin φ, a = −800 000 cos φ and so on.
draw::PointHistory crank_history() {
  draw::PointHistory history{"Crank", "B", "mm", "crank", "°", {}, {}};
  for (int k = 0; k <= 360; ++k) {
    const double angle = k * M_PI / 180;
    const Vector2d way(std::cos(angle), std::sin(angle)), across(-way.y(), way.x());
    history.drives.push_back(k);
    history.states.push_back({80 * way, 8000 * across, -800000 * way});
  }
  return history;
}

/// Where the numbers of a plot stand: beside its frame, and under it or under the next one in its column.
Extent cell_of(const draw::Picture& picture, int panel) {
  const auto frame_of = [&](int p) {
    return draw::extent_of(*find_mark(picture, "plot-" + std::to_string(p)));
  };
  const int below = panel == 0 ? 0 : panel / 2 * 2 + 1;
  constexpr double kAround = 20, kToTheLeft = 10;
  return {Vector2d(frame_of(panel).min() - Vector2d(kToTheLeft, kAround)),
          Vector2d(frame_of(below).max() + Vector2d(kAround, kAround))};
}

void expect_curve(const draw::Picture& picture, const std::string& id,
                  const std::vector<Vector2d>& expected) {
  SCOPED_TRACE(id);
  const int panel = id[6] - '0';
  std::vector<draw::Mark> numbers;  // those of y beside this plot, those of x under it or under the next one
  const Extent frame = draw::extent_of(*find_mark(picture, "plot-" + std::to_string(panel)));
  for (const draw::Mark& mark : picture.marks) {
    const auto* const label = std::get_if<draw::Label>(&mark.shape);
    if (label == nullptr) continue;
    const bool beside = std::abs(label->at.y() - 4 - frame.center().y()) < frame.sizes().y() / 2 + 3;
    if (label->anchor == draw::Anchor::middle || beside) numbers.push_back(mark);
  }
  const Reading reading(numbers, cell_of(picture, panel));
  const auto& segments = std::get<draw::Outline>(find_mark(picture, id)->shape).segments;
  ASSERT_EQ(segments.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_LT((segments[k].to - reading.pixel(expected[k])).norm(), 0.01) << k;
}

TEST(PointPlots, CurvesLieWhereTheirValuesAre) {
  const draw::PointHistory history = crank_history();
  const draw::Picture picture = draw::draw_chart(draw::point_plots(history));
  std::vector<Vector2d> path, x, y, vx, vy, ax, ay;
  for (std::size_t k = 0; k < history.drives.size(); ++k) {
    const double drive = history.drives[k];
    const mechanism::PointState& s = history.states[k];
    path.push_back(s.position);
    x.emplace_back(drive, s.position.x());
    y.emplace_back(drive, s.position.y());
    vx.emplace_back(drive, s.velocity.x() / 1e3);  // the axis says 10³
    vy.emplace_back(drive, s.velocity.y() / 1e3);
    ax.emplace_back(drive, s.acceleration.x() / 1e6);  // and 10⁶
    ay.emplace_back(drive, s.acceleration.y() / 1e6);
  }
  expect_curve(picture, "curve-0-0", path);
  expect_curve(picture, "curve-1-0", x);
  expect_curve(picture, "curve-1-1", y);
  expect_curve(picture, "curve-2-0", vx);
  expect_curve(picture, "curve-3-0", vy);
  expect_curve(picture, "curve-4-0", ax);
  expect_curve(picture, "curve-5-0", ay);
}

TEST(PointPlots, TextsLieWithinThePictureAndApart) {
  const draw::Picture picture = draw::draw_chart(draw::point_plots(crank_history()));
  const Extent paper(Vector2d(0, 0), Vector2d(picture.width, picture.height));
  std::vector<Extent> labels;
  for (const draw::Mark& mark : picture.marks) {
    const Extent extent = draw::extent_of(mark);
    EXPECT_TRUE(paper.contains(extent));
    const auto* const label = std::get_if<draw::Label>(&mark.shape);
    if (label == nullptr) continue;
    for (const Extent& other : labels) EXPECT_TRUE(extent.intersection(other).isEmpty()) << label->text;
    labels.push_back(extent);
  }
}

// A guided point: what rounding leaves of its other coordinate is no motion.
TEST(PointPlots, DrawRoundingAsNothing) {
  draw::PointHistory history = crank_history();
  for (mechanism::PointState& state : history.states) {
    state.velocity.x() = 1e-12 * std::sin(state.velocity.y());
    state.acceleration.x() = 0;
  }
  const draw::Chart chart = draw::point_plots(history);
  for (const Vector2d& point : chart.panels[2].curves[0].points) EXPECT_EQ(point.y(), 0);
}

// Whatever a point that stands seems to do: a turn of 1 s of links of 80 makes 500 mm/s, beside which it is
// nothing.
TEST(PointPlots, DrawAPointThatStandsAsStanding) {
  draw::PointHistory history = crank_history();
  history.size = 80;
  history.rate = 2 * M_PI;
  for (mechanism::PointState& state : history.states) {
    state.position *= 1e-14 / 80;
    state.velocity *= 1e-12 / 8000;
    state.acceleration *= 1e-12 / 800000;
  }
  const draw::Chart chart = draw::point_plots(history);
  for (const draw::Panel& panel : chart.panels) {
    for (const draw::Curve& curve : panel.curves) {
      for (const Vector2d& point : curve.points) EXPECT_EQ(point.y(), 0) << panel.y.name;
    }
  }
  history.size = 1e-14;  // of such links it would be a motion
  EXPECT_NE(draw::point_plots(history).panels[1].curves[0].points[0].y(), 0);
}

// v = 1/√(s + 10⁻⁵) along the way s from a limit: what is drawn is what can be seen beside the rest.
TEST(PointPlots, LeaveOutWhatRisesOutOfSightAtALimit) {
  draw::PointHistory history = crank_history();
  for (std::size_t k = 0; k < history.states.size(); ++k)
    history.states[k].velocity = Vector2d(1 / std::sqrt(static_cast<double>(k) / 360 + 1e-5), 1);
  history.states[0].acceleration *= 1e12;  // beside which all else would be rounding
  const auto greatest = [](const draw::Chart& chart) {
    double most = 0;
    for (const Vector2d& point : chart.panels[2].curves[0].points) most = std::fmax(most, point.y());
    return most;
  };
  EXPECT_GT(greatest(draw::point_plots(history)), 300);
  history.ends_at_limit = true;
  EXPECT_LT(greatest(draw::point_plots(history)), 10);  // 4 times that of a fifth of the way
  EXPECT_GT(greatest(draw::point_plots(history)), 5);
  EXPECT_NE(draw::point_plots(history).panels[4].curves[0].points[100].y(), 0);
}

TEST(PointPlots, SayTheirUnits) {
  const draw::Picture picture = draw::draw_chart(draw::point_plots(crank_history()));
  std::string texts;
  for (const draw::Mark& mark : picture.marks) {
    if (const auto* const label = std::get_if<draw::Label>(&mark.shape)) texts += label->text + "\n";
  }
  for (const char* text : {"crank [°]", "[10³ mm/s]", "[10⁶ mm/s²]", "x [mm]", "Crank: point B"})
    EXPECT_NE(texts.find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace oblique::test
