// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace oblique::mechanism {

/// Of any matrix, the greatest first.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix);

/// matrix = U diag(values) Vᵀ of a square matrix, the greatest value first.
struct SingularDecomposition {
  Eigen::MatrixXd u, v;
  Eigen::VectorXd values;
};
SingularDecomposition singular_decomposition(const Eigen::MatrixXd& matrix);

}  // namespace oblique::mechanism
