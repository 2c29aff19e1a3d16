// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/linear_factors.h>

#include <cmath>

namespace oblique::solve {

LinearFactors::LinearFactors(Eigen::Index n, const std::vector<Eigen::Triplet<double>>& entries) {
  constexpr Eigen::Index kMostDense = 64;
  if (n > kMostDense) {
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    sparse_.emplace(matrix);
    if (sparse_->exist()) sign_ = sparse_->sign();
    return;
  }
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (const auto& entry : entries) matrix(entry.row(), entry.col()) += entry.value();
  if (!matrix.allFinite()) return;
  dense_ = Eigen::PartialPivLU<Eigen::MatrixXd>(matrix);
  sign_ = static_cast<int>(dense_.permutationP().determinant());
  // signs alone: the determinant itself may leave the range of numbers
  for (const double pivot : dense_.matrixLU().diagonal()) {
    if (pivot == 0) sign_ = 0;
    if (pivot < 0) sign_ = -sign_;
  }
}

Eigen::VectorXd LinearFactors::solve(const Eigen::VectorXd& right) const {
  if (sparse_) return sparse_->solve(right);
  return dense_.solve(right);
}

}  // namespace oblique::solve
