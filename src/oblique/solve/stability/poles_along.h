// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/linearisation.h>

namespace oblique::solve {

/// An eigenvalue of the frozen equations at an instant of a run; of a conjugate pair the one above the real
/// axis.
struct PoleAt {
  double time = 0;             ///< [s]
  std::complex<double> value;  ///< [1/s]
  std::size_t state = 0;       ///< that takes the greatest part in its mode
  bool of_problem = false;  ///< the ideal machine has it too (see IdealMachine); else it comes from this one
};

/// The eigenvalues at these instants, in their order. Groups of more than 200 states that act on each other
/// are left out, and instants at which an algebraic loop has no solution.
std::vector<PoleAt> poles_along(const diagram::FlatDiagram& diagram, const network::Program& program,
                                const std::vector<Instant>& instants);

}  // namespace oblique::solve
