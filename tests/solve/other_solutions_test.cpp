// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/other_solutions.h>

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;

/// A program with one loop, of one unknown, in which nothing chooses; how its starts end is up to each test.
const network::Program& blind_loop() {
  static const Compiled made("y = { type = \"cosine\", in = \"3*y\" }\n");
  return made.program;
}

StartOutcome at(double y, bool runs_away = false) {
  return {{y}, {y}, {runs_away}};
}

/// All points at which a start of the loop itself is tried, where none but the guess has a solution.
std::set<double> points_tried() {
  std::set<double> points;
  const auto start = [&](const LoopStart& from) -> StartAttempt {
    if (!from.loop) return {at(0)};
    points.insert(from.unknowns.at(0));
    return {};
  };
  EXPECT_TRUE(choose_start(blind_loop(), 0, "d.toml", start).warnings.empty());
  return points;
}

// The page on runs says: 24 points within ±3 machine units.
TEST(OtherSolutions, AreSoughtFromAsManyPointsAsIsSaid) {
  const std::set<double> points = points_tried();
  EXPECT_EQ(points.size(), 24U);
  EXPECT_GE(*points.begin(), -3);
  EXPECT_LE(*points.rbegin(), 3);
}

TEST(OtherSolutions, AreToldWhicheverPointFindsOne) {
  for (const double point : points_tried()) {
    const auto start = [&](const LoopStart& from) -> StartAttempt {
      if (!from.loop) return {at(0.25)};
      return from.unknowns.at(0) == point ? StartAttempt{at(-0.75)} : StartAttempt{};
    };
    const StartChoice choice = choose_start(blind_loop(), 2, "d.toml", start);
    EXPECT_FALSE(choice.from.loop);
    ASSERT_EQ(choice.warnings.size(), 1U) << point;
    EXPECT_EQ(choice.warnings[0].what,
              "the algebraic loop of 'y' has several solutions: at t = 2 s the run begins with y = 0.25, and "
              "-0.75 is "
              "another; nothing in the diagram chooses between them");
  }
}

TEST(OtherSolutions, AreNotTheSameOneNorBeyondTheReach) {
  for (const double other : {0.25, 0.25 + 1e-6, 3.5}) {
    const auto start = [&](const LoopStart& from) { return StartAttempt{at(from.loop ? other : 0.25)}; };
    EXPECT_TRUE(choose_start(blind_loop(), 0, "d.toml", start).warnings.empty()) << other;
  }
}

// Where the run begins beyond them another one there is as near.
TEST(OtherSolutions, AreToldBeyondTheReachOfOneThatIsItself) {
  const auto start = [&](const LoopStart& from) { return StartAttempt{at(from.loop ? -8 : 8)}; };
  EXPECT_EQ(choose_start(blind_loop(), 0, "d.toml", start).warnings.size(), 1U);
}

// What the elements leave is no start while there is another, from wherever the loops have gone to that.
TEST(OtherSolutions, GiveTheStartWhereTheElementsWouldLeaveTheOneOfTheGuesses) {
  for (const bool every : {false, true}) {
    const auto start = [&](const LoopStart& from) {
      const bool stays = !every && from.loop && from.goes && from.unknowns.at(0) > 0;
      return StartAttempt{stays ? at(1) : at(0, true)};
    };
    const StartChoice choice = choose_start(blind_loop(), 0, "d.toml", start);
    EXPECT_EQ(choice.from.loop.has_value(), !every);
    EXPECT_TRUE(choice.from.goes);
    EXPECT_EQ(choice.warnings.size(), every ? 0U : 1U);
  }
}

// A start in which loops fail all the way may take a second; refusals are not to take a minute.
TEST(OtherSolutions, AreSoughtFromFewerPointsWhereStartsTakeVeryManyEvaluations) {
  for (const bool found : {true, false}) {
    int starts = 0;
    const auto start = [&](const LoopStart& from) -> StartAttempt {
      ++starts;
      return found && !from.loop ? StartAttempt{at(0.25), 100'000} : StartAttempt{{}, 100'000};
    };
    choose_start(blind_loop(), 0, "d.toml", start);
    EXPECT_EQ(starts, 3) << found;  // 300 000 for each loop
  }
}

// Where the guesses lead to none, the first point that leads to one is what the run is to start from.
TEST(OtherSolutions, GiveTheStartWhereTheGuessesGiveNone) {
  for (const double point : points_tried()) {
    const auto start = [&](const LoopStart& from) -> StartAttempt {
      return from.loop && from.unknowns.at(0) == point ? StartAttempt{at(1)} : StartAttempt{};
    };
    const StartChoice choice = choose_start(blind_loop(), 0, "d.toml", start);
    EXPECT_TRUE(choice.warnings.empty());
    EXPECT_EQ(choice.from.unknowns, std::vector<double>{point});
    EXPECT_TRUE(choice.from.goes);
  }
  const auto none = [](const LoopStart&) -> StartAttempt { return {}; };
  EXPECT_FALSE(choose_start(blind_loop(), 0, "d.toml", none).from.loop);
}

}  // namespace
}  // namespace oblique::solve
