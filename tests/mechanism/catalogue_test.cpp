// SPDX-License-Identifier: MIT
// Every shipped mechanism, at every degree, against the natural coordinates.
#include <oblique/mechanism/motion/motion.h>

#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/expectation.h>

#include "catalogue.h"
#include "mechanism_text.h"
#include "natural_coordinates.h"

namespace oblique::mechanism {
namespace {

using Oracle = NaturalCoordinates;
using Real = Oracle::Real;

// the accuracy that the project promises
constexpr double kClosure = 1e-13;
constexpr std::array kAccuracy{1e-12, 1e-10, 1e-10};

/// What no computation with rounded positions can better: next to a singular position, whose equations have
/// the condition κ, the positions err by κ·ε, and as the rates are solved for with matrices made of these
/// positions, velocities err by κ²·ε and accelerations by κ³·ε. It takes κ > 80 to be seen: of this
/// catalogue, the parallelogram half a degree from its points of change.
double slack(std::size_t order, Real conditioning) {
  const double floor = std::numeric_limits<double>::epsilon() /
                       std::pow(static_cast<double>(conditioning), static_cast<double>(order + 1));
  return std::max(1.0, floor / kAccuracy[order]);
}

/// Largest departure from the oracle of one kind of number, and the largest number of that kind.
struct Measure {
  double departure = 0;
  double size = 0;
  std::string where;  ///< of the departure

  /// `times` ≥ 1 is how much farther the number may depart than others.
  void compare(double ours, Real theirs, double times, const std::string& what, std::size_t row) {
    const double difference = std::isnan(ours) ? std::numeric_limits<double>::infinity()
                                               : static_cast<double>(std::abs(ours - theirs)) / times;
    size = std::max(size, static_cast<double>(std::abs(theirs)));
    if (difference <= departure) return;
    departure = difference;
    where = what + ", row " + std::to_string(row);
  }
};

/// A motion held against the oracle: positions, velocities and accelerations of points, links and prismatic
/// joints.
struct Comparison {
  std::array<Measure, 3> points, bodies, slides;
  double closure = 0;         ///< largest residual of our own positions [length unit]
  std::size_t ok = 0;         ///< rows with status `ok`
  std::size_t reachable = 0;  ///< rows without numbers for which the oracle has some
};

std::vector<Oracle::Given> given(const Motion& motion, std::size_t row) {
  std::vector<Oracle::Given> result;
  for (const auto& drive : motion.drives[row])
    result.push_back({drive.value, drive.rate, drive.acceleration});
  return result;
}

Oracle::Vector positions(const Configuration& configuration) {
  Oracle::Vector result(2 * static_cast<Eigen::Index>(configuration.points.size()));
  for (std::size_t i = 0; i < configuration.points.size(); ++i)
    result.segment<2>(2 * static_cast<Eigen::Index>(i)) = configuration.points[i].position.cast<Real>();
  return result;
}

void compare_row(const Mechanism& mechanism, const Oracle& oracle, const Configuration& ours,
                 const Oracle::Pose& pose, std::vector<Real>& angles, std::size_t row,
                 Comparison& comparison) {
  const std::array slacks{slack(0, pose.conditioning), slack(1, pose.conditioning),
                          slack(2, pose.conditioning)};
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    if (mechanism.points[i].fixed) continue;
    const std::string& name = mechanism.points[i].name;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const PointState& point = ours.points[i];
      comparison.points[0].compare(point.position(axis), oracle.point(pose.position, i)(axis), slacks[0],
                                   name, row);
      comparison.points[1].compare(point.velocity(axis), oracle.point(pose.velocity, i)(axis), slacks[1],
                                   name, row);
      comparison.points[2].compare(point.acceleration(axis), oracle.point(pose.acceleration, i)(axis),
                                   slacks[2], name, row);
    }
  }
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    const std::string& name = mechanism.bodies[i].name;
    const auto angle = oracle.angle(pose, i, angles[i]);
    angles[i] = angle.value;
    comparison.bodies[0].compare(ours.bodies[i].angle, angle.value, slacks[0], name, row);
    comparison.bodies[1].compare(ours.bodies[i].omega, angle.rate, slacks[1], name, row);
    comparison.bodies[2].compare(ours.bodies[i].alpha, angle.acceleration, slacks[2], name, row);
  }
  for (std::size_t i = 0; i < mechanism.slides.size(); ++i) {
    const std::string& name = mechanism.slides[i].name;
    const auto slide = oracle.slide(pose, i);
    comparison.slides[0].compare(ours.slides[i].position, slide.value, slacks[0], name, row);
    comparison.slides[1].compare(ours.slides[i].velocity, slide.rate, slacks[1], name, row);
    comparison.slides[2].compare(ours.slides[i].acceleration, slide.acceleration, slacks[2], name, row);
  }
}

