// SPDX-License-Identifier: MIT
#include <oblique/network/loop_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique {
namespace {

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

}  // namespace

bool LoopCode::has_branches() const {
  return !linear &&
         std::find(held_by_amplifier.begin(), held_by_amplifier.end(), true) != held_by_amplifier.end();
}

LoopMatrix::LoopMatrix(std::size_t size)
    : matrix_(index(size), index(size)),
      scale_(index(size)),
      permuted_(index(size)),
      visited_(size),
      lu_(index(size)) {}

bool LoopMatrix::factor(const LoopCode& loop, const double* slots, double mass) {
  scale_ = Eigen::Map<const Eigen::VectorXd>(loop.natural_scale.data(), index(loop.size()));
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop.held_by_amplifier[i]) scale_[index(i)] = std::max(scale_[index(i)], mass);
  }
  for (const MatrixEntry& entry : loop.slopes) {
    scale_[entry.row] = std::max(scale_[entry.row], std::abs(slots[entry.slot]));
  }
  if (!scale_.allFinite() || scale_.minCoeff() <= 0) return false;
  matrix_.setZero();
  for (const MatrixEntry& entry : loop.slopes) {
    matrix_(entry.row, entry.column) = slots[entry.slot] / scale_[entry.row];
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop.held_by_amplifier[i]) matrix_(index(i), index(i)) += mass / scale_[index(i)];
  }
  const double smallest_pivot = 8 * std::numeric_limits<double>::epsilon() * static_cast<double>(loop.size());
  if (loop.size() == 1) return std::abs(matrix_(0, 0)) > smallest_pivot;
  lu_.compute(matrix_);
  return lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > smallest_pivot;
}

int LoopMatrix::determinant_sign() {
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
    norm = std::max(norm, std::abs(residual) / scale_[index(i)]);
  }
  return norm;
}

}  // namespace oblique
