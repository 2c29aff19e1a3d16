// SPDX-License-Identifier: MIT
// Feedback systems of control textbooks. The poles are the roots of the numerator of 1 + L(s) by NumPy
// (numpy.roots), the margins the roots of |L(iω)|² = 1, both from transfer functions, never from a matrix.
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/solve/stability/analysis.h>
#include <oblique/solve/stability/stability_report.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using Verdict = StabilityVerdict;

struct TextbookLoop {
  const char* name;
  const char* blocks;  ///< beside r, the reference
  Verdict verdict;
  double real, imaginary;        ///< of the rightmost pole [1/s]
  std::size_t growing;           ///< poles right of the axis
  std::optional<double> margin;  ///< of the amplifier a [°]
};

// a = −K (y − r)/(1 + s/(2π bandwidth)) everywhere.
const TextbookLoop kLoops[] = {
    {"TwoLags", R"(a  = { type = "servo-amplifier", in = ["l2", "-r"], gain = 100, bandwidth = 10 }
l1 = { type = "transfer-lag", in = "a", time_constant = 1e-4 }
l2 = { type = "transfer-lag", in = "l1", time_constant = 1e-4 })",
     Verdict::stable, -1914.7021, 5951.991, 0, 37.416325},
    {"TwoLagsAndTooMuchGain",
     R"(a  = { type = "servo-amplifier", in = ["l2", "-r"], gain = 1000, bandwidth = 10 }
l1 = { type = "transfer-lag", in = "a", time_constant = 1e-4 }
l2 = { type = "transfer-lag", in = "l1", time_constant = 1e-4 })",
     Verdict::servos_unstable, 2801.37633, 15401.521, 2, -27.813490},
    {"MotorWithAnIntegrator", R"(a = { type = "servo-amplifier", in = ["y", "-r"], gain = 5, bandwidth = 100 }
i = { type = "integrator", in = "a" }
y = { type = "transfer-lag", in = "i", time_constant = 0.1 })",
     Verdict::stable, -4.95957825, 5.0394594, 0, 65.115707},
    {"TwoIntegratorsAndALead",
     R"(a  = { type = "servo-amplifier", in = ["y", "-r"], gain = 4, bandwidth = 100 }
i1 = { type = "integrator", in = "a" }
i2 = { type = "integrator", in = "i1" }
l  = { type = "transfer-lag", in = "i2", time_constant = 0.1 }
y  = { type = "summer", in = ["10*i2", "-9*l"] })",
     Verdict::stable, -1.44626008, 0, 0, 54.023728},
    {"TwoIntegratorsAlone", R"(a  = { type = "servo-amplifier", in = ["i2", "-r"], gain = 4, bandwidth = 100 }
i1 = { type = "integrator", in = "a" }
i2 = { type = "integrator", in = "i1" })",
     Verdict::servos_unstable, 0.00318303436, 1.99998734, 2, -0.182377},
    {"ConditionallyStable",
     R"(a  = { type = "servo-amplifier", in = ["y", "-r"], gain = 10, bandwidth = 1000 }
i1 = { type = "integrator", in = "a" }
i2 = { type = "integrator", in = "i1" }
i3 = { type = "integrator", in = "i2" }
y  = { type = "summer", in = ["i1", "2*i2", "i3"] })",
     Verdict::stable, -0.78153012, 0, 0, 78.596910},
    {"ConditionallyStableWithTooLittleGain",
     R"(a  = { type = "servo-amplifier", in = ["y", "-r"], gain = 0.3, bandwidth = 1000 }
i1 = { type = "integrator", in = "a" }
i2 = { type = "integrator", in = "i1" }
i3 = { type = "integrator", in = "i2" }
y  = { type = "summer", in = ["i1", "2*i2", "i3"] })",
     Verdict::servos_unstable, 0.0748439689, 0.81343714, 2, -13.685234},
    {"NonMinimumPhase",
     R"(a  = { type = "servo-amplifier", in = ["y", "-r"], gain = 0.5, bandwidth = 100 }
l1 = { type = "transfer-lag", in = "a", time_constant = 0.5 }
l2 = { type = "transfer-lag", in = "l1", time_constant = 1 }
y  = { type = "summer", in = ["-l1", "2*l2"] })",
     Verdict::stable,
     -0.997612706,
     1.41420617,
     0,
     {}},
    {"NonMinimumPhaseWithTooMuchGain",
     R"(a  = { type = "servo-amplifier", in = ["y", "-r"], gain = 3, bandwidth = 100 }
l1 = { type = "transfer-lag", in = "a", time_constant = 0.5 }
l2 = { type = "transfer-lag", in = "l1", time_constant = 1 }
y  = { type = "summer", in = ["-l1", "2*l2"] })",
     Verdict::servos_unstable, 1.49052609, 2.38807389, 2, -50.992893},
    {"ThreeEqualLagsBelowEight",
     R"(a  = { type = "servo-amplifier", in = ["l2", "-r"], gain = 7, bandwidth = 0.15915494309189535 }
l1 = { type = "transfer-lag", in = "a" }
l2 = { type = "transfer-lag", in = "l1" })",
     Verdict::stable, -0.0435344086, 1.656647, 0, 4.552297},
    {"ThreeEqualLagsAboveEight",
     R"(a  = { type = "servo-amplifier", in = ["l2", "-r"], gain = 9, bandwidth = 0.15915494309189535 }
l1 = { type = "transfer-lag", in = "a" }
l2 = { type = "transfer-lag", in = "l1" })",
     Verdict::servos_unstable, 0.0400419115, 1.80140543, 2, -3.796837},
    {"UnstablePlantHeld",
     R"(a = { type = "servo-amplifier", in = ["y", "-r"], gain = 10, bandwidth = 100 }
y = { type = "integrator", in = ["y", "a"] })",
     Verdict::stable, -9.14774182, 0, 0, 83.352979},
    {"UnstablePlantAndTooLittleGain",
     R"(a = { type = "servo-amplifier", in = ["y", "-r"], gain = 0.5, bandwidth = 100 }
y = { type = "integrator", in = ["y", "a"] })",
     Verdict::servos_unstable,
     0.500397887,
     0,
     1,
     {}},
    {"TwoAmplifiersInOneLoop",
     R"(a  = { type = "servo-amplifier", in = ["l2", "-r"], gain = 20, bandwidth = 10 }
l1 = { type = "transfer-lag", in = "a", time_constant = 0.001 }
b  = { type = "servo-amplifier", in = ["-l1"], gain = 3, bandwidth = 50 }
l2 = { type = "transfer-lag", in = "b", time_constant = 0.002 })",
     Verdict::servos_unstable, 197.171151, 579.642578, 2, -61.429374},
    {"PidOnAnOscillator",
     R"(a  = { type = "servo-amplifier", in = ["y", "-r"], gain = 1, bandwidth = 1000 }
x1 = { type = "integrator", in = "x2" }
x2 = { type = "integrator", in = "x3" }
x3 = { type = "integrator", in = ["a", "-0.4*x3", "-x2"] }
y  = { type = "summer", in = ["2*x1", "3*x2", "x3"] })",
     Verdict::stable, -0.416393874, 1.8316056, 0, 33.576188},
    {"FiveLags",
     R"(a  = { type = "servo-amplifier", in = ["l4", "-r"], gain = 2000, bandwidth = 1 }
l1 = { type = "transfer-lag", in = "a", time_constant = 0.01 }
l2 = { type = "transfer-lag", in = "l1", time_constant = 0.003 }
l3 = { type = "transfer-lag", in = "l2", time_constant = 0.001 }
l4 = { type = "transfer-lag", in = "l3", time_constant = 0.0003 })",
     Verdict::servos_unstable, 279.623924, 493.266967, 2, -99.807763},
    {"Resonance", R"(a  = { type = "servo-amplifier", in = ["x1", "-r"], gain = 0.15, bandwidth = 1000 }
i  = { type = "integrator", in = "a" }
x1 = { type = "integrator", in = "x2" }
x2 = { type = "integrator", in = ["i", "-0.2*x2", "-x1"] })",
     Verdict::stable, -0.0244400551, 0.995987979, 0, 88.197203},
    {"ResonanceAboveOne",
     R"(a  = { type = "servo-amplifier", in = ["x1", "-r"], gain = 0.25, bandwidth = 1000 }
i  = { type = "integrator", in = "a" }
x1 = { type = "integrator", in = "x2" }
x2 = { type = "integrator", in = ["i", "-0.2*x2", "-x1"] })",
     Verdict::servos_unstable, 0.0235656662, 1.00551106, 2, -27.448800},
};

