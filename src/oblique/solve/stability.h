// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <oblique/network/program.h>

namespace oblique {

/// Largest real part [1/s] of the eigenvalues of the servo loops alone, linearised at (t, states) with all
/// other states frozen there: negative where every loop would return to rest. −inf without servo states. NaN
/// where an algebraic loop cannot be solved. Groups of loops that do not act on each other are taken one by
/// one.
double servo_stability(const Program& program, Workspace& workspace, double t,
                       std::span<const double> states);

/// The states of the first group of servo loops with an eigenvalue in the right half plane, or none.
std::vector<std::size_t> unstable_group(const Program& program, Workspace& workspace, double t,
                                        std::span<const double> states);

}  // namespace oblique
