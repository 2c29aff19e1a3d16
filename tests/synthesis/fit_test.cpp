// SPDX-License-Identifier: MIT
#include <oblique/synthesis/fit.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/motion/obstacle.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/text/document.h>
#include <oblique/text/file.h>

#include "fitting.h"

namespace oblique::synthesis {
namespace {

using namespace test;
using ::testing::HasSubstr;

FourBar four_bar_of(const Fit& fit) {  // of AB, BCF, CD, BCF.F
  const std::vector<double> v = values_of(fit);
  return {v.at(0), v.at(1), v.at(2), 200, v.at(3), v.at(4)};
}

bool turns_fully(const std::string& text) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "fitted.toml");
  return !mechanism::find_obstacle(mechanism, mechanism::decompose(mechanism));
}

/// The error of a four-bar by its own trigonometry.
double rms_at(const FourBar& four_bar, const std::vector<double>& angles, const FourBar& wanted,
              const Eigen::Vector2d& shift = Eigen::Vector2d::Zero()) {
  double sum = 0;
  for (const double angle : angles)
    sum += (four_bar.point(angle) - wanted.point(angle) - shift).squaredNorm();
  return std::sqrt(sum / static_cast<double>(angles.size()));
}

class BothTimings : public ::testing::TestWithParam<Timing> {};
INSTANTIATE_TEST_SUITE_P(Fit, BothTimings, ::testing::Values(Timing::given, Timing::free));

// The path is that of known lengths, by trigonometry; from others they must be found again. Ten digits are
// written to the file, so 1e-6 of lengths of 100 is far above rounding.
TEST_P(BothTimings, RecoverTheDimensionsOfAPath) {
  const FourBar wanted{83, 146, 156, 200, 53, 42};
  for (const FourBar& given : {FourBar{}, FourBar{70, 150, 140, 200, 60, 30}}) {
    const Fit found =
        fit(given.text(), {"AB", "BCF", "CD", "BCF.F"}, csv_of(wanted, angles_of_a_turn(24), GetParam()));
    EXPECT_TRUE(found.improved);
    EXPECT_GT(found.before.rms, 1);
    EXPECT_LT(found.after.rms, 1e-7);
    EXPECT_LE(found.after.rms, found.after.largest);
    const std::vector<double> values = values_of(found);
    const std::vector<double> expected{83, 146, 156, 53, 42};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(values[i], expected[i], 1e-6);
    EXPECT_TRUE(turns_fully(found.text));
  }
}

TEST(Fit, RecoversAFramePointInItsCoordinates) {
  FourBar wanted;
  wanted.frame = 210;
  const Fit found = fit(FourBar{}.text(), {"D.x"}, csv_of(wanted, angles_of_a_turn(7), Timing::given));
  EXPECT_NEAR(found.dimensions.at(0).after, 210, 1e-6);
}

// Moving the frame moves the path: the only shift that cannot be had otherwise.
TEST_P(BothTimings, FollowAShiftedPathWithTheFrame) {
  const Eigen::Vector2d shift(10, 15);
  const Fit found =
      fit(FourBar{}.text(), {"A", "D"}, csv_of(FourBar{}, angles_of_a_turn(24), GetParam(), 0, shift));
  EXPECT_THAT(values_of(found),
              ::testing::ElementsAre(::testing::DoubleNear(10, 1e-6), ::testing::DoubleNear(15, 1e-6),
                                     ::testing::DoubleNear(210, 1e-6), ::testing::DoubleNear(15, 1e-6)));
}

// With noise of ±a in each coordinate, the rms distance is a·sqrt(2/3) at the truth and less at the optimum;
// with free timing only the part of it that is normal to the path counts, a·sqrt(1/3).
TEST_P(BothTimings, ComeDownToTheNoise) {
  const FourBar wanted{83, 146, 156, 200, 53, 42};
  constexpr double kNoise = 0.5;
  const Fit found = fit(FourBar{}.text(), {"AB", "BCF", "CD", "BCF.F"},
                        csv_of(wanted, angles_of_a_turn(60), GetParam(), kNoise));
  EXPECT_LE(found.after.rms, found.before.rms);
  const double at_truth = kNoise * std::sqrt(GetParam() == Timing::given ? 2.0 / 3 : 1.0 / 3);
  EXPECT_LT(found.after.rms, 1.15 * at_truth);
  EXPECT_GT(found.after.rms, 0.7 * at_truth);
  EXPECT_LE(found.after.largest, 2 * kNoise);
}