class Textbook : public ::testing::TestWithParam<TextbookLoop> {};
INSTANTIATE_TEST_SUITE_P(Loops, Textbook, ::testing::ValuesIn(kLoops),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(Textbook, HasThePolesTheMarginAndTheVerdict) {
  const TextbookLoop& loop = GetParam();
  const Compiled made(fmt::format("r = {{ type = \"constant\", value = 0.1 }}\n{}\n", loop.blocks));
  const SignalFlow flow(made.flat, made.program);
  const std::vector<Instant> instants{{0, made.program.start()}};
  const StabilityReport report = judge_stability(made.program, flow, instants);
  EXPECT_EQ(report.verdict, loop.verdict);
  ASSERT_TRUE(report.rightmost);
  // The table has nine digits; a bandwidth in hertz and a multiple real pole lose some.
  const double size = std::hypot(loop.real, loop.imaginary);
  EXPECT_NEAR(report.rightmost->mode.pole.real(), loop.real, 1e-7 * size);
  EXPECT_NEAR(report.rightmost->mode.pole.imag(), loop.imaginary, 1e-7 * size);
  EXPECT_EQ(report.growing, loop.growing);
  // An ideal amplifier leaves no motion but that of the zeros of the plant, none of which lies right of the
  // axis near these poles.
  EXPECT_TRUE(report.rightmost_is_servo || loop.growing == 0);
  EXPECT_EQ(report.grows_from.has_value(), loop.growing > 0);

  // The loop and the margin are told together.
  const std::vector<LoopReport> loops = explain_loops(made.program, flow, instants);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_FALSE(loops[0].algebraic);
  EXPECT_EQ(loops[0].unknowns.size(), report.margins.size());
  ASSERT_FALSE(report.margins.empty());
  const ServoMargin& margin = report.margins.front();
  EXPECT_EQ(margin.margin.has_value(), loop.margin.has_value());
  if (margin.margin && loop.margin) {
    EXPECT_NEAR(margin.margin->degrees, *loop.margin, 1e-5);
  }
}

Analysis analysis_of(const Compiled& made, double until) {
  RunOptions options;
  options.until = until;
  return analyse(made.program, made.flat, options);
}

TEST(LoopThroughLags, HasTheGainOfItsAmplifierAndAllItsMembers) {
  const Compiled made(std::string("r = { type = \"constant\", value = 0.1 }\n") + kLoops[0].blocks + "\n");
  const LoopReport loop = analysis_of(made, 0.1).loops.at(0);
  EXPECT_THAT(loop.members, ::testing::ElementsAre("a", "l1", "l2"));
  EXPECT_EQ(loop.kind, LoopKind::linear);
  EXPECT_NEAR(loop.unknowns.at(0).least_gain, 100, 1e-6);
  EXPECT_NEAR(loop.unknowns.at(0).static_error.value(), 0.01, 1e-9);
  EXPECT_NEAR(loop.time_constant.value(), 1 / 1914.7021, 1e-9);
}

TEST(LoopThroughLags, BehindAnIntegratorIsExactAtRest) {
  const Compiled made(std::string("r = { type = \"constant\", value = 0.1 }\n") + kLoops[2].blocks + "\n");
  const LoopReport loop = analysis_of(made, 1).loops.at(0);
  EXPECT_TRUE(std::isinf(loop.unknowns.at(0).least_gain));
  EXPECT_EQ(loop.unknowns.at(0).static_error.value(), 0);
}

// Lags inside an algebraic loop: s1 = r − s2/2 − x, s2 = s1 + x/3, T x′ = s1 − x. So s1 = (r − 7x/6)/1.5 and
// the pole is −(1 + 7/9)/T. No amplifier, hence the problem's.
TEST(Verdict, OfALagInsideAnAlgebraicLoop) {
  const Compiled made(R"toml(r  = { type = "constant", value = 0.1 }
s1 = { type = "summer", in = ["r", "-0.5*s2", "-x"] }
s2 = { type = "summer", in = ["s1", "0.3333333333333333*x"] }
x  = { type = "transfer-lag", in = "s1", time_constant = 0.02 }
)toml");
  const StabilityReport report = analysis_of(made, 1).stability;
  EXPECT_EQ(report.verdict, Verdict::stable);
  EXPECT_NEAR(report.problem_mode->mode.pole.real(), -(1 + 7.0 / 9) / 0.02, 1e-9);
  EXPECT_FALSE(report.servo_mode);
}

TEST(Verdict, OfAnOscillatorIsUndampedAndOfIntegratorsAloneNoFeedback) {
  EXPECT_EQ(analysis_of(Compiled(R"toml(x = { type = "integrator", in = ["3*v"], initial = 1 }
v = { type = "integrator", in = ["-3*x"] }
)toml"),
                        1)
                .stability.verdict,
            Verdict::undamped);
  EXPECT_EQ(analysis_of(Compiled(R"toml(one = { type = "constant" }
x = { type = "integrator", in = ["one"] }
)toml"),
                        1)
                .stability.verdict,
            Verdict::no_feedback);
}

// What acts on itself with a pole at zero: Lyapunov's critical case, alone and beside a mode that decays
// (Khalil, Nonlinear Systems: both rests are unstable, x grows as x³), and the sum of what two tanks hold.
TEST(Verdict, OfAPoleAtZeroThatIsNoIntegratorsIsUndamped) {
  for (const char* blocks : {R"toml(x = { type = "integrator", in = ["x3"] }
x2 = { type = "squarer", in = "x" }
x3 = { type = "multiplier", in = ["x", "x2"] }
)toml",
                             R"toml(x = { type = "integrator", in = ["xy"] }
y = { type = "integrator", in = ["-y", "x2"] }
xy = { type = "multiplier", in = ["x", "y"] }
x2 = { type = "squarer", in = "x" }
)toml",
                             R"toml(a = { type = "integrator", in = ["-a", "b"], initial = 1 }
b = { type = "integrator", in = ["a", "-b"] }
)toml"})
    EXPECT_EQ(analysis_of(Compiled(blocks), 1).stability.verdict, Verdict::undamped) << blocks;
}

