// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/network/program.h>

namespace oblique {

/// The states that are brought to rest before the clock starts: those of servo amplifiers.
std::vector<std::size_t> rest_states(const Program& program);

/// Brings servo loops to rest at time t while all other states are held, as an operator waits for the loops to settle
/// before he starts the clock: the loops run with the clock stopped, then Newton's method takes them to dx/dt = 0.
/// Changes `states` in place. Throws SolveError where a loop does not settle or an algebraic loop has no solution.
void bring_to_rest(const Program& program, Workspace& workspace, double t, std::vector<double>& states,
                   const std::string& file);

}  // namespace oblique
