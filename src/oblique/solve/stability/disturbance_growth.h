// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/linearisation.h>

namespace oblique::solve {

/// What became along a run of the small disturbance of its start that grew the most.
struct DisturbanceGrowth {
  double factor = 1;        ///< how many times as large it was at the end; e^700 at most
  double exponent = 0;      ///< its mean rate over the second half of the run [1/s]
  double from = 0, to = 0;  ///< [s] the run
  /// ln of what it grew by in the second half, when a transient is over.
  double late_growth() const { return exponent * (to - from) / 2; }
  /// A chain of integrators multiplies a disturbance by 2 or 4 then, and what grows as an exponential for
  /// some of its time constants by more: below a factor 2 nothing is said to grow, above 30 all is.
  bool grows() const { return late_growth() > 3.4; }          // ln 30
  bool does_not_grow() const { return late_growth() < 0.7; }  // ln 2
};

/// Integrates the variational equation δ′ = A(t) δ of every group of states that act on each other and whose
/// A changes along the run: eigenvalues frozen at each moment do not tell what such a group does (Vinograd
/// 1952: all of them left of the axis, and it grows). Over each row the matrix is the mean of both ends
/// (Magnus, second order); the same with every second row must agree. Nothing where no A changes, where a
/// group that does has more than 60 states, or where the rows are too far apart to tell.
std::optional<DisturbanceGrowth> disturbance_growth(const network::Program& program,
                                                    const std::vector<Instant>& rows);

}  // namespace oblique::solve
