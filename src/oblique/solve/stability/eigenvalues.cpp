// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/eigenvalues.h>

#include <complex>
#include <limits>

#include <Eigen/Eigenvalues>

namespace oblique::solve {

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() == Eigen::Success) return solver.eigenvalues();
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  return Eigen::VectorXcd::Constant(matrix.rows(), std::complex<double>(kNoNumber, kNoNumber));
}

std::optional<EigenSystem> eigensystem_of(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return EigenSystem{solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace oblique::solve
