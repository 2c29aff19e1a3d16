// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/axes.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

const Extent kPlace{Vector2d(10, 20), Vector2d(610, 420)};

const Label* find_label(const std::vector<Mark>& marks, const std::string& text) {
  for (const Mark& mark : marks) {
    const auto* const label = std::get_if<Label>(&mark.shape);
    if (label != nullptr && label->text == text) return label;
  }
  return nullptr;
}

Scale range(const std::string& name, const std::string& unit, double least, double greatest) {
  return {{name, unit}, {least, greatest}, false};
}

Axes stretched(const Scale& x, const Scale& y) {
  return Axes::within(kPlace, x, y, Axes::Shape::stretched);
}

TEST(Axes, StandNumbersWhereTheirValuesLie) {
  const Axes axes = stretched(range("x", "m", 0, 3), range("y", "m", -1, 1));
  const std::vector<Mark> marks = axes.marks();
  const Label* const two = find_label(marks, "2.0");
  ASSERT_NE(two, nullptr);
  EXPECT_NEAR(two->at.x(), axes.at({2, 0}).x(), 1e-9);
  EXPECT_NEAR(axes.at({0, -1}).x(), axes.frame().min().x(), 1e-9);
  EXPECT_NEAR(axes.at({0, -1}).y(), axes.frame().max().y(), 1e-9);
  EXPECT_NEAR(axes.at({3, 1}).x(), axes.frame().max().x(), 1e-9);
  EXPECT_NE(find_label(marks, "x [m]"), nullptr);
  EXPECT_NE(find_label(marks, "y [m]"), nullptr);
}

TEST(Axes, EqualOnesShowAllAndScaleAlike) {
  const Axes axes =
      Axes::within(kPlace, range("x", "m", 0, 900), range("y", "m", 0, 50'000), Axes::Shape::equal);
  EXPECT_NEAR(axes.scale().x(), axes.scale().y(), 1e-12 * axes.scale().x());
  for (const Vector2d& corner : {Vector2d(0, 0), Vector2d(900, 50'000)}) {
    const Vector2d at = axes.at(corner);
    EXPECT_GE(axes.frame().exteriorDistance(at), 0);
    EXPECT_LT(axes.frame().exteriorDistance(at), 1e-9);
  }
  // and count alike: with one power of ten, in squares
  const std::vector<Mark> marks = axes.marks();
  EXPECT_NE(find_label(marks, "x [10³ m]"), nullptr);
  EXPECT_NE(find_label(marks, "y [10³ m]"), nullptr);
}

// Numbers short and long, of every order of magnitude, in a wide frame and in a narrow one.
TEST(Axes, KeepWithinTheirPlaceAndApartFromEachOther) {
  const Extent narrow(Vector2d(10, 20), Vector2d(230, 420));
  for (const Extent& place : {kPlace, narrow}) {
    for (const double offset : {0.0, 1.0, 9876.5, 12'345.6}) {
      for (const double size : {7e-6, 1e-5, 0.013, 1.0, 77.0, 3e4, 2e11}) {
        const Axes axes = Axes::within(place, range("x", "mm", offset - size, offset + size),
                                       range("y", "mm", -size, 2 * size), Axes::Shape::stretched);
        std::vector<Extent> labels;
        for (const Mark& mark : axes.marks()) {
          const Extent extent = extent_of(mark);
          EXPECT_TRUE(place.contains(extent)) << extent.min().transpose() << " " << extent.max().transpose();
          if (!std::holds_alternative<Label>(mark.shape)) continue;
          for (const Extent& other : labels)
            EXPECT_TRUE(extent.intersection(other).isEmpty()) << std::get<Label>(mark.shape).text;
          labels.push_back(extent);
        }
        EXPECT_GE(labels.size(), 5U) << offset << " " << size;
      }
    }
  }
}

// 0 to 4 in ones would stand 22 px apart upwards and 35 px apart to the right, where lines keep 40 px and 62
// px.
TEST(Axes, OfASmallFrameHaveFewNumbers) {
  const Axes axes(Extent(Vector2d(0, 0), Vector2d(140, 90)), range("x", "", 0, 4), range("y", "", 0, 4),
                  Axes::Shape::stretched);
  const std::vector<Mark> marks = axes.marks();
  const auto count = [&](const std::string& text) {
    return std::count_if(marks.begin(), marks.end(), [&](const Mark& mark) {
      const auto* const label = std::get_if<Label>(&mark.shape);
      return label != nullptr && label->text == text;
    });
  };
  EXPECT_EQ(count("0") + count("2") + count("4"), 6);  // three of each axis
  EXPECT_EQ(count("1") + count("3"), 0);
}

TEST(Axes, ShowWhatHasOneValue) {
  const Axes axes = stretched(range("x", "", 0, 1), range("y", "", 4, 4));
  EXPECT_NEAR(axes.at({0, 4}).y(), axes.frame().center().y(), 1e-9);
}

TEST(Curve, HasGapsWhereThereIsNoValue) {
  const Axes axes = stretched(range("x", "", 0, 4), range("y", "", 0, 1));
  const Mark mark = curve_mark(axes, {{0, 0}, {1, 1}, {2, std::nan("")}, {3, 0}, {4, 1}}, {});
  const auto& segments = std::get<Outline>(mark.shape).segments;
  ASSERT_EQ(segments.size(), 4U);
  EXPECT_EQ(segments[2].kind, Segment::Kind::move);
  EXPECT_NEAR((segments[3].to - axes.at({4, 1})).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace oblique::draw