// x″ = −q, where an amplifier finds q from 2 q = 2 x. The oscillator stays the problem's, and a mode that the
// amplifier's delay of 8 ns moves by 4e-9 of its frequency stays undamped.
TEST(Verdict, OfAnOscillatorThatAFastAmplifierServesIsUndamped) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["v"], initial = 0.5 }
v = { type = "integrator", in = ["-q"] }
q = { type = "servo-amplifier", in = ["2*q", "-2*x"], gain = 1e6, bandwidth = 10 }
)toml");
  const StabilityReport report = analysis_of(made, 5).stability;
  EXPECT_EQ(report.verdict, Verdict::undamped);
  ASSERT_TRUE(report.problem_mode && report.problem_mode->ideal_pole);
  EXPECT_NEAR(std::abs(*report.problem_mode->ideal_pole - std::complex<double>(0, 1)), 0, 1e-12);
  EXPECT_NEAR(report.servo_mode->mode.pole.real(), -2e6 * 2 * M_PI * 10, 1e-5 * 1e8);
}

// The same served by an amplifier of 0.05 Hz and a gain of 1: λ³ + (3 ω) λ² + 2 ω = 0 with ω = 0.1 π. The
// problem would not grow, so the machine is told.
TEST(Verdict, OfAnOscillatorThatASlowAmplifierServesIsTheMachines) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["v"], initial = 0.5 }
v = { type = "integrator", in = ["-q"] }
q = { type = "servo-amplifier", in = ["2*q", "-2*x"], gain = 1, bandwidth = 0.05 }
)toml");
  const StabilityReport report = analysis_of(made, 5).stability;
  EXPECT_EQ(report.verdict, Verdict::servos_unstable);
  const std::complex<double> pole = report.rightmost->mode.pole;
  const double w = 0.1 * M_PI;
  EXPECT_LT(std::abs(pole * pole * pole + 3 * w * pole * pole + 2.0 * w), 1e-12);
}

