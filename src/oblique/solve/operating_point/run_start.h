// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/operating_point/other_solutions.h>
#include <oblique/solve/run.h>

// How a run starts. Not installed.
namespace oblique::solve {

/// What a start needs of a run; its algebraic loops begin from `loop_start`.
struct StartParts {
  const network::Program& program;
  const diagram::FlatDiagram& diagram;
  const RunOptions& options;
  const LoopStart& loop_start;
  network::Workspace& workspace;
  Switching& switching;
};

/// Settles switches, events, algebraic loops and servo loops at time t, `states` being those from which it
/// starts; warnings of what was found. Throws SolveError.
std::vector<text::Diagnostic> settle_start(const StartParts& parts, double t, std::vector<double>& states);

/// The same for a run that is to go on from there: refuses what has no rate, and warns of loops whose
/// amplifiers do not rest.
std::vector<text::Diagnostic> start_run(const StartParts& parts, double t, std::vector<double>& states);

}  // namespace oblique::solve
