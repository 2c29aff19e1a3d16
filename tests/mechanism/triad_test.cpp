// SPDX-License-Identifier: MIT
// Cases whose poses are known. Random ones stand in random_triad_test.cpp.
#include <oblique/mechanism/triad/triad.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "triad_scan.h"

namespace oblique::mechanism {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Leg circle(const Vector2d& local, const Vector2d& anchor, double length) {
  return {Leg::Kind::circle, local, anchor, Vector2d::UnitX(), length};
}

Leg fixed_line(const Vector2d& local, const Vector2d& anchor, double angle) {
  return {Leg::Kind::fixed_line, local, anchor, {std::cos(angle), std::sin(angle)}, 0};
}

Leg platform_line(const Vector2d& local, const Vector2d& anchor, double angle) {
  return {Leg::Kind::platform_line, local, anchor, {std::cos(angle), std::sin(angle)}, 0};
}

const Leg kUpright{Leg::Kind::fixed_line, {0, 0}, {0, 0}, {0, 1}, 0};
const Leg kLevel{Leg::Kind::fixed_line, {0, 0}, {0, 0}, {1, 0}, 0};

double angle(const PlatformPose& pose) {
  return std::atan2(pose.sine, pose.cosine);
}

std::vector<double> angles(const PlatformModes& modes) {
  std::vector<double> result;
  for (int i = 0; i < modes.count; ++i) result.push_back(angle(modes.poses[static_cast<std::size_t>(i)]));
  return result;
}

Matrix2d rotation(double theta) {
  return (Matrix2d() << std::cos(theta), -std::sin(theta), std::sin(theta), std::cos(theta)).finished();
}

Vector2d world(const PlatformPose& pose, const Vector2d& local) {
  return pose.position + (Matrix2d() << pose.cosine, -pose.sine, pose.sine, pose.cosine).finished() * local;
}

/// How far the nearest mode is, in position and direction.
double distance_to(const PlatformModes& modes, const PlatformPose& pose) {
  double least = INFINITY;
  for (int i = 0; i < modes.count; ++i) {
    const PlatformPose& mode = modes.poses[static_cast<std::size_t>(i)];
    least = std::min(least, (mode.position - pose.position).norm() +
                                std::hypot(mode.cosine - pose.cosine, mode.sine - pose.sine));
  }
  return least;
}

void expect_closed(const std::array<Leg, 3>& legs, const PlatformModes& modes, double tolerance) {
  for (int i = 0; i < modes.count; ++i) {
    const PlatformPose& pose = modes.poses[static_cast<std::size_t>(i)];
    EXPECT_LT(closing_error(legs, pose), tolerance) << "mode " << i;
    EXPECT_NEAR(std::hypot(pose.cosine, pose.sine), 1, 1e-15) << "mode " << i;
  }
}

/// Known poses must be the modes, all of them.
void expect_modes(const std::array<Leg, 3>& legs, const std::vector<PlatformPose>& poses,
                  double tolerance = 1e-13) {
  const PlatformModes modes = platform_modes(legs);
  EXPECT_FALSE(modes.movable);
  EXPECT_EQ(modes.count, static_cast<int>(poses.size()));
  for (const PlatformPose& pose : poses) {
    EXPECT_LT(distance_to(modes, pose), tolerance) << "at " << angle(pose);
  }
}

/// The platform that the literature solves with six real modes: base (0, 0), (15.91, 0), (0, 10), legs 14.98,
/// 15.38, 12, sides P₁P₂ = 17.04, P₂P₃ = 16.54, P₁P₃ = 20.84, its corners counter-clockwise as those of the
/// base (C. Innocenti and V. Parenti-Castelli 1992; C. Gosselin and J.-P. Merlet 1994).
std::array<Leg, 3> six_mode_platform() {
  const double x = (17.04 * 17.04 + 20.84 * 20.84 - 16.54 * 16.54) / (2 * 17.04);
  const double y = std::sqrt(20.84 * 20.84 - x * x);
  return {circle({0, 0}, {0, 0}, 14.98), circle({17.04, 0}, {15.91, 0}, 15.38), circle({x, y}, {0, 10}, 12)};
}

TEST(Triad, HasTheSixModesOfTheLiterature) {
  const auto legs = six_mode_platform();
  const PlatformModes modes = platform_modes(legs);
  EXPECT_FALSE(modes.movable);
  ASSERT_EQ(modes.count, 6);
  expect_closed(legs, modes, 1e-13);  // lengths of 20: the promise of 1e-13 of the size leaves 2e-12
  const auto scanned = scan_poses(legs, 1000);
  ASSERT_EQ(scanned.size(), 6U);
  for (const PlatformPose& pose : scanned) EXPECT_LT(distance_to(modes, pose), 1e-10);
  for (int i = 1; i < 6; ++i)
    EXPECT_LT(angle(modes.poses[static_cast<std::size_t>(i - 1)]),
              angle(modes.poses[static_cast<std::size_t>(i)]));
}

TEST(Triad, KeepsItsModesUnderMotionsAndScales) {
  const auto legs = six_mode_platform();
  const PlatformModes modes = platform_modes(legs);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double turn : {0.0, 0.7, std::numbers::pi / 2, std::numbers::pi, -2.5}) {
      for (const double platform_turn : {0.0, 1.1, std::numbers::pi}) {
        for (const double mirror : {1.0, -1.0}) {
          const Matrix2d reflection = (Matrix2d() << 1, 0, 0, mirror).finished();
          for (const double far : {0.0, 1e3}) {  // in sizes of the group: costs three digits of 1e-15·20
            const Matrix2d base = scale * rotation(turn) * reflection;
            const Matrix2d own = scale * rotation(platform_turn) * reflection;
            const Vector2d shift = scale * far * Vector2d(20, -13);
            std::array<Leg, 3> changed = legs;
            for (Leg& leg : changed) {
              leg.anchor = base * leg.anchor + shift;
              leg.local = own * leg.local;
              leg.length *= scale;
            }
            const PlatformModes found = platform_modes(changed);
            EXPECT_FALSE(found.movable);
            ASSERT_EQ(found.count, 6);
            for (int i = 0; i < 6; ++i) {
              const PlatformPose& pose = modes.poses[static_cast<std::size_t>(i)];
              const double theta = mirror * angle(pose) + turn - platform_turn;
              const PlatformPose image{(base * pose.position + shift) / scale, std::cos(theta),
                                       std::sin(theta)};
              PlatformModes unscaled = found;
              for (PlatformPose& p : unscaled.poses) p.position /= scale;
              EXPECT_LT(distance_to(unscaled, image), 1e-10) << scale << " " << turn << " " << far;
            }
          }
        }
      }
    }
  }
}