// The error that is reported is that of the numbers in the text, held against trigonometry.
TEST(Fit, ReportsTheErrorOfItsText) {
  const FourBar wanted{83, 146, 156, 200, 53, 42};
  const Eigen::Vector2d shift(7, -9);
  const auto angles = angles_of_a_turn(24);
  const Fit found =
      fit(FourBar{}.text(), {"AB", "BCF", "CD", "BCF.F"}, csv_of(wanted, angles, Timing::given, 0, shift));
  EXPECT_NEAR(found.before.rms, rms_at(FourBar{}, angles, wanted, shift), 1e-10);
  EXPECT_NEAR(found.after.rms, rms_at(four_bar_of(found), angles, wanted, shift), 1e-10);
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(found.text, "new.toml");
  EXPECT_EQ(mechanism::distance(mechanism.bodies[0], 0, 2), four_bar_of(found).crank);
}

// The optimum is one: no step of any size and direction from it leads to a smaller error.
TEST(Fit, EndsAtAMinimum) {
  const FourBar wanted;
  const Eigen::Vector2d shift(10, 15);
  const auto angles = angles_of_a_turn(24);
  const Fit found =
      fit(FourBar{}.text(), {"AB", "BCF", "CD", "BCF.F"}, csv_of(wanted, angles, Timing::given, 0, shift));
  const double least = rms_at(four_bar_of(found), angles, wanted, shift);
  EXPECT_LT(least, found.before.rms / 3);
  test::Noise random;
  for (const double size : {10.0, 1.0, 0.1, 0.01}) {
    for (int k = 0; k < 200; ++k) {
      FourBar other = four_bar_of(found);
      for (double* value : {&other.crank, &other.coupler, &other.rocker, &other.along, &other.left})
        *value += size * random.next();
      const double rms = rms_at(other, angles, wanted, shift);
      EXPECT_FALSE(rms < least * (1 - 1e-12)) << size << " " << k;  // not-a-number: does not close
    }
  }
}

TEST_P(BothTimings, StayWithinTheBounds) {
  const FourBar wanted{83, 146, 156, 200, 53, 42};
  const Fit found = fit(FourBar{}.text(), {"AB", "BCF=135..142", "CD", "BCF.F.x=45..51", "BCF.F.y"},
                        csv_of(wanted, angles_of_a_turn(24), GetParam()));
  EXPECT_TRUE(found.improved);
  EXPECT_LT(found.after.rms, found.before.rms);
  for (const FittedDimension& d : found.dimensions) {
    EXPECT_GE(d.after, d.lower) << d.name;
    EXPECT_LE(d.after, d.upper) << d.name;
  }
  EXPECT_EQ(found.dimensions.at(1).after, 142);  // exactly, not nearly
  EXPECT_TRUE(found.dimensions.at(1).at_bound());
  EXPECT_FALSE(found.dimensions.at(0).at_bound());
}

TEST(Fit, TakesBoundsThatExcludeTheGivenValue) {
  const FourBar wanted{83, 146, 156, 200, 53, 42};
  const Fit found = fit(FourBar{}.text(), {"AB=82..90", "BCF=145..150", "CD", "BCF.F"},
                        csv_of(wanted, angles_of_a_turn(24), Timing::given));
  EXPECT_NEAR(found.dimensions.at(0).after, 83, 1e-6);
}

// The targets are those of a linkage whose crank of 110 cannot turn over: 110 + 200 > 140 + 150. Among the
// linkages that turn, the best is looked for by a random descent that knows Grashof's condition.
TEST(Fit, KeepsTheCrankTurningWhereTheNearestPathWouldNot) {
  const FourBar wanted{110, 140, 150, 200, 50, 45};
  ASSERT_FALSE(wanted.turns());
  std::vector<double> angles;
  for (int k = -10; k <= 10; ++k) angles.push_back(k * std::numbers::pi / 15);
  const Fit found =
      fit(FourBar{}.text(), {"AB", "BCF", "CD", "BCF.F"}, csv_of(wanted, angles, Timing::given), 3);
  const FourBar fitted = four_bar_of(found);
  EXPECT_TRUE(found.turns_fully);
  EXPECT_TRUE(turns_fully(found.text));
  EXPECT_TRUE(fitted.turns());
  const double reached = rms_at(fitted, angles, wanted);
  EXPECT_LT(reached, found.before.rms / 10);

  FourBar best = fitted;
  double least = reached;
  test::Noise random;
  for (int k = 0; k < 200000; ++k) {
    FourBar other = best;
    const double size = std::pow(10, 2 * random.next() - 1);  // 0.001 … 10
    for (double* value : {&other.crank, &other.coupler, &other.rocker, &other.along, &other.left})
      *value += size * random.next();
    const double rms = rms_at(other, angles, wanted);
    if (!other.turns() || !(rms < least)) continue;
    best = other;
    least = rms;
  }
  // The barrier keeps off the edge by about the square of the angle between two rows, 3e-4 of the size.
  EXPECT_GT(least, 0.998 * reached);
}

