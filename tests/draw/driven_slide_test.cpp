// SPDX-License-Identifier: MIT
// Driven slides are seen: in the colour of drives, with an arrow the way they go.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <oblique/draw/animation.h>
#include <oblique/mechanism/follower.h>
#include <oblique/mechanism/motion.h>
#include <oblique/mechanism/read_mechanism.h>

#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;

Mechanism shipped(const std::string& name) {
  return read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name + ".toml");
}

/// A block that is driven along an inclined guide, and the slot of a lever that it turns: two slides of one
/// point, the driven one first.
Mechanism driven_block(const std::string& speed) {
  return parse_mechanism(R"(
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

Configuration at(const Mechanism& mechanism, double time) {
  const Structure structure = decompose(mechanism);
  return Follower(mechanism, structure).advance(time);
}

Picture picture_at(const Mechanism& mechanism, double time) {
  LinkageScene scene;
  scene.shown = at(mechanism, time);
  scene.motion = solve_motion(mechanism, 25).configurations;
  return draw_linkage(mechanism, scene);
}

std::size_t place_of(const Picture& picture, const std::string& id) {
  return static_cast<std::size_t>(find_mark(picture, id) - picture.marks.data());
}

/// The direction from a pin to that corner of an arrow which is farthest from it.
Vector2d way_of(const Mark& arrow, const Vector2d& from) {
  Vector2d tip = from;
  for (const Segment& segment : std::get<Outline>(arrow.shape).segments) {
    if (segment.kind != Segment::Kind::close && (segment.to - from).norm() > (tip - from).norm())
      tip = segment.to;
  }
  return (tip - from).normalized();
}

/// The way [px] in which a slide's point moves along its line just after `time`: the difference of two
/// places, seen from what carries the line.
Vector2d way_along(const Mechanism& mechanism, std::size_t slide, double time) {
  constexpr double kSoon = 1e-4;  // [s]
  const Slide& s = mechanism.slides[slide];
  const Configuration now = at(mechanism, time), soon = at(mechanism, time + kSoon);
  const auto along = [&](const Configuration& here) {
    const Vector2d line = (here.points[s.second].position - here.points[s.first].position).normalized();
    return std::pair(line, line.dot(here.points[s.point].position - here.points[s.first].position));
  };
  const auto [line, before] = along(now);
  const Vector2d way = along(soon).second > before ? line : Vector2d(-line);
  return {way.x(), -way.y()};
}

void expect_arrow(const Mechanism& mechanism, std::size_t slide, double time) {
  SCOPED_TRACE(time);
  const Slide& s = mechanism.slides[slide];
  const Picture picture = picture_at(mechanism, time);
  const Mark* const arrow = find_mark(picture, "arrow-" + s.name);
  ASSERT_NE(arrow, nullptr);
  const Vector2d pin =
      std::get<Disc>(find_mark(picture, "pin-" + mechanism.points[s.point].name)->shape).centre;
  EXPECT_LT((way_of(*arrow, pin) - way_along(mechanism, slide, time)).norm(), 1e-6);
  // beside the block, which is 30 px long, and not far from it
  double nearest = 1e9;
  for (const Segment& segment : std::get<Outline>(arrow->shape).segments) {
    if (segment.kind != Segment::Kind::close) nearest = std::min(nearest, (segment.to - pin).norm());
  }
  EXPECT_GT(nearest, 15);
  EXPECT_LT(nearest, 25);
}

TEST(DrivenSlide, ArrowGoesAsTheDriveDoes) {
  expect_arrow(driven_block("20"), 0, 0);
  expect_arrow(driven_block("-20"), 0, 0);
  expect_arrow(driven_block("20"), 0, 0.4);
  const Mechanism tipper = shipped("hydraulic-tipper");  // its cylinder turns, and its speed is cos(t/4)/8
  expect_arrow(tipper, 0, 0);
  expect_arrow(tipper, 0, 5);
  expect_arrow(tipper, 0, 8);
  expect_arrow(tipper, 0, 20);
}

TEST(DrivenSlide, SetsOffWhereItRests) {
  const Mechanism mechanism = driven_block("\"-30*sin(time)\"");
  const Picture picture = picture_at(mechanism, 0);
  const Vector2d pin = std::get<Disc>(find_mark(picture, "pin-C")->shape).centre;
  EXPECT_LT((way_of(*find_mark(picture, "arrow-lift"), pin) - Vector2d(-0.8, 0.6)).norm(), 1e-9);
}

TEST(DrivenSlide, HasTheColourOfDrivenBodies) {
  const Picture of_crank = picture_at(shipped("slider-crank"), 0);
  const Mark* const crank = find_mark(of_crank, "inside-AB");
  ASSERT_NE(crank, nullptr);
  const Picture picture = picture_at(driven_block("20"), 0);
  for (const char* id : {"slide-lift", "arrow-lift"}) {
    const std::size_t edge = place_of(picture, id);
    const Mark &inside = picture.marks[edge - 1], &paper = picture.marks[edge - 2];
    EXPECT_EQ(inside.fill, crank->fill) << id;
    EXPECT_EQ(inside.opacity, crank->opacity) << id;
    EXPECT_EQ(paper.fill, Ink::paper) << id;  // what lies beneath does not dull the colour
    EXPECT_EQ(paper.opacity, 1) << id;
    EXPECT_EQ(picture.marks[edge].fill, Ink::none) << id;
    for (const Mark* const under : {&inside, &paper}) {
      EXPECT_TRUE(extent_of(*under).center().isApprox(extent_of(picture.marks[edge]).center(), 1e-9));
    }
  }
}

TEST(DrivenSlide, PassiveOnesAreAsTheyWere) {
  const Picture picture = picture_at(shipped("slider-crank-offset"), 0);
  for (const Mark& mark : picture.marks) {
    EXPECT_FALSE(mark.id.starts_with("arrow-")) << mark.id;
    if (!mark.id.starts_with("slide-")) continue;
    EXPECT_EQ(mark.fill, Ink::paper) << mark.id;
  }
}

// The block of the slot lies at the same point: it must not hide the driven one.
TEST(DrivenSlide, LiesOverPassiveBlocksAtItsPoint) {
  const Picture picture = picture_at(driven_block("20"), 0);
  EXPECT_EQ(find_mark(picture, "slide-slot")->fill, Ink::paper);
  EXPECT_LT(place_of(picture, "slide-slot"), place_of(picture, "slide-lift") - 2);
  EXPECT_LT(place_of(picture, "arrow-lift"), place_of(picture, "pin-C"));
}

// A block that goes to and fro, x = −90 sin 2πt: the arrow turns with it, in every frame.
TEST(DrivenSlide, ArrowTurnsBackInAnimations) {
  const Mechanism mechanism = shipped("elliptical-trammel-by-slide");
  LinkageAnimation animation;
  constexpr int kFrames = 24;
  animation.frames = solve_motion(mechanism, kFrames + 1).configurations;
  animation.scene.motion = animation.frames;
  animation.scene.shown = animation.frames.front();
  animation.captions.assign(animation.frames.size(), "block");
  const AnimationFrames frames(mechanism, animation);
  for (std::size_t k = 0; k <= kFrames; ++k) {
    if (k == 6 || k == 18) continue;  // it stands
    const Picture picture = frames.picture(k);
    const Vector2d pin = std::get<Disc>(find_mark(picture, "pin-A")->shape).centre;
    const double right = k > 6 && k < 18 ? 1 : -1;
    EXPECT_LT((way_of(*find_mark(picture, "arrow-across"), pin) - Vector2d(right, 0)).norm(), 1e-6) << k;
  }
}

}  // namespace
}  // namespace oblique::test
