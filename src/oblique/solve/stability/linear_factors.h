// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/LU>

#include <oblique/solve/stability/sparse_factors.h>

// Not installed.
namespace oblique::solve {

/// LU factors of a square matrix: dense ones of a small matrix, sparse ones of a large one.
class LinearFactors {
 public:
  LinearFactors(Eigen::Index n, const std::vector<Eigen::Triplet<double>>& entries);

  /// Sign of the determinant; 0 where the matrix is singular, or its entries are no numbers.
  int sign() const { return sign_; }
  /// Only where `sign` is not 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_;
  std::optional<SparseFactors<double>> sparse_;
  int sign_ = 0;
};

}  // namespace oblique::solve
