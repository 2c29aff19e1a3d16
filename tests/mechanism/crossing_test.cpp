// SPDX-License-Identifier: MIT
// What a motion passes where modes meet: change points, what only looks like one, infinity.
#include <oblique/mechanism/motion/motion.h>

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion_range.h>
#include <oblique/mechanism/structure/structure.h>

#include "../support/tangent.h"

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;
using Kind = MotionEvent::Kind;

constexpr double kDegree = std::numbers::pi / 180;

constexpr const char* kKite = R"(format = "oblique-mechanism/1"
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
)";

/// C lies on the bisector of the crank and the frame, cos(φ/2) + √(4 − sin²(φ/2)) from A.
Vector2d tip_of_kite(double angle) {
  const double half = angle / 2;
  return (std::cos(half) + std::sqrt(4 - std::pow(std::sin(half), 2))) *
         Vector2d(std::cos(half), std::sin(half));
}

// A deltoid over two turns of the crank; at 360° B lies on D.
TEST(Crossing, OfAKitePassesWhereItsPivotsMeet) {
  const Mechanism mechanism = parse_mechanism(kKite, "kite.toml");
  for (const int positions : {91, 721, 10000}) {
    MotionOptions options;
    options.positions = positions;
    options.until = 4 * std::numbers::pi;
    const Motion motion = solve_motion(mechanism, options);
    ASSERT_EQ(motion.events.size(), 2U) << positions;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(motion.events[k].kind, Kind::change);
      EXPECT_NEAR(motion.events[k].time, 2 * std::numbers::pi * static_cast<double>(k + 1) - 40 * kDegree,
                  1e-9);
    }
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const Vector2d c = tip_of_kite(motion.drives[row][0].value);
      // the direction of B → D carries a rounding over their distance, 1e-6 at the least where it is used
      EXPECT_LT((motion.configurations[row].points[3].position - c).norm(), 1e-9) << row;
    }
  }
  EXPECT_EQ(plan_motion_range(mechanism, decompose(mechanism)).changes.size(), 1U);
}