TEST(Triad, HangsOnARevoluteJointAndARod) {
  // The platform's origin on the origin of the world, its point (2, 0) at 1.5 from (3, 0): cos θ by the law
  // of cosines.
  const double theta = std::acos((4 + 9 - 2.25) / 12);
  expect_modes({kUpright, kLevel, circle({2, 0}, {3, 0}, 1.5)},
               {{{0, 0}, std::cos(theta), std::sin(theta)}, {{0, 0}, std::cos(theta), -std::sin(theta)}});
  // the rod stretched: a dead centre, double
  const std::array<Leg, 3> stretched = {kUpright, kLevel, circle({2, 0}, {3.5, 0}, 1.5)};
  const PlatformModes modes = platform_modes(stretched);
  EXPECT_THAT(modes.count, ::testing::AnyOf(1, 2));
  EXPECT_LT(distance_to(modes, {{0, 0}, 1, 0}), 1e-7);
  // out of reach
  EXPECT_EQ(platform_modes({kUpright, kLevel, circle({2, 0}, {3.6, 0}, 1.5)}).count, 0);
}

TEST(Triad, HangsOnARevoluteAndAPrismaticJoint) {
  // PR: the point (2, 0) on the line y = 1
  expect_modes({kUpright, kLevel, fixed_line({2, 0}, {7, 1}, 0)},
               {{{0, 0}, std::sqrt(3) / 2, 0.5}, {{0, 0}, -std::sqrt(3) / 2, 0.5}});
  // RP: the world's point (0, 2) on the platform's line y = 1
  expect_modes({kUpright, kLevel, platform_line({-3, 1}, {0, 2}, 0)},
               {{{0, 0}, 0.5, std::sqrt(3) / 2}, {{0, 0}, 0.5, -std::sqrt(3) / 2}});
}

