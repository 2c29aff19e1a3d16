// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <oblique/mechanism/motion/branch_walk.h>

namespace oblique::mechanism {

/// Where the drives are while a walk has left its branch at a limit, and the configuration is open.
struct Gap {
  BranchWalk::Place behind;  ///< on the branch, before the end at which it was left
  BranchWalk::Place ahead;   ///< of a single drive that turns: beside the branch's other end
  double end = 0;            ///< of a single drive: its value where the branch was left
  double outward = 0;        ///< ±1: in which direction it lies beyond
  double width = 0;          ///< how far beyond it comes to the other end; infinite where to none
  /// Of a single drive: since when it stands beside an end, where the branch has not been taken up yet.
  std::optional<double> reached = {};
};

/// Finds out where the branch that has just been left at a limit goes on: of a single drive that turns, its
/// other end, by following it all the way back.
Gap leave_branch(BranchWalk& walk);

/// Goes on, open, towards `t` until the branch can be taken up again, and stands on it then; false where it
/// stays open. There the links could have come without being taken apart:
///
/// * A single drive comes back to where it left the branch, or comes to the branch's other end. Both
///   are known values of the drive, so the moment is found by bisection. The branch is taken up as near
///   to its end as its modes are told apart there.
/// * Of several drives it is tried from degree to degree whether the straight way of all of them from where
///   the branch was left, by the nearest turns, is free of limits.
bool come_back(BranchWalk& walk, Gap& gap, double t);

}  // namespace oblique::mechanism
