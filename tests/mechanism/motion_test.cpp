// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/motion.h>

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

using ::testing::HasSubstr;

/// A four-bar ABCD with its frame on the x axis.
Mechanism four_bar(double crank, double coupler, double rocker, double frame, const std::string& speed,
                   const std::string& start, const std::string& sketch) {
  std::ostringstream text;
  text.precision(17);
  text << "format = \"oblique-mechanism/1\"\n[frame]\nA = [0, 0]\nD = [" << frame << ", 0]\n[bodies]\n"
       << R"(AB = { points = ["A", "B"], length = )" << crank << " }\n"
       << R"(BC = { points = ["B", "C"], length = )" << coupler << " }\n"
       << R"(CD = { points = ["C", "D"], length = )" << rocker << " }\n"
       << "[drives]\ncrank = { turns = \"AB\", about = \"A\", speed = \"" << speed << "\", start = \""
       << start << "\" }\n[sketch]\nC = " << sketch << "\n";
  return parse_mechanism(text.str(), "four.toml");
}

// A crank that is given from its pin to its bearing, with a speed that varies: B stands opposite to the angle
// φ = t + t², and |AB| = 2.
TEST(Motion, OfACrankGivenFromItsPin) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [1, 0]
[bodies]
AB = { points = ["B", "A"], length = 2 }
[drives]
crank = { turns = "AB", about = "A", speed = "1 + 2*time rad/s" }
[motion]
until = 2
)",
                                              "pin.toml");
  const std::array times{0.0, 0.4, 1.3};
  const Motion motion = solve_motion(mechanism, times);
  for (std::size_t row = 0; row < times.size(); ++row) {
    const double angle = times[row] + times[row] * times[row], rate = 1 + 2 * times[row], bend = 2;
    const Eigen::Vector2d u(std::cos(angle), std::sin(angle)), n(-u.y(), u.x());
    const PointState& b = motion.configurations[row].points[mechanism.find_point("B").value()];
    // the angle is the integral of the law, to 1e-12
    EXPECT_LT((b.position - (Eigen::Vector2d(1, 0) - 2 * u)).norm(), 1e-10);
    EXPECT_LT((b.velocity + 2 * rate * n).norm(), 1e-10);
    EXPECT_LT((b.acceleration + 2 * (bend * n - rate * rate * u)).norm(), 1e-9);
  }
}

// A drive that turns the coupler of a four-bar: B and C follow together, |AB| = 1 and |CD| = 3.
TEST(Motion, OfADriveInsideAGroup) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5 }
CD = { points = ["C", "D"], length = 3 }
[drives]
push = { turns = "BC", about = "B", speed = 0.5, start = "30 deg" }
[sketch]
B = [0.3, 1]
C = [3.3, 2.8]
)",
                                              "push.toml");
  const std::array times{0.0, 0.1, 0.2, 0.3};
  const Motion motion = solve_motion(mechanism, times);
  const auto place = [&](std::size_t row, const char* point) -> const PointState& {
    return motion.configurations[row].points[mechanism.find_point(point).value()];
  };
  for (std::size_t row = 0; row < times.size(); ++row) {
    ASSERT_EQ(motion.configurations[row].status, Status::ok) << row;
    const Eigen::Vector2d b = place(row, "B").position, c = place(row, "C").position;
    const double angle = std::numbers::pi / 6 + 0.5 * times[row];
    EXPECT_NEAR(b.norm(), 1, 1e-13) << row;  // roundings of numbers near 4
    EXPECT_NEAR((c - Eigen::Vector2d(4, 0)).norm(), 3, 1e-13) << row;
    EXPECT_LT((c - b - 3.5 * Eigen::Vector2d(std::cos(angle), std::sin(angle))).norm(), 1e-13) << row;
    // B goes across AB, C across CD, and C about B at 0.5 rad/s
    const Eigen::Vector2d v = place(row, "B").velocity, w = place(row, "C").velocity;
    EXPECT_NEAR(v.dot(b), 0, 1e-12) << row;
    EXPECT_NEAR(w.dot(c - Eigen::Vector2d(4, 0)), 0, 1e-12) << row;
    EXPECT_LT((w - v - 0.5 * Eigen::Vector2d(b.y() - c.y(), c.x() - b.x())).norm(), 1e-12) << row;
  }
}

