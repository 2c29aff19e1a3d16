// SPDX-License-Identifier: MIT
// Runs that cannot be finished, and what they say.
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::failure_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

testing::RunFailure failure(const std::string& blocks, const testing::Request& request = {},
                            const diagram::BlockLibrary& library = testing::shipped_blocks()) {
  const auto found = failure_of(Compiled(blocks, "", library), request);
  if (!found) throw std::runtime_error("the run did not fail");
  return *found;
}

// Algebraic loops without one solution.

// The quotient is that of zeros all along: nothing is known of it in any row, though the last solution solves
// it.
TEST(SingularLoop, OfADividerOfZerosWhereItBegins) {
  const auto f = failure(R"(
f = { type = "function-generator", in = "-2*s", points = [[-1, 0.5], [0, 0], [0, 0.5], [1, 0.5]] }
s = { type = "summer", in = ["2*f"] }
q = { type = "divider", numerator = "2*s", denominator = "2*f", gain = inf, bandwidth = inf }
)",
                         {.until = 5, .samples = 41});
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_THAT(f.message,
              HasSubstr("the algebraic loop q.product → q.quotient → q.product is singular at t = 0 s"));
}

TEST(SingularLoop, OfASummerOnItself) {
  const auto f = failure("one = { type = \"constant\" }\ns = { type = \"summer\", in = [\"one\", \"s\"] }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_EQ(f.time, 0);
  EXPECT_EQ(f.message,
            "d.toml:4:1: the algebraic loop s → s is singular at t = 0 s: its gain is 1\n"
            "  remedy: change a weight so that the gain of the loop is not 1, or put an integrator into it");
}

// x = |x|, of which one side determines nothing: what the other left while the start was sought is no
// solution to begin on.
TEST(SingularLoop, OfOneSideOfAMagnitude) {
  const auto f =
      failure("n = { type = \"inverter\", in = \"m\" }\nm = { type = \"absolute-value\", in = \"n\" }\n",
              {.until = 3, .samples = 41});
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_EQ(f.time, 0);
  EXPECT_THAT(f.message, HasSubstr("is singular at t = 0 s: its gain is 1\n"));
}

TEST(SingularLoop, OfTwoSummersInARing) {
  // a = 1 + 2 b, b = a/2
  const auto f = failure(
      "one = { type = \"constant\" }\na = { type = \"summer\", in = [\"one\", \"2*b\"] }\n"
      "b = { type = \"summer\", in = [\"0.5*a\"] }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_THAT(f.message, HasSubstr("the algebraic loop a → b → a is singular at t = 0 s: its gain is 1\n"));
}

TEST(SingularLoop, OfTwoCoupledSummers) {
  // Both equations are a = b up to a constant; each summer alone has a gain of 1/2.
  const auto f = failure(
      "one = { type = \"constant\" }\na = { type = \"summer\", in = [\"0.5*a\", \"0.5*b\"] }\n"
      "b = { type = \"summer\", in = [\"0.5*a\", \"0.5*b\", \"one\"] }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_THAT(f.message,
              HasSubstr("the algebraic loop a → b → a is singular at t = 0 s: its 2 equations determine no "
                        "unique solution (a combination of its gains is 1)\n"
                        "  remedy: change a weight, or put an integrator or a servo amplifier"));
}

TEST(SingularLoop, ThatIsSingularOnlyToRounding) {
  // 0.1 + 0.2 + 0.7 is 1 − 2⁻⁵³ or 1, according to the order of the terms: no gain to divide by.
  const auto f = failure(
      "one = { type = \"constant\" }\n"
      "s = { type = \"summer\", in = [\"one\", \"0.1*s\", \"0.2*s\", \"0.7*s\"] }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
}

TEST(SingularLoop, OfTwoThatAreSingularOnlyToRounding) {
  // a = 0.9 a + 0.1 b, b = 0.3 a + 0.7 b + 1: the determinant is some 1e-17.
  const auto f = failure(
      "one = { type = \"constant\" }\na = { type = \"summer\", in = [\"0.9*a\", \"0.1*b\"] }\n"
      "b = { type = \"summer\", in = [\"0.3*a\", \"0.7*b\", \"one\"] }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
}

TEST(SingularLoop, OfAnIdealAmplifierThatDoesNotSeeItsOutput) {
  const auto f = failure(
      "one = { type = \"constant\" }\n"
      "q = { type = \"servo-amplifier\", in = [\"one\"], gain = inf }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_THAT(f.message, HasSubstr("the algebraic loop q → q is singular at t = 0 s: its gain is 0, "
                                   "the inputs of 'q' do not respond to its output\n"
                                   "  remedy: wire the output back so that the residual changes with it"));
}

TEST(SingularLoop, AtTheTimeWhereADivisorPassesZero) {
  // x = 1/2 − t: z/x ends at t = 1/2.
  const auto f = failure(R"toml(one = { type = "constant" }
x = { type = "integrator", in = ["-one"], initial = 0.5 }
q = { type = "divider", numerator = "one", denominator = "x", gain = inf, bandwidth = inf }
y = { type = "integrator", in = ["q"] }
)toml",
                         {.tolerance = 1e-6});
  EXPECT_TRUE(f.kind == SolveError::Kind::singular_loop || f.kind == SolveError::Kind::blow_up);
  EXPECT_NEAR(f.time, 0.5, 1e-3);
}

// 1/x has no value at the row at which x is zero: however short the run, those of the instants beside it are
// not taken for it. That time is a binary fraction, so that no rounding makes x another number.
TEST(SingularLoop, AtARowIsNotWhatItIsBeside) {
  for (const double span : {1.0, 0x1p-20}) {
    const diagram::BlockLibrary library = testing::shipped_blocks_and(
        "way", fmt::format("[outputs]\nout = {{}}\n[equations]\nout = \"time/{0} - 0.5\"\n", span));
    const auto f = failure(R"toml(x = { type = "way" }
q = { type = "divider", numerator = "one", denominator = "x", gain = inf, bandwidth = inf }
y = { type = "integrator", in = ["one"] }
one = { type = "constant" }
)toml",
                           {.until = span, .samples = 3}, library);
    EXPECT_EQ(f.kind, SolveError::Kind::singular_loop) << span;
    EXPECT_EQ(f.time, span / 2);
  }
}

TEST(LoopWithoutSolution, IsNamedWithWhereItWasSought) {
  const auto f = failure(
      "z = { type = \"constant\", value = -0.5 }\n"
      "r = { type = \"square-root\", in = \"z\", gain = inf, bandwidth = inf }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_THAT(
      f.message,
      StartsWith(
          "d.toml:4:1: the algebraic loop r.square → r.root → r.square has no solution near r.root = 1 "
          "at t = 0 s"));
  EXPECT_THAT(f.message, HasSubstr("remedy: check that its equation can be satisfied"));
}

TEST(LoopWithoutSolution, ComesUpInTheMiddleOfARun) {
  // x = 1/2 − t: the root ends at t = 1/2.
  const auto f = failure(R"toml(one = { type = "constant" }
x = { type = "integrator", in = ["-one"], initial = 0.5 }
r = { type = "square-root", in = "x", gain = inf, bandwidth = inf }
y = { type = "integrator", in = ["r"] }
)toml",
                         {.samples = 2});
  EXPECT_EQ(f.kind, SolveError::Kind::singular_loop);
  EXPECT_NEAR(f.time, 0.5, 1e-2);
  EXPECT_THAT(f.message, HasSubstr("r.square → r.root"));
}

