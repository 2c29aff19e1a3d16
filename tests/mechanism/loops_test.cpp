// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/loops.h>

#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

#include "mechanism_text.h"

namespace oblique::mechanism {
namespace {

TEST(Grashof, NamesTheClassOfFrameInputCouplerAndOutput) {
  EXPECT_EQ(grashof_class({4, 1, 3.5, 3}), GrashofClass::crank_rocker);
  EXPECT_EQ(grashof_class({4, 3, 3.5, 1}), GrashofClass::crank_rocker);
  EXPECT_EQ(grashof_class({1, 3, 3.5, 4}), GrashofClass::double_crank);
  EXPECT_EQ(grashof_class({3.5, 3, 1, 4}), GrashofClass::double_rocker);
  EXPECT_EQ(grashof_class({80, 40, 80, 40}), GrashofClass::change_point);
  EXPECT_EQ(grashof_class({5, 1, 2, 4}), GrashofClass::change_point);
  EXPECT_EQ(grashof_class({100, 60, 70, 80}), GrashofClass::triple_rocker);
}

// What the rule says of the driven link, the motion does.
TEST(Grashof, AgreesWithTheMotionOfRandomFourBars) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> length(1, 5);
  int turning = 0;
  for (int i = 0; i < 300; ++i) {
    const double g = length(random), a = length(random), b = length(random), c = length(random);
    const std::string text = fmt::format(R"([frame]
A = [0, 0]
D = [{}, 0]
[bodies]
AB = {{ points = ["A", "B"], length = {} }}
BC = {{ points = ["B", "C"], length = {} }}
CD = {{ points = ["C", "D"], length = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1, start = "{} rad" }}
[sketch]
C = [0, 100]
)",
                                         g, a, b, c, length(random));
    const Mechanism four = mechanism(text);
    Structure structure;
    try {
      structure = decompose(four);
    } catch (const MechanismError&) {
      continue;  // the links do not reach each other at this start
    }
    const auto loops = four_bar_loops(four, structure);
    ASSERT_EQ(loops.size(), 1U);
    const GrashofClass type = loops[0].type;
    const bool turns = type == GrashofClass::double_crank ||
                       (type == GrashofClass::crank_rocker && loops[0].shortest.front() == 1);
    EXPECT_EQ(turns, !find_range(four, structure).forward) << text;
    turning += turns ? 1 : 0;
  }
  EXPECT_GT(turning, 20);
}

TEST(FourBarLoops, OfJansensLegWithAndWithoutTheFrame) {
  const Mechanism jansen =
      read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/jansen.toml");
  const auto loops = four_bar_loops(jansen, decompose(jansen));
  ASSERT_EQ(loops.size(), 6U);
  EXPECT_EQ(loops[0].type, GrashofClass::crank_rocker);
  EXPECT_FALSE(loops[0].links[0].body);
  EXPECT_DOUBLE_EQ(loops[0].links[1].length, 15);
  EXPECT_EQ(loops[2].type, GrashofClass::grashof);
  EXPECT_EQ(jansen.bodies[loops[2].links[0].body.value()].name, "rod_c");
  EXPECT_EQ(loops[2].shortest.size(), 1U);
  EXPECT_NEAR(loops[2].shortest_and_longest, 36.7 + 40.1, 1e-12);
}

// A five-bar by two drives, and on its coupler BC the loop B–E–F–C, whose links BE and CF its dyad joins:
// class by class.
TEST(FourBarLoops, OnALinkThatMovesKeepTheNamesThatNeedNoFrame) {
  const auto type = [](double be, double ef, double cf) {
    const Mechanism made = mechanism(fmt::format(R"([frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = {{ points = ["A", "B"], length = 1 }}
BC = {{ points = ["B", "C"], length = 3.5 }}
CD = {{ points = ["C", "D"], length = 3 }}
BE = {{ points = ["B", "E"], length = {} }}
EF = {{ points = ["E", "F"], length = {} }}
CF = {{ points = ["C", "F"], length = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1, start = "60 deg" }}
second = {{ turns = "BE", about = "B", speed = 1, start = "90 deg" }}
)",
                                                 be, ef, cf));
    const auto loops = four_bar_loops(made, find_groups(made));
    EXPECT_EQ(loops.size(), 2U);
    return loops.back().type;
  };
  EXPECT_EQ(type(1, 3, 3), GrashofClass::grashof);         // 1 + 3.5 < 3 + 3
  EXPECT_EQ(type(1, 3, 1.5), GrashofClass::change_point);  // 1 + 3.5 = 3 + 1.5
  EXPECT_EQ(type(2, 2, 2), GrashofClass::triple_rocker);   // 2 + 3.5 < 2 + 2 does not hold
}

