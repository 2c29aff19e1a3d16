// SPDX-License-Identifier: MIT
#include <oblique/compare/error_parts.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/solve/solve_error.h>

#include "../support/arm.h"
#include "../support/chain_of_dyads.h"
#include "../support/compiled.h"
#include "../support/shipped.h"
#include "four_bar.h"

namespace oblique::compare {
namespace {

using std::numbers::pi;
using test::shipped;
using testing::crank_end;
using testing::kCoupler;
using testing::kPivot;
using testing::kRocker;
using testing::rocker_end;
using testing::rocker_end_at_rest;

ComparedRun compared(const std::string& mechanism, patch::PatchMethod method, double gain, double bandwidth) {
  CompareOptions options;
  options.methods = {method};
  options.gains = {gain};
  options.bandwidths = {bandwidth};
  return compare(shipped(mechanism), diagram::BlockLibrary::shipped(), options).runs.front();
}

// One loop, r = c − φ, on a ramp φ = t: τ ċ = −c − μ (c − t). With T = τ/(1 + μ) it follows
//
//     c = μ/(1 + μ) (t − T),     and at rest stands at     c = μ/(1 + μ) t.
TEST(ErrorParts, OfALoopOnARampAreItsStaticErrorAndItsLag) {
  const testing::Compiled ramp(R"(
one = { type = "constant", value = 1 }
phi = { type = "integrator", in = ["one"] }
c   = { type = "servo-amplifier", in = ["c", "-phi"], gain = 20, bandwidth = "5 Hz" }
)");
  solve::RunOptions options;
  options.until = 0.8;
  options.tolerance = 1e-11;
  options.samples = 2;
  solve::Instant end;
  options.on_sample = [&](double t, std::span<const double> states, std::span<const double>) {
    end = {t, {states.begin(), states.end()}, {}};
  };
  solve::run(ramp.program, ramp.flat, options);
  const auto rest = at_rest(ramp.program, {1}, end);
  ASSERT_TRUE(rest);
  ASSERT_EQ(ramp.program.states()[1].name, "c");
  const double share = 20.0 / 21;
  EXPECT_EQ(rest->states[0], end.states[0]);  // the ramp stands still
  EXPECT_NEAR(rest->states[1], share * 0.8, 1e-11);
  EXPECT_NEAR(end.states[1] - rest->states[1], -share / (2 * pi * 5 * 21), 1e-9);  // tolerance over the steps
}

TEST(ErrorParts, TakeCoordinatesThatAreIntegratorsAndServoAmplifiersForTracking) {
  const testing::Compiled made(R"(
x    = { type = "integrator", in = ["-x"], initial = 0.5 }
turn = { type = "integrator", in = ["x"] }
c    = { type = "servo-amplifier", in = ["c", "-turn"], gain = 20 }
)",
                               "[outputs]\n\"P.x\" = { signal = \"x\", scale = 1, unit = \"m\" }\n"
                               "\"P.y\" = { signal = \"c\", scale = 1, unit = \"m\" }\n"
                               "\"phi\" = { signal = \"turn\", scale = 1, unit = \"1\" }\n");
  EXPECT_EQ(tracking_states(made.program, made.flat, {{0, 0, 1}}), (std::vector<std::size_t>{0, 2}));
}

// A static error falls as 1/μ: with a lag that is nearly all of it gone at rest, what is left says so.
TEST(ErrorParts, AreKnownOfAPatchAsTheSourceDrawsIt) {
  for (const std::string name : {"class-iii", "three-rrr"}) {
    const ComparedRun coarse = compared(name, patch::PatchMethod::paper, 1e3, 20);
    const ComparedRun fine = compared(name, patch::PatchMethod::paper, 1e4, 20);
    ASSERT_TRUE(coarse.parts && fine.parts);
    const auto sum = [](const ErrorParts& parts) { return parts.at_rest + parts.lag + parts.solver; };
    EXPECT_NEAR(sum(*coarse.parts), coarse.max_error, 1e-9 * coarse.max_error);
    EXPECT_NEAR(sum(*fine.parts), fine.max_error, 1e-9 * fine.max_error);
    EXPECT_NEAR(coarse.parts->at_rest / fine.parts->at_rest, 10, 0.5);  // the next order in 1/μ: some percent
  }
}

// 1 + x² has no root.
TEST(ErrorParts, FindNoRestWhereThereIsNone) {
  const testing::Compiled made(R"(
one = { type = "constant", value = 1 }
x2  = { type = "multiplier", in = ["x", "x"] }
x   = { type = "integrator", in = ["-x2", "-one"], initial = 0.01 }
)");
  EXPECT_FALSE(at_rest(made.program, {0}, {0, made.program.start(), {}}));
}

TEST(ErrorParts, StaticPartOfTheFourBarIsThatOfItsEquations) {
  const double gain = 100;
  const ComparedRun run = compared("four-bar", patch::PatchMethod::triangles, gain, 20);
  ASSERT_EQ(run.worst.point, "C");
  const double expected = (rocker_end_at_rest(run.worst.drive, gain) - rocker_end(run.worst.drive)).norm();
  ASSERT_TRUE(run.parts);
  // The lag turns the whole error away from the static one by 1e-5/6e-3 at most: 2e-6 in its cosine.
  EXPECT_NEAR(run.parts->at_rest, expected, 3e-6 * expected);
}

// The lag of a loop goes with τ/(1 + μ r′): four times the bandwidth, a quarter of the lag. The part of the
// lag across the error is as long as the part along it and turns the error by 7e-3 at the most: that is 1 %
// of the lag's part along it, and 3e-5 of the static one's.
TEST(ErrorParts, LagOfTrianglesGoesWithTheTimeConstant) {
  const ComparedRun slow = compared("four-bar", patch::PatchMethod::triangles, 1e3, 5);
  const ComparedRun fast = compared("four-bar", patch::PatchMethod::triangles, 1e3, 20);
  ASSERT_TRUE(slow.parts && fast.parts);
  EXPECT_EQ(slow.worst.drive, fast.worst.drive);
  EXPECT_NEAR(slow.parts->lag / fast.parts->lag, 4, 0.04);
  EXPECT_NEAR(slow.parts->at_rest, fast.parts->at_rest, 5e-5 * fast.parts->at_rest);
}

// The gradient servo follows C at −Ċ/K by the squared lengths of two rods, whose gradients are the unit
// vectors e along them:
//
//     Ċ = −K (e₁e₁ᵀ + e₂e₂ᵀ) δ,     K = gain · 2π · bandwidth
TEST(ErrorParts, OfTheGradientServoAreAllLag) {
  const double gain = 1e4, bandwidth = 20;
  const ComparedRun run = compared("four-bar", patch::PatchMethod::gradient, gain, bandwidth);
  ASSERT_EQ(run.worst.point, "C");
  const double angle = run.worst.drive, h = 1e-5;
  const Eigen::Vector2d velocity = (rocker_end(angle + h) - rocker_end(angle - h)) / (2 * h);  // at 1 rad/s
  const Eigen::Vector2d first = (rocker_end(angle) - crank_end(angle)) / kCoupler;
  const Eigen::Vector2d second = (rocker_end(angle) - kPivot) / kRocker;
  const Eigen::Matrix2d stiffness = first * first.transpose() + second * second.transpose();
  const double lag = (stiffness.inverse() * velocity).norm() / (gain * 2 * pi * bandwidth);
  ASSERT_TRUE(run.parts);
  // What is left out is smaller by the crank's speed over K σ², 2e-6; the solver's error of 7e-9 m turns the
  // whole error by 4e-3 at most, 1e-5 in its cosine; the tighter run errs by 1e-10 m.
  EXPECT_NEAR(run.parts->lag, lag, 2e-4 * lag);
  EXPECT_NEAR(run.parts->at_rest, 0, 1e-9);
}

// With an amplifier that leaves nothing all is the solver's, but for what a hundredth of its tolerance
// leaves.
TEST(ErrorParts, OfHugeGainsAreAllTheSolvers) {
  const ComparedRun run = compared("four-bar", patch::PatchMethod::triangles, 1e12, 20);
  ASSERT_TRUE(run.parts);
  EXPECT_GT(run.max_error, 1e-11);
  EXPECT_NEAR(run.parts->solver, run.max_error, 0.1 * run.max_error);
}

// Without loops nothing lags; the error of C points to the lower left, where a product with it has a sign.
TEST(ErrorParts, OfNothingAreZeroWithoutASign) {
  const mechanism::Mechanism arm = mechanism::parse_mechanism(test::kArm, "arm.toml");
  const Comparison comparison = compare(arm, diagram::BlockLibrary::shipped());
  for (const ComparedRun& run : comparison.runs) {
    ASSERT_TRUE(run.parts);
    EXPECT_EQ(run.parts->lag, 0);
    EXPECT_FALSE(std::signbit(run.parts->lag));
  }
}

// The loops of a long chain add up their rounding: a hundredth of the tolerance takes hundreds of times the
// steps there, and a tenth will do.
TEST(ErrorParts, AreKnownOfALongChain) {
  const mechanism::Mechanism chain = mechanism::parse_mechanism(
      "format = \"oblique-mechanism/1\"\n" + test::chain_of_dyads(20), "chain.toml");
  CompareOptions options;
  options.gains = {1e4};
  const ComparedRun run = compare(chain, diagram::BlockLibrary::shipped(), options).runs.front();
  ASSERT_TRUE(run.parts);
  EXPECT_GT(run.parts->at_rest, 0.9 * run.max_error);
}

TEST(ErrorParts, OfARunThatTakesStepsOfRoundingAreGivenUp) {
  const PatchedMechanism patched(patch_named(shipped("four-bar"), {}), diagram::BlockLibrary::shipped());
  EXPECT_THROW(run_recorded(patched, "few steps", 1e-10, {}, {}, 10), solve::SolveError);
}

class PartsOf : public ::testing::TestWithParam<std::tuple<const char*, patch::PatchMethod>> {};
INSTANTIATE_TEST_SUITE_P(
    ErrorParts, PartsOf,
    ::testing::Combine(::testing::Values("jansen", "class-iii", "slider-crank", "whitworth"),
                       ::testing::Values(patch::PatchMethod::triangles, patch::PatchMethod::gradient)));

// An identity, whatever the parts are: only rounding is left, of some ten operations on lengths of the size.
TEST_P(PartsOf, AddUpToTheLargestError) {
  const auto& [name, method] = GetParam();
  CompareOptions options;
  options.methods = {method};
  options.gains = {1e3};
  const Comparison comparison = compare(shipped(name), diagram::BlockLibrary::shipped(), options);
  const ComparedRun& run = comparison.runs.front();
  ASSERT_TRUE(run.parts);
  EXPECT_NEAR(run.parts->at_rest + run.parts->lag + run.parts->solver, run.max_error,
              1e-14 * comparison.size);
}

}  // namespace
}  // namespace oblique::compare
