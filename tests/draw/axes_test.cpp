// SPDX-License-Identifier: MIT
#include <oblique/draw/axes.h>

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;
using testing::ElementsAre;

const Extent kPlace{Vector2d(10, 20), Vector2d(610, 420)};

const Label* find_label(const std::vector<Mark>& marks, const std::string& text) {
  for (const Mark& mark : marks) {
    const auto* const label = std::get_if<Label>(&mark.shape);
    if (label != nullptr && label->text == text) return label;
  }
  return nullptr;
}

TEST(Ticks, AreRound) {
  EXPECT_DOUBLE_EQ(round_step(10, 10), 1);
  EXPECT_DOUBLE_EQ(round_step(1, 4), 0.2);
  EXPECT_DOUBLE_EQ(round_step(7000, 10), 500);
  EXPECT_THAT(ticks_between(-0.3, 1.0, 0.5), ElementsAre(0, 0.5, 1));
}

TEST(Ticks, AreWrittenWithTheDigitsOfTheirStep) {
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_text(-200, 50), "−200");
  EXPECT_EQ(tick_text(-1e-17, 0.1), "0.0");
  EXPECT_EQ(tick_text(2e-9, 1e-9), "2e-09");
}

TEST(Axes, StandNumbersWhereTheirValuesLie) {
  const Axes axes(kPlace, {"x [m]", 0, 3}, {"y [m]", -1, 1}, Axes::Shape::stretched, "A title");
  const std::vector<Mark> marks = axes.marks();
  const Label* const two = find_label(marks, "2.0");
  ASSERT_NE(two, nullptr);
  EXPECT_NEAR(two->at.x(), axes.at({2, 0}).x(), 1e-9);
  EXPECT_NEAR(axes.at({0, -1}).x(), axes.frame().min().x(), 1e-9);
  EXPECT_NEAR(axes.at({0, -1}).y(), axes.frame().max().y(), 1e-9);
  EXPECT_NEAR(axes.at({3, 1}).x(), axes.frame().max().x(), 1e-9);
  EXPECT_NE(find_label(marks, "A title"), nullptr);
}

TEST(Axes, EqualOnesShowAllAndScaleAlike) {
  const Axes axes(kPlace, {"x", 0, 1}, {"y", 0, 5}, Axes::Shape::equal);
  EXPECT_DOUBLE_EQ(axes.scale().x(), axes.scale().y());
  for (const Vector2d& corner : {Vector2d(0, 0), Vector2d(1, 5)}) {
    const Vector2d at = axes.at(corner);
    EXPECT_GE(axes.frame().exteriorDistance(at), 0);
    EXPECT_LT(axes.frame().exteriorDistance(at), 1e-9);
  }
}

TEST(Axes, KeepWithinTheirPlaceAndApartFromEachOther) {
  for (const double size : {1e-5, 1.0, 3e4}) {
    const Axes axes(kPlace, {"x [mm]", -size, size}, {"y [mm]", -size, 2 * size}, Axes::Shape::stretched);
    std::vector<Extent> labels;
    for (const Mark& mark : axes.marks()) {
      const Extent extent = extent_of(mark);
      EXPECT_TRUE(kPlace.contains(extent)) << extent.min().transpose() << " " << extent.max().transpose();
      if (!std::holds_alternative<Label>(mark.shape)) continue;
      for (const Extent& other : labels) EXPECT_TRUE(extent.intersection(other).isEmpty());
      labels.push_back(extent);
    }
  }
}

TEST(Axes, ShowWhatHasOneValue) {
  const Axes axes(kPlace, {"x", 0, 1}, {"y", 4, 4}, Axes::Shape::stretched);
  EXPECT_NEAR(axes.at({0, 4}).y(), axes.frame().center().y(), 1e-9);
}

TEST(Curve, HasGapsWhereThereIsNoValue) {
  const Axes axes(kPlace, {"x", 0, 4}, {"y", 0, 1}, Axes::Shape::stretched);
  const Mark mark = curve_mark(axes, {{0, 0}, {1, 1}, {2, std::nan("")}, {3, 0}, {4, 1}}, {});
  const auto& segments = std::get<Outline>(mark.shape).segments;
  ASSERT_EQ(segments.size(), 4U);
  EXPECT_EQ(segments[2].kind, Segment::Kind::move);
  EXPECT_NEAR((segments[3].to - axes.at({4, 1})).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace oblique
