// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace oblique::solve {

/// LU factors of a sparse square matrix; `Scalar` is double or std::complex<double>.
template <class Scalar>
class SparseFactors {
 public:
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// The matrix must be compressed.
  explicit SparseFactors(const Eigen::SparseMatrix<Scalar>& matrix);
  ~SparseFactors();
  SparseFactors(SparseFactors&&) noexcept;
  SparseFactors& operator=(SparseFactors&&) noexcept;

  /// Whether there are any: not of a singular matrix.
  bool exist() const;
  /// Only where they exist.
  Vector solve(const Vector& right) const;
  /// Of the determinant, of a real matrix; only where they exist.
  int sign() const;

 private:
  class Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace oblique::solve
