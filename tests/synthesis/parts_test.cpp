// SPDX-License-Identifier: MIT
// The parts of a fit by themselves.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/synthesis/least_squares.h>
#include <oblique/synthesis/path_curve.h>
#include <oblique/synthesis/target_path.h>
#include <oblique/synthesis/text_edit.h>

#include "four_bar.h"

namespace oblique::synthesis {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// ---- minimise

/// Rosenbrock's valley as residuals 10(y − x²), 1 − x; it ends at (1, 1).
LeastSquares valley(const Vector2d& lower, const Vector2d& upper) {
  LeastSquares problem;
  problem.residuals = [](const VectorXd& x) { return Vector2d(10 * (x[1] - x[0] * x[0]), 1 - x[0]); };
  problem.jacobian = [](const VectorXd& x) {
    MatrixXd jacobian(2, 2);
    jacobian << -20 * x[0], 10, -1, 0;
    return jacobian;
  };
  problem.lower = lower;
  problem.upper = upper;
  return problem;
}

TEST(Minimise, FollowsAValleyToItsEnd) {
  const auto found = minimise(valley({-3, -3}, {3, 3}), Vector2d(-1.2, 1));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x[0], 1, 1e-9);
  EXPECT_NEAR(found->x[1], 1, 1e-9);
  EXPECT_FALSE(found->blocked);
}

// With x ≤ ½ the sum (1 − x)² is least at x = ½, y = ¼.
TEST(Minimise, EndsExactlyAtABound) {
  const auto found = minimise(valley({-3, -3}, {0.5, 3}), Vector2d(-1.2, 1));
  EXPECT_EQ(found->x[0], 0.5);
  EXPECT_NEAR(found->x[1], 0.25, 1e-9);
  EXPECT_NEAR(found->sum, 0.25, 1e-12);
}

// With y ≤ ½ too: 100(½ − x²)² + (1 − x)², stationary where 200 x³ − 99 x − 1 = 0.
TEST(Minimise, LeavesABoundThatItNeedNotKeep) {
  const auto found = minimise(valley({-3, -3}, {3, 0.5}), Vector2d(-3, 0.5));
  EXPECT_EQ(found->x[1], 0.5);
  const double x = found->x[0];
  EXPECT_NEAR(200 * x * x * x - 99 * x - 1, 0, 1e-5);
  EXPECT_GT(x, 0);
}

TEST(Minimise, TurnsBackFromWhereThereIsNoValue) {
  LeastSquares problem = valley({-3, -3}, {3, 3});
  const auto everywhere = problem.residuals;
  problem.residuals = [everywhere](const VectorXd& x) {
    return x[0] > 0.7 ? std::optional<VectorXd>() : everywhere(x);
  };
  const auto found = minimise(problem, Vector2d(-1.2, 1));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->blocked);
  EXPECT_LE(found->x[0], 0.7);
  EXPECT_LT(found->sum, 0.2);  // (1 − 0.7)² = 0.09 at the edge, 4.84 at the start
  EXPECT_FALSE(minimise(problem, Vector2d(1, 1)));
}

// ---- PathCurve

/// A point on an ellipse, with n rows over a turn of 1 rad/s.
mechanism::Motion ellipse(int n) {
  mechanism::Motion motion;
  for (int k = 0; k <= n; ++k) {
    const double t = 2 * std::numbers::pi * k / n, c = std::cos(t), s = std::sin(t);
    motion.times.push_back(t);
    mechanism::Configuration here;
    here.points.push_back({{3 * c, s}, {-3 * s, c}, {-3 * c, -s}});
    motion.configurations.push_back(here);
  }
  return motion;
}

// 4e-15 is a few roundings of coordinates up to 3.
TEST(PathCurve, IsTheMotionToRounding) {
  const PathCurve curve(ellipse(360), 0);
  for (const double t : test::angles_of_a_turn(1000)) {
    EXPECT_LT((curve.at(t).value() - Vector2d(3 * std::cos(t), std::sin(t))).norm(), 4e-15);
  }
  EXPECT_FALSE(curve.at(-0.1));
  EXPECT_FALSE(curve.at(6.4));
}

// A place beside the ellipse by d along its normal is d away as long as d is below the radius of curvature,
// 1/3 at its ends.
TEST(PathCurve, FindsTheNearestPlace) {
  const PathCurve curve(ellipse(360), 0);
  for (const double t : test::angles_of_a_turn(100)) {
    const Vector2d place(3 * std::cos(t), std::sin(t));
    const Vector2d normal = Vector2d(std::cos(t), 3 * std::sin(t)).normalized();
    for (const double d : {-0.3, 1e-9, 0.3, 5.0}) {
      const auto foot = curve.nearest(place + d * normal);
      ASSERT_TRUE(foot);
      EXPECT_NEAR(foot->time, t, 1e-7);
      EXPECT_NEAR(foot->difference.norm(), std::abs(d), 1e-14);
      EXPECT_LT((foot->projector - normal * normal.transpose()).norm(), 1e-7);
    }
  }
}