// class-iv.toml, but that the drive turns the link CFG, and G goes where it must: all five links in one
// group.
TEST(Motion, OfADriveInsideAGroupOfManyLinks) {
  const Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
H = [180, 60]
[bodies]
HG  = { points = ["H", "G"], length = 20 }
ABE = { points = ["A", "B"], length = 63, marks = { E = [47, 79] } }
BC  = { points = ["B", "C"], length = 70 }
EF  = { points = ["E", "F"], length = 90 }
CFG = { points = ["C", "F"], length = 124, marks = { G = [32, -80] } }
[drives]
push = { turns = "CFG", about = "G", speed = "0.2*cos(3*time) rad/s", start = "108 deg" }
[sketch]
B = [60, 20]
E = [20, 90]
C = [130, 10]
F = [100, 130]
G = [190, 77]
)",
                                              "push.toml");
  const std::array times{0.0, 0.2, 0.5, 1.0};
  const Motion motion = solve_motion(mechanism, times);
  for (std::size_t row = 0; row < times.size(); ++row) {
    ASSERT_EQ(motion.configurations[row].status, Status::ok) << row;
    const auto place = [&](const char* point) -> Eigen::Vector2d {
      return motion.configurations[row].points[mechanism.find_point(point).value()].position;
    };
    const double angle = 0.6 * std::numbers::pi + 0.2 / 3 * std::sin(3 * times[row]);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    // roundings of numbers near 200, through six equations
    EXPECT_LT((place("F") - place("C") - 124 * along).norm(), 1e-10) << row;
    EXPECT_LT((place("G") - place("C") - 32 * along + 80 * across).norm(), 1e-10) << row;
    EXPECT_NEAR((place("G") - place("H")).norm(), 20, 1e-10) << row;
    EXPECT_NEAR((place("C") - place("B")).norm(), 70, 1e-10) << row;
    EXPECT_NEAR((place("F") - place("E")).norm(), 90, 1e-10) << row;
    EXPECT_NEAR(place("B").norm(), 63, 1e-10) << row;
  }
}

TEST(Motion, SpansOneTurnWithBothEnds) {
  const Mechanism mechanism = four_bar(1, 3.5, 3, 4, "-2 rad/s", "30 deg", "[3, 3]");
  const Motion motion = solve_motion(mechanism, 5);
  ASSERT_EQ(motion.times.size(), 5U);
  for (int k = 0; k < 5; ++k) {
    const auto row = static_cast<std::size_t>(k);
    EXPECT_EQ(motion.times[row], std::numbers::pi * k / 4);
    EXPECT_DOUBLE_EQ(motion.drives[row][0].value, std::numbers::pi / 6 - 2 * motion.times[row]);
    EXPECT_EQ(motion.configurations[row].bodies[0].angle, motion.drives[row][0].value);
    EXPECT_EQ(motion.configurations[row].bodies[0].omega, -2);
  }
}

