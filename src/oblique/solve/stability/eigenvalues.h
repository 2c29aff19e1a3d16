// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <Eigen/Core>

namespace oblique::solve {

/// Eigenvalues of a real square matrix, by the QR algorithm: some 10 n³ operations. Not a number where it
/// does not converge.
Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& matrix);

struct EigenSystem {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;  ///< columns, of length 1
};

/// The same with the right eigenvectors; nothing where the algorithm does not converge.
std::optional<EigenSystem> eigensystem_of(const Eigen::MatrixXd& matrix);

}  // namespace oblique::solve