// Two pieces, each as fast as one of its ends alone tells: x = 100 (3 t² − t³), at rest at t = 0 and t = 2.
// The places are beside x(0.8) = 140.8 and x(1.4) = 313.6, and both nearer to where the second piece begins,
// at 200, than to where the first one does.
TEST(PathCurve, FindsTheNearestPlaceOfAPieceThatBeginsOrEndsAtRest) {
  mechanism::Motion motion;
  for (const double t : {0.0, 1.0, 2.0}) {
    motion.times.push_back(t);
    mechanism::Configuration here;
    here.points.push_back(
        {{100 * (3 * t * t - t * t * t), 0}, {100 * (6 * t - 3 * t * t), 0}, {100 * (6 - 6 * t), 0}});
    motion.configurations.push_back(here);
  }
  const PathCurve curve(motion, 0);
  for (const auto& [t, x] : {std::pair(0.8, 140.8), std::pair(1.4, 313.6)}) {
    const auto foot = curve.nearest({x, 5});
    ASSERT_TRUE(foot);
    EXPECT_NEAR(foot->time, t, 1e-12);  // some roundings
    EXPECT_NEAR(foot->difference.norm(), 5, 1e-12);
  }
}

TEST(PathCurve, EndsWhereTheMechanismOpens) {
  mechanism::Motion motion = ellipse(360);
  for (std::size_t row = 90; row <= 270; ++row) motion.configurations[row].status = mechanism::Status::open;
  const PathCurve curve(motion, 0);
  EXPECT_FALSE(curve.at(2));
  const auto foot = curve.nearest({-3, 0.5});
  ASSERT_TRUE(foot);
  EXPECT_NEAR(foot->time, 89 * std::numbers::pi / 180, 1e-12);
  EXPECT_EQ(foot->projector, Eigen::Matrix2d::Identity());
}

TEST(PathCurve, WithoutRowsIsNone) {
  EXPECT_FALSE(PathCurve(mechanism::Motion{}, 0).nearest({0, 0}));
}

// ---- the text

std::string text_at(const std::string& text, std::initializer_list<const char*> keys) {
  const text::Document document = text::parse_document(text, "a.toml");
  const text::Value* value = &document.root;
  for (const char* key : keys) value = value->find(key);
  if (value->kind == text::Value::Kind::array) value = &value->elements.at(1);
  const TextRange range = range_of(text, *value);
  return text.substr(range.begin, range.end - range.begin);
}

TEST(RangeOf, IsTheNumberHoweverItIsWritten) {
  EXPECT_EQ(text_at("a = 80\nb = 2", {"a"}), "80");
  EXPECT_EQ(text_at("a = 80\nb = 2", {"b"}), "2");
  EXPECT_EQ(text_at("\"µ→\" = { b = -1.5e3, c = [1, +2_000] }# x", {"µ→", "b"}), "-1.5e3");
  EXPECT_EQ(text_at("\"µ→\" = { b = -1.5e3, c = [1, +2_000] }# x", {"µ→", "c"}), "+2_000");
  EXPECT_EQ(text_at("x = \"→\"\r\n[a]\r\nb = 7\r\nc = 8", {"a", "b"}), "7");
  EXPECT_EQ(text_at("a.b = \"80 mm\" # \"", {"a", "b"}), "\"80 mm\"");
  EXPECT_EQ(text_at("a = '''80'''", {"a"}), "'''80'''");
  EXPECT_EQ(text_at("\xEF\xBB\xBF"
                    "a = 80",
                    {"a"}),
            "80");
}

TEST(WithComment, KeepsTheTextBehindALineOfItsOwn) {
  EXPECT_EQ(with_comment("a = 1\n", "b"), "# b\na = 1\n");
  EXPECT_EQ(with_comment("a = 1\r\n", "b"), "# b\r\na = 1\r\n");
  EXPECT_EQ(with_comment("\xEF\xBB\xBF"
                         "a = 1\n",
                         "→"),
            "\xEF\xBB\xBF# →\na = 1\n");
  EXPECT_EQ(with_comment("a = 1", "x\ny\x7f"), "# x?y?\na = 1");
  EXPECT_EQ(with_comment("a = 1", "x\xFFy"), "# x?y\na = 1");
}

// ---- the target

TEST(TargetPath, TakesTheUnitsOfItsHeadings) {
  mechanism::Mechanism mechanism = mechanism::parse_mechanism(test::FourBar{}.text(), "m.toml");
  mechanism.length_unit = "cm";
  const TargetPath path = read_target_path("crank [deg],F.x [mm],F.y/m\n90,30,0.04\n", "p.csv", mechanism);
  EXPECT_THAT(path.times, ::testing::ElementsAre(::testing::DoubleNear(std::numbers::pi / 200, 1e-16)));
  EXPECT_LT((path.positions.front() - Vector2d(3, 4)).norm(), 1e-14);
  EXPECT_THAT(read_target_path("t [ms],F.x,F.y\n10,1,2\n", "p.csv", mechanism).times,
              ::testing::ElementsAre(0.01));
}

TEST(TargetPath, TurnsAnglesIntoTimesInTheirOrder) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(test::FourBar{}.text(), "m.toml");
  const TargetPath path = read_target_path("F.y,crank,F.x\n1,3,2\n4,1,5\n", "p.csv", mechanism);
  EXPECT_EQ(path.timing, "crank");
  EXPECT_THAT(path.times, ::testing::ElementsAre(0.01, 0.03));  // at 100 rad/s
  EXPECT_EQ(path.positions.front(), Vector2d(5, 4));
  EXPECT_EQ(mechanism.points[path.point].name, "F");
  EXPECT_THAT(read_target_path("t,F.x,F.y\n0.01,1,2\n", "p.csv", mechanism).times,
              ::testing::ElementsAre(0.01));
  EXPECT_TRUE(read_target_path("F.x,F.y\n1,2\n", "p.csv", mechanism).times.empty());
}

}  // namespace
}  // namespace oblique::synthesis
