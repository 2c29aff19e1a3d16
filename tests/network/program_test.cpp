// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using Vector = std::vector<double>;

double derivative_of_only_state(const Program& program, double x, Workspace& workspace) {
  double derivative = std::nan("");
  EXPECT_TRUE(program.derivatives(0, &x, &derivative, workspace));
  return derivative;
}

TEST(Program, StartsWhereTheIntegratorsDo) {
  const Compiled made(R"(a = { type = "integrator", in = ["b"], initial = 0.25 }
b = { type = "integrator", in = ["a"], initial = -2 }
)");
  EXPECT_EQ(made.program.start(), (Vector{0.25, -2}));
  EXPECT_EQ(made.program.states()[1].name, "b");
  EXPECT_FALSE(made.program.states()[0].at_rest);
}

TEST(Program, GivesSignalsOfLoopsThatNoDerivativeNeeds) {
  // s = x − s y/2 = x/(1 + y/2) feeds nothing.
  const Compiled made(R"(s = { type = "summer", in = ["x", "-0.5*p"] }
p = { type = "multiplier", in = ["s", "y"] }
x = { type = "integrator", in = ["y"] }
y = { type = "integrator", in = ["-x"] }
)");
  Workspace workspace(made.program);
  const Vector x{0.5, 2};
  Vector signals(made.program.n_signals());
  ASSERT_TRUE(made.program.signals(0, x.data(), signals.data(), workspace));
  EXPECT_DOUBLE_EQ(signals[made.signal("s")], 0.25);
  EXPECT_DOUBLE_EQ(signals[made.signal("p")], 0.5);
  EXPECT_DOUBLE_EQ(signals[made.signal("x")], 0.5);
}

TEST(Program, ReadsTheClock) {
  const diagram::BlockLibrary library =
      testing::shipped_blocks_and("clock", "[outputs]\nt = {}\n[equations]\nt = \"time\"\n");
  const Compiled made("c = { type = \"clock\" }\nx = { type = \"integrator\", in = [\"2*c\"] }\n", "",
                      library);
  Workspace workspace(made.program);
  const double x = 0;
  double derivative = 0;
  ASSERT_TRUE(made.program.derivatives(0.75, &x, &derivative, workspace));
  EXPECT_EQ(derivative, 1.5);
}

// The division loop q = z/x by an ideal amplifier: one linear equation, whose solution grows as 1/x.
constexpr const char* kDivision = R"(z = { type = "constant", value = 0.3 }
xq = { type = "multiplier", in = ["x", "q"] }
q = { type = "servo-amplifier", in = ["xq", "-z"], gain = inf, bandwidth = inf }
x = { type = "integrator", in = ["q"] }
)";

TEST(Workspace, ALinearLoopForgetsHowLargeItsSolutionWas) {
  const Compiled made(kDivision);
  Workspace workspace(made.program);
  EXPECT_DOUBLE_EQ(derivative_of_only_state(made.program, 1e-12, workspace), 3e11);
  // Had it been sought from 3e11, rounding would have left 3e11 · 1e-16 = 3e-5.
  EXPECT_DOUBLE_EQ(derivative_of_only_state(made.program, 1, workspace), 0.3);
}

TEST(Workspace, KeepsTheLastSolutionThroughAFailure) {
  const Compiled made(kDivision);
  Workspace workspace(made.program);
  EXPECT_DOUBLE_EQ(derivative_of_only_state(made.program, 0.5, workspace), 0.6);
  const double x = 0;
  double derivative = 0;
  EXPECT_FALSE(made.program.derivatives(0, &x, &derivative, workspace));
  EXPECT_EQ(workspace.trouble().loop, 0U);
  EXPECT_EQ(workspace.trouble().failure, LoopFailure::singular);
  EXPECT_EQ(workspace.trouble().derivative, 0);
  const double not_a_number = std::nan("");
  EXPECT_FALSE(made.program.derivatives(0, &not_a_number, &derivative, workspace));
  EXPECT_EQ(workspace.trouble().failure, LoopFailure::not_finite);
  EXPECT_DOUBLE_EQ(derivative_of_only_state(made.program, 0.5, workspace), 0.6);
}

TEST(Workspace, FollowsTheBranchItIsOnUntilReset) {
  // y² = x by an amplifier that starts at 1 has a second root at −√x; the one found first is followed.
  const Compiled made(R"(yy = { type = "multiplier", in = ["y", "y"] }
y = { type = "servo-amplifier", in = ["yy", "-x"], gain = inf, initial = -2 }
x = { type = "integrator", in = ["y"] }
)");
  Workspace workspace(made.program);
  for (double x = 4; x > 1e-6; x *= 0.7) {
    EXPECT_NEAR(derivative_of_only_state(made.program, x, workspace), -std::sqrt(x), 1e-15) << x;
  }
  EXPECT_EQ(made.program.unknowns()[0].guess, -2);
  workspace.reset();
  EXPECT_NEAR(derivative_of_only_state(made.program, 4, workspace), -2, 1e-15);
}

TEST(Workspace, ReportsALoopWithoutSolution) {
  const Compiled made(
      "r = { type = \"square-root\", in = \"x\", gain = inf, bandwidth = inf }\n"
      "x = { type = \"integrator\", in = [\"-r\"] }\n");
  Workspace workspace(made.program);
  const double x = -0.5;
  double derivative = 0;
  EXPECT_FALSE(made.program.derivatives(0, &x, &derivative, workspace));
  EXPECT_EQ(workspace.trouble().failure, LoopFailure::diverged);
}

