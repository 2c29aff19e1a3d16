// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/step_matrix.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

namespace oblique::solve {
namespace {

/// A random matrix whose column k has the rows k + some of these.
struct Made {
  network::SparsePattern pattern;
  std::vector<double> values;
  Eigen::MatrixXd dense;
};

Made random_matrix(std::size_t n, const std::vector<std::size_t>& below, double scale, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Made made;
  made.dense = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (std::size_t column = 0; column < n; ++column) {
    std::vector<std::size_t> rows;
    for (const std::size_t by : below) rows.push_back((column + by) % n);
    std::sort(rows.begin(), rows.end());
    for (const std::size_t row : rows) {
      made.pattern.rows.push_back(static_cast<std::int64_t>(row));
      made.values.push_back(scale * uniform(random));
      made.dense(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = made.values.back();
    }
    made.pattern.column_starts.push_back(static_cast<std::int64_t>(made.pattern.rows.size()));
  }
  return made;
}

/// The residual of what is solved, against a product that shares nothing with it: some roundings of |W| |x|.
void expect_solved(StepMatrix& matrix, const Made& made, double shift) {
  const auto n = static_cast<Eigen::Index>(made.pattern.size());
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) b[i] = std::cos(static_cast<double>(i));
  Eigen::VectorXd x = b;
  ASSERT_TRUE(matrix.factorise(made.values, shift));
  matrix.solve({x.data(), static_cast<std::size_t>(n)});
  const Eigen::MatrixXd w = shift * Eigen::MatrixXd::Identity(n, n) - made.dense;
  const double size = w.cwiseAbs().rowwise().sum().maxCoeff() * x.cwiseAbs().maxCoeff();
  EXPECT_LT((w * x - b).cwiseAbs().maxCoeff(), 1e-12 * size) << n << ' ' << shift;
}

// Small, full, sparse with and without a diagonal; the second and third matrix goes by the pivots of the
// first, the last would not.
TEST(StepMatrix, Solves) {
  std::mt19937 random(7);
  const std::vector<std::vector<std::size_t>> patterns{{0, 1}, {1, 3}, {0, 1, 2, 5, 7}};
  for (const std::size_t n : {1U, 2U, 9U, 40U, 300U}) {
    for (std::vector<std::size_t> below : patterns) {
      for (std::size_t& by : below) by %= n;
      std::sort(below.begin(), below.end());
      below.erase(std::unique(below.begin(), below.end()), below.end());
      Made made = random_matrix(n, below, 1, random);
      StepMatrix matrix(made.pattern);
      for (const double shift : {10.0, 1e3, 1.7}) expect_solved(matrix, made, shift);
      const Made other = random_matrix(n, below, 1e4, random);
      made.values = other.values;
      made.dense = other.dense;
      for (const double shift : {1e5, 1e-3, 0.3}) expect_solved(matrix, made, shift);
    }
  }
}

TEST(StepMatrix, FillsAFullPattern) {
  std::mt19937 random(3);
  std::vector<std::size_t> all(30);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  const Made made = random_matrix(30, all, 1, random);
  StepMatrix matrix(made.pattern);
  expect_solved(matrix, made, 0.01);
}

TEST(StepMatrix, SaysWhereThereAreNoFactors) {
  for (const std::size_t n : {2U, 50U}) {
    Made made;
    for (std::size_t k = 0; k < n; ++k) {
      made.pattern.rows.push_back(static_cast<std::int64_t>(k));
      made.pattern.column_starts.push_back(static_cast<std::int64_t>(k + 1));
      made.values.push_back(k == 1 ? 2.0 : 1.0);
    }
    StepMatrix matrix(made.pattern);
    EXPECT_FALSE(matrix.factorise(made.values, 2)) << n;
    EXPECT_TRUE(matrix.factorise(made.values, 3)) << n;
  }
}

}  // namespace
}  // namespace oblique::solve
