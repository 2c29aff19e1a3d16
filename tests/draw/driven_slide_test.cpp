// SPDX-License-Identifier: MIT
// Driven prismatic joints are seen: in the colour of drives, with an arrow the way they go.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <oblique/draw/animation/animation.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

#include "../support/shipped.h"
#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using test::shipped;

/// A block that is driven along an inclined guide, and the slot of a lever that it turns: two prismatic
/// joints of one point, the driven one first.
mechanism::Mechanism driven_block(const std::string& speed) {
  return mechanism::parse_mechanism(R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
O = [20, 40]
X = [40, 55]
[bodies]
rod   = { points = ["C", "T"], length = 30 }
lever = { points = ["A", "K"], length = 90 }
[slides]
lift = { point = "C", along = ["O", "X"], of = "rod", angle = "90 deg" }
slot = { point = "C", along = ["A", "K"] }
[drives]
push = { slides = "lift", start = 10, speed = )" +
                                        speed + R"( }
[motion]
until = 1
[sketch]
K = [50, 70]
)",
                                    "driven.toml");
}

mechanism::Configuration at(const mechanism::Mechanism& mechanism, double time) {
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  return mechanism::Follower(mechanism, structure).advance(time);
}

draw::Picture picture_at(const mechanism::Mechanism& mechanism, double time) {
  draw::LinkageScene scene;
  scene.shown = at(mechanism, time);
  scene.motion = mechanism::solve_motion(mechanism, 25).configurations;
  return draw::draw_linkage(mechanism, scene);
}

std::size_t place_of(const draw::Picture& picture, const std::string& id) {
  return static_cast<std::size_t>(find_mark(picture, id) - picture.marks.data());
}

/// The direction from a pin to that corner of an arrow which is farthest from it.
Vector2d way_of(const draw::Mark& arrow, const Vector2d& from) {
  Vector2d tip = from;
  for (const draw::Segment& segment : std::get<draw::Outline>(arrow.shape).segments) {
    if (segment.kind != draw::Segment::Kind::close && (segment.to - from).norm() > (tip - from).norm())
      tip = segment.to;
  }
  return (tip - from).normalized();
}

/// The way [px] in which a prismatic joint's point moves along its line just after `time`: the difference of
/// two places, seen from what carries the line.
Vector2d way_along(const mechanism::Mechanism& mechanism, std::size_t slide, double time) {
  constexpr double kSoon = 1e-4;  // [s]
  const mechanism::Slide& s = mechanism.slides[slide];
  const mechanism::Configuration now = at(mechanism, time), soon = at(mechanism, time + kSoon);
  const auto along = [&](const mechanism::Configuration& here) {
    const Vector2d line = (here.points[s.second].position - here.points[s.first].position).normalized();
    return std::pair(line, line.dot(here.points[s.point].position - here.points[s.first].position));
  };
  const auto [line, before] = along(now);
  const Vector2d way = along(soon).second > before ? line : Vector2d(-line);
  return {way.x(), -way.y()};
}

void expect_arrow(const mechanism::Mechanism& mechanism, std::size_t slide, double time) {
  SCOPED_TRACE(time);
  const mechanism::Slide& s = mechanism.slides[slide];
  const draw::Picture picture = picture_at(mechanism, time);
  const draw::Mark* const arrow = find_mark(picture, "arrow-" + s.name);
  ASSERT_NE(arrow, nullptr);
  const Vector2d pin =
      std::get<draw::Disc>(find_mark(picture, "pin-" + mechanism.points[s.point].name)->shape).centre;
  EXPECT_LT((way_of(*arrow, pin) - way_along(mechanism, slide, time)).norm(), 1e-6);
  // beside the block, which is 30 px long, and not far from it
  double nearest = 1e9;
  for (const draw::Segment& segment : std::get<draw::Outline>(arrow->shape).segments) {
    if (segment.kind != draw::Segment::Kind::close) nearest = std::min(nearest, (segment.to - pin).norm());
  }
  EXPECT_GT(nearest, 15);
  EXPECT_LT(nearest, 25);
}