// A pendulum upside down (x″ = x) beside a servo: what grows is the problem.
TEST(Verdict, OfAProblemThatGrowsBesideAServoIsTheProblems) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["v"], initial = 0.001 }
v = { type = "integrator", in = ["q"] }
q = { type = "servo-amplifier", in = ["q", "-x"], gain = 1e5, bandwidth = 10 }
)toml");
  const StabilityReport report = analysis_of(made, 1).stability;
  EXPECT_EQ(report.verdict, Verdict::grows);
  EXPECT_FALSE(report.grows_from);
  EXPECT_NEAR(report.problem_mode->mode.pole.real(), 1, 1e-4);  // the static error of 1e-5
}

// Integrators of finite bandwidth shift the phase, and a circle grows (Dow 1957): by ω²/ω_t each.
TEST(Verdict, ToldWhatAnIdealMachineWouldDo) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["v"], initial = 0.5, bandwidth = 1000 }
v = { type = "integrator", in = ["-x"], bandwidth = 1000 }
)toml");
  const StabilityReport report = analysis_of(made, 5).stability;
  EXPECT_EQ(report.verdict, Verdict::grows);
  const double shift = 1 / (2 * M_PI * 1000);
  EXPECT_NEAR(report.problem_mode->mode.pole.real(), shift, 0.01 * shift);
  EXPECT_NEAR(report.problem_mode->ideal_pole->real(), 0, 1e-12);
}

