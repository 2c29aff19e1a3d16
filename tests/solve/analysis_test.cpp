// SPDX-License-Identifier: MIT
// What is said about loops and stability of diagrams that can be worked out by hand.
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/solve/stability/analysis.h>
#include <oblique/solve/stability/stability_report.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using std::numbers::pi;
using testing::Compiled;
using ::testing::ElementsAre;

constexpr double kLagTau = 1 / (2 * pi * 10);  // of the default of 10 Hz [s]

Analysis analysis_of(const Compiled& made, double until = 1) {
  RunOptions options;
  options.until = until;
  options.samples = 121;
  return analyse(made.program, made.flat, options);
}

TEST(Loops, ALinearFollowerHasGainErrorAndTimeConstant) {
  constexpr double kWeight = 10, kGain = 500;
  const Compiled made(R"toml(u   = { type = "constant", value = 0.4 }
out = { type = "servo-amplifier", in = ["10*out", "-10*u"], gain = 500 }
)toml");
  const Analysis analysis = analysis_of(made);
  EXPECT_EQ(analysis.instants.size(), 61U);
  ASSERT_EQ(analysis.loops.size(), 1U);
  const LoopReport& loop = analysis.loops[0];
  EXPECT_FALSE(loop.algebraic);
  EXPECT_THAT(loop.members, ElementsAre("out"));
  EXPECT_EQ(loop.kind, LoopKind::linear);
  ASSERT_EQ(loop.unknowns.size(), 1U);
  // Differences of an equation that is linear: rounding of numbers of size 2π·10·gain.
  EXPECT_NEAR(loop.unknowns[0].least_gain, kGain * kWeight, 1e-6);
  EXPECT_NEAR(loop.unknowns[0].static_error.value(), 1 / (kGain * kWeight), 1e-12);
  EXPECT_NEAR(loop.time_constant.value(), kLagTau / (1 + kGain * kWeight), 1e-12);
  EXPECT_EQ(loop.unknowns[0].sign, 1);
  EXPECT_THAT(loop.unknowns[0].sign_changes, ElementsAre());
  // The predicted static error is that of the run: out = u L/(1 + L).
  EXPECT_NEAR(analysis.run->trajectory.at(120, 2), 0.4 * (1 - 1 / (1 + kGain * kWeight)), 1e-12);
}

// What an amplifier adds to its residual, and its capacitor, are no matter of the derivative.
TEST(Loops, ARealAmplifierHasTheGainOfItsLoop) {
  const Compiled made(R"toml(u   = { type = "constant", value = 0.4 }
out = { type = "servo-amplifier", in = ["10*out", "-10*u"], gain = 500, offset = 1e-3 }
)toml");
  const Analysis analysis = analysis_of(made);
  ASSERT_EQ(analysis.loops.size(), 1U);
  EXPECT_NEAR(analysis.loops[0].unknowns[0].least_gain, 5000, 1e-6);
  EXPECT_EQ(analysis.loops[0].unknowns[0].sign, 1);
}

// Its noise gain is 1 + 1.5 in the equation and in its own derivative alike.
TEST(Loops, ARealSummerIsOneWhereItFeedsItself) {
  const Compiled made(R"toml(u    = { type = "constant", value = 0.4 }
back = { type = "summer", in = ["u", "-0.5*back"], bandwidth = 1e4 }
off  = { type = "summer", in = ["u", "0.1*back"], bandwidth = 1e4 }
)toml");
  const Analysis analysis = analysis_of(made);
  ASSERT_EQ(analysis.loops.size(), 1U);
  EXPECT_THAT(analysis.loops[0].members, ElementsAre("back"));
  EXPECT_NEAR(analysis.loops[0].unknowns[0].least_gain, 0.5, 1e-9);
}

// c² = u: the derivative 2 c of the residual depends on c.
TEST(Loops, ARootIsNonLinearAndGoesThroughItsSquarer) {
  const Compiled made(R"toml(u  = { type = "constant", value = 0.25 }
cc = { type = "multiplier", in = ["c", "c"] }
c  = { type = "servo-amplifier", in = ["cc", "-u"], gain = 1e4, initial = 1 }
off = { type = "multiplier", in = ["c", "u"] }
)toml");
  const LoopReport loop = analysis_of(made).loops.at(0);
  EXPECT_THAT(loop.members, ElementsAre("cc", "c"));
  EXPECT_EQ(loop.kind, LoopKind::non_linear);
  const double c = (-1e-4 + std::sqrt(1e-8 + 1)) / 2;
  EXPECT_NEAR(loop.unknowns[0].least_gain, 1e4 * 2 * c, 1e-5);
}

