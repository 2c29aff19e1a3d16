// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <oblique/network/program/program.h>

// Not installed.
namespace oblique::solve {

/// What the amplifiers of a loop do about a solution of it, infinitely fast and all alike.
enum class AmplifierMotion { rest, swing, run_away };

/// By the eigenvalues of dg/dz of the amplifiers' equations, the rest of the loop solved: where the real part
/// of one is below 0 they run away, where one has none but an imaginary part they swing for ever. Each row of
/// `jacobian`, d residual/dz of all unknowns of the loop, may have any factor where it is no amplifier's.
AmplifierMotion amplifier_motion(const network::Program& program, std::size_t loop,
                                 const Eigen::MatrixXd& jacobian);

}  // namespace oblique::solve
