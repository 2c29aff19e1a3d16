// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <set>
#include <span>
#include <vector>

#include <oblique/diagram/flatten.h>
#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/text/diagnostic.h>

namespace oblique::solve {

/// Watches the steps of a solver for outputs that lose their last digit on the way from the states: what
/// divides by a state that has come to zero, or subtracts what is nearly alike, shows little but the errors
/// that the tolerance leaves to the states. At some of the steps and events, ever fewer, and at the end of
/// the run these errors are put into all states together, with some combinations of their signs, and the
/// outputs are looked at. A state that has decayed to its errors may be known all the same, and can be: the
/// run is then to begin anew with it known relatively. (`RunOptions::trust` estimates the whole error of
/// every output.) Not installed.
class LostOutputs {
 public:
  /// Gives the outputs at (t, x), false where they have no values.
  using Outputs = std::function<bool(double t, const double* x, double* values)>;

  /// All must outlive the watch; `span` is the length of the run [s].
  LostOutputs(const diagram::FlatDiagram& diagram, OdeSystem& system, const SolverSettings& settings,
              double span, Outputs outputs);

  /// Looks at the states (t, x) that a step has reached.
  void advance(double t, std::span<const double> x);
  /// The same after an event, which may let an output show what it has not read before.
  void begin_segment(double t, std::span<const double> x);
  /// Looks at the end (t, x) of the run.
  void end(double t, std::span<const double> x) { look(t, x); }

  /// One warning about each that had no known digit once, but for those that are `told` of already.
  std::vector<text::Diagnostic> warnings(const std::vector<bool>& told) const;
  /// The states that had decayed to their errors where these moved an output by much.
  const std::set<std::size_t>& decayed() const { return decayed_; }

 private:
  /// When an output lost its last digit, its value then, and by how much the errors move it.
  struct Loss {
    double time = -1;  ///< [s]; below zero where that has not been
    double value = 0, moved = 0;
  };
  double error_of_state(std::size_t i, double x) const;
  bool is_lost(std::size_t output) const;
  bool is_moved_by(std::size_t output, double part) const;
  void find_decayed(double t, std::span<const double> x);
  void look(double t, std::span<const double> x);

  const diagram::FlatDiagram& diagram_;
  OdeSystem& system_;
  const SolverSettings& settings_;
  double span_;
  Outputs outputs_;
  std::vector<double> sizes_;  ///< largest magnitude of each output so far
  std::vector<Loss> losses_;
  std::vector<double> values_, moved_, off_states_;
  std::set<std::size_t> decayed_;
  long steps_ = 0, next_look_ = 16;
  unsigned long segments_ = 0;
};

}  // namespace oblique::solve