// x q = z while x grows from 0.5 to 1.
TEST(Loops, ADivisionVariesWithItsDenominator) {
  for (const char* bandwidth : {"10", "inf"}) {
    const Compiled made(fmt::format(R"toml(one = {{ type = "constant" }}
z   = {{ type = "constant", value = 0.3 }}
x   = {{ type = "integrator", in = ["0.5*one"], initial = 0.5 }}
xq  = {{ type = "multiplier", in = ["x", "q"] }}
q   = {{ type = "servo-amplifier", in = ["xq", "-z"], gain = 1e5, bandwidth = {} }}
)toml",
                                    bandwidth));
    const LoopReport loop = analysis_of(made).loops.at(0);
    EXPECT_EQ(loop.algebraic, std::string_view(bandwidth) == "inf");
    EXPECT_THAT(loop.members, ElementsAre("xq", "q"));
    EXPECT_EQ(loop.kind, LoopKind::varying);
    EXPECT_NEAR(loop.unknowns[0].least_gain, 1e5 * 0.5, 1e-3);
    EXPECT_EQ(loop.unknowns[0].least_time, 0);
    EXPECT_NEAR(loop.unknowns[0].greatest_gain, 1e5, 1e-3);
    EXPECT_NEAR(loop.unknowns[0].static_error.value(), 2e-5, 1e-12);
    EXPECT_EQ(loop.time_constant.has_value(), !loop.algebraic);
  }
}

// x q = 0.3 as above, but x grows by q: the integrator closes a loop of the problem's own, and is held.
TEST(Loops, HoldWhatIsNoAmplifier) {
  const Compiled made(R"toml(z  = { type = "constant", value = 0.3 }
x  = { type = "integrator", in = ["0.5*q"], initial = 0.5 }
xq = { type = "multiplier", in = ["x", "q"] }
q  = { type = "servo-amplifier", in = ["xq", "-z"], gain = 1e5, bandwidth = 10 }
)toml");
  const auto loops = analysis_of(made).loops;
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_THAT(loops[0].members, ElementsAre("xq", "q"));
}

TEST(Loops, AnIdealAmplifierHasInfiniteGainAndNoError) {
  const Compiled made(R"toml(z = { type = "constant", value = 0.3 }
q = { type = "servo-amplifier", in = ["2*q", "-z"], gain = inf }
)toml");
  const LoopReport loop = analysis_of(made).loops.at(0);
  EXPECT_EQ(loop.kind, LoopKind::linear);
  EXPECT_EQ(loop.unknowns[0].least_gain, std::numeric_limits<double>::infinity());
  EXPECT_EQ(loop.unknowns[0].static_error, 0);
}

TEST(Loops, AFeedbackSummerIsExact) {
  const Compiled made(R"toml(u = { type = "constant", value = 0.3 }
a = { type = "summer", in = ["u", "0.5*b"] }
b = { type = "inverter", in = "a" }
)toml");
  const LoopReport loop = analysis_of(made).loops.at(0);
  EXPECT_TRUE(loop.algebraic);
  EXPECT_THAT(loop.members, ElementsAre("a", "b"));
  EXPECT_NEAR(loop.unknowns[0].least_gain, 0.5, 1e-12);  // comes back −0.5-fold
  EXPECT_FALSE(loop.unknowns[0].static_error);
}

TEST(Loops, TellWhereTheDerivativeChangesItsSign) {
  const Compiled made(R"toml(x  = { type = "integrator", in = ["x"] }
xq = { type = "multiplier", in = ["x", "q"] }
q  = { type = "servo-amplifier", in = ["xq"], gain = 100 }
)toml");
  const SignalFlow flow(made.flat, made.program);
  const std::vector<Instant> instants{{0, {0.5, 0}}, {1, {0.1, 0}}, {2, {-0.3, 0}}, {3, {-0.1, 0}}};
  const LoopReport loop = explain_loops(made.program, flow, instants).at(0);
  EXPECT_EQ(loop.unknowns[0].sign, 1);
  ASSERT_EQ(loop.unknowns[0].sign_changes.size(), 1U);
  EXPECT_NEAR(loop.unknowns[0].sign_changes[0], 1.25, 1e-9);
  EXPECT_FALSE(loop.time_constant);  // it would not settle there
  // what begins at zero has no sign yet, and changes none
  const std::vector<Instant> rising{{0, {0, 0}}, {1, {0.2, 0}}, {2, {0.4, 0}}};
  const LoopUnknown unknown = explain_loops(made.program, flow, rising).at(0).unknowns[0];
  EXPECT_EQ(unknown.sign, 0);
  EXPECT_THAT(unknown.sign_changes, ElementsAre());
}

