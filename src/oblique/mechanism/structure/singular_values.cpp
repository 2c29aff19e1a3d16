// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/singular_values.h>

#include <Eigen/SVD>

namespace oblique::mechanism {

/// Jacobi's method finds small ones best, and takes minutes for a thousand rows.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix) {
  constexpr Eigen::Index kMostRows = 100;
  if (matrix.rows() <= kMostRows) return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return Eigen::BDCSVD<Eigen::MatrixXd>(matrix).singularValues();
}

SingularDecomposition singular_decomposition(const Eigen::MatrixXd& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

}  // namespace oblique::mechanism