// What asks for so many rows a turn gets them in each, until they are too many; then no two turns have them
// in the same places. A drive that moves a slide goes once to and fro.
TEST(Motion, HasItsRowsInEachTurn) {
  const auto rows = [](const std::string& until) {
    Mechanism mechanism = four_bar(1, 4, 3, 4, "1 rad/s", "0 deg", "[4, 3]");
    mechanism.motion.until = std::stod(until);
    return rows_over_motion(mechanism, 73);
  };
  EXPECT_EQ(rows_over_motion(four_bar(1, 4, 3, 4, "2 rad/s", "0 deg", "[4, 3]"), 73), 73);
  EXPECT_EQ(rows("3.0"), 73);
  EXPECT_EQ(rows("6.283185307179586"), 73);
  EXPECT_EQ(rows("62.83185307179586"), 721);
  EXPECT_EQ(rows("62.9"), 793);
  EXPECT_EQ(rows("6283.185307179586"), 3608);
  EXPECT_EQ(
      rows_over_motion(
          read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/slider-crank.toml"), 5000),
      5000);
}

// ∫ sin²(t/4) dt = t/2 − sin(t/2): a whole turn in 4π s. A law has no speed at the start by which steps could
// be measured; backwards it is the mirror image.
TEST(Motion, StartsFromRest) {
  // of the cosine's zero rounding leaves 4e-33 rad/s
  for (const std::string law :
       {"sin(time/4)^2", "-sin(time/4)^2", "cos(time/4 + pi/2)^2", "-cos(time/4 + pi/2)^2"}) {
    const Mechanism mechanism = four_bar(1, 3.5, 3, 4, law + " rad/s", "0 deg", "[3, 3]");
    const double direction = law.front() == '-' ? -1 : 1;
    ASSERT_EQ(mechanism.drives.front().speed, direction);
    // there it stands still again: the last 1e-15 of the way take (48e-15)^(1/3) s
    EXPECT_NEAR(period(mechanism), 4 * std::numbers::pi, 1e-4);
    const Motion motion = solve_motion(mechanism, 9);
    for (std::size_t k = 0; k < 9; ++k) {
      const double t = motion.times[k], angle = direction * (t / 2 - std::sin(t / 2));
      const Eigen::Vector2d& b = motion.configurations[k].points[*mechanism.find_point("B")].position;
      EXPECT_NEAR(b.x(), std::cos(angle), 1e-12);
      EXPECT_NEAR(b.y(), std::sin(angle), 1e-12);
      EXPECT_EQ(motion.configurations[k].status, Status::ok);
    }
    // a quarter of the turn, ahead: t/2 − sin(t/2) = π/2
    const auto quarter = time_at_value(mechanism, direction * std::numbers::pi / 2);
    ASSERT_TRUE(quarter);
    EXPECT_NEAR(*quarter / 2 - std::sin(*quarter / 2), std::numbers::pi / 2, 1e-12);
  }
}

TEST(Motion, NeedsADriveAndTwoPositions) {
  Mechanism mechanism = four_bar(1, 3.5, 3, 4, "1 rad/s", "0 deg", "[3, 3]");
  EXPECT_THROW(solve_motion(mechanism, 1), MechanismError);
  mechanism.drives.clear();
  try {
    period(mechanism);
    FAIL();
  } catch (const MechanismError& error) {
    EXPECT_EQ(error.kind(), MechanismError::Kind::request);
    EXPECT_THAT(error.what(), HasSubstr("four.toml: the mechanism has no drive and does not move"));
  }
}

TEST(Motion, IsRefusedWhereADriveTurnsTooOftenToBeFollowed) {
  const Mechanism mechanism = four_bar(1, 3.5, 3, 4, "1 rad/s", "0 deg", "[3, 3]");
  try {
    solve_motion(mechanism, std::array{0.0, 1e9});
    FAIL();
  } catch (const MechanismError& error) {
    EXPECT_EQ(error.kind(), MechanismError::Kind::request);
    EXPECT_THAT(error.what(),
                HasSubstr("drive 'crank' turns 1.59e+08 times in the 1e+09 s of the motion; expected 10000 "
                          "turns of the fastest drive at most\n  remedy: let the motion end earlier"));
  }
  // seven thousand turns are followed; the closed form's phase carries a rounding of 4e4 rad
  const double late = 7000 * 2 * std::numbers::pi + 1;
  const Motion motion = solve_motion(mechanism, std::array{1.0, late});
  EXPECT_NEAR(motion.configurations[1].points[3].position.x(),
              motion.configurations[0].points[3].position.x(), 1e-10);
}

// Similar mechanisms move alike. Factors that are powers of two change no rounding; the largest and the
// smallest come near the lengths that a file may have, where products of four lengths are no numbers any
// more.
TEST(Motion, OfSimilarMechanismsIsSimilar) {
  const Motion motion = solve_motion(four_bar(1, 3.5, 3, 4, "1 rad/s", "30 deg", "[3, 3]"), 25);
  for (const int power : {-330, -273, -20, 20, 260, 329}) {
    const double factor = std::ldexp(1, power);
    const std::string sketch =
        "[\"3*2^" + std::to_string(power) + "\", \"3*2^" + std::to_string(power) + "\"]";
    const Motion similar =
        solve_motion(four_bar(factor, 3.5 * factor, 3 * factor, 4 * factor, "1 rad/s", "30 deg", sketch), 25);
    for (std::size_t row = 0; row < 25; ++row) {
      const Configuration& here = motion.configurations[row];
      const Configuration& there = similar.configurations[row];
      EXPECT_EQ(there.status, Status::ok);
      for (std::size_t point = 2; point < 4; ++point) {
        EXPECT_EQ(here.points[point].position, there.points[point].position / factor) << power;
        EXPECT_EQ(here.points[point].velocity, there.points[point].velocity / factor) << power;
        EXPECT_EQ(here.points[point].acceleration, there.points[point].acceleration / factor) << power;
      }
      EXPECT_EQ(here.bodies[1].alpha, there.bodies[1].alpha) << power;
    }
  }
}

// A drag link (the shortest bar is the frame): all bars turn fully with the crank.
TEST(Motion, FollowsWholeTurnsOfAllBodiesHoweverFewThePositions) {
  const Mechanism mechanism = four_bar(3, 3.5, 3, 1, "1 rad/s", "0 deg", "[0, 2]");
  for (const int positions : {2, 3, 4, 7, 361}) {
    const Motion motion = solve_motion(mechanism, positions);
    for (const std::size_t body : {1U, 2U}) {
      // the crank's last angle is 2π to its rounding, and a triangle multiplies that by a few
      EXPECT_NEAR(
          motion.configurations.back().bodies[body].angle - motion.configurations.front().bodies[body].angle,
          2 * std::numbers::pi, 1e-14);
    }
  }
}

TEST(Motion, GivesTheSameAnglesForAnyRows) {
  const Mechanism mechanism = four_bar(3, 3.5, 3, 1, "-3 rad/s", "100 deg", "[-2, 2]");
  const std::array times{0.0, 5.0, 2.0, 2.0, -4.0, 0.0};
  const Motion sparse = solve_motion(mechanism, times);
  std::vector<double> fine_times;
  for (int k = -400; k <= 500; ++k) fine_times.push_back(k / 100.0);
  const Motion fine = solve_motion(mechanism, fine_times);
  for (const std::size_t body : {0U, 1U, 2U}) {
    const auto fine_angle = [&](double t) {
      return fine.configurations[static_cast<std::size_t>(std::lround(100 * t) + 400)].bodies[body].angle;
    };
    for (std::size_t row = 0; row < times.size(); ++row) {
      // turns counted from the first row in both; angles of some −17 rad carry a rounding of 4e-15 for the
      // whole turns
      EXPECT_NEAR(sparse.configurations[row].bodies[body].angle - sparse.configurations[0].bodies[body].angle,
                  fine_angle(times[row]) - fine_angle(0), 2e-14);
    }
  }
}

// D lies 1e-5 inside the circle of B, so seen from D, B swings by more than half a turn within one degree of
// the crank. With equal links the triangle BCD is the same at both ends, and both links turn with the
// direction from D to B.
TEST(Motion, FollowsABodyThatTurnsMuchFasterThanItsDrive) {
  const double end = 20.45 * std::numbers::pi / 180;
  const Mechanism mechanism = four_bar(2, 1.5, 1.5, 1.99999, "1 rad/s", "-20.45 deg", "[2.5, 0.5]");
  const Motion motion = solve_motion(mechanism, std::array{0.0, 2 * end});
  const double swing = 2 * std::atan2(2 * std::sin(end), 2 * std::cos(end) - 1.99999);
  EXPECT_GT(swing, std::numbers::pi);
  for (const std::size_t body : {1U, 2U}) {
    // roundings of lengths near 2 over |BD| = 0.7; a lost turn would be 2π
    EXPECT_NEAR(motion.configurations[1].bodies[body].angle - motion.configurations[0].bodies[body].angle,
                swing, 1e-14);
  }
}

// Crank and rocker 1, coupler and frame 4: flat at 0° and 180°. There C is where it must be and its rates
// have no value.
TEST(Motion, PassesDeadCentresOfAParallelogram) {
  const Mechanism mechanism = four_bar(1, 4, 1, 4, "1 rad/s", "90 deg", "[4, 1]");
  const Motion motion = solve_motion(mechanism, 9);
  const std::size_t b = mechanism.find_point("B").value();
  const std::size_t c = mechanism.find_point("C").value();
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const Configuration& here = motion.configurations[row];
    const bool flat = row == 2 || row == 6;
    EXPECT_EQ(here.status, flat ? Status::dead_centre : Status::ok) << row;
    EXPECT_EQ(here.group, flat ? std::optional<std::size_t>(1) : std::nullopt);
    EXPECT_EQ(std::isnan(here.points[c].velocity.x()), flat);
    EXPECT_EQ(std::isnan(here.bodies[2].omega), flat);
    EXPECT_FALSE(std::isnan(here.points[b].velocity.x()));
    // roundings of lengths up to 4; at the dead centre the height of the triangle is √ of one
    EXPECT_NEAR((here.points[c].position - here.points[b].position).norm(), 4, 4e-15);
    EXPECT_NEAR((here.points[c].position - Eigen::Vector2d(4, 0)).norm(), 1, 4e-15);
  }
  EXPECT_NEAR(motion.configurations[0].points[c].position.x(), 4, 4e-15);
  EXPECT_NEAR(motion.configurations[0].points[c].position.y(), 1, 4e-15);
  EXPECT_NEAR(motion.configurations[2].points[c].position.x(), 3, 1e-14);
  EXPECT_NEAR(motion.configurations[6].points[c].position.x(), 5, 1e-14);
  // it passes by its velocity and stays a parallelogram, though C changes its side of B → D
  EXPECT_LT(motion.configurations[4].points[b].position.y(), -0.9);
  EXPECT_NEAR(motion.configurations[4].points[c].position.y(), -1, 4e-15);
  ASSERT_EQ(motion.events.size(), 2U);
  EXPECT_EQ(motion.events[0].kind, MotionEvent::Kind::change);
}