TEST(DrivenSlide, ArrowGoesAsTheDriveDoes) {
  expect_arrow(driven_block("20"), 0, 0);
  expect_arrow(driven_block("-20"), 0, 0);
  expect_arrow(driven_block("20"), 0, 0.4);
  const mechanism::Mechanism tipper =
      shipped("hydraulic-tipper");  // its cylinder turns, and its speed is cos(t/4)/8
  expect_arrow(tipper, 0, 0);
  expect_arrow(tipper, 0, 5);
  expect_arrow(tipper, 0, 8);
  expect_arrow(tipper, 0, 20);
}

TEST(DrivenSlide, SetsOffWhereItRests) {
  const mechanism::Mechanism mechanism = driven_block("\"-30*sin(time)\"");
  const draw::Picture picture = picture_at(mechanism, 0);
  const Vector2d pin = std::get<draw::Disc>(find_mark(picture, "pin-C")->shape).centre;
  EXPECT_LT((way_of(*find_mark(picture, "arrow-lift"), pin) - Vector2d(-0.8, 0.6)).norm(), 1e-9);
}

TEST(DrivenSlide, HasTheColourOfDrivenBodies) {
  const draw::Picture of_crank = picture_at(shipped("slider-crank"), 0);
  const draw::Mark* const crank = find_mark(of_crank, "inside-AB");
  ASSERT_NE(crank, nullptr);
  const draw::Picture picture = picture_at(driven_block("20"), 0);
  for (const char* id : {"slide-lift", "arrow-lift"}) {
    const std::size_t edge = place_of(picture, id);
    const draw::Mark &inside = picture.marks[edge - 1], &paper = picture.marks[edge - 2];
    EXPECT_EQ(inside.fill, crank->fill) << id;
    EXPECT_EQ(inside.opacity, crank->opacity) << id;
    EXPECT_EQ(paper.fill, draw::Ink::paper) << id;  // what lies beneath does not dull the colour
    EXPECT_EQ(paper.opacity, 1) << id;
    EXPECT_EQ(picture.marks[edge].fill, draw::Ink::none) << id;
    for (const draw::Mark* const under : {&inside, &paper}) {
      EXPECT_TRUE(
          draw::extent_of(*under).center().isApprox(draw::extent_of(picture.marks[edge]).center(), 1e-9));
    }
  }
}

TEST(DrivenSlide, PassiveOnesAreAsTheyWere) {
  const draw::Picture picture = picture_at(shipped("slider-crank-offset"), 0);
  for (const draw::Mark& mark : picture.marks) {
    EXPECT_FALSE(mark.id.starts_with("arrow-")) << mark.id;
    if (!mark.id.starts_with("slide-")) continue;
    EXPECT_EQ(mark.fill, draw::Ink::paper) << mark.id;
  }
}

// The block of the slot lies at the same point: it must not hide the driven one.
TEST(DrivenSlide, LiesOverPassiveBlocksAtItsPoint) {
  const draw::Picture picture = picture_at(driven_block("20"), 0);
  EXPECT_EQ(find_mark(picture, "slide-slot")->fill, draw::Ink::paper);
  EXPECT_LT(place_of(picture, "slide-slot"), place_of(picture, "slide-lift") - 2);
  EXPECT_LT(place_of(picture, "arrow-lift"), place_of(picture, "pin-C"));
}

// A block that goes to and fro, x = −90 sin 2πt: the arrow turns with it, in every frame.
TEST(DrivenSlide, ArrowTurnsBackInAnimations) {
  const mechanism::Mechanism mechanism = shipped("elliptical-trammel-by-slide");
  draw::LinkageAnimation animation;
  constexpr int kFrames = 24;
  animation.frames = mechanism::solve_motion(mechanism, kFrames + 1).configurations;
  animation.scene.motion = animation.frames;
  animation.scene.shown = animation.frames.front();
  animation.captions.assign(animation.frames.size(), "block");
  const draw::AnimationFrames frames(mechanism, animation);
  for (std::size_t k = 0; k <= kFrames; ++k) {
    if (k == 6 || k == 18) continue;  // it stands
    const draw::Picture picture = frames.picture(k);
    const Vector2d pin = std::get<draw::Disc>(find_mark(picture, "pin-A")->shape).centre;
    const double right = k > 6 && k < 18 ? 1 : -1;
    EXPECT_LT((way_of(*find_mark(picture, "arrow-across"), pin) - Vector2d(right, 0)).norm(), 1e-6) << k;
  }
}

}  // namespace
}  // namespace oblique::test
