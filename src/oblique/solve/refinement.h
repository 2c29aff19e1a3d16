// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <oblique/solve/cvodes_solver.h>
#include <oblique/solve/faint_turns.h>
#include <oblique/solve/growth_watch.h>
#include <oblique/solve/run.h>
#include <oblique/solve/small_states.h>

namespace oblique {

/// What a run did not see.
struct Unseen {
  std::vector<UnseenGrowth> growth;
  std::vector<SmallState> small;
  std::vector<FaintTurn> faint;

  bool empty() const { return growth.empty() && small.empty() && faint.empty(); }
};

/// Where a run is to be finer than its tolerance asks, because states that matter are smaller.
struct Refinement {
  /// [machine unit] of each state: the size at which its absolute tolerance is as much as the relative one;
  /// 0: as usual.
  std::vector<double> reach;
  bool finest = false;  ///< relative tolerance down to rounding

  bool operator==(const Refinement&) const = default;
};

/// Adds what a run did not see.
void refine(const Unseen& unseen, std::size_t n_states, Refinement& refinement);

/// The tolerances and bounds with which a solver meets what a run is asked for.
SolverSettings solver_settings(const std::vector<State>& states, const RunOptions& options,
                               IntegrationMethod method, const Refinement& refinement);

/// The warnings of a run that is not fine enough.
std::vector<Diagnostic> warnings_of(const Unseen& unseen, const Program& program, const FlatDiagram& diagram);

}  // namespace oblique
