// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <oblique/network/program.h>

namespace oblique {

/// Largest real part [1/s] of the eigenvalues of the servo loops alone, linearised at (t, states) with all other states
/// frozen there: negative where every loop would return to rest. −inf without servo states. NaN where an algebraic
/// loop cannot be solved.
double servo_stability(const Program& program, Workspace& workspace, double t, std::span<const double> states);

}  // namespace oblique
