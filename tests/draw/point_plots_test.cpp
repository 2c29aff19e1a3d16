// SPDX-License-Identifier: MIT
#include <oblique/draw/point_plots.h>

#include <cmath>

#include <gtest/gtest.h>

#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

/// The end of a crank of 80 at 100 rad/s: x = 80 cos φ, v = −8000 sin φ, a = −800 000 cos φ and so on.
PointHistory crank_history() {
  PointHistory history{"Crank", "B", "mm", "crank", "°", {}, {}};
  for (int k = 0; k <= 360; ++k) {
    const double angle = k * M_PI / 180;
    const Vector2d way(std::cos(angle), std::sin(angle)), across(-way.y(), way.x());
    history.drives.push_back(k);
    history.states.push_back({80 * way, 8000 * across, -800000 * way});
  }
  return history;
}

/// The numbers that belong to a curve stand in its third of the picture and its half.
Extent cell_of(const Picture& picture, const std::string& id) {
  const Vector2d middle = extent_of(*find_mark(picture, id)).center();
  const double column = std::floor(middle.x() / (picture.width / 3)),
               row = middle.y() > picture.height / 2 ? 1 : 0;
  const Vector2d corner(column * picture.width / 3, row * picture.height * 0.54);
  return {corner, Vector2d(corner + Vector2d(picture.width / 3, picture.height * 0.53))};
}

void expect_curve(const Picture& picture, const std::string& id, const std::vector<Vector2d>& expected) {
  SCOPED_TRACE(id);
  const Reading reading(picture.marks, cell_of(picture, id));
  const auto& segments = std::get<Outline>(find_mark(picture, id)->shape).segments;
  ASSERT_EQ(segments.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_LT((segments[k].to - reading.pixel(expected[k])).norm(), 0.01) << k;
}

TEST(PointPlots, CurvesLieWhereTheirValuesAre) {
  const PointHistory history = crank_history();
  const Picture picture = draw_point_plots(history);
  std::vector<Vector2d> path, x, y, vx, vy, ax, ay;
  for (std::size_t k = 0; k < history.drives.size(); ++k) {
    const double drive = history.drives[k];
    const PointState& s = history.states[k];
    path.push_back(s.position);
    x.emplace_back(drive, s.position.x());
    y.emplace_back(drive, s.position.y());
    vx.emplace_back(drive, s.velocity.x());
    vy.emplace_back(drive, s.velocity.y());
    ax.emplace_back(drive, s.acceleration.x() / 1000);  // the axis says 10³
    ay.emplace_back(drive, s.acceleration.y() / 1000);
  }
  expect_curve(picture, "path", path);
  expect_curve(picture, "x", x);
  expect_curve(picture, "y", y);
  expect_curve(picture, "vx", vx);
  expect_curve(picture, "vy", vy);
  expect_curve(picture, "ax", ax);
  expect_curve(picture, "ay", ay);
}

TEST(PointPlots, TextsLieWithinThePictureAndApart) {
  const Picture picture = draw_point_plots(crank_history());
  const Extent paper(Vector2d(0, 0), Vector2d(picture.width, picture.height));
  std::vector<Extent> labels;
  for (const Mark& mark : picture.marks) {
    const Extent extent = extent_of(mark);
    EXPECT_TRUE(paper.contains(extent));
    const auto* const label = std::get_if<Label>(&mark.shape);
    if (label == nullptr) continue;
    for (const Extent& other : labels) EXPECT_TRUE(extent.intersection(other).isEmpty()) << label->text;
    labels.push_back(extent);
  }
}

TEST(PointPlots, SayTheirUnits) {
  const Picture picture = draw_point_plots(crank_history());
  std::string texts;
  for (const Mark& mark : picture.marks) {
    if (const auto* const label = std::get_if<Label>(&mark.shape)) texts += label->text + "\n";
  }
  for (const char* text : {"crank [°]", "[mm/s]", "[10³ mm/s²]", "x [mm]", "Crank: point B"})
    EXPECT_NE(texts.find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace oblique::test
