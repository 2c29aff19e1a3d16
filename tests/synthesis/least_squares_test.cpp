// SPDX-License-Identifier: MIT
#include <oblique/synthesis/least_squares.h>

#include <gtest/gtest.h>

namespace oblique::synthesis {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// r = (x₀ − `at`, 1/10) within these bounds; x₁ has no effect.
LeastSquares one_of_two(double at, const VectorXd& lower, const VectorXd& upper) {
  LeastSquares problem;
  problem.residuals = [at](const VectorXd& x) { return std::optional<VectorXd>(Vector2d(x[0] - at, 0.1)); };
  problem.jacobian = [](const VectorXd&) { return MatrixXd{{1, 0}, {0, 0}}; };
  problem.lower = lower;
  problem.upper = upper;
  return problem;
}

TEST(LeastSquares, LeaveAloneWhatHasNoEffect) {
  const auto found = minimise(one_of_two(1, Vector2d(0, 0), Vector2d(3, 3)), Vector2d(2.5, 0.7));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x[0], 1, 1e-6);  // the root of the least gain that is worth a step
  EXPECT_EQ(found->x[1], 0.7);
}

TEST(LeastSquares, ReachABoundExactly) {
  const auto found = minimise(one_of_two(5, Vector2d(0, 0), Vector2d(3, 3)), Vector2d(2.5, 0.7));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->x[0], 3);
}

// A range of 1, far away from zero: steps are small beside the range, not beside the numbers.
TEST(LeastSquares, JudgeAStepByTheRange) {
  constexpr double kFar = 1e12;
  const auto found =
      minimise(one_of_two(kFar + 0.5, Vector2d(kFar, 0), Vector2d(kFar + 1, 1)), Vector2d(kFar, 0.7));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x[0] - kFar, 0.5, 2e-4);  // numbers there are 1.2e-4 apart
}

}  // namespace
}  // namespace oblique::synthesis
