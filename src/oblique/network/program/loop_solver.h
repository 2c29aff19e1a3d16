// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include <oblique/network/program/failed_search.h>
#include <oblique/network/program/loop_matrix.h>
#include <oblique/network/program/pole_guard.h>
#include <oblique/network/program/tape.h>

namespace oblique::network {

enum class LoopFailure : std::uint8_t {
  none,
  singular,
  diverged,
  not_finite,
  lost  ///< no solution on the branch that is followed
};

/// Scratch memory of one loop, and what is known of its last solution.
///
/// Of a loop with branches, a solution is one that the amplifiers reach from the last: Newton's method where
/// it stays on the branch (it never turns back, and the determinant of dg/dz keeps its sign), else the motion
/// of the amplifiers themselves, infinitely fast, until they rest. Of one without amplifiers it is one on the
/// same branch; any where there is none, and no branch is followed.
class LoopWorkspace {
 public:
  explicit LoopWorkspace(std::size_t size);

  LoopMatrix& matrix() { return matrix_; }

  /// Solves the loop by Newton's method, damped where the residual would grow, from what the unknowns' slots
  /// hold (one LU from zero where it is linear); they then hold the solution, to rounding, and `body` has
  /// been run on it.
  LoopFailure solve_loop(const LoopCode& loop, std::span<const Instruction> tape, double* slots);

  /// How often its equations have been evaluated so far.
  std::size_t evaluations() const { return evaluations_; }

  /// While a branch is followed, `lost` is told where it ends, and nothing leaves it.
  void follow_branch(bool follow) { following_ = follow; }

  /// Forgets what it knows of the last solution, but not what is held.
  void reset();

  /// At time t, where the loop is singular, its unknowns are these: for as long as they solve it or, with
  /// `whatever`, in any case.
  void hold(double t, std::vector<double> unknowns, bool whatever);

 private:
  /// How Newton's method is to go: as it likes; over no pole; or so too, by a part of its long steps, and to
  /// no other sign of the determinant of dg/dz.
  enum class Steps : std::uint8_t { any, guarded, parts };
  /// How it has ended.
  struct Search {
    LoopFailure failure = LoopFailure::none;
    bool damped = false;      ///< a step has led uphill
    bool even_order = false;  ///< each step was half the one before it: the root has no derivative
    int first_sign = 0;       ///< of the determinant of dg/dz where it began
  };
  void evaluate(std::span<const Instruction> body, double* slots);
  Search newton(const LoopCode& loop, std::span<const Instruction> body, double* slots,
                Steps steps = Steps::any);
  bool pass_guesses_on(const LoopCode& loop, std::span<const Instruction> body, double* slots);
  LoopFailure solve_unbranched(const LoopCode& loop, std::span<const Instruction> body, double* slots);
  LoopFailure solve_beside_fold(const LoopCode& loop, std::span<const Instruction> body, double* slots);
  LoopFailure solve_linear(const LoopCode& loop, std::span<const Instruction> body, double* slots);
  LoopFailure solve_branched(const LoopCode& loop, std::span<const Instruction> body, double* slots);
  bool solves(const LoopCode& loop, std::span<const Instruction> body, double* slots,
              std::span<const double> unknowns);
  bool keeps_sign(const LoopCode& loop, std::span<const Instruction> body, double* slots,
                  const Eigen::VectorXd& from, int sign);
  bool relax(const LoopCode& loop, std::span<const Instruction> body, double* slots);
  double way(const LoopCode& loop, const double* slots) const;
  double longest_change(const LoopCode& loop, const double* slots) const;
  double move(const LoopCode& loop, double* slots, double fraction) const;
  void read(const LoopCode& loop, const double* slots, Eigen::VectorXd& unknowns) const;
  void write(const LoopCode& loop, double* slots, const Eigen::VectorXd& unknowns) const;

  LoopMatrix matrix_;
  LoopMatrix beside_;  ///< of `keeps_sign`
  PoleGuard poles_;
  FailedSearch failed_;
  LoopFailure failure_ = LoopFailure::none;  ///< of the last search
  Eigen::MatrixXd step_;                     ///< one column
  Eigen::VectorXd start_;                    ///< iterate that the step starts from
  Eigen::VectorXd origin_, target_;          ///< where a search began and ended
  Eigen::VectorXd end_, between_;            ///< of `keeps_sign`

  std::size_t evaluations_ = 0;
  bool following_ = false;
  bool solved_ = false;  ///< a solution is known, and was no singular one
  int branch_ = 0;       ///< sign of the determinant of dg/dz on it
  double held_time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> held_;
  bool held_whatever_ = false;
};

}  // namespace oblique::network
