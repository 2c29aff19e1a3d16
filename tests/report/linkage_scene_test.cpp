// SPDX-License-Identifier: MIT
#include <oblique/report/linkage_scene.h>

#include <numbers>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::report {
namespace {

// A four-bar of which nothing turns: its crank swings between the two places at which coupler and rocker lie
// on one line, |BD| = 2 + 2.
TEST(DrawnMotion, GoesFromOneLimitToTheOther) {
  const mechanism::Mechanism swinging = mechanism::parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 3 }
BC = { points = ["B", "C"], length = 2 }
CD = { points = ["C", "D"], length = 2 }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "20 deg" }
[sketch]
C = [3.5, 2]
)",
                                                                   "swinging.toml");
  const DrawnMotion motion = drawn_motion(swinging, mechanism::decompose(swinging), 5);
  EXPECT_TRUE(motion.ends_at_limit);
  ASSERT_EQ(motion.rows.size(), 5U);
  ASSERT_EQ(motion.times.size(), 5U);
  const auto distance = [&](std::size_t row) {
    const auto& points = motion.rows[row].points;
    return (points[*swinging.find_point("B")].position - points[*swinging.find_point("D")].position).norm();
  };
  for (std::size_t row = 0; row < 5; ++row) EXPECT_EQ(motion.rows[row].status, mechanism::Status::ok) << row;
  // It stops a hundred-thousandth of the way before the limit.
  EXPECT_NEAR(distance(0), 4, 1e-3);
  EXPECT_NEAR(distance(4), 4, 1e-3);
  EXPECT_LT(distance(2), 3.5);
  for (const int positions : {2, 3, 6})
    EXPECT_EQ(linkage_scene(swinging, 0, positions).scene.others.size(),
              static_cast<std::size_t>(positions - 1));
}

mechanism::Mechanism crank(const std::string& more) {
  return mechanism::parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)" + more,
                                    "crank.toml");
}

// A turn is gone through once, a quarter of one there and back, with the velocities of the way back.
TEST(DrawnRound, EndsAsItBegins) {
  const DrawnMotion turn = drawn_round(crank(""), 8);
  EXPECT_TRUE(turn.closed);
  EXPECT_EQ(turn.rows.size(), 9U);
  EXPECT_NEAR(turn.times.back(), 2 * std::numbers::pi, 1e-12);  // rounding
  const DrawnMotion quarter = drawn_round(crank("[motion]\nuntil = \"pi/2\"\n"), 8);
  EXPECT_FALSE(quarter.closed);
  ASSERT_EQ(quarter.rows.size(), 9U);
  const std::size_t b = 1;
  for (std::size_t k = 0; k < 9; ++k) {
    const mechanism::PointState &one = quarter.rows[k].points[b], &other = quarter.rows[8 - k].points[b];
    EXPECT_EQ(quarter.times[k], quarter.times[8 - k]);
    EXPECT_EQ(one.position, other.position);
    if (k != 4) {
      EXPECT_EQ(one.velocity, -other.velocity);
    }
  }
  EXPECT_NEAR(quarter.rows[4].points[b].position.y(), 3, 1e-12);  // rounding
}

}  // namespace
}  // namespace oblique::report
