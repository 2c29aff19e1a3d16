// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Groups of more loops than these act on each other are not given to the QR algorithm, which takes n³
/// operations. They are judged by a bound that is sufficient, and close where the matrix of the loops is
/// diagonally dominant.
inline constexpr std::ptrdiff_t kMostLoopsForEigenvalues = 300;

/// Largest real part [1/s] of the eigenvalues of the servo loops alone, linearised at (t, states) with all
/// other states frozen there: negative where every loop would return to rest. −inf without servo states. NaN
/// where an algebraic loop cannot be solved, or where the bound does not tell. Groups of loops that do not
/// act on each other are taken one by one; of a large one it is the bound.
double servo_stability(const network::Program& program, network::Workspace& workspace, double t,
                       std::span<const double> states);

/// The states of the first group of servo loops with an eigenvalue in the right half plane, or none. Groups
/// of more than kMostLoopsForEigenvalues are passed over.
std::vector<std::size_t> unstable_group(const network::Program& program, network::Workspace& workspace,
                                        double t, std::span<const double> states);

}  // namespace oblique::solve
