// SPDX-License-Identifier: MIT
// The oracle of the exact kinematics itself, against closed forms and against its own differences.
#include "natural_coordinates.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::mechanism {
namespace {

using Oracle = NaturalCoordinates;
using Real = Oracle::Real;
using Given = Oracle::Given;

constexpr auto kSliderCrank = R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
X = [1, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3 }
[slides]
s = { point = "C", along = ["A", "X"], offset = 0.5 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)";

/// Every kind of equation at once: a triangle with marks, a pin in a moving slot, a prismatic pair on a link,
/// a driven prismatic joint.
constexpr auto kMixed = R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0.5]
X = [5, 1.5]
[bodies]
crank = { points = ["A", "B"], length = 1 }
slot  = { points = ["D", "E"], length = 2, marks = { F = [0.5, 1.5] } }
yoke  = { points = ["G", "H", "K"], sides = [1, 1.2, 1.3], turn = "right" }
[slides]
pin   = { point = "B", along = ["D", "E"], offset = 0.2 }
guide = { point = "G", along = ["D", "F"], offset = -0.3, angle = "40 deg" }
push  = { point = "K", along = ["D", "X"] }
[drives]
turn = { turns = "crank", about = "A", speed = 1 }
)";

Oracle::Vector guess(const Mechanism& mechanism,
                     const std::vector<std::pair<std::string, Eigen::Vector2d>>& at) {
  Oracle::Vector result = Oracle::Vector::Zero(2 * static_cast<Eigen::Index>(mechanism.points.size()));
  for (const auto& [name, position] : at) {
    result.segment<2>(2 * static_cast<Eigen::Index>(mechanism.find_point(name).value())) =
        position.cast<Real>();
  }
  return result;
}

TEST(NaturalCoordinates, SolveTheSliderCrank) {
  const Mechanism mechanism = parse_mechanism(kSliderCrank, "slider-crank.toml");
  const Oracle oracle(mechanism);
  const Oracle::Vector start = guess(mechanism, {{"B", {1, 0}}, {"C", {4, 0}}});
  std::vector<Given> before{{0, 0, 0}};
  Oracle::Pose pose = oracle.solve(start, before);
  for (int k = 1; k <= 36; ++k) {
    // an uneven crank: φ̇ = 2, φ̈ = 0.7
    const std::vector<Given> here{{10 * k * Oracle::kPi / 180, 2, 0.7L}};
    pose = oracle.follow(pose, before, here, 3);
    before = here;
    const Real c = std::cos(here[0].value), s = std::sin(here[0].value);
    // x = c + √q, q = 9 − (s − e)²
    const Real h = s - 0.5L, root = std::sqrt(9 - h * h);
    const Real slope = -s - h * c / root;
    const Real curvature = -c - (c * c - h * s) / root - h * h * c * c / (root * root * root);
    const Oracle::Scalar slide = oracle.slide(pose, 0);
    EXPECT_NEAR(static_cast<double>(slide.value - (c + root)), 0, 1e-17);
    EXPECT_NEAR(static_cast<double>(slide.rate - 2 * slope), 0, 1e-17);
    EXPECT_NEAR(static_cast<double>(slide.acceleration - (4 * curvature + 0.7L * slope)), 0, 1e-16);
    const Oracle::Scalar rod = oracle.angle(pose, 1, 0);
    EXPECT_NEAR(static_cast<double>(rod.value + std::asin(h / 3)), 0, 1e-18);
    EXPECT_NEAR(static_cast<double>(rod.rate + 2 * c / root), 0, 1e-17);
  }
}

// Central differences over ± h err by h²/6 times the third derivative: 1e-8 here, of numbers around 1.
TEST(NaturalCoordinates, DifferentiateTheirPositions) {
  const Mechanism mechanism = parse_mechanism(kMixed, "mixed.toml");
  const Oracle oracle(mechanism);
  const Real h = 1e-4L, rate = 1.3L, acceleration = -0.8L;
  const auto at = [&](Real t) {
    return std::vector<Given>{
        {0.4L + rate * t + acceleration * t * t / 2, rate + acceleration * t, acceleration}};
  };
  const Oracle::Vector start = guess(mechanism, {{"B", {0.9, 0.4}},
                                                 {"E", {2, 0.5}},
                                                 {"F", {3.5, -1}},
                                                 {"G", {3, -1}},
                                                 {"H", {3, -2}},
                                                 {"K", {4, 0.5}}});
  const Oracle::Pose pose = oracle.solve(start, at(0));
  ASSERT_LT(pose.residual, 1e-18L);
  ASSERT_GT(pose.conditioning, 0.01L);
  const Oracle::Pose before = oracle.solve(pose.position, at(-h)), after = oracle.solve(pose.position, at(h));
  const auto expect_near = [](const Oracle::Vector& a, const Oracle::Vector& b) {
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-6L);
    EXPECT_GT(b.cwiseAbs().maxCoeff(), 0.5L);
  };
  expect_near((after.position - before.position) / (2 * h), pose.velocity);
  expect_near((after.velocity - before.velocity) / (2 * h), pose.acceleration);
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    const auto angle = oracle.angle(pose, i, 0);
    EXPECT_NEAR(static_cast<double>(
                    (oracle.angle(after, i, angle.value).value - oracle.angle(before, i, angle.value).value) /
                    (2 * h)),
                static_cast<double>(angle.rate), 1e-6);
    EXPECT_NEAR(
        static_cast<double>((oracle.angle(after, i, 0).rate - oracle.angle(before, i, 0).rate) / (2 * h)),
        static_cast<double>(angle.acceleration), 1e-6);
  }
  for (std::size_t i = 0; i < mechanism.slides.size(); ++i) {
    const auto slide = oracle.slide(pose, i);
    EXPECT_NEAR(static_cast<double>((oracle.slide(after, i).value - oracle.slide(before, i).value) / (2 * h)),
                static_cast<double>(slide.rate), 1e-6);
    EXPECT_NEAR(static_cast<double>((oracle.slide(after, i).rate - oracle.slide(before, i).rate) / (2 * h)),
                static_cast<double>(slide.acceleration), 1e-6);
  }
}

