// SPDX-License-Identifier: MIT
// The rightmost modes of large systems, against closed forms and the QR algorithm.
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <oblique/solve/stability/analysis.h>
#include <oblique/solve/stability/rightmost_modes.h>
#include <oblique/solve/stability/stability_report.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using Sparse = Eigen::SparseMatrix<double>;

std::vector<std::size_t> all_of(Eigen::Index n) {
  std::vector<std::size_t> states(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < states.size(); ++i) states[i] = i;
  return states;
}

/// A ring of decays of −1 with couplings of 0.3, the first of which grows at 2 instead.
Sparse ring_with_a_defect(int n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, i == 0 ? 2.0 : -1.0);
    entries.emplace_back(i, (i + 1) % n, 0.3);
    entries.emplace_back(i, (i + n - 1) % n, 0.3);
  }
  Sparse a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

// A defect d on a long chain of couplings t binds one mode at √(d² + 4 t²) above the middle of the others.
TEST(RightmostModes, OfADefectOnARingIsTheBoundOne) {
  for (const int n : {210, 5000}) {
    const Sparse a = ring_with_a_defect(n);
    const auto modes = rightmost_modes(a, all_of(n));
    ASSERT_FALSE(modes.empty());
    EXPECT_NEAR(modes[0].pole.real(), -1 + std::sqrt(9 + 4 * 0.09), 1e-12);
    EXPECT_EQ(modes[0].pole.imag(), 0);
    EXPECT_EQ(modes[0].participants[0].state, 0U);
    // |x_k|² falls by r² a place, r = (√(d² + 4t²) − d)/2t: the share of the defect is (1 − r²)/(1 + r²).
    const double r = (std::sqrt(9.36) - 3) / 0.6;
    EXPECT_NEAR(modes[0].participants[0].share, (1 - r * r) / (1 + r * r), 1e-9);
    EXPECT_FALSE(is_proven_stable(a));
  }
}

TEST(RightmostModes, OfRandomSparseMatricesAreThoseOfTheQrAlgorithm) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int trial = 0; trial < 6; ++trial) {
    constexpr int kSize = 230;
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < kSize; ++i) {
      // Rates over four decades, some of them oscillating.
      const double rate = std::pow(10.0, 2 * value(random));
      entries.emplace_back(i, i, -rate);
      const int partner = i % 2 == 0 ? i + 1 : i - 1;
      entries.emplace_back(i, partner, (i % 2 == 0 ? 1 : -1) * rate * (1.2 + value(random)));
      for (int k = 0; k < 2; ++k)
        entries.emplace_back(i, static_cast<int>(random() % kSize), 0.4 * rate * value(random));
    }
    if (trial % 2 == 0) entries.emplace_back(17, 17, 40.0);
    Sparse a(kSize, kSize);
    a.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXcd exact =
        Eigen::EigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(a), false).eigenvalues();
    const double rightmost = exact.real().maxCoeff();
    const auto modes = rightmost_modes(a, all_of(kSize));
    ASSERT_FALSE(modes.empty()) << trial;
    EXPECT_NEAR(modes[0].pole.real(), rightmost, 1e-9 * exact.cwiseAbs().maxCoeff()) << trial;
    EXPECT_TRUE(rightmost < 0 || !is_proven_stable(a));
  }
}

// A chain of oscillators, hardly damped, of which one grows: among many alike on the axis.
TEST(RightmostModes, FindAnOscillationThatGrowsAmongDampedOnes) {
  constexpr int kPairs = 400;
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < kPairs; ++k) {
    const double frequency = 1 + 0.02 * k;
    entries.emplace_back(2 * k, 2 * k + 1, frequency);
    entries.emplace_back(2 * k + 1, 2 * k, -frequency);
    const double damping = k == 250 ? -0.05 : 0.1;
    entries.emplace_back(2 * k, 2 * k, -damping * frequency);
    entries.emplace_back(2 * k + 1, 2 * k + 1, -damping * frequency);
    entries.emplace_back(2 * k, (2 * k + 2) % (2 * kPairs), 1e-9);  // one group
  }
  Sparse a(2 * kPairs, 2 * kPairs);
  a.setFromTriplets(entries.begin(), entries.end());
  const auto modes = rightmost_modes(a, all_of(2 * kPairs));
  ASSERT_FALSE(modes.empty());
  EXPECT_NEAR(modes[0].pole.real(), 0.05 * 6, 1e-6);
  EXPECT_NEAR(modes[0].pole.imag(), 6, 1e-6);
}

// The heat equation: −2 on the diagonal, 1 beside it. The slowest is −4 sin²(π/(2 (n + 1))).
TEST(RightmostModes, OfAHeatedRodDecayAndAreProvenTo) {
  constexpr int kPlaces = 1000;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < kPlaces; ++i) {
    entries.emplace_back(i, i, -2.0);
    if (i > 0) entries.emplace_back(i, i - 1, 1.0);
    if (i + 1 < kPlaces) entries.emplace_back(i, i + 1, 1.0);
  }
  Sparse a(kPlaces, kPlaces);
  a.setFromTriplets(entries.begin(), entries.end());
  EXPECT_TRUE(is_proven_stable(a));
  const auto modes = rightmost_modes(a, all_of(kPlaces));
  ASSERT_FALSE(modes.empty());
  const double slowest = -4 * std::pow(std::sin(M_PI / (2 * (kPlaces + 1))), 2);
  EXPECT_NEAR(modes[0].pole.real(), slowest, 1e-12);
}

// A chain of two decays of −1, of which the first hears the second as loud: the rows sum to 0, and the bound
// is below it only with weights. It lies above the eigenvalues, which are −1.
TEST(RealPartBound, WeighsTheStatesWhereRowsAloneDoNotTell) {
  Sparse a(2, 2);
  const std::vector<Eigen::Triplet<double>> entries = {{0, 0, -1.0}, {0, 1, 1.0}, {1, 1, -1.0}};
  a.setFromTriplets(entries.begin(), entries.end());
  EXPECT_LT(real_part_bound(a), 0);
  EXPECT_GE(real_part_bound(a), -1);
  EXPECT_TRUE(is_proven_stable(a));
}

TEST(RightmostModes, JudgeADiagramOfFiveThousandStates) {
  constexpr int kStates = 5000;
  std::string blocks;
  for (int i = 0; i < kStates; ++i) {
    blocks +=
        fmt::format("x{0} = {{ type = \"integrator\", in = [\"{1}*x{0}\", \"0.3*x{2}\", \"0.3*x{3}\"] }}\n",
                    i, i == 0 ? 2 : -1, (i + 1) % kStates, (i + kStates - 1) % kStates);
  }
  const Compiled made(blocks);
  const SignalFlow flow(made.flat, made.program);
  std::vector<Instant> instants(61, {0, made.program.start()});
  const StabilityReport report = judge_stability(made.program, flow, instants);
  EXPECT_EQ(report.verdict, StabilityVerdict::grows);
  EXPECT_NEAR(report.rightmost->mode.pole.real(), -1 + std::sqrt(9.36), 1e-12);
  EXPECT_FALSE(report.rightmost_is_servo);
}

}  // namespace
}  // namespace oblique::solve
