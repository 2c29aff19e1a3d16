// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/read_mechanism.h>

#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "four_bar_file.h"

namespace oblique::mechanism {
namespace {

TEST(MechanismReader, ReadsPointsBodiesDrivesAndSketch) {
  const Mechanism mechanism = parse_mechanism(kFourBar, "four.toml");
  ASSERT_EQ(mechanism.points.size(), 5U);
  EXPECT_EQ(mechanism.points[1].name, "D");
  EXPECT_TRUE(mechanism.points[1].fixed);
  EXPECT_EQ(mechanism.points[1].position, Eigen::Vector2d(4, 0));
  EXPECT_FALSE(mechanism.points[mechanism.find_point("M").value()].fixed);
  ASSERT_EQ(mechanism.bodies.size(), 3U);
  const Body& coupler = mechanism.bodies[mechanism.find_body("BC").value()];
  EXPECT_EQ(coupler.find(mechanism.find_point("C").value())->local, Eigen::Vector2d(3.5, 0));
  EXPECT_EQ(coupler.find(mechanism.find_point("M").value())->local, Eigen::Vector2d(1.75, 1));
  EXPECT_EQ(coupler.place, (text::Place{"four.toml", {9, 1}}));
  ASSERT_EQ(mechanism.drives.size(), 1U);
  EXPECT_EQ(mechanism.drives[0].speed, 1);
  EXPECT_EQ(mechanism.drives[0].about, mechanism.find_point("A"));
  ASSERT_EQ(mechanism.sketch.size(), 1U);
  EXPECT_EQ(mechanism.sketch[0].position, Eigen::Vector2d(3.5, 2.9));
  EXPECT_EQ(mechanism.largest_length(), 3.5);
  EXPECT_FALSE(mechanism.find_point("X"));
}

TEST(MechanismReader, ConvertsQuantitiesToTheUnitOfTheFile) {
  std::string text = with("length = \"m\"", "length = \"mm\"");
  text.replace(text.find("length = 3.5"), 12, "length = \"3 cm\"");
  text.replace(text.find("[4, 0]"), 6, "[\"4 cm\", \"10*sqrt(4)\"]");
  text.replace(text.find("1 rad/s"), 7, "60 rpm");
  text.replace(text.find("0 deg"), 5, "90 deg");
  const Mechanism mechanism = parse_mechanism(text, "four.toml");
  EXPECT_EQ(mechanism.length_unit, "mm");
  // one or two roundings of the conversion factor
  EXPECT_DOUBLE_EQ(mechanism.bodies[1].points[1].local.x(), 30);
  EXPECT_DOUBLE_EQ(mechanism.points[1].position.x(), 40);
  EXPECT_DOUBLE_EQ(mechanism.points[1].position.y(), 20);
  EXPECT_DOUBLE_EQ(mechanism.drives[0].speed, 2 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(mechanism.drives[0].start, std::numbers::pi / 2);
}

TEST(MechanismReader, PutsTheThirdPointOfATriangleOnItsSide) {
  for (const bool left : {true, false}) {
    const Mechanism mechanism =
        parse_mechanism(with(R"(CD = { points = ["C", "D"], length = 3 })",
                             std::string(R"(CD = { points = ["C", "D", "E"], sides = [3, 4, 5], turn = ")") +
                                 (left ? "left" : "right") + "\" }"),
                        "triangle.toml");
    const Body& body = mechanism.bodies[2];
    // |CD| = 3, |DE| = 4, |EC| = 5: a right angle at D
    EXPECT_NEAR(body.points[2].local.x(), 3, 1e-15);
    EXPECT_NEAR(body.points[2].local.y(), left ? 4 : -4, 1e-15);
    EXPECT_NEAR(distance(body, body.points[0].point, body.points[2].point), 5, 1e-15);
  }
}

TEST(MechanismReader, AllowsAFlatTriangle) {
  const Mechanism mechanism =
      parse_mechanism(with(R"(CD = { points = ["C", "D"], length = 3 })",
                           R"(CD = { points = ["C", "D", "E"], sides = [0.1, 0.2, 0.3], turn = "left" })"),
                      "flat.toml");
  EXPECT_NEAR(mechanism.bodies[2].points[2].local.x(), 0.3, 1e-15);
  // 0.1 + 0.2 exceeds 0.3 by 5e-17, which is a height of √(2·0.3·5e-17…) at most
  EXPECT_NEAR(mechanism.bodies[2].points[2].local.y(), 0, 1e-8);
}

TEST(MechanismReader, ReadsAStructureWithoutDrives) {
  EXPECT_TRUE(parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
)",
                              "pendulum.toml")
                  .drives.empty());
}

TEST(MechanismReader, ReadsSlides) {
  std::string text = with("[sketch]", R"([slides]
s = { point = "D", along = ["B", "C"], offset = "10 mm" }
g = { point = "C", along = ["D", "A"], angle = "90 deg", of = "BC" }
[sketch])");
  text.replace(text.find(kCrank), kCrank.size(), R"(crank = { slides = "s", speed = "20 mm/s", start = 2 })");
  const Mechanism mechanism = parse_mechanism(text, "slides.toml");
  ASSERT_EQ(mechanism.slides.size(), 2U);
  const Slide& pin = mechanism.slides[0];
  EXPECT_EQ(mechanism.points[pin.point].name, "D");
  EXPECT_EQ(mechanism.points[pin.first].name, "B");
  EXPECT_EQ(mechanism.points[pin.second].name, "C");
  EXPECT_EQ(pin.carrier, mechanism.find_body("BC"));
  EXPECT_DOUBLE_EQ(pin.offset, 0.01);
  EXPECT_FALSE(pin.of);
  const Slide& guide = mechanism.slides[1];
  EXPECT_FALSE(guide.carrier);
  EXPECT_EQ(guide.of, mechanism.find_body("BC"));
  EXPECT_DOUBLE_EQ(guide.angle, std::numbers::pi / 2);
  EXPECT_EQ(mechanism.drives[0].slide, 0U);
  EXPECT_DOUBLE_EQ(mechanism.drives[0].speed, 0.02);
  EXPECT_EQ(mechanism.drives[0].start, 2);
}

TEST(MechanismReader, GivesBrokenTomlToTheTextStage) {
  EXPECT_THROW(parse_mechanism("format = ", "bad.toml"), text::ReadError);
  EXPECT_THROW(read_mechanism("no-such-file.toml"), text::ReadError);
}

}  // namespace
}  // namespace oblique::mechanism