/// Our first row gives the oracle its assembly mode; from there it goes its own way, in steps so small that
/// it cannot change the mode. Only behind positions that cannot be assembled does it begin anew.
Comparison hold_against_oracle(const Mechanism& mechanism, const Motion& motion) {
  // odd, so that no step ends halfway between two rows, on the parallelogram's point of change
  constexpr int kStepsPerRow = 5;
  const Oracle oracle(mechanism);
  const Real unit = mechanism.largest_length();
  Comparison comparison;
  Oracle::Pose pose;
  std::vector<Real> angles(mechanism.bodies.size());
  std::size_t last = 0;
  bool following = false;
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const Configuration& ours = motion.configurations[row];
    const auto drives = given(motion, row);
    if (ours.status == Status::open) {
      const auto beyond = following ? oracle.follow(pose, given(motion, last), drives, kStepsPerRow) : pose;
      // Newton's method ends somewhere; closed to rounding is closed
      if (following && beyond.residual < 1e-14L * unit) ++comparison.reachable;
      following = false;
      continue;
    }
    comparison.closure =
        std::max(comparison.closure, static_cast<double>(oracle.residual(positions(ours), drives)));
    if (ours.status == Status::dead_centre) continue;  // no rates; the oracle passes it by
    ++comparison.ok;
    if (following) {
      pose = oracle.follow(pose, given(motion, last), drives, kStepsPerRow);
    } else {
      pose = oracle.solve(positions(ours), drives);
      for (std::size_t i = 0; i < angles.size(); ++i) angles[i] = ours.bodies[i].angle;
    }
    following = true;
    last = row;
    EXPECT_TRUE(oracle.guides_agree(positions(ours))) << "row " << row;
    EXPECT_LT(pose.residual, 1e-16L * unit) << "the oracle itself, row " << row;
    compare_row(mechanism, oracle, ours, pose, angles, row, comparison);
  }
  return comparison;
}

/// What roundings are relative to. A velocity arises from the largest ω times a length and an acceleration
/// from ω², also where all of them cancel (a coupler that does not turn has α = 0 and not a largest one).
struct Scales {
  std::array<double, 3> points, bodies, slides;

  Scales(const Mechanism& mechanism, const Comparison& c) {
    const double length = mechanism.largest_length();
    const double omega = c.bodies[1].size;
    points = {length, std::max(c.points[1].size, omega * length),
              std::max(c.points[2].size, omega * omega * length)};
    bodies = {1, omega, std::max(c.bodies[2].size, omega * omega)};
    slides = points;
  }
};

bool is_exact(const Mechanism& mechanism, const Comparison& c) {
  const Scales scales(mechanism, c);
  bool exact = c.closure <= kClosure * mechanism.largest_length();
  for (std::size_t order = 0; order < 3; ++order) {
    exact = exact && c.points[order].departure <= kAccuracy[order] * scales.points[order] &&
            c.bodies[order].departure <= kAccuracy[order] * scales.bodies[order] &&
            c.slides[order].departure <= kAccuracy[order] * scales.slides[order];
  }
  return exact;
}

class Catalogue : public ::testing::TestWithParam<std::string> {};

TEST_P(Catalogue, MotionIsThatOfTheNaturalCoordinates) {
  const MovingMechanism moving(GetParam());
  const Comparison c = hold_against_oracle(moving.mechanism, moving.motion);
  const Scales scales(moving.mechanism, c);
  EXPECT_LE(c.closure, kClosure * moving.mechanism.largest_length());
  const char* const orders[] = {"position", "velocity", "acceleration"};
  for (std::size_t order = 0; order < 3; ++order) {
    const double accuracy = kAccuracy[order];
    EXPECT_LE(c.points[order].departure, accuracy * scales.points[order])
        << orders[order] << " of point " << c.points[order].where;
    EXPECT_LE(c.bodies[order].departure, accuracy * scales.bodies[order])
        << orders[order] << " of body " << c.bodies[order].where;
    EXPECT_LE(c.slides[order].departure, accuracy * scales.slides[order])
        << orders[order] << " of slide " << c.slides[order].where;
  }
  EXPECT_EQ(c.reachable, 0U) << "positions that can be assembled are said to be open";
  // all of them move through the whole table but the one that is there to show its limits
  EXPECT_EQ(c.ok == moving.rows(), GetParam() != "double-rocker") << c.ok << " rows of " << moving.rows();
}

TEST_P(Catalogue, GivesWhatItsFileExpects) {
  const Mechanism mechanism = read_mechanism(catalogue_folder() / (GetParam() + ".toml"));
  EXPECT_GE(mechanism.expectations.size(), 3U);
  for (const MechanismFinding& finding : check_expectations(mechanism)) {
    EXPECT_TRUE(finding.met) << finding.expectation.text << " is " << finding.actual << " instead of "
                             << finding.expectation.value;
  }
}