// 0.1 + 0.2 against 0.3: the exact sum is reached, missed and passed by roundings.
TEST(Motion, TakesRoundingJustPastFlatForADeadCentre) {
  Mechanism mechanism = parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [0.3, 0]
[bodies]
AC = { points = ["A", "C"], length = 0.1 }
CD = { points = ["C", "D"], length = 0.2 }
)",
                                        "flat.toml");
  Structure structure = find_groups(mechanism);
  structure.groups[0].side = 1;
  for (const double excess : {-2e-16, 0.0, 2e-16}) {
    mechanism.points[1].position.x() = 0.3 + excess;
    const Configuration here = start_configuration(mechanism, structure);
    EXPECT_EQ(here.status, Status::dead_centre) << excess;
    EXPECT_NEAR(here.points[2].position.x(), 0.1, 1e-15);
  }
  for (const double excess : {-1e-12, 1e-12}) {
    mechanism.points[1].position.x() = 0.3 + excess;
    EXPECT_EQ(start_configuration(mechanism, structure).status, excess > 0 ? Status::open : Status::ok);
  }
}

// C has no place of its own while B lies on D and both links are equal.
TEST(Motion, HasNoNumbersWhereThePivotsOfEqualLinksMeet) {
  const Mechanism mechanism = four_bar(2, 1.5, 1.5, 2, "1 rad/s", "40 deg", "[2.5, 0.5]");
  Mechanism there = mechanism;
  there.drives[0].start = 0;
  EXPECT_EQ(start_configuration(there, decompose(mechanism)).status, Status::open);
}

