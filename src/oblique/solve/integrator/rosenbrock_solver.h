// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/solve/integrator/step_matrix.h>

namespace oblique::solve {

/// Rodas5P with its own choice of steps: one factorisation and eight solutions a step, no iteration. It keeps
/// nothing of the steps before, so that it is at full length soon after an event. Not installed.
class RosenbrockSolver final : public Solver {
 public:
  /// Starts at (t0, x0) and will not pass `end`, which comes after `length`. `system` must outlive the
  /// solver.
  RosenbrockSolver(OdeSystem& system, double t0, std::span<const double> x0, double end, double length,
                   const SolverSettings& settings);

  void restart(double t, std::span<const double> x, double end, double length) override;
  void limit_step(double longest) override;
  double step() override;
  /// From the polynomial of order 4 that belongs to the method.
  void states_at(double t, std::span<double> x) const override;
  void rates_at(double t, std::span<double> dxdt) const override;
  std::span<const double> states() const override { return x_; }
  SolverStatistics statistics() const override { return statistics_; }
  std::vector<double> weighted_errors() const override;

 private:
  enum class Outcome { taken, inaccurate, impossible };

  bool evaluate(double clock, std::span<const double> x, std::span<double> dxdt);
  void begin();
  double first_step() const;
  double length_of_next() const;
  double factor_after(Outcome outcome, bool tried);
  Outcome try_step(double h);
  bool linearise(double h);
  bool differentiate(double clock, std::span<const double> x);
  bool take_differences(double clock, std::span<const double> x);
  void differentiate_by_time(double h);
  bool run_stages(double h);
  double error_of(std::span<const double> difference) const;
  void find_between();
  bool look_between(double h);
  void take(double h);
  double time_of(double clock) const { return clock >= length_ ? end_ : start_ + clock; }
  bool has_moved() const;
  double part_of(double t) const;
  SolverFailure failure() const;

  OdeSystem& system_;
  std::size_t n_;
  SolverSettings settings_;
  double longest_;  ///< step [s]
  double start_ = 0, end_ = 0, length_ = 0;
  double clock_ = 0;                  ///< since `start_` [s]
  double t_ = 0;                      ///< reached [s]
  std::optional<double> next_;        ///< step to try [s]; nothing: there has been none since the start
  bool first_ = true;                 ///< no step since the start
  bool knows_linearisation_ = false;  ///< at the time reached, in `jacobian_` and `by_time_`
  SmallSteps small_steps_;
  bool saw_refusal_ = false, saw_not_finite_ = false;  ///< since the last step that was not small
  SolverStatistics statistics_;

  StepMatrix matrix_;
  std::optional<StepMatrix> full_matrix_;  ///< of a Jacobian by differences
  StepMatrix* factors_ = nullptr;          ///< which of the two
  bool by_time_matters_ = false;
  std::vector<double> x_, rates_;           ///< at the time reached
  std::vector<double> jacobian_, by_time_;  ///< df/dx and df/dt there
  std::vector<double> at_, stages_, derivatives_, after_, rates_after_, between_after_;
  double error_ = 0;  ///< of the last step that was tried, beside the tolerance
  // The last step, in which the solution can be read.
  double step_ = 0;  ///< [s]; zero: none since the start
  std::vector<double> before_, between_;
};

}  // namespace oblique::solve