// A crank that cannot turn over at first need not afterwards; its targets lie where it moves.
TEST(Fit, WorksOnAMechanismThatDoesNotTurn) {
  const FourBar given{112, 141, 151, 200, 50, 45}, wanted{110, 140, 150, 200, 50, 45};
  std::vector<double> angles;
  for (int k = -8; k <= 8; ++k) angles.push_back(k * std::numbers::pi / 15);
  for (const Timing timing : {Timing::given, Timing::free}) {
    const Fit found = fit(given.text(), {"AB", "BCF", "CD"}, csv_of(wanted, angles, timing));
    EXPECT_FALSE(found.turns_fully);
    EXPECT_NEAR(found.dimensions.at(0).after, 110, 1e-6);
    EXPECT_NEAR(found.dimensions.at(1).after, 140, 1e-6);
  }
}

// The other assembly of the wanted lengths would fit perfectly; the given one must not be left.
TEST(Fit, KeepsTheAssemblyMode) {
  const FourBar wanted{83, 146, 156, 200, 53, 42};
  const std::string mirrored = FourBar{}.text("[128, -132]");
  const Fit found =
      fit(mirrored, {"AB", "BCF", "CD", "BCF.F"}, csv_of(wanted, angles_of_a_turn(24), Timing::given));
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(found.text, "new.toml");
  const mechanism::Motion motion = mechanism::solve_motion(mechanism, 13);
  const std::size_t b = *mechanism.find_point("B"), c = *mechanism.find_point("C"),
                    d = *mechanism.find_point("D");
  for (const mechanism::Configuration& at : motion.configurations) {
    const Eigen::Vector2d bd = at.points[d].position - at.points[b].position;
    const Eigen::Vector2d bc = at.points[c].position - at.points[b].position;
    EXPECT_LT(bd.x() * bc.y() - bd.y() * bc.x(), 0);  // C right of B → D
  }
  EXPECT_GT(found.after.rms, 1);
}

// The sketch lies above the line of pivots at first; the frame is turned until it lies below.
TEST(Fit, MovesTheSketchOnlyWhereItWouldPickAnotherMode) {
  const FourBar four_bar;
  const std::string text = four_bar.text("[180, 10]");
  std::string csv = "F.x,F.y\n";
  const double turn = 0.5;  // [rad], about A: D goes up to y = 96
  for (const double angle : angles_of_a_turn(24)) {
    const Eigen::Vector2d p = four_bar.point(angle);
    csv += fmt::format("{},{}\n", std::cos(turn) * p.x() - std::sin(turn) * p.y(),
                       std::sin(turn) * p.x() + std::cos(turn) * p.y());
  }
  const Fit turned = fit(text, {"D.x", "D.y=-50..150"}, csv, 1);
  EXPECT_NEAR(turned.dimensions.at(0).after, 200 * std::cos(turn), 1e-6);
  EXPECT_NEAR(turned.dimensions.at(1).after, 200 * std::sin(turn), 1e-6);
  EXPECT_TRUE(turned.sketch_moved);
  EXPECT_THAT(turned.text, ::testing::Not(HasSubstr("C = [180, 10]")));
  const Fit little =
      fit(text, {"AB"}, csv_of({82, 140, 150, 200, 50, 45}, angles_of_a_turn(24), Timing::free), 1);
  EXPECT_FALSE(little.sketch_moved);
  EXPECT_THAT(little.text, HasSubstr("C = [180, 10]"));
}