// Crank 2, coupler 1.5, rocker 1, frame 3.5: BD ≤ 2.5 only while |φ| < arccos(10/14).
TEST(Motion, MarksTheRowsWhereTheMechanismIsOpen) {
  const Mechanism mechanism = four_bar(2, 1.5, 1, 3.5, "2 rad/s", "0 deg", "[3, 1]");
  const Motion motion = solve_motion(mechanism, 361);
  const double limit = std::acos(10.0 / 14);
  int open = 0;
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const Configuration& here = motion.configurations[row];
    const bool closed = std::abs(std::remainder(motion.drives[row][0].value, 2 * std::numbers::pi)) < limit;
    EXPECT_EQ(here.status, closed ? Status::ok : Status::open) << row;
    if (closed) continue;
    ++open;
    EXPECT_EQ(here.group, 1U);
    for (std::size_t point = 2; point < here.points.size(); ++point)
      EXPECT_TRUE(std::isnan(here.points[point].position.x()));
    for (const BodyState& body : here.bodies) EXPECT_TRUE(std::isnan(body.angle));
  }
  EXPECT_EQ(open, 361 - 90);  // arccos(10/14) = 44.4°: rows 0 … 44 and 316 … 360 are closed
  for (const MotionColumn& column : motion_columns(mechanism, motion)) {  // only t and the drive have values
    EXPECT_EQ(std::isnan(column.values[180]), column.name != "t" && column.name != "crank") << column.name;
  }
}