// Turned by π exactly, where tan(θ/2) has its pole; lines and rods, in any unit of length.
TEST(Triad, KnowsHalfATurn) {
  for (const double unit : {1.0, 1e-6}) {
    const PlatformPose half_turn{unit * Vector2d(1, 2), -1, 0};
    const std::array<Vector2d, 3> locals = {Vector2d(0, 0), unit * Vector2d(2, 0.5),
                                            unit * Vector2d(0.5, 1.5)};
    const std::array<Vector2d, 3> anchors = {unit * Vector2d(4, 0), unit * Vector2d(-3, -1),
                                             unit * Vector2d(0, 5)};
    for (int kinds = 0; kinds < 27; ++kinds) {
      std::array<Leg, 3> legs;
      int rest = kinds;
      for (std::size_t i = 0; i < 3; ++i, rest /= 3) {
        const Vector2d arm = world(half_turn, locals[i]) - anchors[i];
        if (rest % 3 == 0) legs[i] = circle(locals[i], anchors[i], arm.norm());
        if (rest % 3 == 1) legs[i] = {Leg::Kind::fixed_line, locals[i], anchors[i], arm.normalized(), 0};
        if (rest % 3 == 2) legs[i] = {Leg::Kind::platform_line, locals[i], anchors[i], arm.normalized(), 0};
      }
      const PlatformModes modes = platform_modes(legs);
      EXPECT_FALSE(modes.movable) << kinds << " in " << unit;
      EXPECT_LT(distance_to(modes, half_turn), 1e-13) << kinds << " in " << unit;
      expect_closed(legs, modes, 1e-13 * unit);
    }
  }
}

TEST(Triad, DoesNotMindWhichPointNamesALine) {
  const double along = 1e4;  // costs four digits of 1e-16
  for (int lines = 1; lines < 8; ++lines) {
    std::array<Leg, 3> legs = {fixed_line({0.2, 0.1}, {0, 0.3}, 0.4), platform_line({0.5, -0.2}, {1, 1}, 1.9),
                               fixed_line({-0.4, 0.8}, {0.3, 1}, 2.5)};
    for (std::size_t i = 0; i < 3; ++i) {
      if ((lines >> i & 1) == 0) legs[i] = circle(legs[i].local, legs[i].anchor, 0.9);
    }
    std::array<Leg, 3> slid = legs;
    for (Leg& leg : slid) {
      if (leg.kind == Leg::Kind::fixed_line) leg.anchor += along * leg.direction;
      if (leg.kind == Leg::Kind::platform_line) leg.local -= along * leg.direction;
    }
    const PlatformModes modes = platform_modes(legs);
    const PlatformModes same = platform_modes(slid);
    EXPECT_EQ(modes.count, same.count) << lines;
    for (int i = 0; i < modes.count; ++i)
      EXPECT_LT(distance_to(same, modes.poses[static_cast<std::size_t>(i)]), 1e-10) << lines;
  }
}

TEST(Triad, FindsTwoModesInOneDirection) {
  // At θ = 0 the places that the rods leave to the platform's origin are circles about anchor − local. With
  // these on one line, here x = y, all three may meet in two points, here (1, 3) and (3, 1). There D = N = 0:
  // q = N/D says nothing, and F has a double zero that is no dead centre.
  const std::array<Vector2d, 3> locals = {Vector2d(1, -0.5), Vector2d(-0.3, 2), Vector2d(0.2, 0.7)};
  const std::array<double, 3> centres = {-2, 0.5, 4};
  std::array<Leg, 3> legs;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2d centre(centres[i], centres[i]);
    legs[i] = circle(locals[i], centre + locals[i], (Vector2d(1, 3) - centre).norm());
  }
  const PlatformModes modes = platform_modes(legs);
  EXPECT_FALSE(modes.movable);
  EXPECT_LT(distance_to(modes, {{1, 3}, 1, 0}), 1e-13);
  EXPECT_LT(distance_to(modes, {{3, 1}, 1, 0}), 1e-13);
  expect_closed(legs, modes, 1e-13);
  EXPECT_EQ(static_cast<std::size_t>(modes.count), scan_poses(legs, 1000).size());
}

