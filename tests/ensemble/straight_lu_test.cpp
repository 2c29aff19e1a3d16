// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/straight_lu.h>

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/ensemble/lanes/lane_kernels.h>

namespace oblique::ensemble {
namespace {

struct Sparse {
  std::vector<StraightLu::Place> places;
  std::vector<std::vector<double>> values;  ///< of each matrix
};

// Matrices of one pattern with a strong entry in each row, on a permuted diagonal: an order has to be found.
Sparse random_matrices(std::uint32_t n, std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<std::uint32_t> strong(n);
  for (std::uint32_t i = 0; i < n; ++i) strong[i] = i;
  std::shuffle(strong.begin(), strong.end(), random);
  std::set<StraightLu::Place> places;
  for (std::uint32_t i = 0; i < n; ++i) {
    places.insert({i, strong[i]});
    for (int k = 0; k < 2; ++k) places.insert({i, random() % n});
  }
  Sparse made{{places.begin(), places.end()}, {}};
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double>& values = made.values.emplace_back();
    for (const auto& [row, column] : made.places)
      values.push_back(number(random) + (column == strong[row] ? 4 : 0));
  }
  return made;
}

Eigen::MatrixXd dense(std::uint32_t n, const Sparse& sparse, std::size_t which) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < sparse.places.size(); ++k)
    matrix(sparse.places[k].first, sparse.places[k].second) = sparse.values[which][k];
  return matrix;
}

TEST(StraightLu, SolvesAsAFactorisationWithPivotsDoes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  const LaneKernels& kernels = *lane_kernels(4);
  for (const std::uint32_t n : {1U, 2U, 7U, 23U}) {
    const Sparse sparse = random_matrices(n, 4, random);
    const auto lu = StraightLu::make(n, sparse.places, sparse.values);
    ASSERT_TRUE(lu);
    LaneArray entries(lu->n_entries() * 4), reciprocals(n * 4), growth(4), b(n * 4), work(n * 4), x(n * 4);
    for (std::size_t l = 0; l < 4; ++l) {
      for (std::size_t k = 0; k < sparse.places.size(); ++k) entries[k * 4 + l] = sparse.values[l][k];
      for (std::uint32_t i = 0; i < n; ++i) b[i * 4 + l] = number(random);
    }
    kernels.factor(lu->code(), entries.data(), reciprocals.data(), growth.data());
    kernels.solve(lu->code(), entries.data(), reciprocals.data(), b.data(), work.data(), x.data());
    for (std::size_t l = 0; l < 4; ++l) {
      Eigen::VectorXd right(n);
      for (std::uint32_t i = 0; i < n; ++i) right(i) = b[i * 4 + l];
      const Eigen::MatrixXd matrix = dense(n, sparse, l);
      const Eigen::VectorXd truth = matrix.fullPivLu().solve(right);
      const double condition = matrix.norm() * matrix.inverse().norm();
      for (std::uint32_t i = 0; i < n; ++i) {
        // both round to some units of the condition number
        EXPECT_NEAR(x[i * 4 + l], truth(i), 1e-14 * condition * (1 + truth.norm())) << n << " lane " << l;
      }
      EXPECT_LE(growth[l], 10);  // a tenth of the largest in the column is the least that is taken
    }
  }
}

TEST(StraightLu, FillsInNoMoreThanAnArrowNeeds) {
  // Taken in the order of its rows, an arrow fills in whole; the point last, nothing.
  constexpr std::uint32_t n = 20;
  std::vector<StraightLu::Place> places;
  std::vector<double> values;
  for (std::uint32_t i = 0; i < n; ++i) {
    places.push_back({i, i});
    values.push_back(2);
    if (i == 0) continue;
    places.push_back({0, i});
    places.push_back({i, 0});
    values.push_back(0.1);
    values.push_back(0.1);
  }
  const std::vector<std::vector<double>> samples{values};
  const auto lu = StraightLu::make(n, places, samples);
  ASSERT_TRUE(lu);
  EXPECT_EQ(lu->n_entries(), places.size());
}

TEST(StraightLu, RefusesWhereNoOrderSuitsAllSamples) {
  // One sample wants the diagonal, the other one what is beside it.
  const std::vector<StraightLu::Place> places{{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  const std::vector<std::vector<double>> samples{{1, 0, 0, 1}, {0, 1, 1, 0}};
  EXPECT_FALSE(StraightLu::make(2, places, samples));
}

TEST(StraightLu, TellsWhereAMatrixIsOtherThanItsSamples) {
  const std::vector<StraightLu::Place> places{{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  const std::vector<std::vector<double>> samples{{1, 0.5, 0.5, 1}};
  const auto lu = StraightLu::make(2, places, samples);
  ASSERT_TRUE(lu);
  const LaneKernels& kernels = *lane_kernels(4);
  LaneArray entries(lu->n_entries() * 4), reciprocals(8), growth(4);
  for (std::size_t l = 0; l < 4; ++l) {
    entries[0 + l] = l == 2 ? 1e-9 : 1;  // the pivots nearly vanish in one lane
    entries[4 + l] = entries[8 + l] = 0.5;
    entries[12 + l] = entries[0 + l];
  }
  kernels.factor(lu->code(), entries.data(), reciprocals.data(), growth.data());
  EXPECT_EQ(growth[0], 0.5);
  EXPECT_NEAR(growth[2], 5e8, 1);
}

}  // namespace
}  // namespace oblique::ensemble
