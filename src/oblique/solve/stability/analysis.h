// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability/loop_report.h>
#include <oblique/solve/stability/stability_report.h>

namespace oblique::solve {

/// What a trial run tells about a diagram.
struct Analysis {
  std::optional<Run> run;             ///< with its overloads; nothing where the run failed
  std::optional<SolveError> failure;  ///< why it did
  /// Moments evenly spread over the rows of the run; where the run failed, or servo loops grow on it, those
  /// at which the loops stand at rest, as far as they can.
  std::vector<Instant> instants;
  bool quasi_steady = false;  ///< whether the instants are of the latter kind
  StabilityReport stability;
  std::vector<LoopReport> loops;
  /// The fastest change of every state at the instants [machine unit/s].
  std::vector<double> fastest_derivatives;
};

/// Runs a diagram on trial and judges its loops and its stability at up to `most_instants` of its rows; where
/// the run fails, at those that it reached. Never throws SolveError.
Analysis analyse(const network::Program& program, const diagram::FlatDiagram& diagram, RunOptions options,
                 std::size_t most_instants = 61);

}  // namespace oblique::solve