TEST(MotionColumns, AreThoseOfTheFormat) {
  const Mechanism mechanism = four_bar(1, 3.5, 3, 4, "1 rad/s", "30 deg", "[3, 3]");
  const Motion motion = solve_motion(mechanism, 7);
  const auto columns = motion_columns(mechanism, motion);
  std::string names;
  for (const MotionColumn& column : columns) names += column.name + ",";
  EXPECT_EQ(names,
            "t,crank,B.x,B.y,B.vx,B.vy,B.ax,B.ay,C.x,C.y,C.vx,C.vy,C.ax,C.ay,"
            "AB.angle,AB.omega,AB.alpha,BC.angle,BC.omega,BC.alpha,CD.angle,CD.omega,CD.alpha,");
  EXPECT_EQ(columns[1].values[0], 0.5235987755982988);
  EXPECT_EQ(columns[2].unit, "m");
  EXPECT_EQ(columns[4].unit, "m/s");
  EXPECT_EQ(columns[6].unit, "m/s^2");
  // each value stands where its name says
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const Configuration& here = motion.configurations[row];
    const PointState& c = here.points[mechanism.find_point("C").value()];
    EXPECT_EQ(columns[0].values[row], motion.times[row]);
    EXPECT_EQ(columns[8].values[row], c.position.x());
    EXPECT_EQ(columns[11].values[row], c.velocity.y());
    EXPECT_EQ(columns[12].values[row], c.acceleration.x());
    EXPECT_EQ(columns[17].values[row], here.bodies[1].angle);
    EXPECT_EQ(columns[22].values[row], here.bodies[2].alpha);
  }
}

TEST(MotionColumns, HaveNoRatesAtADeadCentre) {
  const Mechanism mechanism = four_bar(1, 4, 1, 4, "1 rad/s", "90 deg", "[4, 1]");
  const Motion motion = solve_motion(mechanism, 5);
  ASSERT_EQ(motion.configurations[1].status, Status::dead_centre);
  const auto columns = motion_columns(mechanism, motion);
  EXPECT_FALSE(std::isnan(columns[8].values[1]));  // C.x
  EXPECT_TRUE(std::isnan(columns[10].values[1]));  // C.vx
  EXPECT_TRUE(std::isnan(columns[12].values[1]));  // C.ax
}

// It passes its change points either way; one passed badly was once taken for a limit days away.
TEST(FindRange, OfAParallelogramHasNoLimits) {
  const Mechanism mechanism =
      read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/parallelogram.toml");
  const MotionLimits range = find_range(mechanism, decompose(mechanism));
  EXPECT_FALSE(range.forward);
  EXPECT_FALSE(range.backward);
}

// A double rocker that turns round at its limits: back from the first it passes its start. A law that has no
// value before t = 0 cannot take it farther, which is no limit.
TEST(Motion, IsRefusedWhereItsLawEndsBeforeItsLimit) {
  MotionOptions options;
  options.positions = 7;
  options.at_limit = AtLimit::reverse;
  const auto rocker = [](const std::string& speed) {
    return four_bar(60, 70, 80, 100, speed, "30 deg", "[100, 80]");
  };
  options.until = 6;
  try {
    solve_motion(rocker("2 + 0.001*sqrt(time) rad/s"), options);
    FAIL() << "it runs back to where its law has no value";
  } catch (const MechanismError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("the speed of drive 'crank' has no value before t = 0 s, and from its limit the drive "
                  "runs back in time, farther than that; expected a law that has values back to the "
                  "other limit\n  remedy: let it stop there, at_limit = \"stop\" in [motion], or write "
                  "the law so that it goes on before that"));
  }
  // One that has them there, and one that does not come so far.
  EXPECT_EQ(solve_motion(rocker("2 + 0.001*time rad/s"), options).times.size(), 7U);
  options.until = 1;
  EXPECT_EQ(solve_motion(rocker("2 + 0.001*sqrt(time) rad/s"), options).times.size(), 7U);
}

}  // namespace
}  // namespace oblique::mechanism
