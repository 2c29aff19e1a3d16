// SPDX-License-Identifier: MIT
#include <oblique/draw/animation/animation.h>

#include <cstdlib>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/animation/animated_page.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

#include "../support/shipped.h"
#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using test::shipped;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kFrames = 12;

draw::LinkageAnimation animation_of(const mechanism::Mechanism& mechanism) {
  draw::LinkageAnimation animation;
  animation.frames = mechanism::solve_motion(mechanism, kFrames + 1).configurations;
  animation.scene.motion = mechanism::solve_motion(mechanism, 121).configurations;
  animation.scene.shown = animation.frames.front();
  animation.scene.traces = draw::points_to_trace(mechanism);
  animation.captions.assign(animation.frames.size(), "crank");
  animation.duration = 2.5;
  return animation;
}

std::vector<double> numbers_of(std::string text) {
  for (char& c : text) c = c == ';' || c == ',' ? ' ' : c;
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (double number = 0; stream >> number;) numbers.push_back(number);
  return numbers;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Where the pin of a point stands in the pictures of the frames, one after the other.
std::vector<Vector2d> pins_in_pictures(const mechanism::Mechanism& mechanism,
                                       const draw::LinkageAnimation& animation, const std::string& point) {
  std::vector<Vector2d> pins;
  for (const mechanism::Configuration& frame : animation.frames) {
    draw::LinkageScene scene = animation.scene;
    scene.shown = frame;
    pins.push_back(
        std::get<draw::Disc>(find_mark(draw::draw_linkage(mechanism, scene), "pin-" + point)->shape).centre);
  }
  return pins;
}

// Numbers are written to a hundredth: half of that in x and in y.
constexpr double kRounding = 0.0075;

TEST(AnimatedSvg, MovesPinsThroughTheFrames) {
  const mechanism::Mechanism mechanism = shipped("four-bar");
  const draw::LinkageAnimation animation = animation_of(mechanism);
  const std::string svg = draw::animated_svg(mechanism, animation, draw::Theme::automatic);
  const std::regex pattern(
      R"rx(type="translate" dur="2.5s" repeatCount="indefinite" values="([^"]*)"/>\n<circle id="pin-C")rx");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, pattern));
  const std::vector<double> values = numbers_of(match[1]);
  const std::vector<Vector2d> pins = pins_in_pictures(mechanism, animation, "C");
  ASSERT_EQ(values.size(), 2 * pins.size());
  for (std::size_t k = 0; k < pins.size(); ++k)
    EXPECT_LT((Vector2d(values[2 * k], values[2 * k + 1]) - pins[k]).norm(), kRounding);
}

// A link is shifted with its first point, and turned about it so that its second point lies where it is.
TEST(AnimatedSvg, TurnsBodiesWithTheirAngles) {
  const mechanism::Mechanism mechanism = shipped("four-bar");
  const draw::LinkageAnimation animation = animation_of(mechanism);
  const std::string svg = draw::animated_svg(mechanism, animation, draw::Theme::automatic);
  const std::size_t body = svg.find("id=\"body-" + mechanism.bodies[1].name + "\"");
  ASSERT_NE(body, std::string::npos);
  const std::size_t turn = svg.rfind("type=\"rotate\"", body), begin = svg.find("values=\"", turn) + 8;
  const std::vector<double> values = numbers_of(svg.substr(begin, svg.find('"', begin) - begin));
  ASSERT_EQ(values.size(), animation.frames.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto& points = mechanism.bodies[1].points;
    const Vector2d way = animation.frames[k].points[points[1].point].position -
                         animation.frames[k].points[points[0].point].position;
    EXPECT_NEAR(std::remainder(values[k] + std::atan2(way.y(), way.x()) * 180 / M_PI, 360), 0, 1e-3);
  }
}

TEST(AnimatedSvg, ClosesWhatItOpens) {
  for (const char* name : {"jansen", "scotch-yoke", "three-bar"}) {
    const mechanism::Mechanism mechanism = shipped(name);
    const std::string svg = draw::animated_svg(mechanism, animation_of(mechanism), draw::Theme::dark);
    EXPECT_EQ(occurrences(svg, "<g"), occurrences(svg, "</g>")) << name;
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    EXPECT_EQ(svg, draw::animated_svg(mechanism, animation_of(mechanism), draw::Theme::dark));
  }
}

TEST(AnimatedPage, HasTheFramesAndNothingFromElsewhere) {
  mechanism::Mechanism mechanism = shipped("four-bar");
  mechanism.title = "</title><script>";
  const draw::LinkageAnimation animation = animation_of(mechanism);
  const std::string page = draw::animated_page(mechanism, animation, draw::Theme::automatic);
  EXPECT_THAT(page, Not(HasSubstr("</title><script>")));
  EXPECT_THAT(page, HasSubstr("<input id=\"place\" type=\"range\""));
  EXPECT_THAT(page, HasSubstr("const duration = 2.5;"));
  EXPECT_EQ(occurrences(page, "http"), 1U);  // the name of SVG itself
  EXPECT_EQ(occurrences(page, "<script>"), 1U);
  const std::size_t begin = page.find("const motions = [") + 17;
  const std::string motions = page.substr(begin, page.find("];", begin) - begin);
  EXPECT_EQ(occurrences(motions, "["), occurrences(page, "data-moves=\"\""));
  const std::string first = motions.substr(1, motions.find(']') - 1);  // of the first link
  EXPECT_EQ(numbers_of(first).size(), 3U * (kFrames + 1));
}

}  // namespace
}  // namespace oblique::test
