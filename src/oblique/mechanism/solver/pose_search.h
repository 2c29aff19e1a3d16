// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <oblique/mechanism/solver/group_system.h>

namespace oblique::mechanism {

/// Poses of a group that has no closed form: the hint and then random guesses, in the box of its known points
/// with its size around it, are closed by Newton's method; poses that differ are kept. The guesses are the
/// same in each call. Never complete.
GroupPoses search_poses(GroupSystem& system, std::span<const DriveState> drives, const Configuration& here,
                        const GroupPose* hint);

}  // namespace oblique::mechanism
