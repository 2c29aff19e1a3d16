// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/integrator/solver.h>

namespace oblique::solve {

/// A state that is hardly known beside its size, and is read by something that this matters to.
struct SmallState {
  std::size_t state = 0;
  double size = 0;          ///< [machine unit] its largest magnitude
  std::size_t reading = 0;  ///< number of what reads it
};

/// Watches the steps of a solver for states that matter though they stay so small that the absolute tolerance
/// decides about them: 1e-15 cos t is zero to a solver, and a gain of 1e15 shows it. At some of the steps the
/// error that the solver leaves to each such state is put into it, alone and with what it grows to in the
/// other states (by implicit steps of the linearised equations), and the readings are looked at: outputs in
/// their units, and the event functions of switches beside their own size. States that are no more than the
/// rounding of what they integrate are not told of: nothing would make them known. Where all states of a
/// diagram are below 1e-4 it stands in small units (amperes of a nerve), and all above 1e-13 matter, as do
/// those behind an output that stays between the two; but for what slides hold at zero to within errors. Not
/// installed.
class SmallStates {
 public:
  /// Gives `n_readings` values at (t, x), false where they have none; those from `n_relative` on matter
  /// beside their own size alone.
  using Readings = std::function<bool(double t, const double* x, double* values)>;

  /// `tolerance` is that of the run, `span` its length [s]. All must outlive the watch.
  SmallStates(OdeSystem& system, const SolverSettings& settings, double tolerance, double span,
              Readings readings, std::size_t n_readings, std::size_t n_relative);

  /// Looks at the states (t, x) that a step has reached or the run starts from.
  void advance(double t, std::span<const double> x);

  /// Looks at the end (t, x) of the run.
  void end(double t, std::span<const double> x) { look(t, x); }

  /// Of the states that were small all the time, those that were read; all of them in small units.
  std::vector<SmallState> found() const;

 private:
  bool is_small(std::size_t i) const;
  void look(double t, std::span<const double> x);
  void read(double t, std::span<const double> x, std::size_t state, const std::vector<double>& off);
  std::optional<std::size_t> reader_of(std::size_t state) const;

  OdeSystem& system_;
  const SolverSettings& settings_;
  double tolerance_, span_;
  Readings readings_;
  std::size_t n_relative_;
  std::vector<double> peaks_, noise_;   ///< of the states: largest magnitude, and what rounding makes of them
  std::vector<double> left_by_others_;  ///< what the errors of larger states and of those held make of them
  std::vector<double> sizes_;           ///< of the readings
  std::vector<double> values_, moved_, off_states_;
  std::vector<bool> held_;  ///< of each state: whether a slide may have held it at zero
  std::map<std::size_t, std::vector<double>>
      moves_;  ///< of each small state, by how much it moves the readings
  /// The first look is late: many a state begins at zero, and is small for some steps only.
  long steps_ = 0, next_look_ = 16;
};

}  // namespace oblique::solve
