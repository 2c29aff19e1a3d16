// SPDX-License-Identifier: MIT
// The small curves in symbols, held against what they stand for.
#include <oblique/draw/schematic/symbols.h>

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::draw::schematic {
namespace {

using Eigen::Vector2d;
using Line = std::vector<Vector2d>;
using ::testing::SizeIs;

/// What is written with two decimals is equal as far as that.
constexpr double kDecimals = 1e-9;

const std::vector<std::string> kIcons{"function-generator",
                                      "comparator",
                                      "absolute-value",
                                      "backlash",
                                      "dead-zone",
                                      "limiter",
                                      "bounded",
                                      "diode",
                                      "sign",
                                      "step",
                                      "ramp",
                                      "pulse-train",
                                      "noise",
                                      "contact",
                                      "source",
                                      "monostable",
                                      "track-and-store",
                                      "counter",
                                      "resolver",
                                      "crank",
                                      "potentiometer",
                                      "dyad",
                                      "triangle"};

Line curve_of(const std::string& icon) {
  return icon_lines(icon).at(0);
}

/// The points in the opposite order, mirrored: the same line where the curve is even (1, −1) or odd (−1, −1).
Line mirrored(const Line& line, double x, double y) {
  Line result;
  for (auto p = line.rbegin(); p != line.rend(); ++p) result.emplace_back(x * p->x(), y * p->y());
  return result;
}

void expect_same(const Line& a, const Line& b, const std::string& icon) {
  ASSERT_EQ(a.size(), b.size()) << icon;
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_LT((a[k] - b[k]).norm(), kDecimals) << icon << k;
}

double distance_to_nearest(const Line& line, const Vector2d& point) {
  double nearest = INFINITY;
  for (const Vector2d& p : line) nearest = std::min(nearest, (p - point).norm());
  return nearest;
}

TEST(Icons, LieWithinTheirSquareAndFillIt) {
  for (const std::string& icon : kIcons) {
    const auto lines = icon_lines(icon);
    ASSERT_FALSE(lines.empty()) << icon;
    double least = 0, most = 0;
    for (const Line& line : lines) {
      EXPECT_GE(line.size(), 2U) << icon;
      for (const Vector2d& p : line) {
        EXPECT_LE(p.cwiseAbs().maxCoeff(), 1 + kDecimals) << icon << " " << p.transpose();
        least = std::min(least, p.x());
        most = std::max(most, p.x());
      }
    }
    EXPECT_LE(least, -0.7) << icon;
    EXPECT_GE(most, 0.7) << icon;
  }
  EXPECT_THAT(icon_lines("nothing of the kind"), SizeIs(0));
}

// A signal over time and a function over its argument have one value at each.
TEST(Icons, OfFunctionsAndSignalsGoFromLeftToRight) {
  for (const char* const icon :
       {"function-generator", "comparator", "absolute-value", "dead-zone", "limiter", "bounded", "sign",
        "step", "ramp", "pulse-train", "noise", "source", "monostable", "counter"}) {
    const Line line = curve_of(icon);
    EXPECT_EQ(line.front().x(), -1) << icon;
    EXPECT_EQ(line.back().x(), 1) << icon;
    for (std::size_t k = 1; k < line.size(); ++k) EXPECT_GE(line[k].x(), line[k - 1].x()) << icon;
  }
}

TEST(Icons, OfOddFunctionsAreOddAndOfEvenOnesEven) {
  for (const char* const icon : {"dead-zone", "limiter", "bounded", "sign", "comparator", "source"})
    expect_same(curve_of(icon), mirrored(curve_of(icon), -1, -1), icon);
  for (const char* const icon : {"absolute-value", "pulse-train", "monostable"})
    expect_same(curve_of(icon), mirrored(curve_of(icon), -1, 1), icon);
}

// What switches goes straight up and down between two levels.
TEST(Icons, OfSwitchingSignalsHaveTwoLevels) {
  for (const char* const icon : {"comparator", "sign", "step", "pulse-train", "monostable"}) {
    const Line line = curve_of(icon);
    const double first = line.front().y(), other = line.at(2).y();
    EXPECT_LT(first, 0) << icon;
    EXPECT_GT(other, 0) << icon;
    for (std::size_t k = 0; k < line.size(); ++k) {
      EXPECT_EQ(line[k].y(), k / 2 % 2 == 0 ? first : other) << icon << k;
    }
    for (std::size_t k = 1; k + 1 < line.size(); k += 2) EXPECT_EQ(line[k].x(), line[k + 1].x()) << icon << k;
  }
  EXPECT_EQ(curve_of("sign").at(1).x(), 0);
  EXPECT_EQ(icon_lines("comparator").at(1).at(0).y(), 0);  // the axis that it compares with
  EXPECT_EQ(icon_lines("comparator").at(1).at(1).y(), 0);
}

TEST(Icons, OfFunctionsHaveTheirShape) {
  const Line limiter = curve_of("limiter");
  EXPECT_EQ(limiter[0].y(), limiter[1].y());
  EXPECT_LT(limiter[1].y(), limiter[2].y());
  const Line dead = curve_of("dead-zone");
  EXPECT_EQ(dead[1].y(), 0);
  EXPECT_LT(dead[0].y(), 0);
  const Line absolute = curve_of("absolute-value");
  ASSERT_EQ(absolute.size(), 3U);
  EXPECT_EQ(absolute[1].x(), 0);
  EXPECT_LT(absolute[1].y(), absolute[0].y());
  const Line ramp = curve_of("ramp");
  EXPECT_EQ(ramp[0].y(), ramp[1].y());
  EXPECT_GT(ramp[2].y(), ramp[1].y());
  const Line any = curve_of("function-generator");
  for (std::size_t k = 1; k < any.size(); ++k) EXPECT_GT(any[k].y(), any[k - 1].y());
  const Line wave = curve_of("source");  // one period of a sine
  const double amplitude = wave.at(wave.size() / 4).y();
  EXPECT_GT(amplitude, 0.5);
  for (const Vector2d& p : wave) EXPECT_NEAR(p.y(), -amplitude * std::sin(M_PI * p.x()), kDecimals);
  const Line noise = curve_of("noise");
  for (std::size_t k = 1; k + 1 < noise.size(); ++k) {
    EXPECT_LT(noise[k].y() * noise[k + 1].y(), 0) << k;  // it changes its sign from each to the next
  }
}

// A wire, an arrow that points along it, and a bar at its tip.
TEST(Icons, OfADiodeIsAnArrowAgainstABar) {
  const auto lines = icon_lines("diode");
  ASSERT_EQ(lines.size(), 3U);
  const Line &wire = lines[0], &arrow = lines[1], &bar = lines[2];
  EXPECT_EQ(wire[0], Vector2d(-1, 0));
  EXPECT_EQ(wire[1], Vector2d(1, 0));
  ASSERT_EQ(arrow.size(), 4U);
  EXPECT_EQ(arrow[0], arrow[3]);
  expect_same(bar, mirrored(bar, 1, -1), "diode");
  EXPECT_EQ(arrow[0], Vector2d(arrow[2].x(), -arrow[2].y()));
  EXPECT_EQ(arrow[1].y(), 0);
  EXPECT_GT(arrow[1].x(), arrow[0].x());
  EXPECT_EQ(bar[0].x(), arrow[1].x());
}

// It inverts: high before, low after.
TEST(Icons, OfTheBoundedAmplifierFall) {
  expect_same(curve_of("bounded"), mirrored(curve_of("limiter"), -1, 1), "bounded");
}

// A counter goes up by one and one: steps of one width and one height.
TEST(Icons, OfACounterIsAStairOfEqualSteps) {
  const Line line = curve_of("counter");
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vector2d step = line[k + 1] - line[k];
    EXPECT_LT((step - (k % 2 == 0 ? Vector2d(0.5, 0) : Vector2d(0, 0.5))).norm(), kDecimals) << k;
  }
}

// Out and back on two parallel lines, shifted by the play.
TEST(Icons, OfBacklashIsAParallelogram) {
  const Line line = curve_of("backlash");
  ASSERT_EQ(line.size(), 5U);
  EXPECT_EQ(line.front(), line.back());
  EXPECT_LT((line[2] - line[1] + line[4] - line[3]).norm(), kDecimals);
  EXPECT_EQ(line[0].y(), line[1].y());
  EXPECT_GT(line[2].x(), line[1].x());
}

// It follows a wave up to the moment of storing, drops to what it stored before, and stays there.
TEST(Icons, OfTrackAndStoreFollowsAndHolds) {
  const auto lines = icon_lines("track-and-store");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].back(), lines[1].front());
  for (std::size_t k = 1; k < lines[0].size(); ++k) {
    EXPECT_GT(lines[0][k].x(), lines[0][k - 1].x());
    EXPECT_GE(lines[0][k].y(), lines[0][k - 1].y());
  }
  EXPECT_EQ(lines[1][0].x(), lines[1][1].x());
  EXPECT_EQ(lines[1][2].y(), lines[1][3].y());
}

