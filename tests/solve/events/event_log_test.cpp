// SPDX-License-Identifier: MIT
#include <oblique/solve/events/event_log.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::solve {
namespace {

using ::testing::SizeIs;

class EventLogOfComparator : public ::testing::Test {
 protected:
  const testing::Compiled made_{
      "x = { type = \"integrator\", in = \"x\" }\nc = { type = \"comparator\", in = \"x\" }\n"};
  const std::string file_ = "d.toml";
  EventLog log_{made_.program, file_};
};

TEST_F(EventLogOfComparator, CountsAllAndKeepsTheFirstThousand) {
  for (int k = 0; k < 1500; ++k) log_.record(k, std::to_string(k));
  EXPECT_EQ(log_.count(), 1500);
  ASSERT_THAT(log_.records(), SizeIs(1000));
  EXPECT_EQ(log_.records().back().what, "999");
  EXPECT_EQ(log_.records().back().time, 999);
}

TEST_F(EventLogOfComparator, TellsWhichWayASwitchTurns) {
  log_.record_turn(0, 1, 0.5);
  log_.record_turn(0, 0, 1.5);
  const std::string name = made_.program.switches()[0].block + ": " + made_.program.switches()[0].comparison;
  ASSERT_THAT(log_.records(), SizeIs(2));
  EXPECT_EQ(log_.records()[0].what, name + " from now on");
  EXPECT_EQ(log_.records()[1].what, name + " no longer");
}

// It may come back ever and ever: the time of the first is told.
TEST_F(EventLogOfComparator, WarnsOfAUnitOnce) {
  log_.warn_of_no_side(0, 0.5);
  log_.warn_of_no_side(0, 0.75);
  ASSERT_THAT(log_.warnings(), SizeIs(1));
  EXPECT_THAT(log_.warnings()[0].what, ::testing::HasSubstr(" at t = 0.5 s"));
}

// What settles in rounds is told of with what it has settled to.
TEST_F(EventLogOfComparator, WarnsOfTheLastOfWhatItSaysAgain) {
  log_.warn({{file_, {}}, "x in a circle: at x = 0.01", {}, {}});
  log_.warn({{file_, {}}, "y in a circle: at y = 2", {}, {}});
  log_.warn({{file_, {}}, "x in a circle: at x = 0", {}, {}});
  ASSERT_THAT(log_.warnings(), SizeIs(2));
  EXPECT_EQ(log_.warnings()[0].what, "x in a circle: at x = 0");
}

TEST_F(EventLogOfComparator, SaysWhatIsEndless) {
  EXPECT_EQ(log_.endless("'c'", "why", 2).kind(), SolveError::Kind::chatter);
  log_.record(1, "c: x");
  EXPECT_THAT(log_.endless("events set each other off", 2).what(),
              ::testing::HasSubstr("'c: x' switches without end at t = 2 s (events set each other off)"));
}

}  // namespace
}  // namespace oblique::solve
