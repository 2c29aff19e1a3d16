// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <oblique/solve/cvodes_solver.h>
#include <oblique/solve/growth_watch.h>
#include <oblique/solve/run.h>

namespace oblique {

/// Where a run is to be finer than its tolerance asks, because states that matter are smaller.
struct Refinement {
  std::vector<double>
      reach;            ///< [machine unit] of each state, the size down to which it matters; 0: as usual
  bool finest = false;  ///< relative tolerance down to rounding

  bool operator==(const Refinement&) const = default;
};

/// Adds what a run did not see.
void refine(std::span<const UnseenGrowth> found, std::size_t n_states, Refinement& refinement);

/// The tolerances and bounds with which a solver meets what a run is asked for.
SolverSettings solver_settings(const std::vector<State>& states, const RunOptions& options,
                               IntegrationMethod method, const Refinement& refinement);

/// The warning of a run that is not fine enough.
Diagnostic unseen_growth(const std::vector<State>& states, const UnseenGrowth& growth,
                         const std::string& file);

}  // namespace oblique