TEST(Icons, OfContactsHaveAnArmThatLiesOnOneOfTwo) {
  const auto lines = icon_lines("contact");
  ASSERT_EQ(lines.size(), 3U);
  expect_same(lines[1], mirrored({lines[0].rbegin(), lines[0].rend()}, 1, -1), "contact");
  EXPECT_EQ(lines[2][0], Vector2d(1, 0));
  EXPECT_EQ(lines[2][1].y(), 0);
  EXPECT_LT((lines[2][2] - lines[0][1]).norm(), 0.2);  // its tip nearly touches
}

TEST(Icons, OfTurningPartsAreRound) {
  const auto crank = icon_lines("crank"), tap = icon_lines("potentiometer");
  for (const auto& [circle, radius] : {std::pair(crank.at(0), 0.95), std::pair(tap.at(0), 0.7)}) {
    EXPECT_LT((circle.front() - circle.back()).norm(), kDecimals);
    for (const Vector2d& p : circle) EXPECT_NEAR(p.norm(), radius, kDecimals);
  }
  // The crank's arm goes from the centre to the rim, the axle's mark lies about the centre.
  EXPECT_EQ(crank[1][0], Vector2d(0, 0));
  EXPECT_NEAR(crank[1][1].norm(), 0.95, 0.01);
  expect_same(crank[2], mirrored(crank[2], -1, -1), "crank");
  // The tap goes across through the centre, and its head is even about it.
  expect_same(tap.at(1), mirrored(tap[1], -1, -1), "potentiometer");
  ASSERT_EQ(tap.at(2).size(), 3U);
  EXPECT_EQ(tap[2][1], tap[1][1]);
  EXPECT_EQ(tap[2][0], Vector2d(tap[2][2].y(), tap[2][2].x()));
}