TEST(Verdict, OfAnAmplifierThatNothingLoopsThroughIsAboutTheProblemAlone) {
  const Compiled made(R"toml(x = { type = "integrator", in = ["-x"], initial = 0.5 }
m = { type = "multiplier", in = ["x", "x"], bandwidth = 1e6 }
)toml");
  const Analysis analysis = analysis_of(made, 1);
  EXPECT_TRUE(analysis.loops.empty());
  EXPECT_TRUE(analysis.stability.margins.empty());
  EXPECT_EQ(analysis.stability.verdict, Verdict::stable);
}

// --- systems that vary with time

// Vinograd 1952: frozen, both eigenvalues are (−1 ± i√7)/4; the solution is e^(t/2).
const char* const kVinograd = R"toml(c = { type = "integrator", in = "-s", initial = 1 }
s = { type = "integrator", in = "c" }
cc = { type = "squarer", in = "c" }
ss = { type = "squarer", in = "s" }
sc = { type = "multiplier", in = ["s", "c"] }
ccx = { type = "multiplier", in = ["cc", "x"] }
scy = { type = "multiplier", in = ["sc", "y"] }
scx = { type = "multiplier", in = ["sc", "x"] }
ssy = { type = "multiplier", in = ["ss", "y"] }
x = { type = "integrator", in = ["-x", "1.5*ccx", "y", "-1.5*scy"], initial = 0.001 }
y = { type = "integrator", in = ["-x", "-1.5*scx", "-y", "1.5*ssy"], initial = 0 }
)toml";

TEST(TimeVarying, VinogradsSystemGrowsAlthoughNoFrozenModeDoes) {
  const StabilityReport report = analysis_of(Compiled(kVinograd), 20).stability;
  EXPECT_EQ(report.growing, 0U);
  EXPECT_TRUE(report.varies);
  ASSERT_TRUE(report.growth);
  EXPECT_NEAR(report.growth->exponent, 0.5, 1e-3);  // rows of 0.02 s, second order
  EXPECT_NEAR(std::log(report.growth->factor), 10, 0.5);
  EXPECT_EQ(report.verdict, Verdict::grows);
}

// Frozen, both eigenvalues are −1 and −10; the solution is e^(2t) (cos 6t + 2 sin 6t, 2 cos 6t − sin 6t).
// Rows are 0.03 s apart, in which A turns by 0.36.
TEST(TimeVarying, ASystemThatTurnsQuicklyGrowsAlthoughNoFrozenModeDoes) {
  const StabilityReport report =
      analysis_of(
          Compiled(R"toml(a = { type = "time-function", formula = "-1 - 9*cos(6*time)^2 + 6*sin(12*time)" }
b = { type = "time-function", formula = "12*cos(6*time)^2 + 4.5*sin(12*time)" }
c = { type = "time-function", formula = "-12*sin(6*time)^2 + 4.5*sin(12*time)" }
d = { type = "time-function", formula = "-1 - 9*sin(6*time)^2 - 6*sin(12*time)" }
ax = { type = "multiplier", in = ["a", "x"] }
by = { type = "multiplier", in = ["b", "y"] }
cx = { type = "multiplier", in = ["c", "x"] }
dy = { type = "multiplier", in = ["d", "y"] }
x = { type = "integrator", in = ["ax", "by"], initial = 0.01 }
y = { type = "integrator", in = ["cx", "dy"], initial = 0.01 }
)toml"),
          30)
          .stability;
  EXPECT_EQ(report.growing, 0U);
  ASSERT_TRUE(report.growth);
  EXPECT_NEAR(report.growth->exponent, 2, 0.05);  // fourth order in 0.72
  EXPECT_EQ(report.verdict, Verdict::grows);
}

