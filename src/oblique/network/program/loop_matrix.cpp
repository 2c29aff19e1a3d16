// SPDX-License-Identifier: MIT
#include <oblique/network/program/loop_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseLU>

namespace oblique::network {
namespace {

/// Up to here dense factors are as quick.
constexpr std::size_t kShort = 100;
/// Entries of the Jacobian for an unknown, on the average, up to which sparse factors stay sparse.
constexpr std::size_t kFew = 8;

}  // namespace

/// Factors that grow with the derivatives and what fills in between them, not with the cube of the size.
/// (They take memory anew each time, which beside their work is nothing.)
class LoopMatrix::Sparse : public Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> {
 public:
  Sparse() = default;
  explicit Sparse(const LoopCode& loop) {
    std::vector<Eigen::Triplet<double>> places;
    for (const MatrixEntry& entry : loop.jacobian)
      places.emplace_back(static_cast<int>(entry.row), static_cast<int>(entry.column), 0.0);
    for (int i = 0; i < static_cast<int>(loop.size()); ++i) places.emplace_back(i, i, 0.0);
    matrix.resize(eigen_index(loop.size()), eigen_index(loop.size()));
    matrix.setFromTriplets(places.begin(), places.end());
    const auto place_of = [&](Eigen::Index row, Eigen::Index column) {
      return static_cast<std::size_t>(&matrix.coeffRef(row, column) - matrix.valuePtr());
    };
    for (const MatrixEntry& entry : loop.jacobian) of_entry.push_back(place_of(entry.row, entry.column));
    for (std::size_t i = 0; i < loop.size(); ++i)
      of_diagonal.push_back(place_of(eigen_index(i), eigen_index(i)));
    analyzePattern(matrix);
  }

  /// Eigen's factors cannot be copied: they are made anew.
  std::unique_ptr<Sparse> copy() const {
    auto made = std::make_unique<Sparse>();
    made->matrix = matrix;
    made->of_entry = of_entry;
    made->of_diagonal = of_diagonal;
    made->analyzePattern(made->matrix);
    if (m_factorizationIsOk) made->factorize(made->matrix);
    return made;
  }

  double smallest_pivot() const {
    double smallest = std::numeric_limits<double>::infinity();
    for (Eigen::Index column = 0; column < cols(); ++column) {
      for (SCMatrix::InnerIterator entry(m_Lstore, column); entry; ++entry) {
        if (entry.index() == column) smallest = std::min(smallest, std::abs(entry.value()));
      }
    }
    return smallest;
  }

  Eigen::SparseMatrix<double> matrix;              ///< rows scaled by 1/scale_
  std::vector<std::size_t> of_entry, of_diagonal;  ///< where its values are
  Eigen::MatrixXd right_sides, solutions;
};

bool LoopCode::has_branches() const {
  return !linear &&
         std::find(held_by_amplifier.begin(), held_by_amplifier.end(), true) != held_by_amplifier.end();
}

LoopMatrix::LoopMatrix(std::size_t size)
    : scale_(eigen_index(size)), permuted_(eigen_index(size)), visited_(size) {
  if (size > kShort) return;  // it may be sparse
  matrix_.resize(eigen_index(size), eigen_index(size));
  lu_ = Eigen::PartialPivLU<Eigen::MatrixXd>(eigen_index(size));
}

LoopMatrix::~LoopMatrix() = default;

LoopMatrix::LoopMatrix(const LoopMatrix& other)
    : sparse_(other.sparse_ ? other.sparse_->copy() : nullptr),
      matrix_(other.matrix_),
      scale_(other.scale_),
      permuted_(other.permuted_),
      visited_(other.visited_),
      lu_(other.lu_) {}

LoopMatrix& LoopMatrix::operator=(const LoopMatrix& other) {
  if (this != &other) *this = LoopMatrix(other);
  return *this;
}

LoopMatrix::LoopMatrix(LoopMatrix&&) noexcept = default;
LoopMatrix& LoopMatrix::operator=(LoopMatrix&&) noexcept = default;

/// Once, for a long loop.
void LoopMatrix::prepare(const LoopCode& loop) {
  if (loop.jacobian.size() <= kFew * loop.size()) {
    sparse_ = std::make_unique<Sparse>(loop);
  } else {
    matrix_.resize(eigen_index(loop.size()), eigen_index(loop.size()));
  }
}

bool LoopMatrix::factor_sparse(const LoopCode& loop, const double* slots, double mass,
                               double smallest_pivot) {
  double* const values = sparse_->matrix.valuePtr();
  std::fill(values, values + sparse_->matrix.nonZeros(), 0.0);
  for (std::size_t k = 0; k < loop.jacobian.size(); ++k) {
    const double derivative = slots[loop.jacobian[k].slot];
    if (!std::isfinite(derivative)) return false;
    values[sparse_->of_entry[k]] = derivative / scale_[loop.jacobian[k].row];
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop.held_by_amplifier[i]) values[sparse_->of_diagonal[i]] += mass / scale_[eigen_index(i)];
  }
  sparse_->factorize(sparse_->matrix);
  return sparse_->info() == Eigen::Success && sparse_->smallest_pivot() > smallest_pivot;
}