TEST(Workspace, SolvesANonLinearLoopFromFarAway) {
  // From 1 the full Newton step to √1e12 overshoots by 5e5 times; damping must not stop short of the root.
  const Compiled made(
      "r = { type = \"square-root\", in = \"x\", gain = inf, bandwidth = inf }\n"
      "x = { type = \"integrator\", in = [\"r\"] }\n");
  for (const double x : {1e-12, 1e-3, 1.0, 1e12}) {
    Workspace workspace(made.program);
    EXPECT_NEAR(derivative_of_only_state(made.program, x, workspace), std::sqrt(x),
                1e-15 * std::sqrt(x) + 1e-18)
        << x;
  }
}

/// The derivative of x′ = z, where z solves `equation` (names z and x) by Newton's method from `guess`.
double implicit_solution(const std::string& equation, double x, double guess) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and(
      "root", "[inputs]\nx = {}\n[outputs]\nz = {}\n[implicit]\nz = \"" + equation +
                  "\"\n[start]\nz = { guess = " + std::to_string(guess) + " }\n");
  const Compiled made("x = { type = \"integrator\", in = [\"r\"] }\nr = { type = \"root\", x = \"x\" }\n", "",
                      library);
  Workspace workspace(made.program);
  double derivative = std::nan("");
  EXPECT_TRUE(made.program.derivatives(0, &x, &derivative, workspace)) << equation << " at " << x;
  return derivative;
}

// cos² + sin² = 1 leaves sin z = x, and the rounding of terms of order k, which no step makes smaller.
TEST(LoopNearZero, IsSolvedToTheRoundingOfItsTerms) {
  for (const double k : {1.0, 1e2, 1e4, 1e6}) {
    const std::string terms = std::to_string(k);
    const std::string equation =
        "sin(z) + " + terms + "*cos(0.3 + z)^2 + " + terms + "*sin(0.3 + z)^2 - " + terms + " - x";
    for (int power = 0; power <= 80; ++power) {
      const double x = power == 0 ? 0 : std::pow(10.0, -0.2 * power) * (power % 2 == 0 ? 0.7 : -0.7);
      // some roundings of k, over the derivative cos z > 0.7
      EXPECT_NEAR(implicit_solution(equation, x, 0.2), std::asin(x), 1e-15 * k + 1e-15) << x << " " << k;
    }
  }
}

// What is small by nature is solved to its own rounding, not to that of 1.
TEST(LoopNearZero, KeepsTheDigitsOfSmallSolutions) {
  for (const double x : {1e-12, 1e-18, 1e-24, 1e-30}) {
    EXPECT_NEAR(implicit_solution("z^2 - x", x, 1), std::sqrt(x), 1e-15 * std::sqrt(x)) << x;
    EXPECT_NEAR(implicit_solution("exp(z)*z - x", x, 0.5), x * (1 - x), 1e-15 * x) << x;
  }
}

/// atan y = x by an ideal amplifier that starts at 3.
class ArcTest : public ::testing::Test {
 protected:
  diagram::BlockLibrary library = testing::shipped_blocks_and(
      "arc", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"atan(in)\"\n");
  Compiled made{
      "a = { type = \"arc\", in = \"y\" }\n"
      "y = { type = \"servo-amplifier\", in = [\"a\", \"-x\"], gain = inf, initial = 3 }\n"
      "x = { type = \"integrator\", in = [\"y\"] }\n",
      "", library};
  Workspace workspace{made.program};
};

TEST_F(ArcTest, DampsStepsThatWouldOvershoot) {
  // From |y| > 1.39 the full Newton steps alternate with growing size.
  EXPECT_NEAR(derivative_of_only_state(made.program, 0.5, workspace), std::tan(0.5), 1e-15);
}

TEST_F(ArcTest, ReturnsFromAFailureToTheLastSolution) {
  EXPECT_NEAR(derivative_of_only_state(made.program, 0.5, workspace), std::tan(0.5), 1e-15);
  const double x = 2;  // beyond π/2: the search ends far out, where the derivative is lost
  double derivative = 0;
  EXPECT_FALSE(made.program.derivatives(0, &x, &derivative, workspace));
  EXPECT_NEAR(derivative_of_only_state(made.program, 0.5, workspace), std::tan(0.5), 1e-15);
}

TEST(Program, IsSharedBetweenThreads) {
  // A dyad on a moving pivot, five loops: each thread follows the same path with a Workspace of its own.
  const Compiled made(
      R"(c = { type = "dyad-rrr", px = "x", py = "y", qx = "q", r1 = 0.9, r2 = 0.7, gain = inf, bandwidth = inf, qy = "o" }
q = { type = "constant", value = 1.2 }
o = { type = "constant", value = 0 }
x = { type = "integrator", in = ["c.x"] }
y = { type = "integrator", in = ["c.y"] }
)");
  const auto walk = [&](Vector& seen) {
    Workspace workspace(made.program);
    Vector derivatives(2), values(made.program.jacobian_pattern().entries());
    for (int k = 0; k < 2000; ++k) {
      const Vector x{0.2 * std::sin(0.01 * k), 0.2 * std::cos(0.01 * k)};
      if (!made.program.derivatives(0, x.data(), derivatives.data(), workspace)) return;
      if (!made.program.jacobian(0, x.data(), values.data(), workspace)) return;
      seen.insert(seen.end(), derivatives.begin(), derivatives.end());
      seen.insert(seen.end(), values.begin(), values.end());
    }
  };
  Vector alone, first, second;
  walk(alone);
  std::thread one(walk, std::ref(first)), two(walk, std::ref(second));
  one.join();
  two.join();
  EXPECT_EQ(alone.size(), 2000U * 6);
  EXPECT_EQ(first, alone);
  EXPECT_EQ(second, alone);
}

}  // namespace
}  // namespace oblique::network
