// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Algebraic loops that are singular at the start (t, states) and only there: x y″ + y′ + x y = 0, divided by
/// x, at x = 0, where y″ = −1/2. Their unknowns are the limit of those a moment later, along the way that the
/// states take with them. Holds them there in the workspace; false where no loop is singular or where there
/// is no such limit, and the workspace is then as it was after `reset`.
bool hold_singular_start(const network::Program& program, network::Workspace& workspace, double t,
                         const std::vector<double>& states, double span);

}  // namespace oblique::solve
