// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/heat_map.h>

#include <cmath>

#include <gtest/gtest.h>

namespace oblique::draw {
namespace {

/// The place of the mark of that id; one past the last where there is none.
std::size_t place_of(const Picture& picture, const std::string& id) {
  for (std::size_t k = 0; k < picture.marks.size(); ++k) {
    if (picture.marks[k].id == id) return k;
  }
  return picture.marks.size();
}

Eigen::AlignedBox2d box_of(const Mark& mark) {
  const Box& box = std::get<Box>(mark.shape);
  return {box.corner, Eigen::Vector2d(box.corner + box.size)};
}

HeatMap product(bool logarithmic) {
  HeatMap map{{"gain", "", true}, {"length", "m"}, {"error", "", logarithmic}, {10, 100, 1000}, {1, 2}, {}};
  for (const double y : map.ys) {
    for (const double x : map.xs) map.values.push_back(x * y);
  }
  return map;
}

// Blue over yellow: its opacity is the place of the value on the scale, which goes to round numbers (linear:
// 0 … 2000) or decades (10 … 10⁴).
TEST(HeatMap, ColoursByTheValue) {
  for (const bool logarithmic : {false, true}) {
    const HeatMap map = product(logarithmic);
    const Picture picture = draw_heat_maps("Title", {map}, "");
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t at = place_of(picture, "cell-0-" + std::to_string(i) + "-" + std::to_string(j));
        ASSERT_LT(at + 1, picture.marks.size());
        EXPECT_EQ(picture.marks[at].fill, Ink::yellow);
        EXPECT_EQ(picture.marks[at + 1].fill, Ink::blue);
        const double value = map.xs[i] * map.ys[j];
        EXPECT_NEAR(picture.marks[at + 1].opacity, logarithmic ? (std::log10(value) - 1) / 3 : value / 2000,
                    1e-12);
      }
    }
  }
}

// On the logarithmic axis 100 is the middle: its cells take half of the width, those of the ends a quarter.
TEST(HeatMap, FillsItsFrameWithCellsAroundTheirValues) {
  const Picture picture = draw_heat_maps("", {product(false)}, "");
  const auto frame = box_of(picture.marks[place_of(picture, "plot-0")]);
  double area = 0;
  for (std::size_t j = 0; j < 2; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto cell =
          box_of(picture.marks[place_of(picture, "cell-0-" + std::to_string(i) + "-" + std::to_string(j))]);
      EXPECT_TRUE(frame.contains(cell));
      EXPECT_NEAR(cell.sizes().x() / frame.sizes().x(), i == 1 ? 0.5 : 0.25,
                  1 / frame.sizes().x());  // pixels
      EXPECT_NEAR(cell.sizes().y() / frame.sizes().y(), 0.5, 1 / frame.sizes().y());
      area += cell.volume();
    }
  }
  EXPECT_NEAR(area, frame.volume(), 1e-6 * area);
  for (const Mark& mark : picture.marks) {
    EXPECT_GE(extent_of(mark).min().minCoeff(), 0);
    EXPECT_LE(extent_of(mark).max().x(), picture.width);
    EXPECT_LE(extent_of(mark).max().y(), picture.height);
  }
}

TEST(HeatMap, CrossesOutWhatIsNotKnown) {
  HeatMap map = product(false);
  map.values[1] = std::nan("");
  const Picture picture = draw_heat_maps("", {map}, "1 machine failed.");
  EXPECT_EQ(place_of(picture, "cell-0-1-0"), picture.marks.size());
  EXPECT_LT(place_of(picture, "cell-0-1-1"), picture.marks.size());
}

// The longest number begins where the title does; none is cut off.
TEST(HeatMap, LeavesRoomForTheNumbersOnTheLeft) {
  HeatMap map = product(false);
  map.ys = {100000, 300000};
  const Picture picture = draw_heat_maps("", {map}, "");
  const double frame = box_of(picture.marks[place_of(picture, "plot-0")]).min().x();
  double title = frame, numbers = frame;
  for (const Mark& mark : picture.marks) {
    const auto* const label = std::get_if<Label>(&mark.shape);
    if (label == nullptr || extent_of(mark).max().x() > frame + 100) continue;
    if (label->anchor == Anchor::start) title = std::min(title, extent_of(mark).min().x());
    if (label->anchor == Anchor::end) numbers = std::min(numbers, extent_of(mark).min().x());
  }
  EXPECT_LT(title, frame);
  EXPECT_NEAR(numbers, title, 1.01);  // the frame stands at a whole pixel
}

}  // namespace
}  // namespace oblique::draw