TEST(Stability, NamesTheElementsOfABadlyDampedServoMode) {
  // The residual comes back through a second amplifier: L = K/(1 + τ s)², ζ = 1/√(1 + K) in the closed loop.
  const Compiled made(R"toml(u = { type = "constant", value = 0.1 }
a = { type = "servo-amplifier", in = ["b", "-u"], gain = 99, bandwidth = 10 }
b = { type = "servo-amplifier", in = ["-a"], gain = 1, bandwidth = 10 }
s = { type = "integrator", in = ["-2*s", "b"] }
)toml");
  const StabilityReport report = analysis_of(made).stability;
  ASSERT_TRUE(report.servo_mode);
  const Mode& mode = report.servo_mode->mode;
  EXPECT_NEAR(mode.damping_ratio(), 0.1, 1e-9);
  EXPECT_NEAR(mode.natural_frequency(), 10 / kLagTau, 1e-6);
  EXPECT_EQ(verdict_on(mode), ModeVerdict::badly_damped);
  EXPECT_EQ(mode.participants.size(), 2U);
  EXPECT_NEAR(mode.participants[0].share, 0.5, 1e-9);
  ASSERT_TRUE(report.problem_mode);
  EXPECT_EQ(report.problem_mode->mode.pole, -2.0);
  ASSERT_EQ(report.margins.size(), 2U);
  // |L| = 1 at (τω)² = K − 1.
  const double margin = 180 - 2 * std::atan(std::sqrt(98.0)) * 180 / pi;
  for (const ServoMargin& servo : report.margins) EXPECT_NEAR(servo.margin->degrees, margin, 1e-6);
  EXPECT_FALSE(report.grows_from);
  EXPECT_THAT(report.left_out, ElementsAre());
}

TEST(Stability, AnOscillatorIsUndampedAndNoFaultOfAServo) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["3*v"], initial = 1 }
v = { type = "integrator", in = ["-3*x"] }
)toml");
  const StabilityReport report = analysis_of(made).stability;
  EXPECT_FALSE(report.servo_mode);
  EXPECT_EQ(verdict_on(report.problem_mode->mode), ModeVerdict::undamped);
  EXPECT_NEAR(report.problem_mode->mode.natural_frequency(), 3, 1e-12);
}

// A ring of 201 heated places: 0 for all together, and −4 sin²(π/201) for the slowest that die.
TEST(Stability, SeeksTheRightmostModesOfWhatIsLargeAndSaysSo) {
  std::string ladder;
  for (int i = 0; i < 201; ++i) {
    ladder += fmt::format("x{0} = {{ type = \"integrator\", in = [\"-2*x{0}\", \"x{1}\", \"x{2}\"] }}\n", i,
                          (i + 200) % 201, (i + 1) % 201);
  }
  const StabilityReport report = analysis_of(Compiled(ladder)).stability;
  ASSERT_EQ(report.left_out.size(), 1U);
  EXPECT_THAT(report.left_out[0], ::testing::HasSubstr("201 states"));
  ASSERT_TRUE(report.problem_mode);
  EXPECT_NEAR(report.rightmost->mode.pole.real(), -4 * std::pow(std::sin(pi / 201), 2), 1e-12);
  EXPECT_FALSE(report.proven);  // the ring as a whole does not decay
}

TEST(Analysis, OfARunThatFailsTellsOfItsLoopsAtRest) {
  // x falls through 0 at t = 0.5, where the loop x q = z loses its gain and then blows up.
  const Compiled made(R"toml(one = { type = "constant" }
x  = { type = "integrator", in = ["-2*one"], initial = 1 }
xq = { type = "multiplier", in = ["x", "q"] }
q  = { type = "servo-amplifier", in = ["xq", "-0.01*one"], gain = 1e4 }
)toml");
  const Analysis analysis = analysis_of(made);
  ASSERT_TRUE(analysis.failure);
  EXPECT_EQ(analysis.failure->kind(), SolveError::Kind::blow_up);
  EXPECT_FALSE(analysis.run);
  EXPECT_TRUE(analysis.quasi_steady);
  EXPECT_EQ(analysis.instants.size(), 61U);
  const LoopUnknown& q = analysis.loops.at(0).unknowns.at(0);
  ASSERT_EQ(q.sign_changes.size(), 1U);
  EXPECT_NEAR(q.sign_changes[0], 0.5, 1e-9);                          // L is linear in t here
  EXPECT_NEAR(analysis.stability.grows_from.value(), 0.5, 1.1 / 60);  // the next instant
}

TEST(Analysis, OfLoopsThatStandNowhereGivesTheInstantsOfTheRun) {
  // q² = 0.25 − t has no root from t = 0.25 on.
  const Compiled made(R"toml(one = { type = "constant" }
x  = { type = "integrator", in = ["one"] }
q2 = { type = "multiplier", in = ["q", "q"] }
q  = { type = "servo-amplifier", in = ["q2", "x", "-0.25*one"], initial = 0.5, gain = 1e4 }
)toml");
  const Analysis analysis = analysis_of(made);
  ASSERT_TRUE(analysis.failure);
  EXPECT_FALSE(analysis.quasi_steady);
  EXPECT_GE(analysis.instants.size(), 15U);  // a sixtieth of a second apart
  EXPECT_LE(analysis.instants.size(), 17U);
}

}  // namespace
}  // namespace oblique::solve
