// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Dense>

#include <oblique/network/program/tape.h>

namespace oblique::network {

inline Eigen::Index eigen_index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

/// A number on a slot that belongs at (row, column) of a matrix.
struct MatrixEntry {
  std::uint32_t row, column, slot;
};

/// An algebraic loop g(z) = 0 as code: `body` computes, from the unknowns' slots, the residuals and dg/dz.
struct LoopCode {
  std::vector<std::uint32_t> unknown_slots;
  std::vector<std::uint32_t> residual_slots;
  std::vector<MatrixEntry> jacobian;  ///< dg/dz
  std::vector<double> natural_scale;  ///< a row of dg/dz far below this has cancelled: 1 where torn, else 0
  TapeRange body;
  bool linear = false;  ///< dg/dz does not depend on z: one step solves it
  /// Of each unknown, whether an amplifier holds it: with the rest of the loop solved it moves as −g.
  std::vector<bool> held_by_amplifier;

  std::size_t size() const { return unknown_slots.size(); }
  /// Whether it may have several solutions of which amplifiers choose one.
  bool has_branches() const;
};

/// dg/dz of one loop, and its LU factors: dense, since the loops of diagrams are short, but sparse where a
/// loop is long and each of its elements reads few others.
class LoopMatrix {
 public:
  explicit LoopMatrix(std::size_t size);
  ~LoopMatrix();
  LoopMatrix(const LoopMatrix& other);
  LoopMatrix& operator=(const LoopMatrix& other);
  LoopMatrix(LoopMatrix&&) noexcept;
  LoopMatrix& operator=(LoopMatrix&&) noexcept;

  /// Factors dg/dz as the slots hold it now, with `mass` added for each amplifier; false where it is singular
  /// to rounding.
  bool factor(const LoopCode& loop, const double* slots, double mass = 0);

  // Of what was factored last:
  /// Overwrites `right_sides` (a column for each) with the solutions of dg/dz · X = right_sides.
  void solve(Eigen::Ref<Eigen::MatrixXd> right_sides);
  /// +1 or −1.
  int determinant_sign();
  /// Largest residual over the scale of its row: the length of the step that the row asks for.
  double residual_norm(const LoopCode& loop, const double* slots) const;

 private:
  class Sparse;
  void prepare(const LoopCode& loop);
  bool factor_sparse(const LoopCode& loop, const double* slots, double mass, double smallest_pivot);

  std::unique_ptr<Sparse> sparse_;  ///< in place of the two below that are dense
  Eigen::MatrixXd matrix_;          ///< rows scaled by 1/scale_
  Eigen::VectorXd scale_;
  Eigen::VectorXd permuted_;
  std::vector<char> visited_;  ///< scratch of `determinant_sign`
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace oblique::network
