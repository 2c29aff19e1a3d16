// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <oblique/mechanism/motion/branch_walk.h>

namespace oblique::mechanism {

/// How a step of a walk went.
enum class Crossing : std::uint8_t {
  passed,          ///< it was made, or what it met was passed
  limit,           ///< the branch ends here
  at_singularity,  ///< the time asked for lies where the modes meet: it is in `shown`
  regular,         ///< there is nothing to cross: smaller steps will do
};

/// One step towards `t`, which deals with what lies on the way:
///
/// * A step is tried, and halved until it is good (`BranchWalk::attempt`).
/// * Where the normalised determinant of a group has all but vanished, or steps have become too small to
/// count, two modes
///   of the group are about to meet. The second order of its conditions (`Singularity`) says how.
/// * Two lines that cross are a change point. It is passed to as far on the other side, in the mode to which
/// the
///   velocity leads. All groups that pass one at the same time do so together.
/// * A fold is a limit: the walk ends.
/// * A group that is hundreds of its sizes away goes to infinity like 1/(t∞ − t). It is passed to the other
/// side,
///   unless the walk stops there.
///
/// Nothing is ever placed nearer to such a point than where the pose still tells the modes apart.
Crossing step_towards(BranchWalk& walk, double t);

/// Walks towards `t` to the first limit, or to infinity where the walk stops there, and says where. The walk
/// then stands at the last place before it.
std::optional<MotionEvent> walk_to_limit(BranchWalk& walk, double t);

}  // namespace oblique::mechanism