// What the equations say, in other words: cosines and distances from the positions.
TEST(NaturalCoordinates, KeepLengthsOffsetsAndAngles) {
  const Mechanism mechanism = parse_mechanism(kMixed, "mixed.toml");
  const Oracle oracle(mechanism);
  const Oracle::Vector start = guess(mechanism, {{"B", {0.9, 0.4}},
                                                 {"E", {2, 0.5}},
                                                 {"F", {3.5, -1}},
                                                 {"G", {3, -1}},
                                                 {"H", {3, -2}},
                                                 {"K", {4, 0.5}}});
  const Oracle::Pose pose = oracle.solve(start, {{0.4L, 1, 0}});
  const auto at = [&](const char* name) {
    return oracle.point(pose.position, mechanism.find_point(name).value());
  };
  const auto cross = [](const Oracle::Planar& a, const Oracle::Planar& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const auto expect_equal = [](Real a, double b) { EXPECT_NEAR(static_cast<double>(a), b, 1e-15); };
  expect_equal((at("E") - at("D")).norm(), 2);
  expect_equal((at("H") - at("G")).norm(), 1);
  expect_equal((at("K") - at("H")).norm(), 1.2);
  expect_equal((at("G") - at("K")).norm(), 1.3);
  EXPECT_LT(cross(at("H") - at("G"), at("K") - at("G")), 0);  // to the right
  const Oracle::Planar slot = (at("E") - at("D")) / 2;
  expect_equal(slot.dot(at("F") - at("D")), 0.5);
  expect_equal(cross(slot, at("F") - at("D")), 1.5);
  expect_equal(cross(slot, at("B") - at("D")), 0.2);
  const Oracle::Planar line = (at("F") - at("D")).normalized();
  expect_equal(cross(line, at("G") - at("D")), -0.3);
  expect_equal(std::abs(std::atan2(cross(line, at("H") - at("G")), line.dot(at("H") - at("G")))),
               static_cast<double>(Oracle::kPi) * (oracle.guides_agree(pose.position) ? 40 : 140) / 180);
  expect_equal(cross(at("X") - at("D"), at("K") - at("D")), 0);
}

TEST(NaturalCoordinates, DriveASlide) {
  Mechanism mechanism = parse_mechanism(kSliderCrank, "slider-crank.toml");
  Drive& drive = mechanism.drives.front();
  drive.slide = 0;
  const Oracle oracle(mechanism);
  const Oracle::Pose pose =
      oracle.solve(guess(mechanism, {{"B", {0, 1}}, {"C", {3, 0}}}), {{2.9L, -1.5L, 0.3L}});
  const Oracle::Scalar slide = oracle.slide(pose, 0);
  EXPECT_NEAR(static_cast<double>(slide.value), 2.9, 1e-15);
  EXPECT_NEAR(static_cast<double>(slide.rate), -1.5, 1e-15);
  EXPECT_NEAR(static_cast<double>(slide.acceleration), 0.3, 1e-15);
}

TEST(NaturalCoordinates, SaySoWhereNothingCloses) {
  const Mechanism mechanism = parse_mechanism(kSliderCrank, "slider-crank.toml");
  Mechanism long_reach = mechanism;
  long_reach.drives.front().slide = 0;
  const Oracle oracle(long_reach);
  const Oracle::Pose pose = oracle.solve(guess(mechanism, {{"B", {1, 0}}, {"C", {4, 0}}}), {{5, 0, 0}});
  EXPECT_FALSE(pose.residual < 1e-3L);
}

}  // namespace
}  // namespace oblique::mechanism