// On from one time to the next, and back.
TEST(Crossing, IsPassedToAndFro) {
  const Mechanism mechanism = parse_mechanism(kKite, "kite.toml");
  const Structure structure = decompose(mechanism);
  Follower follower(mechanism, structure);
  for (const double t : {8.0, 4.0, 13.0, -2.0, 7.0}) {
    const Configuration& here = follower.advance(t);
    ASSERT_EQ(here.status, Status::ok) << t;
    // as above
    EXPECT_LT((here.points[3].position - tip_of_kite(40 * kDegree + t)).norm(), 1e-9) << t;
  }
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
    options.until = 4 * std::numbers::pi / speed;
    const Motion motion = solve_motion(kite, options);
    ASSERT_EQ(motion.events.size(), 2U) << speed;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(motion.events[k].kind, Kind::change);
      EXPECT_NEAR(motion.events[k].time * speed,
                  2 * std::numbers::pi * static_cast<double>(k + 1) - 40 * kDegree, 1e-9)
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

// A double rocker that stops where its coupler and its right rocker lie on one line, |BD| = 150: the last row
// is that pose, from wherever the row before it is. (From some the limit seemed to lie a rounding nearer, and
// the row was open.)
TEST(Crossing, EndsInThePoseOfALimit) {
  const Mechanism mechanism =
      read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/double-rocker.toml");
  const double angle = std::acos((60. * 60 + 100. * 100 - 150. * 150) / (2 * 60 * 100));
  const Vector2d b = 60 * Vector2d(std::cos(angle), std::sin(angle)), d(100, 0);
  const Vector2d c = b + (d - b) * 70 / 150;
  const std::size_t point = mechanism.find_point("C").value();
  for (const AtLimit at_limit : {AtLimit::stop, AtLimit::reverse}) {
    for (int positions = 2; positions < 200; ++positions) {
      MotionOptions options;
      options.positions = positions;
      options.at_limit = at_limit;
      const Motion motion = solve_motion(mechanism, options);
      for (const Configuration& here : motion.configurations)
        ASSERT_NE(here.status, Status::open) << positions;
      if (at_limit == AtLimit::reverse) continue;
      // A dead centre goes by the root of the way: 1e-6 of a link for the 1e-13 rad that rounding leaves.
      EXPECT_NEAR((motion.configurations.back().points[point].position - c).norm(), 0, 1e-4) << positions;
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
    EXPECT_NEAR(motion.events[0].time, std::numbers::pi / 2, 1e-9);
    EXPECT_EQ(motion.events[1].kind, Kind::infinity);
    EXPECT_NEAR(motion.events[1].time, 3 * std::numbers::pi / 2, 1e-9);
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
  EXPECT_NEAR(stopped.times.back(), std::numbers::pi / 2 - 1e-3, 1e-9);
  EXPECT_EQ(stopped.configurations.back().status, Status::ok);
  const MotionRange motion_range = plan_motion_range(mechanism, decompose(mechanism));
  ASSERT_TRUE(motion_range.range.forward && motion_range.range.backward);
  EXPECT_EQ(motion_range.range.forward->kind, Kind::infinity);
  EXPECT_NEAR(motion_range.range.backward->time, -std::numbers::pi / 2, 1e-9);
}

/// The rounding of scale·tan ψ. A body that is told of by a point so far away is turned by that point's
/// rounding, 1 + |tan ψ| times that of a number; dy/dψ magnifies it. 4e-15 are some twenty of them.
double rounding_at(double scale, double psi) {
  const double tangent = std::tan(psi);
  return 4e-15 * scale * (1 + tangent * tangent) * (1 + std::abs(tangent));
}

/// Whether a point runs along x = `scale` as y = `scale`·tan ψ, ψ rising at 1 rad/s, in axes that are turned
/// by `turn`. Each rate is as much steeper in ψ.
void expect_tangent(const PointState& point, double scale, double psi, double turn = 0) {
  const Eigen::Rotation2Dd back(-turn);
  const double tangent = std::tan(psi), secant = 1 + tangent * tangent, steep = 1 + std::abs(tangent);
  const double rounding = rounding_at(scale, psi);
  EXPECT_NEAR((back * point.position).x(), scale, rounding);
  EXPECT_NEAR((back * point.position).y(), scale * tangent, rounding);
  EXPECT_NEAR((back * point.velocity).y(), scale * secant, rounding * steep);
  EXPECT_NEAR((back * point.acceleration).y(), 2 * scale * tangent * secant, rounding * steep * steep);
}

// A plate with two slots, 60 apart, on pins at P and at the crank's tip Q: n·(Q − P) = 150 sin(φ − ψ) = 60
// gives its direction ψ = φ − asin(0.4). Its point C, on the first slot, runs on x = 100: y = 100 tan ψ. The
// group has three slides, is followed by Newton's method and goes away where the slots stand along the guide.
// Turned by 80°, with nearly no way along one of the axes, it does the same.
TEST(Crossing, TakesATriadThroughInfinity) {
  const double lag = std::asin(0.4);
  for (const double turn : {0.0, 80 * kDegree}) {
    const auto place = [&](double x, double y) {
      const Vector2d turned = Eigen::Rotation2Dd(turn) * Vector2d(x, y);
      return fmt::format("[{}, {}]", turned.x(), turned.y());
    };
    const Mechanism mechanism =
        parse_mechanism(fmt::format(R"(format = "oblique-mechanism/1"
[frame]
P = [0, 0]
F = {}
E = {}
[bodies]
arm = {{ points = ["P", "Q"], length = 150 }}
plate = {{ points = ["C", "K"], length = 30, marks = {{ L = [0, 60], M = [30, 60] }} }}
[slides]
first = {{ point = "P", along = ["C", "K"] }}
second = {{ point = "Q", along = ["L", "M"] }}
guide = {{ point = "C", along = ["F", "E"] }}
[drives]
crank = {{ turns = "arm", about = "P", speed = 1, start = {} }}
[sketch]
C = {}
K = {}
)",
                                    place(100, 0), place(100, 100), turn, place(100, -45), place(127, -57)),
                        "plate.toml");
    ASSERT_EQ(decompose(mechanism).groups.at(1).form.kind, GroupKind::triad);
    const std::size_t c = mechanism.find_point("C").value(), k = mechanism.find_point("K").value();
    for (const int positions : {8, 91, 361, 10000}) {
      const Motion motion = solve_motion(mechanism, positions);
      ASSERT_EQ(motion.events.size(), 2U) << positions;
      for (const std::size_t i : {0U, 1U}) {
        EXPECT_EQ(motion.events[i].kind, Kind::infinity);
        EXPECT_NEAR(motion.events[i].time,
                    std::numbers::pi / 2 + lag + static_cast<double>(i) * std::numbers::pi, 1e-9);
      }
      for (std::size_t row = 0; row < motion.times.size(); ++row) {
        SCOPED_TRACE(motion.times[row]);
        const Configuration& here = motion.configurations[row];
        ASSERT_EQ(here.status, Status::ok);
        const double psi = motion.times[row] - lag;
        expect_tangent(here.points[c], 100, psi, turn);
        // K is 30 along the slots from C
        const double rounding = rounding_at(100, psi);
        const Vector2d along = here.points[k].position - here.points[c].position;
        EXPECT_NEAR(along.x(), 30 * std::cos(psi + turn), rounding);
        EXPECT_NEAR(along.y(), 30 * std::sin(psi + turn), rounding);
      }
    }
  }
}

// The arm's direction φ is driven, its joint B is not: B is carried along x = 112 by a block on two pins,
// whose line is 12 from B (20·15/25), and the arm's slot is on the pin O, so that B stands at 112 tan φ. The
// two bodies are solved together, and both are told of by the place of B.
TEST(Crossing, TakesTwoBodiesWithOneBaseThroughInfinity) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
O = [0, 0]
F = [100, 0]
E = [100, 100]
[bodies]
arm = { points = ["B", "T"], length = 150 }
block = { points = ["B", "L"], length = 20, marks = { K = [0, 15] } }
[slides]
slot = { point = "O", along = ["B", "T"] }
upper = { point = "L", along = ["F", "E"] }
lower = { point = "K", along = ["F", "E"] }
[drives]
crank = { turns = "arm", about = "B", speed = 1 }
[sketch]
B = [112, 0]
L = [100, 16]
K = [100, -9]
)",
                                              "arm.toml");
  const Structure structure = decompose(mechanism);
  ASSERT_EQ(structure.groups.at(0).form.placing, Placing::iteration);
  ASSERT_EQ(structure.groups.at(0).bodies.size(), 2U);
  const std::size_t b = mechanism.find_point("B").value(), l = mechanism.find_point("L").value();
  for (const int positions : {8, 91, 361, 10000}) {
    const Motion motion = solve_motion(mechanism, positions);
    ASSERT_EQ(motion.events.size(), 2U) << positions;
    for (const std::size_t i : {0U, 1U}) {
      EXPECT_EQ(motion.events[i].kind, Kind::infinity);
      EXPECT_NEAR(motion.events[i].time, std::numbers::pi / 2 + static_cast<double>(i) * std::numbers::pi,
                  1e-9);
    }
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const double t = motion.times[row];
      SCOPED_TRACE(t);
      const Configuration& here = motion.configurations[row];
      const bool is_there = std::abs(std::cos(t)) < 1e-9;
      ASSERT_EQ(here.status, is_there ? Status::open : Status::ok);
      if (is_there) continue;
      expect_tangent(here.points[b], 112, t);
      EXPECT_NEAR(here.points[l].position.y(), 112 * std::tan(t) + 16, rounding_at(112, t));
    }
  }
}