// x′ = (2 cos t − k) x: multiplied by e^(−2πk) a turn, though it grows at times for k < 2.
TEST(TimeVarying, AFrozenModeThatGrowsAtTimesNeedNotGrow) {
  for (const double decay : {1.0, 3.0}) {
    const Compiled made(fmt::format(R"toml(c = {{ type = "integrator", in = "-s", initial = 1 }}
s = {{ type = "integrator", in = "c" }}
cx = {{ type = "multiplier", in = ["c", "x"] }}
x = {{ type = "integrator", in = ["2*cx", "-{}*x"], initial = 0.1 }}
)toml",
                                    decay));
    const StabilityReport report = analysis_of(made, 8 * M_PI).stability;
    ASSERT_TRUE(report.growth);
    EXPECT_NEAR(report.growth->exponent, -decay, 1e-3);  // whole turns
    EXPECT_EQ(report.verdict, decay < 2 ? Verdict::grows_at_times : Verdict::undamped);
    EXPECT_EQ(report.growing, decay < 2 ? 1U : 0U);
  }
}

// Mathieu's x″ + (1 + h cos 2t) x = 0 with h = 0.4 grows by h/4 a second at the first resonance, to second
// order in h; with cos 3.1 t it does not. Frozen it is undamped either way.
TEST(TimeVarying, AParametricResonanceGrows) {
  for (const double frequency : {2.0, 3.1}) {
    const Compiled made(fmt::format(R"toml(c = {{ type = "integrator", in = "-{0}*s", initial = 1 }}
s = {{ type = "integrator", in = "{0}*c" }}
cx = {{ type = "multiplier", in = ["c", "x"] }}
x = {{ type = "integrator", in = ["v"], initial = 0.01 }}
v = {{ type = "integrator", in = ["-x", "-0.4*cx"] }}
)toml",
                                    frequency));
    const StabilityReport report = analysis_of(made, 100).stability;
    ASSERT_TRUE(report.growth);
    EXPECT_EQ(report.growing, 0U);
    if (frequency == 2) {
      EXPECT_NEAR(report.growth->exponent, 0.1, 0.01);
    }
    EXPECT_EQ(report.verdict, frequency == 2 ? Verdict::grows : Verdict::undamped);
  }
}

// Van der Pol: unstable inside its limit cycle, on which the largest exponent is 0.
TEST(TimeVarying, ALimitCycleGrowsAtTimesOnly) {
  const Compiled made(R"toml(xx = { type = "squarer", in = "x" }
xxv = { type = "multiplier", in = ["xx", "v"] }
x = { type = "integrator", in = ["v"], initial = 2 }
v = { type = "integrator", in = ["-x", "v", "-xxv"] }
)toml");
  const StabilityReport report = analysis_of(made, 40).stability;
  EXPECT_EQ(report.verdict, Verdict::grows_at_times);
  ASSERT_TRUE(report.growth);
  EXPECT_NEAR(report.growth->exponent, 0, 0.05);
}

// Lorenz' attractor: the largest exponent is 0.906, over this run within a third of it.
TEST(TimeVarying, ChaosGrowsAlongTheRun) {
  const Compiled made(R"toml(xz = { type = "multiplier", in = ["x", "z"] }
xy = { type = "multiplier", in = ["x", "y"] }
x = { type = "integrator", in = ["10*y", "-10*x"], initial = 1 }
y = { type = "integrator", in = ["28*x", "-y", "-xz"], initial = 1 }
z = { type = "integrator", in = ["xy", "-2.6666666666666667*z"], initial = 20 }
)toml");
  const StabilityReport report = analysis_of(made, 40).stability;
  EXPECT_EQ(report.verdict, Verdict::grows);
  ASSERT_TRUE(report.growth);
  EXPECT_NEAR(report.growth->exponent, 0.906, 0.3);
}

}  // namespace
}  // namespace oblique::solve