bool LoopMatrix::factor(const LoopCode& loop, const double* slots, double mass) {
  scale_ = Eigen::Map<const Eigen::VectorXd>(loop.natural_scale.data(), eigen_index(loop.size()));
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop.held_by_amplifier[i]) scale_[eigen_index(i)] = std::max(scale_[eigen_index(i)], mass);
  }
  for (const MatrixEntry& entry : loop.jacobian) {
    scale_[entry.row] = std::max(scale_[entry.row], std::abs(slots[entry.slot]));
  }
  if (!scale_.allFinite() || scale_.minCoeff() <= 0) return false;
  const double smallest_pivot = 8 * std::numeric_limits<double>::epsilon() * static_cast<double>(loop.size());
  if (!sparse_ && matrix_.size() == 0) prepare(loop);
  if (sparse_) return factor_sparse(loop, slots, mass, smallest_pivot);
  matrix_.setZero();
  for (const MatrixEntry& entry : loop.jacobian) {
    matrix_(entry.row, entry.column) = slots[entry.slot] / scale_[entry.row];
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop.held_by_amplifier[i]) matrix_(eigen_index(i), eigen_index(i)) += mass / scale_[eigen_index(i)];
  }
  if (loop.size() == 1) return std::abs(matrix_(0, 0)) > smallest_pivot;
  lu_.compute(matrix_);
  return lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > smallest_pivot;
}

int LoopMatrix::determinant_sign() {
  if (sparse_) return sparse_->signDeterminant() < 0 ? -1 : 1;
  if (matrix_.rows() == 1) return matrix_(0, 0) < 0 ? -1 : 1;
  int sign = 1;
  const auto& row_of = lu_.permutationP().indices();
  std::fill(visited_.begin(), visited_.end(), char{0});
  for (Eigen::Index i = 0; i < row_of.size(); ++i) {
    if (lu_.matrixLU()(i, i) < 0) sign = -sign;
    // A cycle of even length is an odd permutation.
    for (Eigen::Index k = i; visited_[static_cast<std::size_t>(k)] == 0; k = row_of[k]) {
      visited_[static_cast<std::size_t>(k)] = 1;
      if (row_of[k] != i) sign = -sign;
    }
  }
  return sign;
}

void LoopMatrix::solve(Eigen::Ref<Eigen::MatrixXd> right_sides) {
  if (right_sides.cols() == 0) return;  // a loop that no state enters
  for (Eigen::Index column = 0; column < right_sides.cols(); ++column) {
    right_sides.col(column).array() /= scale_.array();
  }
  if (sparse_) {
    sparse_->right_sides = right_sides;
    sparse_->solutions = sparse_->solve(sparse_->right_sides);
    right_sides = sparse_->solutions;
    return;
  }
  if (matrix_.rows() == 1) {
    right_sides /= matrix_(0, 0);
    return;
  }
  const auto& row_of = lu_.permutationP().indices();
  for (Eigen::Index column = 0; column < right_sides.cols(); ++column) {
    for (Eigen::Index i = 0; i < row_of.size(); ++i) permuted_[row_of[i]] = right_sides(i, column);
    right_sides.col(column) = permuted_;
  }
  lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(right_sides);
  lu_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(right_sides);
}

double LoopMatrix::residual_norm(const LoopCode& loop, const double* slots) const {
  double norm = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double residual = slots[loop.residual_slots[i]];
    if (!std::isfinite(residual)) return std::numeric_limits<double>::infinity();
    norm = std::max(norm, std::abs(residual) / scale_[eigen_index(i)]);
  }
  return norm;
}

}  // namespace oblique::network
