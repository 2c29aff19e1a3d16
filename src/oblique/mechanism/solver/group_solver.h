// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/solver/group_bodies.h>
#include <oblique/mechanism/solver/group_state.h>
#include <oblique/mechanism/solver/group_system.h>
#include <oblique/mechanism/solver/singularity.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// A group that Newton's method places is at a dead centre where its normalised determinant is smaller: two
/// modes that meet do so like square roots of the rounding.
inline constexpr double kMeeting = 1e-7;

/// Puts one group together whose known elements stand in a configuration. It keeps scratch memory, so one
/// object serves one thread; after construction nothing allocates but `poses`.
///
/// Positions: a rotation for a crank; two loci (circles, lines) that intersect for a point or a link of known
/// direction; a cos θ + b sin θ = c for a link about a known point; otherwise Newton's method from the pose
/// that stands in the configuration. Rates: from the linear systems of GroupSystem; for an
/// RRR dyad, with D = e₁ × e₂, e₁ = C − P, e₂ = C − Q:
///
///     ω₁ = e₂·(Q̇ − Ṗ)/D,   ω₂ = e₁·(Q̇ − Ṗ)/D
///     α₁ = e₂·b/D,   α₂ = e₁·b/D,   b = Q̈ − P̈ + ω₁²e₁ − ω₂²e₂
class GroupSolver {
 public:
  GroupSolver(const Mechanism& mechanism, const Group& group);

  /// Positions and rates of the group in `here`, on the given side (as Group::side; unused where a group has
  /// no sides). Groups without closed form start from the pose in `here`. `open` leaves them as they were.
  Status place(std::span<const DriveState> drives, int side, Configuration& here);

  /// The same for a pose that is known already.
  Status place(std::span<const DriveState> drives, const GroupPose& pose, Configuration& here);

  /// Every pose; `hint` is a guess from which the search begins where there is no closed form.
  GroupPoses poses(std::span<const DriveState> drives, const Configuration& here,
                   const GroupPose* hint = nullptr);

  /// Closes a guess by Newton's method; nothing where it does not converge.
  std::optional<GroupPose> close(std::span<const DriveState> drives, const Configuration& here,
                                 const GroupPose& guess);

  /// Whether `place` starts from the pose in the configuration.
  bool is_tracked() const;

  /// Whether the group has one assembly mode only, for which `side` is 0.
  bool is_single() const;

  /// How far the last placement is from one where its modes meet: the determinant of J over the product of
  /// the lengths of its rows, angles counted as lengths on the group's size; in [−1, 1]. 1 for drives.
  double normalised_determinant() const { return determinant_; }

  /// Size of the last placement's first correction by Newton's method over the group's size: how wrong the
  /// guess was.
  double correction() const { return correction_; }

  /// By which part of the first correction the second one was left: below 1/4 no other pose lies as near as
  /// the corrections go (Kantorovich, with a reserve); 0 where one correction was enough.
  double contraction() const { return contraction_; }

  /// The conditions beside the pose in `here`, of which the groups before have their rates; `seconds` is a
  /// time in which the drives make a way of the order of 1.
  Singularity singularity(std::span<const DriveState> drives, const Configuration& here, double seconds);

  /// Takes the pose in `here` as it stands, at a point where modes meet: without rates.
  void stand(std::span<const DriveState> drives, Configuration& here);

  /// Moves the pose in `here`, as a guess, by a step of the unknowns (angles as lengths on the group's size).
  void displace(const Eigen::VectorXd& step, Configuration& here) const;

  /// The rates of the unknowns in `here`, in the same order and measure.
  Eigen::VectorXd velocity(const Configuration& here) const;

  /// How far its farthest point is from the frame, over the size of the mechanism.
  double distance(const Configuration& here) const;

 private:
  Status place_crank(std::span<const DriveState> drives, Configuration& here);
  Status place_dyad(int side, Configuration& here);
  Status find(std::span<const DriveState> drives, int side, const Configuration& here);
  Status finish(std::span<const DriveState> drives, Configuration& here, bool is_dead_centre);

  const Mechanism& mechanism_;
  const Group& group_;
  const GroupForm& form_;
  const GroupEquations& equations_;
  GroupBodies bodies_;
  GroupSystem system_;
  GroupState state_;
  double inverse_r1_ = 0, inverse_r2_ = 0;  ///< of the dyad's links
  double determinant_ = 1;
  double correction_ = 0;
  double contraction_ = 0;
};

}  // namespace oblique::mechanism
