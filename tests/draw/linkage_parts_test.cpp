// SPDX-License-Identifier: MIT
// The parts that mechanisms are drawn of, each in a frame of its own [px], y down.
#include <oblique/draw/linkage/linkage_parts.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

#include "../support/shipped.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using test::shipped;
using Carrier = draw::LinkagePart::Carrier;

constexpr double kScale = 2;  // px a millimetre

std::vector<draw::LinkagePart> parts_of(const mechanism::Mechanism& mechanism) {
  // Every third of a degree: the ends of a stroke are met within 10⁻⁵ of the crank's length.
  return draw::linkage_parts(mechanism, mechanism::solve_motion(mechanism, 1081).configurations, kScale);
}

const draw::LinkagePart& part_of(const std::vector<draw::LinkagePart>& parts, Carrier carrier) {
  const auto found = std::find_if(parts.begin(), parts.end(),
                                  [&](const draw::LinkagePart& part) { return part.carrier == carrier; });
  EXPECT_NE(found, parts.end());
  return *found;
}

std::vector<Vector2d> corners_of_part(const draw::Mark& mark) {
  std::vector<Vector2d> corners;
  for (const draw::Segment& segment : std::get<draw::Outline>(mark.shape).segments) {
    if (segment.kind != draw::Segment::Kind::close) corners.push_back(segment.to);
  }
  return corners;
}

// The piston comes to rest at √((l+r)² − e²) and at √((l−r)² − e²) from the bearing, l = 150, r = 50, e = 40.
TEST(LinkageParts, GuideReachesAsFarBeyondBothEndsOfTheStroke) {
  const auto parts = parts_of(shipped("slider-crank-offset"));
  const draw::LinkagePart& guide = part_of(parts, Carrier::guide);
  const double near = kScale * std::sqrt(100 * 100 - 40 * 40), far = kScale * std::sqrt(200 * 200 - 40 * 40);
  const std::vector<Vector2d> line = corners_of_part(guide.marks.at(0)),
                              ground = corners_of_part(guide.marks.at(1));
  ASSERT_EQ(line.size(), 2U);
  const double overhang = near - line[0].x();
  EXPECT_GT(overhang, 15);  // half a block
  EXPECT_NEAR(line[1].x(), far + overhang, 1e-3);
  EXPECT_EQ(line[0].y(), -40 * kScale);  // up
  EXPECT_EQ(line[1].y(), -40 * kScale);
  // The ground is as long, under the block.
  EXPECT_EQ(ground[0].x(), line[0].x());
  EXPECT_EQ(ground[1].x(), line[1].x());
  const Eigen::AlignedBox<double, 2> block = draw::extent_of(part_of(parts, Carrier::slide).marks.at(0));
  EXPECT_GE(ground[0].y(), line[0].y() + block.max().y() - 1);
  EXPECT_LT(ground[0].y(), line[0].y() + block.max().y() + 2);
}

TEST(LinkageParts, GroundIsHatchedAllAlongOnItsLowerSide) {
  const auto parts = parts_of(shipped("slider-crank-offset"));
  for (const draw::LinkagePart& part : parts) {
    if (part.carrier != Carrier::guide && part.carrier != Carrier::frame) continue;
    const auto ground = corners_of_part(part.marks.at(1)), strokes = corners_of_part(part.marks.at(2));
    ASSERT_GE(strokes.size(), 8U);
    ASSERT_EQ(strokes.size() % 2, 0U);
    const double pitch = strokes[2].x() - strokes[0].x();
    EXPECT_NEAR(strokes[0].x(), ground[0].x() + pitch, 1e-9);
    EXPECT_GT(strokes.back().x() + 2 * pitch, ground[1].x());
    for (std::size_t k = 0; k < strokes.size(); k += 2) {
      EXPECT_NEAR(strokes[k].x(), strokes[0].x() + pitch * static_cast<double>(k / 2), 1e-9);
      EXPECT_EQ(strokes[k].y(), ground[0].y());
      EXPECT_LE(strokes[k].x(), ground[1].x() + 1e-6);
      EXPECT_GE(strokes[k + 1].x(), ground[0].x() - 1e-9);
      EXPECT_LT(strokes[k + 1].x(), strokes[k].x());
      EXPECT_GT(strokes[k + 1].y(), strokes[k].y());
    }
  }
}