Mechanism slider_linkage(double r, double l, double offset) {
  return mechanism(fmt::format(R"([frame]
A = [0, 0]
X = [9, 0]
[bodies]
AB = {{ points = ["A", "B"], length = {} }}
BC = {{ points = ["B", "C"], length = {} }}
[slides]
piston = {{ point = "C", along = ["A", "X"], offset = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1, start = "5 deg" }}
[sketch]
C = [9, 0]
)",
                               r, l, offset));
}

SliderLoop::Type type_of(const Mechanism& mechanism) {
  const auto loops = slider_loops(mechanism, find_groups(mechanism));
  return loops.size() == 1 ? loops[0].type : SliderLoop::Type::none_turns;
}

TEST(SliderLoops, SayWhatTurnsOfASliderCrank) {
  EXPECT_EQ(type_of(slider_linkage(1, 3, 1)), SliderLoop::Type::crank_turns);
  EXPECT_EQ(type_of(slider_linkage(1, 3, -1)), SliderLoop::Type::crank_turns);
  EXPECT_EQ(type_of(slider_linkage(1, 3, 2)), SliderLoop::Type::change_point);
  EXPECT_EQ(type_of(slider_linkage(1, 3, 2.5)), SliderLoop::Type::none_turns);
  EXPECT_EQ(type_of(slider_linkage(3, 1, 1)), SliderLoop::Type::rod_turns);
  const Mechanism offset = slider_linkage(1, 3, 1);
  const auto loops = slider_loops(offset, find_groups(offset));
  EXPECT_FALSE(loops.at(0).is_lever);
  EXPECT_EQ(loops.at(0).radius, 1);
  EXPECT_EQ(loops.at(0).length, 3);
  EXPECT_EQ(loops.at(0).offset, 1);
}

// The guide runs in the direction (0.8, 0.6) through (5, 1), and the crank turns about (2, 3): its normal
// (−0.6, 0.8) sees the pivot at −0.6·(2 − 5) + 0.8·(3 − 1) = 3.4.
TEST(SliderLoops, MeasureTheOffsetFromTheGuideWhereverItLies) {
  const Mechanism crank = mechanism(R"([frame]
A = [2, 3]
P = [5, 1]
Q = [9, 4]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 6 }
[slides]
piston = { point = "C", along = ["P", "Q"] }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)");
  const auto loops = slider_loops(crank, find_groups(crank));
  EXPECT_NEAR(loops.at(0).offset, 3.4, 1e-14);  // a few roundings of numbers below 9
  EXPECT_EQ(loops.at(0).type, SliderLoop::Type::crank_turns);
}

// A slotted lever about D over the crank's pin, or a bar at the pin through a sleeve at D.
TEST(SliderLoops, SayWhatTurnsOfASlottedLever) {
  const auto lever = [](double r, double d, double offset) {
    return mechanism(fmt::format(R"([frame]
A = [0, 0]
D = [0, {}]
[bodies]
AB = {{ points = ["A", "B"], length = {} }}
DE = {{ points = ["D", "E"], length = 9 }}
[slides]
slot = {{ point = "B", along = ["D", "E"], offset = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1 }}
)",
                                 -d, r, offset));
  };
  const Mechanism swinging = lever(1, 3, 0);
  EXPECT_TRUE(slider_loops(swinging, find_groups(swinging)).at(0).is_lever);
  EXPECT_EQ(type_of(swinging), SliderLoop::Type::lever_swings);
  EXPECT_EQ(type_of(lever(3, 1, 0)), SliderLoop::Type::lever_turns);
  EXPECT_EQ(type_of(lever(3, 1, 2)), SliderLoop::Type::change_point);
  EXPECT_EQ(type_of(lever(2, 1, 2)), SliderLoop::Type::none_turns);
  EXPECT_EQ(type_of(mechanism(R"([frame]
A = [0, 0]
D = [150, 0]
[bodies]
AB = { points = ["A", "B"], length = 100 }
BP = { points = ["B", "P"], length = 300 }
[slides]
b = { point = "D", along = ["B", "P"] }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)")),
            SliderLoop::Type::lever_swings);
}

}  // namespace
}  // namespace oblique::mechanism
