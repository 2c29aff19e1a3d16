// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/integrator/ode_system.h>

namespace oblique::solve {

/// Tells whether a solver has stepped over something: a pulse that comes to a system at rest, whose error
/// test saw nothing of it.
///
/// Where something may happen inside a step (SourceWatch says where to look), the residual u′ − f(t, u) of
/// the solution u between the solver's own points shows whether the step has seen it: over the part of a step
/// that a sample stands for it makes an error of about |u′ − f| Δ/(1 + Δ |∂f/∂u|). What moves a state that
/// rests is seen however little it is, as it may be a seed.
class HiddenMotion {
 public:
  /// `system` must outlive this; tolerances as those of the solver, the absolute ones of each state.
  HiddenMotion(OdeSystem& system, double relative_tolerance, std::vector<double> absolute_tolerances);

  /// The first of `sample_times` in the step that begins at `from` where the solution misses the equations;
  /// the last of them is the end of the step and not looked at.
  std::optional<double> find(double from, std::span<const double> sample_times, const Interpolant& solution);

  /// How long a step may be that sees what was found [s], and until when there was nothing to see [s].
  double longest_step() const { return longest_; }
  double seen_until() const { return seen_until_; }

 private:
  bool is_pushed(double part);
  bool misses(double t, double part, const Interpolant& solution);

  OdeSystem& system_;
  double relative_;
  std::vector<double> absolute_;
  std::vector<double> x_, rates_, derivatives_, jacobian_;
  std::vector<double> pushes_;  ///< [machine unit] of each state: the most that has moved it out of a rest
  double longest_ = 0, seen_until_ = 0;
};

}  // namespace oblique::solve
