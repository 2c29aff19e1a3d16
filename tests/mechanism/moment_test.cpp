// SPDX-License-Identifier: MIT
// What is told of a mechanism at one moment: instant centres, reduced inertia, kinematic coefficients.
#include <cmath>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/coefficients.h>
#include <oblique/mechanism/model/inertia.h>
#include <oblique/mechanism/structure/structure.h>

#include "analysed.h"

namespace oblique::mechanism {
namespace {

using namespace analysed;

TEST(InstantCentre, OfACouplerIsWhereItsCranksMeet) {
  const Mechanism four = four_bar(1, 3.5, 3, 4, "50 deg");
  const MechanismAnalysis analysis = analysis_of(four);
  const Configuration here = start_configuration(four, decompose(four));
  const Eigen::Vector2d a = here.points[0].position, d = here.points[1].position;
  const Eigen::Vector2d b = here.points[2].position, c = here.points[3].position;
  // a + s (b − a) = d + t (c − d)
  const auto cross = [](const Eigen::Vector2d& v, const Eigen::Vector2d& w) {
    return v.x() * w.y() - v.y() * w.x();
  };
  const Eigen::Vector2d meeting = a + cross(d - a, c - d) / cross(b - a, c - d) * (b - a);
  ASSERT_EQ(analysis.centres.size(), 6U);
  EXPECT_LT((analysis.centres[1].position.value() - meeting).norm(), 1e-12);
  EXPECT_EQ(analysis.centres[0].position.value(), a);
  EXPECT_EQ(analysis.centres[3].position.value(), b);  // of AB against BC
}

// A. Kennedy's theorem holds for any three links.
TEST(InstantCentre, OfThreeLinksLieOnALine) {
  const Mechanism six = read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/six-bar.toml");
  const MechanismAnalysis analysis = analysis_of(six);
  const std::size_t n = six.bodies.size();
  EXPECT_EQ(analysis.centres.size(), n * (n + 1) / 2);
  const auto centre = [&](std::optional<std::size_t> first, std::size_t second) {
    for (const InstantCentre& c : analysis.centres) {
      if (c.first == first && c.second == second) return c.position.value();
    }
    return Eigen::Vector2d(0, 0);
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Eigen::Vector2d one = centre(std::nullopt, i) - centre(i, j);
      const Eigen::Vector2d other = centre(std::nullopt, j) - centre(i, j);
      const double cross = one.x() * other.y() - one.y() * other.x();
      EXPECT_NEAR(cross, 0, 1e-9 * (1 + one.norm() * other.norm())) << i << " " << j;
    }
  }
}

TEST(InstantCentre, OfTranslationIsAtInfinity) {
  const MechanismAnalysis analysis = analysis_of(four_bar(1, 3, 1, 3, "60 deg", "[3.5, 1]"));
  const InstantCentre& coupler = analysis.centres[1];
  EXPECT_FALSE(coupler.position);
  const Eigen::Vector2d along(std::cos(kPi / 3), std::sin(kPi / 3));
  EXPECT_NEAR(std::abs(coupler.direction.value().dot(along)), 1, 1e-12);
}

TEST(InstantCentre, DoesNotDependOnTheSpeed) {
  const auto coupler_at = [](const Mechanism& mechanism, double times_as_fast) {
    Configuration here = start_configuration(mechanism, decompose(mechanism));
    for (PointState& point : here.points) point.velocity *= times_as_fast;
    for (BodyState& body : here.bodies) body.omega *= times_as_fast;
    return instant_centre(mechanism, here, std::nullopt, 1);
  };
  const Mechanism rocking = four_bar(1, 3.5, 3, 4, "50 deg");
  const Mechanism parallelogram = four_bar(1, 3, 1, 3, "60 deg", "[3.5, 1]");
  const Eigen::Vector2d place = coupler_at(rocking, 1).position.value();
  for (const double speed : {1e-9, 1e9}) {
    EXPECT_LT((coupler_at(rocking, speed).position.value_or(Eigen::Vector2d::Zero()) - place).norm(), 1e-12);
    EXPECT_FALSE(coupler_at(parallelogram, speed).position) << speed;
    EXPECT_TRUE(coupler_at(parallelogram, speed).direction) << speed;
  }
}

/// Twice the kinetic energy at a crank speed of 1, from positions alone, differentiated by five points.
double slider_crank_inertia(double phi, double offset) {
  const auto rod_angle = [&](double p) { return std::asin((offset - 50 * std::sin(p)) / 150); };
  const auto rod_middle = [&](double p) {
    return Eigen::Vector2d(50 * std::cos(p) + 75 * std::cos(rod_angle(p)),
                           50 * std::sin(p) + 75 * std::sin(rod_angle(p)));
  };
  const double h = 1e-3;
  const auto slope = [&](const auto& f) {
    return ((f(phi - 2 * h) - f(phi + 2 * h)) + 8 * (f(phi + h) - f(phi - h))) / (12 * h);
  };
  const double turn = slope(rod_angle);
  const Eigen::Vector2d way(slope([&](double p) { return rod_middle(p).x(); }),
                            slope([&](double p) { return rod_middle(p).y(); }));
  const double crank = 0.4 * (50 * 50 + 10 * 10) / 12 + 0.4 * 25 * 25;
  return 1e-6 * (crank + 0.9 * way.squaredNorm() + 0.9 * 150 * 150 / 12 * turn * turn);
}

TEST(Inertia, ReducedToTheCrankOfASliderCrank) {
  for (const char* speed : {"1 rad/s", "-3 rad/s", "2 + sin(time) rad/s"}) {
    const Mechanism crank = slider_crank(40, speed);
    const Structure structure = decompose(crank);
    const Motion motion = solve_motion(crank, 25);
    for (const MotionColumn& column : analysis_columns(crank, structure, motion)) {
      if (column.name != "crank.inertia") continue;
      EXPECT_EQ(column.unit, "kg*m^2");
      for (std::size_t row = 0; row < 25; ++row) {
        EXPECT_NEAR(column.values[row], slider_crank_inertia(motion.drives[row][0].value, 40), 1e-13);
      }
    }
  }
  const MechanismAnalysis analysis = analysis_of(slider_crank(40, "5 rad/s"));
  const InertiaReport& report = analysis.inertia.value();
  EXPECT_NEAR(report.bars.at(0).inertia, 0.4 * (0.05 * 0.05 + 0.01 * 0.01) / 12, 1e-18);
  EXPECT_NEAR(report.least.value, slider_crank_inertia(report.least.drive, 40), 1e-13);
  for (int k = 0; k < 360; ++k) {
    const double here = slider_crank_inertia(k * kPi / 180, 40);
    EXPECT_GE(here, report.least.value - 1e-13);
    EXPECT_LE(here, report.greatest.value + 1e-13);
  }
  EXPECT_NEAR(report.greatest_energy.value, 25 * report.greatest.value / 2, 1e-12);
}

std::vector<double> column(const std::vector<MotionColumn>& columns, const std::string& name) {
  for (const MotionColumn& column : columns) {
    if (column.name == name) return column.values;
  }
  ADD_FAILURE() << name;
  return {};
}

// x = r cos φ + √(l² − (r sin φ − e)²), whatever the crank's speed.
TEST(Coefficients, AreThoseOfThePositionWhateverTheSpeed) {
  for (const char* speed : {"1 rad/s", "-20 rad/s", "2 + sin(3*time) rad/s"}) {
    const Mechanism crank = slider_crank(40, speed);
    const Motion motion = solve_motion(crank, 37);
    const auto columns = analysis_columns(crank, decompose(crank), motion);
    const auto first = column(columns, "C.dx"), second = column(columns, "C.ddx");
    const auto slide = column(columns, "piston.ddposition"), turn = column(columns, "AB.dangle");
    for (std::size_t row = 0; row < 37; ++row) {
      const double phi = motion.drives[row][0].value, c = std::cos(phi), s = std::sin(phi);
      const double y = 50 * s - 40, root = std::sqrt(150 * 150 - y * y);
      const double x1 = -50 * s - y * 50 * c / root;
      const double x2 =
          -50 * c - (50 * 50 * c * c - y * 50 * s) / root - y * y * 50 * 50 * c * c / (root * root * root);
      EXPECT_NEAR(first[row], x1, 1e-11);
      EXPECT_NEAR(second[row], x2, 1e-10);
      EXPECT_NEAR(slide[row], x2, 1e-10);
      EXPECT_NEAR(turn[row], 1, 1e-14);
    }
  }
}

TEST(Coefficients, HaveNoValueWhereTheDriveStands) {
  const Coefficients none = kinematic_coefficients(0, 1, {1, 0, 2});
  EXPECT_TRUE(std::isnan(none.first));
  EXPECT_TRUE(std::isnan(none.second));
}

}  // namespace
}  // namespace oblique::mechanism
