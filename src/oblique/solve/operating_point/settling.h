// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/network/program/program.h>

// Not installed.
namespace oblique::solve {

/// States in groups that act on each other, each after the groups that it follows.
using StateGroups = std::vector<std::vector<std::size_t>>;

/// Lets the states of the groups run at time t, with the clock stopped and all others held, until they rest:
/// implicit Euler steps, short at first so that they follow the way the loops take, then ever longer until
/// they are Newton's method (pseudo-transient continuation). A step that changes a state much, or across
/// which 1/h − df/dx of a group changes the sign of its determinant (there a loop is unstable), is taken
/// again shorter. Magnitudes, limiters and tables change their sides and lines on the way, or, where that
/// leads nowhere, stay on those where they stand. Whether they settle; where not, `states` is as they were
/// last.
bool settle(const network::Program& program, network::Workspace& workspace, double t,
            const StateGroups& groups, std::vector<double>& states);

}  // namespace oblique::solve
