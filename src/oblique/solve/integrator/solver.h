// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/run_records.h>

namespace oblique::solve {

struct SolverSettings {
  double relative_tolerance = 1e-8;
  double absolute_tolerance = 1e-8;  ///< [machine unit]
  std::int64_t max_steps = 10'000'000;
  double max_step = std::numeric_limits<double>::infinity();  ///< [s] the longest step
  diagram::IntegrationMethod method = diagram::IntegrationMethod::bdf;
  std::vector<double> own_tolerances = {};  ///< [machine unit] of each state, where not all have that one
  double asked = 1e-8;                      ///< relative tolerance of the run; the solver's is tighter

  /// The absolute tolerance of a state [machine unit].
  double absolute_tolerance_of(std::size_t state) const {
    return own_tolerances.empty() ? absolute_tolerance : own_tolerances[state];
  }
};

/// Why a solver could not go on.
struct SolverFailure {
  enum class Kind {
    not_finite,     ///< dx/dt or a state is not a number
    no_value,       ///< the system refused to give dx/dt, however short the step
    no_derivative,  ///< the sensitivities have no value, though dx/dt has one
    small_step,     ///< the step fell below what the time can resolve
    step_budget,    ///< `max_steps` are used up
    interrupted,    ///< the system is to end
    other,          ///< anything else CVODES reports
  };
  Kind kind = Kind::other;
  double time = 0;  ///< [s] reached
  int code = 0;     ///< CVODES' return value
};

/// What integrates a smooth segment of a run, step by step. Its own clock starts at zero with every start, so
/// that a segment far shorter than what the time itself resolves late in a run keeps its length. Errors are
/// measured by the state that is worst beside its tolerance, so that no number of other states hides it.
class Solver : public Interpolant {
 public:
  /// Starts anew at (t, x), where the system has jumped, and will not pass `end`, which comes after `length`.
  virtual void restart(double t, std::span<const double> x, double end, double length) = 0;

  /// No step is longer than this from now on [s]; infinity: as long as the tolerance lets it be.
  virtual void limit_step(double longest) = 0;

  /// Takes one step and returns the time reached [s], exactly `end` at last. Throws SolverFailure.
  virtual double step() = 0;

  /// The states at the time reached.
  virtual std::span<const double> states() const = 0;

  virtual SolverStatistics statistics() const = 0;

  /// Of each state: estimated local error of the last step over its tolerance; the test is that these are
  /// below 1.
  virtual std::vector<double> weighted_errors() const = 0;
};

/// The time at which a solver is that has gone on by `clock` of `length` since `start` [s]: `end` is reached
/// with the whole length only, however near rounding brings it.
inline double time_within(double start, double clock, double end, double length) {
  return clock >= length ? end : std::min(start + clock, std::nextafter(end, start));
}

/// Counts steps that cannot move the time any more, being some roundings of the time reached. (The length of
/// the run is no measure: a fast decay at the head of a long run takes steps that are nothing beside it.)
/// After so many in a row in which the time since the start has not doubled, as it does in a decay that is
/// faster than the time shows, a solver gives up. Steps that cannot move the states either may be longer.
class SmallSteps {
 public:
  void restart() { *this = SmallSteps(); }
  /// Another step, from `before` to `clock` of `length` since a start at a time of this magnitude [s], which
  /// moved the states by more than a rounding or not; true where that is one too many.
  bool take(double before, double clock, double length, double time, bool moved) {
    constexpr double kRounding = std::numeric_limits<double>::epsilon();
    constexpr int kMost = 20;
    const double smallest = (moved ? 8 : 1000) * kRounding * std::min(std::abs(time), length);
    const bool small = clock - before < smallest && clock < length;
    if (!small || clock > 2 * since_) {
      since_ = clock;
      count_ = 0;
    } else {
      ++count_;
    }
    return count_ > kMost;
  }
  bool any() const { return count_ > 0; }

 private:
  double since_ = 0;  ///< clock from which it is to double
  int count_ = 0;
};

}  // namespace oblique::solve