TEST(LinkageParts, SupportIsATriangleUnderItsPin) {
  const auto parts = parts_of(shipped("four-bar"));
  const draw::LinkagePart& support = part_of(parts, Carrier::frame);
  const auto corners = corners_of_part(support.marks.at(0)), ground = corners_of_part(support.marks.at(1));
  ASSERT_EQ(corners.size(), 3U);
  EXPECT_EQ(corners[0], Vector2d(0, 0));
  EXPECT_EQ(corners[1], Vector2d(-corners[2].x(), corners[2].y()));
  EXPECT_GT(corners[2].x(), 0);
  EXPECT_GT(corners[2].y(), 0);
  EXPECT_EQ(ground[0], Vector2d(-ground[1].x(), corners[1].y()));
  EXPECT_EQ(ground[1].y(), corners[1].y());
  EXPECT_GT(ground[1].x(), corners[2].x());
}

// The pin of a crank slides beside a lever of 50, 10 to 30 from its bearing: the line of the slide is as long
// as the lever, on its left, and goes an overhang beyond the nearer end.
TEST(LinkageParts, TheLineOfASlideOnALinkReachesItsEnds) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(R"toml(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [20, 0]
[bodies]
AB = { points = ["A", "B"], length = 10 }
lever = { points = ["D", "S"], length = 50 }
[slides]
slot = { point = "B", along = ["D", "S"], offset = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
S = [-30, 5]
)toml",
                                                                    "m.toml");
  const auto parts = parts_of(mechanism);
  const auto lever = std::find_if(parts.begin(), parts.end(), [](const draw::LinkagePart& part) {
    return part.carrier == Carrier::body && part.index == 1;
  });
  ASSERT_NE(lever, parts.end());
  const std::vector<Vector2d> line = corners_of_part(lever->marks.at(0));
  ASSERT_EQ(line.size(), 2U);
  EXPECT_DOUBLE_EQ(line[0].y(), -3 * kScale);
  EXPECT_DOUBLE_EQ(line[1].y(), -3 * kScale);
  EXPECT_LE(line[0].x(), 0);
  EXPECT_DOUBLE_EQ(line[1].x(), 50 * kScale);
}

// A link is a plate by its form, however small it is: one of 10 µm, given in metres.
TEST(LinkageParts, ASmallPlateIsAPlate) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(R"toml(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
ABC = { points = ["A", "B"], length = 1e-5, marks = { C = [0.5e-5, 0.5e-5] } }
AD = { points = ["A", "D"], length = 1e-5, marks = { E = [0.5e-5, 0] } }
[drives]
crank = { turns = "ABC", about = "A", speed = 1 }
other = { turns = "AD", about = "A", speed = 1 }
)toml",
                                                                    "m.toml");
  std::vector<std::vector<std::string>> marks;  // of each part of a link
  for (const draw::LinkagePart& part :
       draw::linkage_parts(mechanism, mechanism::solve_motion(mechanism, 3).configurations, kScale * 1e7)) {
    if (part.carrier != Carrier::body) continue;
    std::vector<std::string>& ids = marks.emplace_back();
    for (const draw::Mark& mark : part.marks) ids.push_back(mark.id);
  }
  using Ids = std::vector<std::string>;  // what is inside a plate lies under all else
  EXPECT_THAT(marks, ::testing::UnorderedElementsAre(Ids{"inside-ABC"}, Ids{"body-ABC"},
                                                     Ids{"inside-AD", "body-AD"}));
}

}  // namespace
}  // namespace oblique::test
