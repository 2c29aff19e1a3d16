// SPDX-License-Identifier: MIT
// What a motion passes where modes meet: change points, what only looks like one, infinity.
#include <oblique/mechanism/motion/motion.h>

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion_range.h>
#include <oblique/mechanism/structure/structure.h>

#include "../support/tangent.h"

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;
using Kind = MotionEvent::Kind;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

// A deltoid: C lies on the bisector of the crank and the frame, cos(φ/2) + √(4 − sin²(φ/2)) from A, over two
// turns of the crank; at 360° B lies on D.
TEST(Crossing, OfAKitePassesWhereItsPivotsMeet) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [1, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 2 }
DC = { points = ["D", "C"], length = 2 }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "40 deg" }
[sketch]
C = [2, 1.5]
)",
                                              "kite.toml");
  for (const int positions : {91, 721, 10000}) {
    MotionOptions options;
    options.positions = positions;
    options.until = 4 * kPi;
    const Motion motion = solve_motion(mechanism, options);
    ASSERT_EQ(motion.events.size(), 2U) << positions;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(motion.events[k].kind, Kind::change);
      EXPECT_NEAR(motion.events[k].time, 2 * kPi * static_cast<double>(k + 1) - 40 * kDegree, 1e-9);
    }
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const double half = motion.drives[row][0].value / 2;
      const Vector2d c = (std::cos(half) + std::sqrt(4 - std::pow(std::sin(half), 2))) *
                         Vector2d(std::cos(half), std::sin(half));
      // the direction of B → D carries a rounding over their distance, 1e-6 at the least where it is used
      EXPECT_LT((motion.configurations[row].points[3].position - c).norm(), 1e-9) << row;
    }
  }
  EXPECT_EQ(plan_motion_range(mechanism, decompose(mechanism)).changes.size(), 1U);
}

// The same places, whatever the clock: a thousand times faster or slower they are passed at other times.
TEST(Crossing, IsPassedAtAnySpeed) {
  for (const double speed : {1e-3, 1.0, 1e3}) {
    const Mechanism kite = parse_mechanism(fmt::format(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [1, 0]
[bodies]
AB = {{ points = ["A", "B"], length = 1 }}
BC = {{ points = ["B", "C"], length = 2 }}
DC = {{ points = ["D", "C"], length = 2 }}
[drives]
crank = {{ turns = "AB", about = "A", speed = {}, start = "40 deg" }}
[sketch]
C = [2, 1.5]
)",
                                                       speed),
                                           "kite.toml");
    MotionOptions options;
    options.positions = 91;
    options.until = 4 * kPi / speed;
    const Motion motion = solve_motion(kite, options);
    ASSERT_EQ(motion.events.size(), 2U) << speed;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(motion.events[k].kind, Kind::change);
      EXPECT_NEAR(motion.events[k].time * speed, 2 * kPi * static_cast<double>(k + 1) - 40 * kDegree, 1e-9)
          << speed;
    }
    const double half = motion.drives.back()[0].value / 2;
    const double reach = std::cos(half) + std::sqrt(4 - std::pow(std::sin(half), 2));
    // as above
    EXPECT_LT(
        (motion.configurations.back().points[3].position - reach * Vector2d(std::cos(half), std::sin(half)))
            .norm(),
        1e-9)
        << speed;
  }
}

// A rocker that is longer than the parallelogram's by 1e-13 makes it a crank and rocker: C never changes its
// side of B → D, though it comes as near to it as 4e-7.
TEST(Crossing, IsNoneWhereModesOnlyComeNear) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [2, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 2 }
DC = { points = ["D", "C"], length = "1+1e-13" }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "30 deg" }
[sketch]
C = [2.86, 0.5]
)",
                                              "near.toml");
  for (const int positions : {91, 361, 1441}) {
    const Motion motion = solve_motion(mechanism, positions);
    EXPECT_TRUE(motion.events.empty());
    for (const Configuration& here : motion.configurations) {
      const Vector2d b = here.points[2].position, d(2, 0);
      EXPECT_GT(
          (d - b).x() * (here.points[3].position - b).y() - (d - b).y() * (here.points[3].position - b).x(),
          0);
    }
  }
}

// x = 100 tan φ
TEST(Crossing, GoesThroughInfinity) {
  const Mechanism mechanism =
      parse_mechanism("format = \"oblique-mechanism/1\"\n" + std::string(test::kTangent) +
                          "[drives]\ncrank = { turns = \"arm\", about = \"O\", speed = 1 }\n",
                      "tangent.toml");
  for (const int positions : {8, 91, 361, 10000}) {
    const Motion motion = solve_motion(mechanism, positions);
    ASSERT_EQ(motion.events.size(), 2U) << positions;
    EXPECT_EQ(motion.events[0].kind, Kind::infinity);
    EXPECT_NEAR(motion.events[0].time, kPi / 2, 1e-9);
    EXPECT_EQ(motion.events[1].kind, Kind::infinity);
    EXPECT_NEAR(motion.events[1].time, 3 * kPi / 2, 1e-9);
    const std::size_t c = mechanism.find_point("C").value();
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const double t = motion.times[row];
      const bool is_there = std::abs(std::cos(t)) < 1e-9;
      EXPECT_EQ(motion.configurations[row].status, is_there ? Status::open : Status::ok) << t;
      if (is_there) continue;
      const double x = 100 * std::tan(t);
      EXPECT_NEAR(motion.configurations[row].points[c].position.y(), x, 1e-13 * (100 + x * x)) << t;
    }
  }
  MotionOptions options;
  options.at_limit = AtLimit::stop;
  const Motion stopped = solve_motion(mechanism, options);
  EXPECT_NEAR(stopped.times.back(), kPi / 2 - 1e-3, 1e-9);
  EXPECT_EQ(stopped.configurations.back().status, Status::ok);
  const MotionRange motion_range = plan_motion_range(mechanism, decompose(mechanism));
  ASSERT_TRUE(motion_range.range.forward && motion_range.range.backward);
  EXPECT_EQ(motion_range.range.forward->kind, Kind::infinity);
  EXPECT_NEAR(motion_range.range.backward->time, -kPi / 2, 1e-9);
}

}  // namespace
}  // namespace oblique::mechanism
