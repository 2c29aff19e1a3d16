// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/mechanism/motion/branch_return.h>
#include <oblique/mechanism/motion/branch_walk.h>

namespace oblique::mechanism {

/// A motion that ends at infinity stops this far before it, where the mechanism is a thousand times its size
/// away [rad of the fastest drive].
inline constexpr double kBeforeInfinity = 1e-3;

/// Follows a mechanism from time 0, on one branch of its positions. Steps are made so small that a group
/// never changes its mode between two of them (BranchWalk). Where a group comes near to a singularity the
/// steps go to zero, and the second order of its conditions says what is ahead (`crossings`): the branch
/// turns back, which is a limit, or another mode crosses it, which is a change point and passed by the
/// velocity. Nothing of this depends on the times asked for.
///
/// Beyond a limit the configuration is open until the drives come to where the branch that was left goes on:
/// there the links could have come without being taken apart. Of a single drive these are the two ends of
/// the branch, wherever in its turns; of several drives, what the straight way of all of them reaches.
class Follower {
 public:
  Follower(const Mechanism& mechanism, const Structure& structure);

  /// The configuration at time `t` [s], before or after the one of the call before.
  const Configuration& advance(double t);

  /// Of a follower that has not advanced: goes on the way to time `t` to the first limit, or to infinity, and
  /// says where. The configuration is then the last one before it, within 1e-10 rad of the fastest drive of a
  /// limit.
  std::optional<MotionEvent> advance_to_limit(double t);

  const Configuration& here() const { return walk_.here; }
  double time() const { return walk_.time; }
  const std::vector<DriveState>& drives() const { return walk_.drives; }
  const std::vector<MotionEvent>& events() const { return walk_.events; }
  /// Of a group where the follower stands (GroupSolver::normalised_determinant).
  double normalised_determinant(std::size_t group) const { return walk_.courses[group].determinant; }

 private:
  BranchWalk walk_;
  std::optional<Gap> gap_;  ///< while open
};

}  // namespace oblique::mechanism
