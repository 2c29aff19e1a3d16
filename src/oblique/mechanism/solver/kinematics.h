// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/solver/group_solver.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// Puts a mechanism together, group after group. The mechanism and the structure have to outlive it; one
/// object serves one thread.
class Kinematics {
 public:
  Kinematics(const Mechanism& mechanism, const Structure& structure);

  /// Exact positions and rates of all points and links at given states of the drives, one for each of
  /// Mechanism::drives. Groups without closed form start from the poses in `here`. Sets status and group;
  /// where a group is open, nothing has a value. Angles of links and prismatic joints are set by `finish`.
  void place(std::span<const DriveState> drives, Configuration& here);

  /// The angles of the links from their cosines and sines, in (−π, π] but for driven ones, which have their
  /// drive's; and the prismatic joints.
  void finish(std::span<const DriveState> drives, Configuration& here) const;

  /// Writes the poses at time 0 into `here`: from where tracked groups start.
  void load_start(Configuration& here) const;

  GroupSolver& solver(std::size_t group) { return solvers_[group]; }
  const GroupSolver& solver(std::size_t group) const { return solvers_[group]; }
  const Mechanism& mechanism() const { return mechanism_; }
  const Structure& structure() const { return structure_; }

 private:
  const Mechanism& mechanism_;
  const Structure& structure_;
  std::vector<GroupSolver> solvers_;
  std::vector<LineRef> lines_;  ///< of the prismatic joints
};

/// The configuration of a structure at the start: `place` and `finish` at time 0.
Configuration start_configuration(const Mechanism& mechanism, const Structure& structure);

}  // namespace oblique::mechanism
