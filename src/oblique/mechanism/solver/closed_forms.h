// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/solver/group_state.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// Where the unknown point or link of a group is that is placed as `pinned`, `crossing` or `about_pivot`, on
/// the given side, in `state`. What +1 means: of two circles the meeting point on the left of first → second,
/// of a circle and a line the one further along the line; of a link about a pivot, where
/// a cos θ + b sin θ = c, the angle on the left of (a, b). `open` where there is none, `dead_centre` where
/// the two sides meet.
Status find_by_closed_form(const Mechanism& mechanism, const Group& group, std::span<const DriveState> drives,
                           int side, const Configuration& here, GroupState& state);

/// All poses of a triad.
GroupPoses platform_poses(const Mechanism& mechanism, const Group& group, const Configuration& here);

}  // namespace oblique::mechanism
