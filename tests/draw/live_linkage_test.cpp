// SPDX-License-Identifier: MIT
// A mechanism that is shown live, measured at the numbers of its axes.
#include <oblique/draw/linkage/live_linkage.h>

#include <cmath>

#include <gtest/gtest.h>

#include <oblique/mechanism/motion/motion.h>

#include "../support/shipped.h"
#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;

const draw::Mark* find_in(const std::vector<draw::Mark>& marks, const std::string& id) {
  for (const draw::Mark& mark : marks) {
    if (mark.id == id) return &mark;
  }
  return nullptr;
}

draw::LinkageScene scene_of(const mechanism::Motion& motion) {
  draw::LinkageScene scene;
  scene.motion = motion.configurations;
  scene.shown = motion.configurations.front();
  scene.analog = draw::AnalogOverlay{{}, {}, "analog, its error magnified", {}};
  return scene;
}

TEST(LiveLinkage, PutsPinsWhereTheAxesSayAtEveryMoment) {
  for (const char* const name : {"four-bar", "class-iii", "slider-crank", "jansen"}) {
    const mechanism::Mechanism mechanism = shipped(name);
    const mechanism::Motion motion = mechanism::solve_motion(mechanism, 61);
    const draw::LiveLinkage live(mechanism, scene_of(motion));
    const draw::Picture background = live.background();
    const Reading reading(background.marks);
    const Eigen::AlignedBox<double, 2> paper(Vector2d(0, 0), Vector2d(background.width, background.height));
    for (const mechanism::Configuration& here : motion.configurations) {
      const std::vector<draw::Mark> marks = live.exact(here);
      for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
        const Vector2d& place = here.points[p].position;
        // labels of axes lie at their ticks to a hundredth of a pixel
        EXPECT_LT((live.pixel(place) - reading.pixel(place)).norm(), 0.01);
        EXPECT_LT((live.place(live.pixel(place)) - place).norm(), 1e-12 * mechanism.largest_length());
        const draw::Mark* const pin = find_in(marks, "pin-" + mechanism.points[p].name);
        if (pin == nullptr) continue;
        EXPECT_LT((std::get<draw::Disc>(pin->shape).centre - live.pixel(place)).norm(), 1e-9);
      }
      for (const draw::Mark& mark : marks)
        EXPECT_TRUE(paper.contains(draw::extent_of(mark))) << name << mark.id;
    }
  }
}

TEST(LiveLinkage, DrawsTheAnalogMechanismWhereItIsTold) {
  const mechanism::Mechanism mechanism = shipped("four-bar");
  const mechanism::Motion motion = mechanism::solve_motion(mechanism, 61);
  const draw::LiveLinkage live(mechanism, scene_of(motion));
  std::vector<Vector2d> places;
  for (const mechanism::PointState& point : motion.configurations[7].points)
    places.push_back(point.position + Vector2d(0.1, -0.2));
  const std::size_t c = mechanism.find_point("C").value();
  const std::vector<draw::Mark> drawn = live.analog(places);
  const draw::Mark* const pin = find_in(drawn, "analog-pin-C");
  ASSERT_NE(pin, nullptr);
  EXPECT_LT((std::get<draw::Disc>(pin->shape).centre - live.pixel(places[c])).norm(), 1e-9);
  places[c].x() = std::nan("");
  const std::vector<draw::Mark> fewer = live.analog(places);
  EXPECT_EQ(find_in(fewer, "analog-pin-C"), nullptr);
  EXPECT_EQ(fewer.size(), drawn.size() - 3);  // the pin and the two links that it joins
}

// The connecting rod always lies to the left of the piston: its name stands clear of the rod, all the way.
TEST(LiveLinkage, KeepsTheNameOfAPistonOffItsRod) {
  const mechanism::Mechanism mechanism = shipped("slider-crank");
  const mechanism::Motion motion = mechanism::solve_motion(mechanism, 61);
  const draw::LiveLinkage live(mechanism, scene_of(motion));
  const std::size_t pin = mechanism.find_point("C").value(), crank = mechanism.find_point("B").value();
  for (const mechanism::Configuration& here : motion.configurations) {
    const std::vector<draw::Mark> marks = live.exact(here);
    const draw::Mark* const name = find_in(marks, "name-C");
    ASSERT_NE(name, nullptr);
    const Vector2d from = live.pixel(here.points[crank].position), to = live.pixel(here.points[pin].position);
    for (int k = 0; k <= 100; ++k)
      EXPECT_FALSE(draw::extent_of(*name).contains(Vector2d(from + k / 100.0 * (to - from))));
  }
}

// In two positions half a turn apart the crank leads away from its pin to opposite sides: the name stands
// clear of it, and of the coupler, in both.
TEST(LiveLinkage, KeepsANameOffTheLinksInAShortMotionToo) {
  const mechanism::Mechanism mechanism = shipped("four-bar");
  const mechanism::Motion motion = mechanism::solve_motion(mechanism, 61);
  const std::size_t pin = mechanism.find_point("B").value();
  for (const auto& [first, second] : {std::pair(0U, 30U), {30U, 0U}}) {
    draw::LinkageScene scene = scene_of(motion);
    scene.motion = {motion.configurations[first], motion.configurations[second]};
    const draw::LiveLinkage live(mechanism, scene);
    for (const mechanism::Configuration& here : scene.motion) {
      const std::vector<draw::Mark> marks = live.exact(here);
      const draw::Mark* const name = find_in(marks, "name-B");
      ASSERT_NE(name, nullptr);
      const Vector2d to = live.pixel(here.points[pin].position);
      for (const char* const other : {"A", "C"}) {
        const Vector2d from = live.pixel(here.points[mechanism.find_point(other).value()].position);
        for (int k = 0; k <= 100; ++k)
          EXPECT_FALSE(draw::extent_of(*name).contains(Vector2d(from + k / 100.0 * (to - from)))) << other;
      }
    }
  }
}

}  // namespace
}  // namespace oblique::test
