// SPDX-License-Identifier: MIT
// The shipped mechanisms against an independent solution of their loop equations.
#include <oblique/mechanism/motion/motion.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include "loop_equations.h"

namespace oblique::mechanism {
namespace {

using LongReal = LoopEquations::Real;
using LongComplex = LoopEquations::Complex;
using Chain = LoopEquations::Chain;
constexpr LongReal kPi = std::numbers::pi_v<LongReal>;

/// A loop oracle with the names of its links' bodies and a first guess of the links' angles.
struct ExactOracle {
  LoopEquations equations;
  std::vector<std::string> bodies;
  std::vector<LongReal> guess;
};

Chain join(Chain chain, const Chain& more, bool backwards = false) {
  for (LoopEquations::Term term : more) {
    if (backwards) term.offset += kPi;
    chain.push_back(term);
  }
  return chain;
}

/// A + a + b + c = D, angles of A→B, B→C, C→D; M rides on the coupler.
ExactOracle four_bar(LongReal a, LongReal b, LongReal c, LongReal d, LongComplex mark,
                     const std::string& coupler, const std::string& mark_name) {
  ExactOracle oracle;
  oracle.equations.loops = {{{0, a}, {1, b}, {2, c}, {-1, d, kPi}}};
  oracle.equations.points = {{"B", 0, {{0, a}}},
                             {"C", 0, {{0, a}, {1, b}}},
                             {mark_name, 0, {{0, a}, {1, std::abs(mark), std::arg(mark)}}}};
  oracle.bodies = {"AB", coupler, "CD"};
  oracle.guess = {0, 1.0L, -1.2L};
  return oracle;
}

/// Angle between the sides `a` and `b` of a triangle whose third side is `c`.
LongReal corner(LongReal a, LongReal b, LongReal c) {
  return std::acos((a * a + b * b - c * c) / (2 * a * b));
}

/// Adds one leg of Jansen's mechanism. Links in the order j, upper (angle of P2→O2), k, c, f, lower (P4→P5).
void add_leg(ExactOracle& oracle, const std::string& point, const std::string& suffix, LongReal pin_offset,
             const std::vector<LongReal>& guess) {
  const LongReal a = 38, b = 41.5L, c = 39.3L, d = 40.1L, e = 55.8L, f = 39.4L, g = 36.7L, h = 65.7L, i = 49,
                 j = 50, k = 61.9L, l = 7.8L, m = 15;
  const int first = static_cast<int>(oracle.bodies.size());
  const int j_link = first, upper = first + 1, k_link = first + 2, c_link = first + 3, f_link = first + 4,
            lower = first + 5;
  const LongComplex o2(-a, -l);
  const LoopEquations::Term to_o1{-1, std::abs(o2), std::arg(o2) + kPi};  // O2 → O1
  const Chain pin{{0, m, pin_offset}};
  // P3 lies to the right of P2 → O2: from O2 its direction is that of O2 → P2, turned left by the corner at
  // O2
  const LoopEquations::Term o2_p2{upper, b, kPi}, o2_p3{upper, d, kPi + corner(b, d, e)};
  // P6 lies to the left of P4 → P5
  const LoopEquations::Term p4_p6{lower, g, corner(h, g, i)};
  const Chain o2_to_p6{{c_link, c}};
  const Chain o2_to_p4 = join({o2_p3}, {{f_link, f}});
  oracle.equations.loops.push_back(join(join(join({to_o1}, pin), {{j_link, j}}), {o2_p2}, true));
  oracle.equations.loops.push_back(join(join(join({to_o1}, pin), {{k_link, k}}), o2_to_p6, true));
  oracle.equations.loops.push_back(join(join(o2_to_p4, {p4_p6}), o2_to_p6, true));
  auto& points = oracle.equations.points;
  points.push_back({point + "1", 0, pin});
  points.push_back({point + "2", 0, join(pin, {{j_link, j}})});
  points.push_back({point + "3", o2, {o2_p3}});
  points.push_back({point + "4", o2, o2_to_p4});
  points.push_back({point + "5", o2, join(o2_to_p4, {{lower, h}})});
  points.push_back({point + "6", o2, o2_to_p6});
  for (const char* name : {"rod_j", "upper", "rod_k", "rod_c", "rod_f", "lower"})
    oracle.bodies.push_back(name + suffix);
  oracle.guess.insert(oracle.guess.end(), guess.begin(), guess.end());
}

LongReal radians(LongReal degrees) {
  return degrees * kPi / 180;
}

ExactOracle jansen() {
  ExactOracle oracle;
  oracle.bodies = {"crank"};
  oracle.guess = {0};
  add_leg(oracle, "P", "", 0,
          {radians(141), radians(-110), radians(-133), radians(-74), radians(-85), radians(-70)});
  add_leg(oracle, "Q", "2", kPi,
          {radians(143), radians(-66), radians(-124), radians(-107), radians(-100), radians(-70)});
  return oracle;
}

/// Largest departures from the oracle over one turn. Positions relative to the largest link; a rate relative
/// to the largest of its kind in the motion.
struct Departure {
  double position = 0, angle = 0, velocity = 0, acceleration = 0, omega = 0, alpha = 0;
};

Departure departure(const std::string& file, const ExactOracle& oracle) {
  const Mechanism mechanism =
      read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + file);
  const Motion motion = solve_motion(mechanism, 361);
  Departure worst;
  Departure largest;
  const auto grow = [](double& value, LongReal candidate) {
    value = std::max(value, static_cast<double>(std::abs(candidate)));
  };
  const auto compare = [&](double& difference, double& size, const Eigen::Vector2d& ours,
                           const LongComplex& theirs) {
    grow(difference, std::abs(LongComplex(ours.x(), ours.y()) - theirs));
    grow(size, std::abs(theirs));
  };
  LoopEquations::Vector guess = Eigen::Map<const LoopEquations::Vector>(
      oracle.guess.data(), static_cast<Eigen::Index>(oracle.guess.size()));
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const Configuration& here = motion.configurations[row];
    EXPECT_EQ(here.status, Status::ok);
    const auto state = oracle.equations.solve(motion.drives[row][0].value, mechanism.drives[0].speed, guess);
    guess = state.theta;
    for (const auto& point : oracle.equations.points) {
      const auto moving = oracle.equations.point(point, state);
      const PointState& ours = here.points[mechanism.find_point(point.name).value()];
      compare(worst.position, largest.position, ours.position, moving.position);
      compare(worst.velocity, largest.velocity, ours.velocity, moving.velocity);
      compare(worst.acceleration, largest.acceleration, ours.acceleration, moving.acceleration);
    }
    for (std::size_t i = 0; i < oracle.bodies.size(); ++i) {
      const BodyState& ours = here.bodies[mechanism.find_body(oracle.bodies[i]).value()];
      const auto link = static_cast<Eigen::Index>(i);
      // the whole turns of the first guess are arbitrary
      grow(worst.angle, std::remainder(ours.angle - state.theta(link), 2 * kPi));
      grow(worst.omega, ours.omega - state.omega(link));
      grow(worst.alpha, ours.alpha - state.alpha(link));
      grow(largest.omega, state.omega(link));
      grow(largest.alpha, state.alpha(link));
    }
  }
  worst.position /= mechanism.largest_length();
  worst.velocity /= largest.velocity;
  worst.acceleration /= largest.acceleration;
  worst.omega /= largest.omega;
  worst.alpha /= largest.alpha;
  return worst;
}

