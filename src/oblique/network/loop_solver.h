// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include <oblique/network/tape.h>

namespace oblique {

/// A number on a slot that belongs at (row, column) of a matrix.
struct MatrixEntry {
  std::uint32_t row, column, slot;
};

/// An algebraic loop g(z) = 0 as code: `body` computes, from the unknowns' slots, the residuals and dg/dz.
struct LoopCode {
  std::vector<std::uint32_t> unknown_slots;
  std::vector<std::uint32_t> residual_slots;
  std::vector<MatrixEntry> slopes;    ///< dg/dz
  std::vector<double> natural_scale;  ///< a row of dg/dz far below this has cancelled: 1 where torn, else 0
  TapeRange body;
  bool linear = false;  ///< dg/dz does not depend on z: one step solves it

  std::size_t size() const { return unknown_slots.size(); }
};

enum class LoopFailure : std::uint8_t { none, singular, diverged, not_finite };

/// Scratch memory and LU factors of one loop; dense, since the loops of diagrams are short.
class LoopWorkspace {
 public:
  explicit LoopWorkspace(std::size_t size);

  /// Factors dg/dz as the slots hold it now; false where it is singular to rounding.
  bool factor(const LoopCode& loop, const double* slots);

  /// Overwrites `right_sides` (a column for each) with the solutions of dg/dz · X = right_sides.
  void solve(Eigen::Ref<Eigen::MatrixXd> right_sides);

  /// Solves the loop by Newton's method, damped where the residual would grow, from what the unknowns' slots
  /// hold (one LU from zero where it is linear); they then hold the solution, to rounding, and `body` has
  /// been run on it.
  LoopFailure solve_loop(const LoopCode& loop, std::span<const Instruction> tape, double* slots);

 private:
  double residual_norm(const LoopCode& loop, const double* slots) const;
  double move(const LoopCode& loop, double* slots, double fraction) const;

  Eigen::MatrixXd matrix_;  ///< rows scaled by 1/scale_
  Eigen::VectorXd scale_;
  Eigen::MatrixXd step_;   ///< one column
  Eigen::VectorXd start_;  ///< iterate that the step starts from
  Eigen::VectorXd permuted_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace oblique
