// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/solver/group_state.h>

namespace oblique::mechanism {

/// The conditions g(q, t) = 0 of a group as a linear system for a step of its unknowns or for their rates,
///
///     J q̇ = −∂g/∂t,      J q̈ = −(d²g/dt² with q̈ = 0)
///
/// where the right-hand sides follow from the motion of the known elements. Rows as in
/// GroupEquations::conditions; angles are counted as lengths on the group's size.
class GroupSystem {
 public:
  /// Mechanism and equations have to outlive it. After construction nothing allocates.
  GroupSystem(const Mechanism& mechanism, const GroupEquations& equations);

  const GroupEquations& equations() const { return equations_; }

  /// Of the group: the largest of its lengths [length unit].
  double size() const { return size_; }

  /// right = −g.
  void evaluate(const GroupState& state, std::span<const DriveState> drives, const Configuration& here);

  void evaluate_jacobian(const GroupState& state, const Configuration& here);

  /// right = −dg/dt with q̇ = 0, or (`second`) −d²g/dt² with q̈ = 0.
  void evaluate_rates(const GroupState& state, std::span<const DriveState> drives, const Configuration& here,
                      bool second);

  /// solution = J⁻¹ right; false where there is none.
  bool solve();

  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  const Eigen::VectorXd& right() const { return right_; }
  const Eigen::VectorXd& solution() const { return solution_; }

  /// The determinant of J, as it was solved last, over the product of the lengths of its rows; in [−1, 1],
  /// but for bodies that are far away.
  double normalised_determinant() const;

 private:
  const Mechanism& mechanism_;
  const GroupEquations& equations_;
  double size_;
  Eigen::MatrixXd jacobian_, work_;
  Eigen::VectorXd right_, solution_;
  double determinant_ = 1;
};

}  // namespace oblique::mechanism