/// "FourBar" for "four-bar".
std::string test_name(const ::testing::TestParamInfo<std::string>& file) {
  std::string name;
  bool first = true;
  for (const char c : file.param) {
    if (c != '-') name += first ? static_cast<char>(std::toupper(c)) : c;
    first = c == '-';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, Catalogue, ::testing::ValuesIn(catalogue_names()), test_name);

TEST(CatalogueComparison, AcceptsTheMotionItself) {
  const MovingMechanism four_bar("four-bar");
  EXPECT_TRUE(is_exact(four_bar.mechanism, hold_against_oracle(four_bar.mechanism, four_bar.motion)));
}

// The comparison would be worth nothing if it let these pass.

TEST(CatalogueComparison, CatchesAJumpToTheOtherMode) {
  const MovingMechanism four_bar("four-bar");
  Motion motion = four_bar.motion;
  // from row 180 on the other triangle over BD, which closes as well
  const std::size_t b = 2, c = 3, d = 1;
  for (std::size_t row = 180; row < motion.times.size(); ++row) {
    auto& points = motion.configurations[row].points;
    const Eigen::Vector2d along = (points[d].position - points[b].position).normalized();
    const Eigen::Vector2d arm = points[c].position - points[b].position;
    points[c].position = points[b].position + 2 * along.dot(arm) * along - arm;
  }
  ASSERT_EQ(four_bar.mechanism.points[b].name + four_bar.mechanism.points[c].name, "BC");
  EXPECT_FALSE(is_exact(four_bar.mechanism, hold_against_oracle(four_bar.mechanism, motion)));
}

TEST(CatalogueComparison, CatchesErrorsJustAboveItsTolerance) {
  const MovingMechanism three_bar("three-bar");
  const auto exact_after = [&](auto change) {
    Motion motion = three_bar.motion;
    change(motion.configurations[77]);
    return is_exact(three_bar.mechanism, hold_against_oracle(three_bar.mechanism, motion));
  };
  const std::size_t p = three_bar.mechanism.find_point("P").value();
  const double length = three_bar.mechanism.largest_length();
  EXPECT_TRUE(exact_after([](Configuration&) {}));
  EXPECT_FALSE(exact_after([&](Configuration& c) { c.points[p].position.x() += 2e-12 * length; }));
  EXPECT_FALSE(exact_after([&](Configuration& c) { c.points[p].velocity.y() *= 1 + 1e-7; }));
  EXPECT_FALSE(exact_after([&](Configuration& c) { c.points[p].acceleration *= -1; }));
  EXPECT_FALSE(exact_after([&](Configuration& c) { c.bodies[1].angle += 6.283185307179586; }));
  EXPECT_FALSE(exact_after([&](Configuration& c) { c.bodies[1].omega += 1e-8; }));
  EXPECT_FALSE(exact_after([&](Configuration& c) { c.slides[0].velocity *= 1 + 1e-7; }));
  EXPECT_FALSE(exact_after([&](Configuration& c) { c.slides[0].acceleration = std::nan(""); }));
}

// The crank's end is at x = 1 at 360°, between two of the 3601 positions, the nearer of which gives 1.4e-7
// less; from 0.03° on it is there between the last and the first. The parabola through three errs by the
// fourth power of their distance, 1e-12.
TEST(Expectations, FindExtremesBetweenThePositions) {
  for (const std::string start : {"0.03 deg", "100.03 deg"}) {
    const auto findings = check_expectations(mechanism(R"toml([units]
length = "m"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
[drives]
crank = { turns = "AB", about = "A", speed = "1 rad/s", start = ")toml" +
                                                       start + R"toml(" }
[expect]
"B.x maximum" = { value = 1, within = 1e-11 }
"B.x minimum" = { value = -1, within = 1e-11 }
)toml"));
    ASSERT_EQ(findings.size(), 2U);
    for (const MechanismFinding& finding : findings)
      EXPECT_TRUE(finding.met) << start << ": " << finding.actual;
  }
}

// In each of 120 turns, as in one.
TEST(Expectations, FindExtremesInEachTurn) {
  const auto findings = check_expectations(mechanism(R"toml([units]
length = "m"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
[drives]
crank = { turns = "AB", about = "A", speed = "1 rad/s", start = "100.03 deg" }
[motion]
until = "240*pi"
[expect]
"B.x maximum" = { value = 1, within = 1e-11 }
)toml"));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_TRUE(findings[0].met) << findings[0].actual;
}

}  // namespace
}  // namespace oblique::mechanism
