// SPDX-License-Identifier: MIT
// A motion stays on the branch of its positions on which it was begun.
#include <oblique/mechanism/motion/motion.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include "mechanism_text.h"
#include "random_sixbar.h"

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;
using Kind = MotionEvent::Kind;

Motion solve(const Mechanism& mechanism, int positions) {
  return solve_motion(mechanism, positions);
}

std::vector<double> times_of(const Motion& motion, Kind kind) {
  std::vector<double> times;
  for (const MotionEvent& event : motion.events) {
    if (event.kind == kind) times.push_back(event.time);
  }
  return times;
}

const Vector2d& place(const Configuration& here, const Mechanism& mechanism, const std::string& point) {
  return here.points[mechanism.find_point(point).value()].position;
}

/// Every link is as long as it is and not turned over.
void expect_rigid(const RandomSixbar& sixbar, const Mechanism& mechanism, const Motion& motion) {
  for (const Configuration& here : motion.configurations) {
    if (here.status != Status::ok) continue;
    // Newton's last step is below 1e-9 of the size and squared after that; the rest are roundings of
    // coordinates
    for (const RandomSixbar::Bar& bar : sixbar.bars)
      ASSERT_NEAR((place(here, mechanism, bar.a) - place(here, mechanism, bar.b)).norm(), bar.length, 1e-12);
    for (const RandomSixbar::Plate& plate : sixbar.plates) {
      const Vector2d base = place(here, mechanism, plate.b) - place(here, mechanism, plate.a);
      const Vector2d to = place(here, mechanism, plate.c) - place(here, mechanism, plate.a);
      ASSERT_GT(plate.side * (base.x() * to.y() - base.y() * to.x()), 0);
    }
  }
}

/// No point goes farther from one row to the next than the greater of its two speeds allows. Between two rows
/// of a quarter degree the speed of a point may pass a maximum; three times the greater one is never reached
/// by what moves on, and a leap to another mode is some hundred times as far.
void expect_continuous(const Mechanism& mechanism, const Motion& motion) {
  for (std::size_t row = 1; row < motion.times.size(); ++row) {
    const Configuration& before = motion.configurations[row - 1];
    const Configuration& here = motion.configurations[row];
    const bool event = std::any_of(motion.events.begin(), motion.events.end(), [&](const MotionEvent& e) {
      return e.time >= motion.times[row - 1] && e.time <= motion.times[row];
    });
    if (event || before.status != Status::ok || here.status != Status::ok) continue;
    const double dt = motion.times[row] - motion.times[row - 1];
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      const double fastest = std::max(before.points[p].velocity.norm(), here.points[p].velocity.norm());
      ASSERT_LE((here.points[p].position - before.points[p].position).norm(), 3 * fastest * dt + 1e-3)
          << "row " << row << " " << mechanism.points[p].name;
    }
  }
}

/// What came again after a limit is where the mechanism stood, or would have stood before its start, at the
/// same angle of the crank: the way back from the start leads there.
void expect_the_same_branch(const Mechanism& mechanism, const Motion& motion) {
  const std::vector<double> returns = times_of(motion, Kind::return_);
  if (returns.empty()) return;
  const double turn = motion.times.back();
  constexpr double kBeside = 1e-8;
  Motion backwards = solve_motion(mechanism, std::vector<double>{0, returns.front() - turn + kBeside});
  ASSERT_EQ(times_of(backwards, Kind::limit).size(), 0U);
  std::vector<double> times;
  std::vector<std::size_t> rows;
  for (std::size_t row = motion.times.size(); row-- > 0 && motion.times[row] > returns.front();) {
    if (motion.configurations[row].status != Status::ok) continue;
    times.push_back(motion.times[row] - turn);
    rows.push_back(row);
  }
  backwards = solve_motion(mechanism, times);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(backwards.configurations[i].status, Status::ok) << times[i];
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      const double far =
          (backwards.configurations[i].points[p].position - motion.configurations[rows[i]].points[p].position)
              .norm();
      // beside a limit a rounding of the angle is one of its root in the position
      ASSERT_LT(far, 1e-6) << times[i];
    }
  }
}