// Solutions that leave the machine.

TEST(BlowUp, StopsAtThePoleAndNamesTheBlock) {
  // x′ = x², x = 1/(1 − t)
  const auto f = failure(R"toml(xx = { type = "multiplier", in = ["x", "x"] }
x = { type = "integrator", in = ["xx"], initial = 1 }
y = { type = "integrator", in = ["-y"], initial = 1 }
)toml",
                         {.until = 2});
  EXPECT_EQ(f.kind, SolveError::Kind::blow_up);
  EXPECT_NEAR(f.time, 1, 1e-5);  // a thousand steps of 1e-8 move the pole
  EXPECT_THAT(f.message, StartsWith("d.toml: the run stopped at t = "));
  EXPECT_THAT(f.message, HasSubstr(" s: the solution grows without bound or jumps there, 'x' = "));
  EXPECT_THAT(f.message, HasSubstr("largest weighted local errors:\n    x = "));
  EXPECT_THAT(f.message, HasSubstr("remedy: look for a positive feedback"));
}

TEST(BlowUp, OfExponentialGrowthIsFoundBeforeInfinity) {
  const auto f = failure("x = { type = \"integrator\", in = [\"x\"], initial = 1, rate = 1000 }\n");
  EXPECT_EQ(f.kind, SolveError::Kind::blow_up);
  EXPECT_NEAR(f.time, 0.71, 0.01);  // e^(1000 t) leaves the range of a double at ln(1.8e308)/1000
}

