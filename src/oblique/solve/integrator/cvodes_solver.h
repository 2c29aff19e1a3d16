// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/run_records.h>
#include <oblique/solve/sensitivity/sensitivities.h>

namespace oblique::solve {

struct SolverSettings {
  double relative_tolerance = 1e-8;
  double absolute_tolerance = 1e-8;  ///< [machine unit]
  long max_steps = 10'000'000;
  double max_step = std::numeric_limits<double>::infinity();  ///< [s] the longest step
  bool adams = false;                                         ///< Adams–Moulton formulas in place of BDF
  std::vector<double> own_tolerances = {};  ///< [machine unit] of each state, where not all have that one
};

/// Why a solver could not go on.
struct SolverFailure {
  enum class Kind {
    not_finite,   ///< dx/dt or a state is not a number
    no_value,     ///< the system refused to give dx/dt, however short the step
    small_step,   ///< the step fell below what the time can resolve
    step_budget,  ///< `max_steps` are used up
    interrupted,  ///< the system is to end
    other,        ///< anything else CVODES reports
  };
  Kind kind = Kind::other;
  double time = 0;  ///< [s] reached
  int code = 0;     ///< CVODES' return value
};

/// CVODES with variable-order BDF (or Adams), Newton's method, and KLU on the analytic Jacobian. Errors are
/// measured by the state that is worst beside its tolerance, so that no number of other states hides it. Owns
/// all of SUNDIALS' memory.
///
/// CVODES' own clock starts at zero with every start, so that a segment far shorter than what the time itself
/// resolves late in a run keeps its length.
class CvodesSolver final : public Interpolant {
 public:
  /// Starts at (t0, x0) and will not pass `end`, which comes after `length`. `system` must outlive the
  /// solver.
  CvodesSolver(OdeSystem& system, double t0, std::span<const double> x0, double end, double length,
               const SolverSettings& settings);
  ~CvodesSolver() override;
  CvodesSolver(CvodesSolver&&) noexcept;
  CvodesSolver& operator=(CvodesSolver&&) noexcept;

  /// Starts anew at (t, x), where the system has jumped, and will not pass `end`, which comes after `length`.
  void restart(double t, std::span<const double> x, double end, double length);

  /// Integrates these sensitivities along with the states from the start on, each after the states' step
  /// (staggered), and holds their errors within the tolerances, too. Must outlive this.
  void follow(Sensitivities& sensitivities);
  /// After a restart: they are now these.
  void set_sensitivities(const std::vector<std::vector<double>>& values);
  /// Those that are followed, at a time within the last step.
  std::vector<std::vector<double>> sensitivities_at(double t) const;

  /// No step is longer than this from now on [s]; infinity: as long as the tolerance lets it be.
  void limit_step(double longest);

  /// Takes one step and returns the time reached [s], exactly `end` at last. Throws SolverFailure.
  double step();

  /// The states at a time within the last step, from the solver's own interpolating polynomial.
  void states_at(double t, std::span<double> x) const override;
  void rates_at(double t, std::span<double> dxdt) const override;

  /// The states at the time reached.
  std::span<const double> states() const;

  SolverStatistics statistics() const;

  /// Of each state: estimated local error of the last step over its tolerance; the test is that these are
  /// below 1.
  std::vector<double> weighted_errors() const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace oblique::solve
