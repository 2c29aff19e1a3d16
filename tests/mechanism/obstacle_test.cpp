// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/obstacle.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

/// Crank 1 on a frame of 4: |BD|² = 17 − 8 cos φ goes from 3 at 0° to 5 at 180°.
Mechanism four_bar(double coupler, double rocker, double start, const std::string& sketch = "[2.5, 2]") {
  return parse_mechanism(fmt::format(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = {{ points = ["A", "B"], length = 1 }}
BC = {{ points = ["B", "C"], length = {} }}
CD = {{ points = ["C", "D"], length = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1, start = "{} deg" }}
[sketch]
C = {}
)",
                                     coupler, rocker, start, sketch),
                         "four.toml");
}

std::optional<Obstacle> obstacle_of(const Mechanism& mechanism) {
  return find_obstacle(mechanism, decompose(mechanism));
}

// The links reach 5 with an excess that may be negative: then they open about 180°, for 0.18° of the crank at
// −4e-6 and for a ten-millionth of a turn at −1e-12, wherever the positions of a coarse search fall.
TEST(Obstacle, IsFoundBetweenPositionsHoweverShort) {
  for (const double start : {0.0, 0.25, 0.5, 77.1, 179.99, 250.3}) {
    for (const double size : {1e-2, 1e-5, 4e-6, 1e-8, 1e-10, 1e-12}) {
      EXPECT_FALSE(obstacle_of(four_bar(2.5, 2.5 + size, start))) << start << " " << size;
      if (start == 179.99 && size == 1e-2) continue;  // the start itself is open
      const auto found = obstacle_of(four_bar(2.5, 2.5 - size, start > 179 ? 90 : start));
      ASSERT_TRUE(found) << start << " " << size;
      EXPECT_EQ(found->group, 1U);
      const double angle = found->time + (start > 179 ? 90 : start) * std::numbers::pi / 180;
      const double limit = (17 - (5 - size) * (5 - size)) / 8;  // cos φ where it opens
      // the limit is told to 1e-11 rad; flat within 32 ε of 5 counts as a dead centre, 1e-14 more of |BD|
      EXPECT_LE(std::cos(angle), limit + 1e-11) << start << " " << size;
      // the two folds lie √(10 size) rad apart: that each is one, and not only a place without a next step,
      // is proven
      const Mechanism open = four_bar(2.5, 2.5 - size, start > 179 ? 90 : start);
      const auto range = find_range(open, decompose(open));
      for (const auto& end : {range.forward, range.backward}) {
        ASSERT_TRUE(end) << start << " " << size;
        EXPECT_EQ(end->kind, MotionEvent::Kind::limit) << start << " " << size;
      }
    }
  }
}

TEST(Obstacle, IsADeadCentreThatIsOnlyTouched) {
  for (const double start : {0.0, 0.25, 10.1, 33.3}) {
    const auto outer = obstacle_of(four_bar(2.5, 2.5, start));
    ASSERT_TRUE(outer) << start;
    EXPECT_EQ(outer->status, Status::dead_centre);
    // flat within 32 ε of 5, 3.6e-14: |BD| = 5 − 0.4 τ² comes so near within τ = 3e-7
    EXPECT_NEAR(outer->time, (180 - start) * std::numbers::pi / 180, 4e-7);
  }
  const auto inner = obstacle_of(four_bar(5, 2, 90.25, "[2.5, 1]"));  // 5 − 2 is the least |BD|, at 360°
  ASSERT_TRUE(inner);
  EXPECT_EQ(inner->status, Status::dead_centre);
  EXPECT_NEAR(inner->time, 269.75 * std::numbers::pi / 180, 4e-7);
  EXPECT_FALSE(obstacle_of(four_bar(5, 2 + 1e-9, 90.25, "[2.5, 1]")));
}

TEST(Obstacle, IsNoneForAGrashofLinkage) {
  EXPECT_FALSE(obstacle_of(four_bar(3.5, 3, 0)));
}

TEST(Obstacle, NeedsADrive) {
  Mechanism mechanism = four_bar(3.5, 3, 0);
  const Structure structure = decompose(mechanism);
  mechanism.drives.clear();
  EXPECT_THROW(find_obstacle(mechanism, structure), MechanismError);
}

}  // namespace
}  // namespace oblique::mechanism
