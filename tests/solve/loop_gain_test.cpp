// SPDX-License-Identifier: MIT
// Loop gains and phase margins of the loops of textbooks.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <oblique/solve/stability/loop_gain.h>

namespace oblique::solve {
namespace {

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

// L = K/(s (1 + T s)): x′ = −K y, T y′ = x − y.
TEST(OpenLoops, IntegratorAndLagHaveTheMarginOfTheTextbook) {
  constexpr double kLag = 0.2;
  for (const double gain : {0.5, 5.0, 500.0}) {
    Eigen::MatrixXd a(2, 2);
    a << 0, -gain, 1 / kLag, -1 / kLag;
    const OpenLoops loops(a);
    const auto margin = loops.phase_margin(0, 0);
    ASSERT_TRUE(margin);
    // ω² (1 + T² ω²) = K²; rounding of the bisection.
    const double frequency =
        std::sqrt((std::sqrt(1 + 4 * gain * gain * kLag * kLag) - 1) / (2 * kLag * kLag));
    EXPECT_NEAR(margin->frequency, frequency, 1e-10 * frequency);
    EXPECT_NEAR(margin->degrees, 90 - degrees(std::atan(frequency * kLag)), 1e-8);
    const auto at = loops.gain(0, 0, {0, 3});
    const std::complex<double> s(0, 3);
    EXPECT_LT(std::abs(at - gain / (s * (1.0 + kLag * s))), 1e-12 * std::abs(at));
  }
}

// A lone amplifier: L = K/(1 + τ s).
TEST(OpenLoops, ALoneAmplifierHasAtLeastNinetyDegrees) {
  constexpr double kTau = 0.016, kGain = 1e6;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(1, 1, -(1 + kGain) / kTau);
  const OpenLoops loops(a);
  EXPECT_NEAR(loops.gain(0, -1 / kTau, 0).real(), kGain, 1e-9 * kGain);
  const auto margin = loops.phase_margin(0, -1 / kTau);
  ASSERT_TRUE(margin);
  const double frequency = std::sqrt(kGain * kGain - 1) / kTau;
  EXPECT_NEAR(margin->frequency, frequency, 1e-9 * frequency);
  EXPECT_NEAR(margin->degrees, 180 - degrees(std::atan(frequency * kTau)), 1e-8);
}

TEST(OpenLoops, PositiveFeedbackHasANegativeMargin) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(1, 1, -1 + 10);  // L = −10/(1 + s)
  const auto margin = OpenLoops(a).phase_margin(0, -1);
  ASSERT_TRUE(margin);
  EXPECT_NEAR(margin->degrees, -degrees(std::atan(std::sqrt(99))), 1e-8);
}

// x′ = a x, of which p is its own: 1 + L = (s − a)/(s − p). At the eigenvalue L is −1, at the own pole
// infinite, and 0 everywhere where nothing is fed back. All numbers here are exact.
TEST(OpenLoops, GainIsItsFormulaAtItsPolesToo) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(1, 1, -2);
  const OpenLoops loops(a);
  EXPECT_EQ(loops.gain(0, -3, -2), -1.0);
  EXPECT_TRUE(std::isinf(loops.gain(0, -3, -3).real()));
  EXPECT_EQ(loops.gain(0, -3, -1), -0.5);
  EXPECT_EQ(loops.gain(0, -2, -1), 0.0);
  EXPECT_EQ(loops.gain(0, -2, 3), 0.0);
}

TEST(OpenLoops, AWeakLoopHasNoCrossover) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(1, 1, -1 - 0.5);
  EXPECT_FALSE(OpenLoops(a).phase_margin(0, -1));
}

// Three lags of 1 s in a row, L = K/(1 + s)³: on the verge of instability at K = 8, where ω = √3.
TEST(OpenLoops, ThreeLagsLoseTheirMarginAtAGainOfEight) {
  for (const double gain : {4.0, 8.0, 16.0}) {
    Eigen::MatrixXd a(3, 3);
    a << -1, 0, -gain, 1, -1, 0, 0, 1, -1;
    const OpenLoops loops(a);
    for (int place = 0; place < 3; ++place) {  // one loop, wherever it is cut
      const auto margin = loops.phase_margin(place, -1);
      ASSERT_TRUE(margin);
      const double frequency = std::sqrt(std::pow(gain, 2.0 / 3) - 1);
      EXPECT_NEAR(margin->frequency, frequency, 1e-9);
      EXPECT_NEAR(margin->degrees, 180 - 3 * degrees(std::atan(frequency)), 1e-7);
    }
  }
}

}  // namespace
}  // namespace oblique::solve