// The decay takes steps of 1e-8 s at first, 1e-20 of the run.
TEST(BlowUp, IsNoFastDecayAtTheHeadOfALongRun) {
  const Compiled made(R"toml(one = { type = "constant" }
lag = { type = "integrator", in = ["-1e6*lag", "1e6*one"], initial = 0.5 }
slow = { type = "integrator", in = ["-1e-12*slow"], initial = 1 }
)toml");
  const auto result = testing::run_of(made, {.until = 1e12, .samples = 2});
  EXPECT_NEAR(testing::row_values(result, "lag").back(), 1, 1e-7);
  // e^−1, to the tolerance of 1e-8 in some hundred steps
  EXPECT_NEAR(testing::row_values(result, "slow").back(), std::exp(-1), 1e-6);
}

TEST(NotFinite, SignalAtTheStart) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and(
      "inverse", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"1/in\"\n");
  const auto f = failure(
      "x = { type = \"integrator\", in = [\"-x\"] }\nv = { type = \"inverse\", in = \"x\" }\n", {}, library);
  EXPECT_EQ(f.kind, SolveError::Kind::blow_up);
  EXPECT_EQ(f.time, 0);
  EXPECT_THAT(f.message, HasSubstr("the signal 'v' is not a finite number at t = 0"));
  EXPECT_THAT(f.message,
              HasSubstr("remedy: look for a division by zero, a root or logarithm of a negative signal"));
}

TEST(NotFinite, DerivativeAtTheStart) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and(
      "slope", "[outputs]\nout = {}\n[equations]\n\"der(out)\" = \"1/out\"\n[start]\nout = \"0\"\n");
  const auto f = failure("x = { type = \"slope\" }\n", {}, library);
  EXPECT_EQ(f.kind, SolveError::Kind::blow_up);
  EXPECT_EQ(f.time, 0);
  EXPECT_EQ(
      f.message,
      "d.toml: the rate of 'x' is no finite number where the run starts, at t = 0 s; expected equations that "
      "have a value there\n  remedy: start a little beside it, or write a quotient of zeros as its limit, "
      "with "
      "an if(…) in a block");
}

// x = e^1000t comes to 1e10 turns a second within 30 ms, which no search can look through.
TEST(StepBudget, OfLooksAtTurnsIsTold) {
  const auto f = failure(
      "x = { type = \"integrator\", in = \"1000*x\", initial = 1 }\nc = { type = \"cosine\", in = \"x\" }\n"
      "k = { type = \"comparator\", in = \"c\" }\n",
      {.until = 1, .max_steps = 2000});
  EXPECT_EQ(f.kind, SolveError::Kind::step_budget);
  EXPECT_THAT(
      f.message,
      HasSubstr(" rad a second: too fast for every turn to be examined for a crossing\n  remedy: end "
                "the run before, keep the argument of the sine or cosine small, or give more 'max_steps' in "
                "[run]"));
}

TEST(StepBudget, IsKept) {
  const auto f = failure(
      "x = { type = \"integrator\", in = [\"-y\"], initial = 1 }\n"
      "y = { type = \"integrator\", in = [\"x\"] }\n",
      {.until = 1000, .max_steps = 50});
  EXPECT_EQ(f.kind, SolveError::Kind::step_budget);
  EXPECT_GT(f.time, 0);
  EXPECT_LT(f.time, 20);
  EXPECT_THAT(f.message, HasSubstr(": its budget of 50 steps is used up, the last step was "));
  EXPECT_THAT(f.message, HasSubstr("remedy: raise max_steps in [run], loosen the tolerance"));
}

// u' = -u/|u|: at rest after 1 s, where the quotient of two numbers that are both next to nothing goes on.
TEST(StepBudget, IsNotToBeRaisedWhereStepsBecomeEverShorter) {
  const auto f = failure(
      "uu = { type = \"squarer\", in = \"u\" }\n"
      "v = { type = \"square-root\", in = \"uu\", gain = \"inf\", bandwidth = \"inf\" }\n"
      "c = { type = \"divider\", numerator = \"u\", denominator = \"v\", gain = \"inf\", bandwidth = \"inf\" "
      "}\n"
      "u = { type = \"integrator\", in = [\"-c\"], initial = 1 }\n",
      {.until = 2, .max_steps = 20000});
  EXPECT_EQ(f.kind, SolveError::Kind::step_budget);
  EXPECT_THAT(
      f.message,
      HasSubstr("remedy: end the run earlier with 'until', or look at what comes to an end near t = 1"));
}

TEST(StepBudget, OfExactlyTheStepsNeededIsEnough) {
  const Compiled made("x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n");
  const long needed = testing::run_of(made).statistics.steps;
  EXPECT_FALSE(failure_of(made, {.max_steps = needed}));
  EXPECT_TRUE(failure_of(made, {.max_steps = needed - 1}));
}

}  // namespace
}  // namespace oblique::solve