TEST(Icons, OfTheResolverIsAVectorWithItsAngle) {
  const auto lines = icon_lines("resolver");
  ASSERT_EQ(lines.size(), 4U);
  const Vector2d origin = lines[0][0], tip = lines[1][1];
  EXPECT_EQ(lines[1][0], origin);
  EXPECT_EQ(lines[0][1].y(), origin.y());
  EXPECT_EQ(lines[2][1], tip);  // the head, its barbs of one length and as far from the shaft
  const Vector2d along = (tip - origin).normalized(), one = lines[2][0] - tip, other = lines[2][2] - tip;
  EXPECT_NEAR(one.norm(), other.norm(), 0.01);
  EXPECT_NEAR(one.dot(along), other.dot(along), 0.06);  // drawn by eye
  EXPECT_LT(one.dot(along), -0.3);
  const Line& angle = lines[3];
  const double radius = (angle.front() - origin).norm();
  for (const Vector2d& p : angle) EXPECT_NEAR((p - origin).norm(), radius, kDecimals);
  EXPECT_NEAR(angle.front().y(), origin.y(), kDecimals);
  const Vector2d last = angle.back() - origin;
  EXPECT_NEAR(std::atan2(last.y(), last.x()), std::atan2(along.y(), along.x()), 0.01);
}

// Two links between three joints, each of which a link's end touches.
TEST(Icons, OfTheDyadAreTwoLinksAndThreeJoints) {
  const auto lines = icon_lines("dyad");
  ASSERT_EQ(lines.size(), 5U);
  for (std::size_t k = 2; k < 5; ++k) {
    const Line& joint = lines[k];
    Vector2d centre = Vector2d::Zero();
    for (std::size_t p = 0; p + 1 < joint.size(); ++p)
      centre += joint[p] / static_cast<double>(joint.size() - 1);
    for (const Vector2d& p : joint) EXPECT_NEAR((p - centre).norm(), 0.18, kDecimals);
  }
  EXPECT_LT(distance_to_nearest(lines[3], lines[0][0]), 0.05);
  EXPECT_LT(distance_to_nearest(lines[2], lines[0][1]), 0.05);
  EXPECT_LT(distance_to_nearest(lines[2], lines[1][0]), 0.05);
  EXPECT_LT(distance_to_nearest(lines[4], lines[1][1]), 0.05);
  const Line triangle = curve_of("triangle");
  ASSERT_EQ(triangle.size(), 4U);
  EXPECT_EQ(triangle.front(), triangle.back());
  EXPECT_EQ(triangle[0], Vector2d(-triangle[2].x(), triangle[2].y()));
  EXPECT_GT(triangle[1].y(), 0.5);
}

}  // namespace
}  // namespace oblique::draw::schematic