/// The accuracy that the project promises; roundings of a few dozen operations behind three dyads, whose
/// triangles multiply them by 1/sin of an angle above 20°, stay two decimal places below it.
void expect_exact(const std::string& file, const ExactOracle& oracle) {
  const Departure worst = departure(file, oracle);
  EXPECT_LT(worst.position, 1e-12);
  EXPECT_LT(worst.angle, 1e-12);
  EXPECT_LT(worst.velocity, 1e-10);
  EXPECT_LT(worst.acceleration, 1e-10);
  EXPECT_LT(worst.omega, 1e-10);
  EXPECT_LT(worst.alpha, 1e-10);
}

TEST(ExactMotion, OfTheFourBarSolvesItsLoopEquations) {
  expect_exact("four-bar.toml", four_bar(1, 3.5L, 3, 4, {1.75L, 1}, "BCM", "M"));
}

TEST(ExactMotion, OfTheSixBarSolvesItsLoopEquations) {
  expect_exact("six-bar-above.toml", four_bar(80, 140, 150, 200, {50, 45}, "BCF", "F"));
}

TEST(ExactMotion, OfJansensLegsSolvesTheirLoopEquations) {
  expect_exact("jansen.toml", jansen());
}

// R₁ cos θ₄ − R₂ cos θ₂ + R₃ = cos(θ₂ − θ₄), R₁ = d/a, R₂ = d/c, R₃ = (a² − b² + c² + d²)/2ac (F.
// Freudenstein 1954)
TEST(ExactMotion, OfTheFourBarFulfilsFreudensteinsEquation) {
  const Mechanism mechanism =
      read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml");
  const double a = 1, b = 3.5, c = 3, d = 4;
  const Motion motion = solve_motion(mechanism, 361);
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const double input = motion.drives[row][0].value;
    const double output = motion.configurations[row].bodies[2].angle + std::numbers::pi;  // of D→C
    // terms up to 4, a dozen roundings
    EXPECT_NEAR(
        d / a * std::cos(output) - d / c * std::cos(input) + (a * a - b * b + c * c + d * d) / (2 * a * c),
        std::cos(input - output), 2e-14);
  }
}

// What makes the leg a leg: the foot is the lowest point, nearly level while it is down, and lifted on its
// way back.
TEST(ExactMotion, OfJansensFootIsFlatOnTheGround) {
  const Mechanism mechanism =
      read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/jansen.toml");
  const Motion motion = solve_motion(mechanism, 361);
  for (const std::string leg : {"P", "Q"}) {
    const std::size_t foot = mechanism.find_point(leg + "5").value();
    double lowest = 0, highest = -1000, left = 1000, right = -1000;
    for (const Configuration& here : motion.configurations) {
      const Eigen::Vector2d at = here.points[foot].position;
      for (const char* other : {"1", "2", "3", "4", "6"}) {
        EXPECT_LT(at.y(), here.points[mechanism.find_point(leg + other).value()].position.y());
      }
      lowest = std::min(lowest, at.y());
      highest = std::max(highest, at.y());
      left = std::min(left, at.x());
      right = std::max(right, at.x());
    }
    const auto down = std::count_if(
        motion.configurations.begin(), motion.configurations.end() - 1, [&](const Configuration& here) {
          const bool is_down = here.points[foot].position.y() < lowest + 1;
          EXPECT_TRUE(!is_down || here.points[foot].velocity.x() > 0);  // all of it one sweep
          return is_down;
        });
    // the known proportions of the leg, to the tenth of a millimetre of its rounded lengths
    EXPECT_NEAR(right - left, 67.9, 0.1);
    EXPECT_NEAR(highest - lowest, 22.5, 0.1);
    EXPECT_GT(down, 150);  // of 360 positions within 1 mm of the ground
  }
}

}  // namespace
}  // namespace oblique::mechanism