// The group of two platforms goes through infinity at 52.47°, and the determinant over the lengths of its
// rows grows without end there. It is left at a limit beyond, and taken up again at the other end of the way
// back, which leads through infinity as well. Both ends are folds by the arc length with SciPy.
TEST(Crossing, TakesAGroupThroughInfinityWhoseDeterminantGrows) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
F8 = [-0.141, 0.847]
G11 = [-0.315, -1.018]
G12 = [0.429, -0.831]
[bodies]
k = { points = ["A", "B"], length = 0.182 }
l1 = { points = ["B", "P1"], length = 1.36, marks = { M13 = [-0.024, 0.584] } }
u7 = { points = ["P3", "P4"], length = 1.844, marks = { P5 = [-0.029, 0.319] } }
v7 = { points = ["P5", "P6"], length = 1.277, marks = { P7 = [1.27, 0.987] } }
c9 = { points = ["F8", "Q9"], length = 0.601 }
c14 = { points = ["M13", "Q14"], length = 0.608 }
[slides]
s1 = { point = "P1", along = ["A", "B"], offset = 0.844 }
s2 = { point = "P3", along = ["F8", "Q9"], offset = 1.296, of = "u7", angle = "-0.533 rad" }
s3 = { point = "P4", along = ["B", "P1"], offset = -0.56 }
s4 = { point = "P6", along = ["G11", "G12"], offset = 1.541 }
s5 = { point = "P7", along = ["M13", "Q14"], offset = 0.743, of = "v7", angle = "5.927 rad" }
[drives]
crank = { turns = "k", about = "A", speed = "1 rad/s", start = "-2.967 rad" }
[sketch]
P1 = [1.018, -0.677]
P3 = [1.134, 0.553]
P4 = [-0.305, -0.6]
P5 = [1.356, 0.323]
P6 = [0.13, 0.683]
P7 = [-0.141, -0.266]
Q9 = [-0.354, 0.286]
M13 = [0.077, 0.494]
Q14 = [-0.53, 0.452]
)",
                                              "platforms.toml");
  const double degree = std::numbers::pi / 180, start = -2.967;
  for (const int positions : {37, 361, 1013}) {
    const Motion motion = solve_motion(mechanism, positions);
    ASSERT_EQ(motion.events.size(), 3U) << positions;
    EXPECT_EQ(motion.events[0].kind, Kind::infinity);
    EXPECT_NEAR(motion.events[0].time, 52.4678 * degree - start, 1e-5);
    EXPECT_EQ(motion.events[1].kind, Kind::limit);
    EXPECT_NEAR(motion.events[1].time, 81.052785785 * degree - start, 1e-9);
    EXPECT_EQ(motion.events[2].kind, Kind::return_);
    EXPECT_NEAR(motion.events[2].time, 186.833810188 * degree - start, 1e-9);
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const double t = motion.times[row];
      const bool is_open = t > motion.events[1].time && t < motion.events[2].time;
      EXPECT_EQ(motion.configurations[row].status, is_open ? Status::open : Status::ok) << t;
    }
  }
}

}  // namespace
}  // namespace oblique::mechanism
