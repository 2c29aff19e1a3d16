// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/refinement.h>
#include <oblique/solve/operating_point/other_solutions.h>
#include <oblique/solve/run.h>

namespace oblique::solve {

/// What became apparent in one run, also in one that failed.
struct Observed {
  Unseen unseen;
  long steps = 0;
};

/// One run from its start to its end: smooth segments, and events between them. Its algebraic loops begin
/// from `loop_start`. With `may_end_unseen` it ends early where it must be made again: it has met growth that
/// it did not see, long ago. Throws SolveError. Not installed.
Run run_once(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options,
             const LoopStart& loop_start, const Refinement& refinement, bool may_end_unseen,
             Observed& observed);

/// What the start of such a run leads to. Throws SolveError.
StartOutcome start_once(const network::Program& program, const diagram::FlatDiagram& diagram,
                        const RunOptions& options, const LoopStart& loop_start);

}  // namespace oblique::solve
