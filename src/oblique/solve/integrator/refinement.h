// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/faint_turn.h>
#include <oblique/solve/integrator/growth_watch.h>
#include <oblique/solve/integrator/small_states.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/solve/run.h>

namespace oblique::solve {

/// What a run did not see.
struct Unseen {
  std::vector<UnseenGrowth> growth;
  std::vector<SmallState> small;
  std::vector<FaintTurn> faint;
  std::vector<std::size_t> lost;  ///< states that were zero but for errors where a signal had no value, or an
                                  ///< output no digit

  bool empty() const { return growth.empty() && small.empty() && faint.empty() && lost.empty(); }
  bool is_faint_alone() const { return growth.empty() && small.empty() && lost.empty(); }
};

/// Where a run is to be finer than its tolerance asks, because states that matter are smaller.
struct Refinement {
  /// [machine unit] of each state: the size at which its absolute tolerance is as much as the relative one;
  /// 0: as usual.
  std::vector<double> reach;
  double nearest =
      0;  ///< least part of states by which they are away from an equilibrium to be left; 0: none

  bool operator==(const Refinement&) const = default;
};

/// Adds what a run did not see.
void refine(const Unseen& unseen, std::size_t n_states, Refinement& refinement);

/// The tolerances and bounds with which a solver meets what a run is asked for.
SolverSettings solver_settings(const std::vector<network::State>& states, const RunOptions& options,
                               diagram::IntegrationMethod method, const Refinement& refinement);

/// The warnings of a run that is not fine enough: as no tolerance is, or as a finer one was `out_of_steps`.
std::vector<text::Diagnostic> warnings_of(const Unseen& unseen, const network::Program& program,
                                          const diagram::FlatDiagram& diagram, bool out_of_steps = false);

}  // namespace oblique::solve