TEST(Branch, IsKeptByRandomSixbars) {
  int with_limit = 0, returning = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSixbar sixbar = random_sixbar(seed);
    const Mechanism mechanism = parse_mechanism(sixbar.text, "six.toml");
    const Motion motion = solve(mechanism, 1441);
    expect_rigid(sixbar, mechanism, motion);
    expect_continuous(mechanism, motion);
    expect_the_same_branch(mechanism, motion);
    // two modes cross only at special dimensions
    EXPECT_TRUE(times_of(motion, Kind::change).empty());
    for (const int positions : {91, 361}) {
      const Motion coarse = solve(mechanism, positions);
      for (const Kind kind : {Kind::limit, Kind::return_}) {
        const std::vector<double> some = times_of(coarse, kind), all = times_of(motion, kind);
        ASSERT_EQ(some.size(), all.size());
        // limits are told within 1e-10 of a radian, which the crank makes in a second
        for (std::size_t i = 0; i < some.size(); ++i) EXPECT_NEAR(some[i], all[i], 1e-9);
      }
      const std::size_t every = 1440 / (static_cast<std::size_t>(positions) - 1);
      for (std::size_t row = 0; row < coarse.times.size(); ++row) {
        const Configuration& here = coarse.configurations[row];
        const Configuration& fine = motion.configurations[every * row];
        ASSERT_EQ(here.status, fine.status) << row;
        if (here.status != Status::ok) continue;
        for (std::size_t p = 0; p < mechanism.points.size(); ++p)
          ASSERT_LT((here.points[p].position - fine.points[p].position).norm(), 1e-9) << row;
      }
    }
    with_limit += times_of(motion, Kind::limit).empty() ? 0 : 1;
    returning += times_of(motion, Kind::return_).empty() ? 0 : 1;
  }
  EXPECT_GE(with_limit, 20);
  EXPECT_GE(returning, 10);
}

/// |BD|² = 13 − 12 cos φ lies between 1.8² and 4.2² for |φ| from arccos(9.76/12) = 35.6° to arccos(−4.64/12)
/// = 112.8°: two arcs, and no way from one to the other but to take it apart.
constexpr const char* kTwoArcs = R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [3, 0]
[bodies]
AB = { points = ["A", "B"], length = 2 }
BC = { points = ["B", "C"], length = 3 }
CD = { points = ["C", "D"], length = 1.2 }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "60 deg" }
[sketch]
C = [3, 1.5]
)";

TEST(Branch, IsNotTakenForAnotherOfTheSameSide) {
  const Mechanism mechanism = parse_mechanism(kTwoArcs, "four.toml");
  const Motion motion = solve(mechanism, 361);
  const double low = std::acos(9.76 / 12), high = std::acos(-4.64 / 12);
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const double angle = motion.drives[row][0].value;
    const bool on_it = (angle > low && angle < high) || angle > low + 2 * std::numbers::pi;
    EXPECT_EQ(motion.configurations[row].status, on_it ? Status::ok : Status::open) << row;
  }
  ASSERT_EQ(motion.events.size(), 2U);
  EXPECT_EQ(motion.events[0].kind, Kind::limit);
  EXPECT_NEAR(motion.events[0].time, high - std::numbers::pi / 3, 1e-10);
  EXPECT_EQ(motion.events[1].kind, Kind::return_);
  EXPECT_NEAR(motion.events[1].time, low + 2 * std::numbers::pi - std::numbers::pi / 3, 1e-10);
}