// Two rods of one length, parallel where the platform has the direction of its base, hold that direction
// alone; the third then says where it stands, to either side. Whichever rod comes first, and however the
// parallelogram lies, both modes are there: where u of one rod is rounding alone, D and N are so too.
TEST(Triad, FindsBothModesOfAParallelogramHeldByARod) {
  const std::array<Vector2d, 3> locals = {Vector2d(1.125, 0), Vector2d(1.6875, -0.5625), Vector2d(0, 0)};
  const std::array<Vector2d, 3> centres = {Vector2d(-1.7, 0), Vector2d(-1.7, 0), Vector2d(0.9, 0)};
  for (int k = 0; k < 40; ++k) {
    const double turn = 0.1 + 0.157 * k, slant = 0.3 * k;
    const Vector2d place(0.3 * std::cos(k), 0.2 * k);  // of all
    std::vector<PlatformPose> poses;
    for (const double side : {1.2, -1.2}) {
      poses.push_back({place + rotation(slant) * Vector2d(0.2, side), std::cos(turn), std::sin(turn)});
    }
    std::array<std::size_t, 3> order = {0, 1, 2};
    do {
      std::array<Leg, 3> legs;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t leg = order[i];
        const Vector2d centre = place + rotation(slant) * centres[leg];
        legs[i] = circle(locals[leg], centre + rotation(turn) * locals[leg],
                         (Vector2d(0.2, 1.2) - centres[leg]).norm());
      }
      const PlatformModes modes = platform_modes(legs);
      EXPECT_FALSE(modes.movable);
      // They close where they are given to rounding, and stand off by no more than some of it.
      for (const PlatformPose& pose : poses) EXPECT_LT(distance_to(modes, pose), 1e-13) << k;
      expect_closed(legs, modes, 1e-13);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Triad, RunsOnParallelGuides) {
  // Points (0, 0) and (2, 0) on y = 0 and y = 1, so sin θ = 1/2, and a rod from (3, −1) to the first: D = 0
  // in every direction.
  const double reach = std::sqrt(3);
  std::vector<PlatformPose> poses;
  for (const double x : {3 + reach, 3 - reach}) {
    poses.push_back({{x, 0}, std::sqrt(3) / 2, 0.5});
    poses.push_back({{x, 0}, -std::sqrt(3) / 2, 0.5});
  }
  expect_modes({fixed_line({0, 0}, {5, 0}, 0), fixed_line({2, 0}, {-5, 1}, std::numbers::pi),
                circle({0, 0}, {3, -1}, 2)},
               poses);
}

TEST(Triad, RunsOnParallelGuidesToADeadCentre) {
  // As above with the guides as far apart as the points, but for `gap`: cos θ = √(1 − (1 − gap)²) ≈ √(2·gap).
  // F would be of fourth order here, and the modes 1e-4 apart unseen.
  const double gap = 1e-9;
  const double theta = std::asin(1 - gap);
  const double reach = std::sqrt(3);
  std::vector<PlatformPose> poses;
  for (const double x : {3 + reach, 3 - reach}) {
    poses.push_back({{x, 0}, std::cos(theta), 1 - gap});
    poses.push_back({{x, 0}, -std::cos(theta), 1 - gap});
  }
  // rounding of the gap, 1e-16, over the slope cos θ ≈ 4e-5
  expect_modes(
      {fixed_line({0, 0}, {5, 0}, 0), fixed_line({2, 0}, {-5, 2 - 2 * gap}, 0), circle({0, 0}, {3, -1}, 2)},
      poses, 1e-10);
}

TEST(Triad, TakesAPlatformThatMirrorsItsBase) {
  // Radical axes parallel in every direction: D = 0 throughout, F a square.
  const PlatformPose known{{0.4, -0.9}, std::cos(2.0), std::sin(2.0)};
  std::array<Leg, 3> legs;
  const std::array<Vector2d, 3> corners = {Vector2d(0, 0), Vector2d(3, 0), Vector2d(1, 2)};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2d local(corners[i].x(), -corners[i].y());
    legs[i] = circle(local, corners[i], (world(known, local) - corners[i]).norm());
  }
  const PlatformModes modes = platform_modes(legs);
  EXPECT_FALSE(modes.movable);
  EXPECT_LT(distance_to(modes, known), 1e-13);
  expect_closed(legs, modes, 1e-13);
  EXPECT_EQ(static_cast<std::size_t>(modes.count), scan_poses(legs, 1000).size());
}

TEST(Triad, IsMovableAsAParallelogram) {
  const std::array<Vector2d, 3> corners = {Vector2d(0, 0), Vector2d(3, 0), Vector2d(1, 2)};
  for (const double turn : {0.0, 0.4, std::numbers::pi}) {
    std::array<Leg, 3> legs;
    for (std::size_t i = 0; i < 3; ++i) legs[i] = circle(corners[i], rotation(turn) * corners[i], 1.7);
    EXPECT_TRUE(platform_modes(legs).movable) << turn;
    // its isolated modes, turned about, remain: they close and are no translations
    const PlatformModes modes = platform_modes(legs);
    expect_closed(legs, modes, 1e-13);
    for (const double theta : angles(modes))
      EXPECT_GT(std::abs(std::remainder(theta - turn, 2 * std::numbers::pi)), 1e-3);

    legs[2].length += 1e-5;  // no parallelogram any more
    EXPECT_FALSE(platform_modes(legs).movable) << turn;
    EXPECT_EQ(platform_modes(legs).count, 4) << turn;  // two of them within 1e-5 of parallel
  }
}

