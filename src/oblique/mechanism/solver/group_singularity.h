// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <oblique/mechanism/solver/group_system.h>
#include <oblique/mechanism/solver/singularity.h>

namespace oblique::mechanism {

/// The conditions of a group to the second order beside the pose in `state`, of which the groups before have
/// their rates in `here`; `seconds` is a time in which the drives make a way of the order of 1. The rates in
/// `state` are lost.
Singularity singularity_of(GroupSystem& system, GroupState& state, std::span<const DriveState> drives,
                           const Configuration& here, double seconds);

}  // namespace oblique::mechanism