// The drive turns back beyond the limit: the branch goes on where it was left, at whatever rows.
TEST(Branch, GoesOnWhereTheDriveComesBack) {
  std::string text = kTwoArcs;
  text.replace(text.find("speed = 1,"), 10, "speed = \"cos(time)\",");
  const Mechanism mechanism = parse_mechanism(text, "four.toml");
  const double limit = std::asin(std::acos(-4.64 / 12) - std::numbers::pi / 3);  // sin t is the crank's way
  for (const int positions : {7, 100, 1000}) {
    MotionOptions options;
    options.positions = positions;
    options.until = std::numbers::pi;
    const Motion motion = solve_motion(mechanism, options);
    ASSERT_EQ(motion.events.size(), 2U) << positions;
    EXPECT_NEAR(motion.events[0].time, limit, 1e-9);
    EXPECT_NEAR(motion.events[1].time, std::numbers::pi - limit, 1e-9);
    const Configuration& last = motion.configurations.back();
    EXPECT_EQ(last.status, Status::ok);
    EXPECT_LT((last.points[3].position - motion.configurations.front().points[3].position).norm(), 1e-12);
  }
}

// Near its other end, 1.5 mm from the pivot of another bar, this group is so ill-conditioned that its modes
// are not told apart within 1e-9 of a radian. The ends are the folds of the pose of its bodies over the
// crank's angle, by the arc length with SciPy.
TEST(Branch, ComesBackAtItsOtherEndWhereItsModesAreHardToTellApart) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
F7 = [0.71079, 1.26481]
F9 = [1.95006, 0.99738]
F11 = [0.64746, 1.28868]
[bodies]
k = { points = ["A", "B"], length = 0.1552 }
u5 = { points = ["P1", "P2"], length = 0.30593, marks = { P3 = [-0.31606, -0.32417] } }
v5 = { points = ["P3", "P4"], length = 1.82486, marks = { P5 = [1.05597, -0.34436] } }
l9 = { points = ["P1", "B"], length = 1.27452 }
l12 = { points = ["F7", "P2"], length = 1.17156 }
l15 = { points = ["F9", "P4"], length = 1.67321 }
l18 = { points = ["P5", "F11"], length = 0.8125 }
[drives]
crank = { turns = "k", about = "A", speed = "1 rad/s", start = "-2.78538 rad" }
[sketch]
P1 = [1.12693, -0.12777]
P2 = [1.14702, 0.1775]
P3 = [1.42981, -0.46401]
P4 = [0.27693, 0.95058]
P5 = [1.02964, 0.572]
)",
                                              "eight.toml");
  const double degree = std::numbers::pi / 180, start = -2.78538;
  for (const int positions : {37, 361, 1013}) {
    const Motion motion = solve(mechanism, positions);
    ASSERT_EQ(motion.events.size(), 2U) << positions;
    EXPECT_EQ(motion.events[0].kind, Kind::limit);
    EXPECT_NEAR(motion.events[0].time, 164.170985757 * degree - start, 1e-9);
    EXPECT_EQ(motion.events[1].kind, Kind::return_);
    EXPECT_NEAR(motion.events[1].time, 182.665478261 * degree - start, 1e-9);
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const double t = motion.times[row];
      const bool is_open = t > motion.events[0].time && t < motion.events[1].time;
      EXPECT_EQ(motion.configurations[row].status, is_open ? Status::open : Status::ok) << t;
    }
  }
}

// A crank and a triad, of which the frame lies so many sizes from the origin. Its branch goes from fold to
// fold, from 281.66237151° − 360° to −35.06051311° by pseudo-arclength continuation of its constraints.
class FarFromTheOrigin : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Offsets, FarFromTheOrigin, ::testing::Values(0, 1e4, 1e5, 1e6));

