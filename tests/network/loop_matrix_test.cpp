// SPDX-License-Identifier: MIT
// Long loops, whose factors are sparse, against solutions that are known beforehand and against the
// recurrence for the determinant of a tridiagonal matrix.
#include <oblique/network/program/loop_matrix.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace oblique::network {
namespace {

constexpr std::size_t kSize = 400;

/// A loop whose derivatives stand on slots 0, 1, …: each row reads itself and its two neighbours, and the
/// rows are in the order of `row_of`.
struct LoopChain {
  explicit LoopChain(unsigned seed) : row_of(kSize) {
    std::iota(row_of.begin(), row_of.end(), 0U);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> derivative(-1, 1);
    for (std::size_t k = 0; k < kSize / 3; ++k) {
      const std::size_t a = random() % kSize, b = random() % kSize;
      if (a == b) continue;
      std::swap(row_of[a], row_of[b]);
      odd = !odd;
    }
    for (std::size_t i = 0; i < kSize; ++i) {
      for (std::size_t j = i == 0 ? 0 : i - 1; j < std::min(kSize, i + 2); ++j) {
        code.jacobian.push_back(
            {row_of[i], static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(slots.size())});
        slots.push_back(derivative(random) + (i == j ? (random() % 2 == 0 ? 2.5 : -2.5) : 0));
      }
    }
    code.unknown_slots.resize(kSize);
    code.residual_slots.resize(kSize);
    code.natural_scale.assign(kSize, 0);
    code.held_by_amplifier.assign(kSize, false);
  }

  std::vector<std::uint32_t> row_of;
  bool odd = false;  ///< whether an odd number of rows were exchanged
  LoopCode code;
  std::vector<double> slots;
};

TEST(LoopMatrix, ACopyHasTheFactorsToo) {
  for (const unsigned seed : {1U, 2U}) {
    const LoopChain chain(seed);
    LoopMatrix matrix(kSize);
    const LoopMatrix empty(matrix);
    ASSERT_TRUE(matrix.factor(chain.code, chain.slots.data()));
    LoopMatrix copy(matrix), assigned(empty);
    assigned = matrix;
    Eigen::MatrixXd ours = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(kSize), 1), others = ours,
                    theirs = ours;
    matrix.solve(ours);
    copy.solve(others);
    assigned.solve(theirs);
    EXPECT_EQ(ours, others);
    EXPECT_EQ(ours, theirs);
  }
}

TEST(LoopMatrix, OfALongLoopSolvesWhatIsKnown) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const LoopChain chain(seed);
    Eigen::MatrixXd known(static_cast<Eigen::Index>(kSize), 2);
    for (Eigen::Index i = 0; i < known.rows(); ++i) {
      const double number = static_cast<double>(i) + 1;
      known.row(i) << std::sin(number), 1 / number;
    }
    Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(known.rows(), 2);
    for (const MatrixEntry& entry : chain.code.jacobian)
      sides.row(entry.row) += chain.slots[entry.slot] * known.row(entry.column);
    LoopMatrix matrix(kSize);
    ASSERT_TRUE(matrix.factor(chain.code, chain.slots.data()));
    matrix.solve(sides);
    // Diagonally dominant by 0.5 of at most 3.5: the condition is below 20.
    EXPECT_LT((sides - known).cwiseAbs().maxCoeff(), 1e-13);
  }
}

// Each of its rows reads all unknowns: its factors are dense.
TEST(LoopMatrix, OfALongLoopOfWhichAllReadsAllSolvesWhatIsKnown) {
  constexpr std::size_t kDense = 120;
  LoopCode code;
  std::vector<double> slots;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> derivative(-1, 1);
  Eigen::MatrixXd matrix(kDense, kDense);
  for (std::uint32_t i = 0; i < kDense; ++i) {
    for (std::uint32_t j = 0; j < kDense; ++j) {
      code.jacobian.push_back({i, j, static_cast<std::uint32_t>(slots.size())});
      slots.push_back(matrix(i, j) = derivative(random) + (i == j ? 2.0 * kDense : 0));
    }
  }
  code.unknown_slots.resize(kDense);
  code.residual_slots.resize(kDense);
  code.natural_scale.assign(kDense, 0);
  code.held_by_amplifier.assign(kDense, false);
  const Eigen::VectorXd known = Eigen::VectorXd::LinSpaced(kDense, -1, 1);
  Eigen::MatrixXd sides = matrix * known;
  LoopMatrix factors(kDense);
  ASSERT_TRUE(factors.factor(code, slots.data()));
  factors.solve(sides);
  // Diagonally dominant by half: the condition is below 3.
  EXPECT_LT((sides - known).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_EQ(factors.determinant_sign(), 1);
}

TEST(LoopMatrix, OfALongLoopKnowsTheSignOfItsDeterminant) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const LoopChain chain(seed);
    std::vector<double> lower(kSize), diagonal(kSize), upper(kSize);
    std::size_t at = 0;
    for (std::size_t i = 0; i < kSize; ++i) {
      if (i > 0) lower[i] = chain.slots[at++];
      diagonal[i] = chain.slots[at++];
      if (i + 1 < kSize) upper[i] = chain.slots[at++];
    }
    // f(k) = d(k) f(k − 1) − l(k) u(k − 1) f(k − 2), as ratios, which neither overflow nor vanish.
    double ratio = diagonal[0];
    bool negative = (ratio < 0) != chain.odd;
    for (std::size_t k = 1; k < kSize; ++k) {
      ratio = diagonal[k] - lower[k] * upper[k - 1] / ratio;
      negative = negative != (ratio < 0);
    }
    LoopMatrix matrix(kSize);
    ASSERT_TRUE(matrix.factor(chain.code, chain.slots.data()));
    EXPECT_EQ(matrix.determinant_sign(), negative ? -1 : 1) << seed;
  }
}

TEST(LoopMatrix, OfALongLoopTellsWhereItIsSingular) {
  LoopChain chain(3);
  LoopMatrix matrix(kSize);
  ASSERT_TRUE(matrix.factor(chain.code, chain.slots.data()));
  const std::vector<double> regular = chain.slots;
  chain.slots[10] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(matrix.factor(chain.code, chain.slots.data()));
  chain.slots = regular;
  // The first two rows are d u 0 and l d u: with u of the second 0, the first is a multiple of it.
  chain.slots[2] = 2 * chain.slots[0];
  chain.slots[3] = 2 * chain.slots[1];
  chain.slots[4] = 0;
  EXPECT_FALSE(matrix.factor(chain.code, chain.slots.data()));
  // Amplifiers that hold the unknowns have a mass, with which it is regular.
  chain.code.held_by_amplifier.assign(kSize, true);
  EXPECT_TRUE(matrix.factor(chain.code, chain.slots.data(), 0.25));
  EXPECT_TRUE(matrix.factor(chain.code, regular.data()));
}

}  // namespace
}  // namespace oblique::network