// Legs that a parallelogram turned by a very little has: its three circles are nearly one.
TEST(Triad, FindsAPoseNextToAParallelogram) {
  const std::array<Vector2d, 3> corners = {Vector2d(0, 0), Vector2d(3, 0), Vector2d(1, 2)};
  for (const double delta : {1e-4, 1e-6, 1e-8, 1e-9}) {
    for (int k = 0; k < 40; ++k) {
      const Vector2d place = rotation(0.157 * k) * Vector2d(1.3 + 0.03 * k, 0);
      const double theta = 0.4 + (k % 2 == 0 ? delta : -delta);
      const PlatformPose known{place, std::cos(theta), std::sin(theta)};
      std::array<Leg, 3> legs;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector2d anchor = rotation(0.4) * corners[i];
        legs[i] = circle(corners[i], anchor, (world(known, corners[i]) - anchor).norm());
      }
      const PlatformModes modes = platform_modes(legs);
      EXPECT_FALSE(modes.movable);
      // The conditions see the place by δ; 1e-13 is what a pose closes to.
      EXPECT_LT(distance_to(modes, known), 1e-13 / delta) << delta << " " << k;
    }
  }
}

TEST(Triad, IsMovableWhereLegsRepeat) {
  const Leg rod = circle({1, 0}, {4, 0}, 2.5);
  const Leg other = circle({0, 1}, {0, 0}, 2);
  EXPECT_TRUE(platform_modes({rod, rod, other}).movable);
  EXPECT_TRUE(platform_modes({rod, other, rod}).movable);
  EXPECT_TRUE(platform_modes({other, rod, rod}).movable);
  EXPECT_TRUE(platform_modes({rod, kLevel, kLevel}).movable);
  EXPECT_TRUE(platform_modes({kUpright, kLevel, fixed_line({0, 0}, {0, 0}, 1)}).movable);
  // the same circle twice, of two lengths: impossible
  const PlatformModes none = platform_modes({rod, circle({1, 0}, {4, 0}, 2.4), circle({0, 1}, {0, 0}, 2)});
  EXPECT_FALSE(none.movable);
  EXPECT_EQ(none.count, 0);
  // a crank: all three rods are on one pivot
  EXPECT_TRUE(platform_modes({circle({1, 0}, {2, 1}, 1), circle({0, 2}, {2, 1}, 2),
                              circle({3, 3}, {2, 1}, std::sqrt(18))})
                  .movable);
}

TEST(Triad, IsMovableAsATrammel) {
  // Cardan's circles: points on a circle through the crossing of their lines, at half the angles.
  std::array<Leg, 3> legs;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = 0.4 + 0.9 * static_cast<double>(i);
    legs[i] = fixed_line({std::cos(2 * at), std::sin(2 * at)}, {5, 3}, at);
  }
  EXPECT_TRUE(platform_modes(legs).movable);
  // moved aside it is rigid
  legs[0].anchor.x() += 0.1;
  EXPECT_FALSE(platform_modes(legs).movable);
}

TEST(Triad, IsMovableOnThreeParallelGuides) {
  const std::array<Leg, 3> legs = {fixed_line({0, 0}, {0, 0}, 0), fixed_line({2, 0}, {0, 1}, 0),
                                   fixed_line({4, 0}, {0, 2}, 0)};
  EXPECT_TRUE(platform_modes(legs).movable);
  std::array<Leg, 3> apart = legs;
  apart[2].anchor.y() = 2.5;
  EXPECT_FALSE(platform_modes(apart).movable);
  EXPECT_EQ(platform_modes(apart).count, 0);
}

// As above, but inclined, so that F is rounding and not 0, and nothing else tells that there is no pose.
TEST(Triad, HasNoPoseOnParallelGuidesThatLieOtherwiseThanItsPoints) {
  for (const double inclined : {0.3, 0.7, 1.1, 2.0}) {
    const auto guide = [&](double x, double y, double turned) {
      return fixed_line({x, 0}, rotation(inclined) * Vector2d(0, y), inclined + turned);
    };
    const PlatformModes modes =
        platform_modes({guide(0, 0, 0), guide(2, 1, std::numbers::pi), guide(4, 2.5, 0)});
    EXPECT_FALSE(modes.movable) << inclined;
    EXPECT_EQ(modes.count, 0) << inclined;
  }
}

}  // namespace
}  // namespace oblique::mechanism
