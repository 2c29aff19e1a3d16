// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/solve/sensitivity/sensitivities.h>

namespace oblique::solve {

struct CvodesMemory;

/// CVODES with variable-order BDF (or Adams), Newton's method, and KLU on the analytic Jacobian.
class CvodesSolver final : public Solver {
 public:
  /// Starts at (t0, x0) and will not pass `end`, which comes after `length`. `system` must outlive the
  /// solver.
  CvodesSolver(OdeSystem& system, double t0, std::span<const double> x0, double end, double length,
               const SolverSettings& settings);
  ~CvodesSolver() override;
  CvodesSolver(CvodesSolver&&) noexcept;
  CvodesSolver& operator=(CvodesSolver&&) noexcept;

  void restart(double t, std::span<const double> x, double end, double length) override;

  /// Goes on from where it is with these settings. No sensitivities are followed.
  void change_settings(const SolverSettings& settings);

  /// Integrates these sensitivities along with the states from the start on, each after the states' step
  /// (staggered), and holds their errors within the tolerances, too. Must outlive this.
  void follow(Sensitivities& sensitivities);
  /// After a restart: they are now these.
  void set_sensitivities(const std::vector<std::vector<double>>& values);
  /// Those that are followed, at a time within the last step.
  std::vector<std::vector<double>> sensitivities_at(double t) const;

  void limit_step(double longest) override;
  double step() override;
  /// From the solver's own interpolating polynomial.
  void states_at(double t, std::span<double> x) const override;
  void rates_at(double t, std::span<double> dxdt) const override;
  std::span<const double> states() const override;
  SolverStatistics statistics() const override;
  std::vector<double> weighted_errors() const override;
  /// The order of the last step.
  int last_order() const;

 private:
  std::unique_ptr<CvodesMemory> memory_;
};

}  // namespace oblique::solve