TEST_P(FarFromTheOrigin, ABranchIsTakenUpAgainBehindALimit) {
  constexpr double kDegree = std::numbers::pi / 180;
  constexpr double kStart = -0.519488236310132, kSpeed = -31.02429582442193;
  const auto at = [](double x, double y) {
    return fmt::format("[{}, {}]\n", x + GetParam(), y - 0.3 * GetParam());
  };
  const Mechanism made = mechanism(
      "title = \"a crank and a triad\"\n[units]\nlength = \"m\"\n[frame]\nF0 = " +
      at(-0.9541723808652023, 0.2702261441736482) + "F1 = " + at(-1.215096894389717, -0.73350532412951) +
      "F2 = " + at(0.094321498851059, -1.4346082415540877) + R"toml([bodies]
crank = { points = ["F0", "B"], length = 0.3725145132460694 }
t1 = { points = ["U1", "V1"], length = 0.28323476958416677, marks = { W1 = [-0.40090490227555153, 0.3640277433381143] } }
a1 = { points = ["B", "U1"], length = 0.9645621819910658 }
b1 = { points = ["F1", "V1"], length = 0.8671856848245377 }
[slides]
s1 = { point = "W1", along = ["F1", "F2"], offset = 0.7493033824816246 }
[drives]
drv = { turns = "crank", about = "F0", speed = "-31.02429582442193 rad/s", start = "-0.519488236310132 rad" }
[sketch]
B = )toml" +
      at(-0.6308024589670822, 0.08529654624362593) + "U1 = " + at(-0.20278880599653348, -0.7791018085663381) +
      "V1 = " + at(-0.38781813929381315, -0.9935454620535893) +
      "W1 = " + at(0.3347250248771161, -0.7133764694044658));
  for (const int rows : {7, 25, 361}) {
    const Motion motion = solve(made, rows);
    EXPECT_TRUE(times_of(motion, Kind::lost).empty());
    const std::vector<double> limits = times_of(motion, Kind::limit),
                              returns = times_of(motion, Kind::return_);
    ASSERT_EQ(limits.size(), 1U);
    ASSERT_EQ(returns.size(), 1U);
    // the truths are written to 1e-8°; as far move them coordinates of 1e6 by their rounding, 1e-10
    const double near = 1e-8 + 2e-14 * GetParam();
    EXPECT_NEAR((kStart + kSpeed * limits[0]) / kDegree, -35.06051311, near);
    EXPECT_NEAR((kStart + kSpeed * returns[0]) / kDegree, -78.33762849, near);
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const bool is_within = motion.times[row] < limits[0] || motion.times[row] > returns[0];
      EXPECT_EQ(motion.configurations[row].status == Status::ok, is_within) << row;
    }
  }
}

// Two drives: an arm of two links carries the revolute joint of a dyad out of its reach, and another way back
// into it.
TEST(Branch, OfSeveralDrivesComesBackOnAStraightWay) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [3, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 2 }
CE = { points = ["C", "E"], length = 2 }
DE = { points = ["D", "E"], length = 1.5 }
[drives]
left  = { turns = "AB", about = "A", speed = 1, start = "60 deg" }
right = { turns = "DE", about = "D", speed = -1, start = "120 deg" }
[sketch]
C = [1.5, 2.5]
)",
                                              "five.toml");
  const Motion motion = solve(mechanism, 361);
  ASSERT_EQ(motion.events.size(), 2U);
  EXPECT_EQ(motion.events[0].kind, Kind::limit);
  EXPECT_EQ(motion.events[1].kind, Kind::return_);
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const double t = motion.times[row];
    const Vector2d b(std::cos(std::numbers::pi / 3 + t), std::sin(std::numbers::pi / 3 + t));
    const Vector2d e(3 + 1.5 * std::cos(2 * std::numbers::pi / 3 - t),
                     1.5 * std::sin(2 * std::numbers::pi / 3 - t));
    EXPECT_EQ(motion.configurations[row].status, (b - e).norm() < 4 ? Status::ok : Status::open) << row;
  }
  const Motion coarse = solve(mechanism, 50);
  ASSERT_EQ(coarse.events.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(coarse.events[i].time, motion.events[i].time, 1e-9);
}

}  // namespace
}  // namespace oblique::mechanism