TEST(Fit, ReplacesTheChangedNumbersAndNothingElse) {
  const std::string text = FourBar{}.text();
  const Fit found = fit(text, {"AB", "CD", "BCF.F.x"},
                        csv_of({82, 140, 155, 200, 50, 45}, angles_of_a_turn(24), Timing::given));
  const std::size_t end = found.text.find('\n');
  EXPECT_EQ(found.text.substr(0, end),
            fmt::format("# Fitted from four-bar.toml: AB, CD changed so that F follows the 24 points of "
                        "target.csv, rms {:.4g} mm (before {:.4g}).",
                        found.after.rms, found.before.rms));
  std::string expected = text;
  expected.replace(expected.find("length = 80"), 11, "length = 82");
  expected.replace(expected.find("\"150 mm\""), 8, "155");
  EXPECT_EQ(found.text.substr(end + 1), expected);
}

TEST(Fit, SaysThatNothingIsNearer) {
  const std::string text = FourBar{}.text();
  const Fit found = fit(text, {"AB", "CD"}, csv_of(FourBar{}, angles_of_a_turn(24), Timing::given));
  EXPECT_FALSE(found.improved);
  EXPECT_EQ(found.text, text);
  EXPECT_EQ(found.after.rms, found.before.rms);
  for (const FittedDimension& d : found.dimensions) EXPECT_FALSE(d.changed());
}

TEST(Fit, IsTheSameAtEveryCall) {
  const std::string csv = csv_of(FourBar{}, angles_of_a_turn(12), Timing::free, 0, {10, 15});
  const std::vector<std::string> free{"AB", "BCF", "CD", "BCF.F"};
  EXPECT_EQ(fit(FourBar{}.text(), free, csv, 3).text, fit(FourBar{}.text(), free, csv, 3).text);
}

// The mechanism of the source, with dyads that hang on each other and bodies given by their sides.
TEST(Fit, FindsTheSidesOfJansensLeg) {
  const std::string file = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/jansen.toml";
  const std::string text = text::read_file(file);
  std::string wanted = text;
  wanted.replace(wanted.find("[65.7, 49, 36.7]"), 16, "[66.5, 48, 36.0]");
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(wanted, "wanted.toml");
  const mechanism::Motion motion = mechanism::solve_motion(mechanism, 25);
  std::string csv = "drive,P5.x,P5.y\n";
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    const Eigen::Vector2d& p = motion.configurations[row].points[*mechanism.find_point("P5")].position;
    csv += fmt::format("{},{},{}\n", motion.drives[row][0].value, p.x(), p.y());
  }
  const Fit found = fit_path(text, "jansen.toml", std::vector<std::string>{"lower.sides"},
                             read_target_path(csv, "foot.csv", mechanism));
  EXPECT_THAT(values_of(found),
              ::testing::ElementsAre(::testing::DoubleNear(66.5, 1e-6), ::testing::DoubleNear(48, 1e-6),
                                     ::testing::DoubleNear(36, 1e-6)));
  EXPECT_THAT(found.text,
              HasSubstr("lower2 = { points = [\"Q4\", \"Q5\", \"Q6\"], sides = [65.7, 49, 36.7]"));
}

// The exercise itself: the six-bar's F, its path wanted elsewhere, within the bounds of the source.
TEST(Fit, BringsTheSixBarNearAShiftedTarget) {
  const std::string file = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/six-bar-above.toml";
  const std::string text = text::read_file(file);
  const Eigen::Vector2d shift(3, 4);
  const auto angles = angles_of_a_turn(36);
  const std::string csv = csv_of(FourBar{}, angles, Timing::given, 0, shift);
  const TargetPath target = read_target_path(csv, "target.csv", mechanism::parse_mechanism(text, file));
  const Fit found =
      fit_path(text, file, std::vector<std::string>{"AB=70..90", "BCF=130..150", "CD=140..160"}, target);
  EXPECT_NEAR(found.before.rms, 5, 1e-9);
  EXPECT_LT(found.after.rms, 4.5);
  // the best of a grid within the bounds, by trigonometry, is no better
  double least = 1e300;
  for (double ab = 70; ab <= 90; ab += 0.5) {
    for (double bc = 130; bc <= 150; bc += 0.5) {
      for (double cd = 140; cd <= 160; cd += 0.5) {
        const FourBar other{ab, bc, cd, 200, 50, 45};
        if (other.turns()) least = std::min(least, rms_at(other, angles, FourBar{}, shift));
      }
    }
  }
  EXPECT_LE(found.after.rms, least);
  EXPECT_GT(found.after.rms, 0.99 * least);
}

}  // namespace
}  // namespace oblique::synthesis
