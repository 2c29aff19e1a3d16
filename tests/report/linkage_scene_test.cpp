// SPDX-License-Identifier: MIT
#include <oblique/report/linkage_scene.h>

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
}

}  // namespace
}  // namespace oblique::report
