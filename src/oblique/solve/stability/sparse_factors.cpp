// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/sparse_factors.h>

#include <complex>
#include <type_traits>

#include <Eigen/SparseLU>

namespace oblique::solve {

template <class Scalar>
class SparseFactors<Scalar>::Factors : public Eigen::SparseLU<Eigen::SparseMatrix<Scalar>> {
 public:
  using Eigen::SparseLU<Eigen::SparseMatrix<Scalar>>::SparseLU;
};

template <class Scalar>
SparseFactors<Scalar>::SparseFactors(const Eigen::SparseMatrix<Scalar>& matrix)
    : factors_(std::make_unique<Factors>(matrix)) {}

template <class Scalar>
SparseFactors<Scalar>::~SparseFactors() = default;
template <class Scalar>
SparseFactors<Scalar>::SparseFactors(SparseFactors&&) noexcept = default;
template <class Scalar>
SparseFactors<Scalar>& SparseFactors<Scalar>::operator=(SparseFactors&&) noexcept = default;

template <class Scalar>
bool SparseFactors<Scalar>::exist() const {
  return factors_->info() == Eigen::Success;
}

template <class Scalar>
typename SparseFactors<Scalar>::Vector SparseFactors<Scalar>::solve(const Vector& right) const {
  return factors_->solve(right);
}

template <class Scalar>
int SparseFactors<Scalar>::sign() const {
  if constexpr (std::is_same_v<Scalar, double>) {
    return static_cast<int>(factors_->signDeterminant());
  } else {
    return 0;
  }
}

template class SparseFactors<double>;
template class SparseFactors<std::complex<double>>;

}  // namespace oblique::solve
