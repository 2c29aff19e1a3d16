// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/solve/stability/coupled_modes.h>

namespace oblique::solve {

/// States that grew out of what the solver does not tell from an unstable equilibrium.
struct UnseenGrowth {
  double time = 0;                  ///< [s] when it was noticed
  std::vector<std::size_t> states;  ///< those that act on each other there
  double distance = 0;              ///< [machine unit] from the equilibrium: the least that was seen
  /// Where the equilibrium is not zero, so that the relative tolerance hides it: the distance as a part of
  /// the largest of the states; else 0.
  double relative = 0;
};

/// Watches the steps of a solver for growth that it does not see. A solver holds states to their tolerances
/// and no finer: near an unstable equilibrium (x = 0 of x′ = x − x²) an error of that size grows as the
/// solution does, and a long implicit step even takes it back to the equilibrium. So wherever states that act
/// on each other are nearer to an equilibrium than some of their tolerances, and a mode of theirs grows, by
/// more than e² in a row, what they do later is not known to the run's tolerance. An equilibrium that is met
/// exactly is none of these: nothing moves there. Not installed.
class GrowthWatch {
 public:
  /// `span` is the length of the run [s]. All must outlive the watch.
  GrowthWatch(OdeSystem& system, const SolverSettings& settings, double span);

  /// Begins a smooth segment at (t, x).
  void restart(double t, std::span<const double> x);

  /// Looks at the step to (t, x).
  void advance(double t, std::span<const double> x);

  /// The rate of the growth that an implicit step of `step` seconds to (t, x) has passed over [1/s], 0 where
  /// there is none. Where such a step is longer than growth takes it goes along the branch from which the
  /// states would run away, as if it held them.
  double outrun(double t, std::span<const double> x, double step);

  /// Whether a state drives itself away at (t, x) by more than this part of itself within so many seconds.
  bool grows(double t, std::span<const double> x, double within, double part);

  /// Looks at the end of the run at what has not been judged.
  void end();

  /// The first growth of each state that was not seen.
  const std::vector<UnseenGrowth>& found() const { return found_; }

 private:
  double near_distance(std::size_t i, double x) const;  ///< [machine unit]
  bool is_near_zero(std::size_t i, double x) const;
  double own_growth(std::size_t state) const;
  bool is_near_rest(std::span<const double> x);
  double driven_distance(double t, std::span<const double> x, const std::vector<std::size_t>& states,
                         double rate, bool zero);
  bool leaves_at_once(std::span<const double> x, const std::vector<std::size_t>& states, double rate,
                      double distance) const;
  void judge(double t, std::span<const double> x, double step);
  void watch_amplitude(const std::vector<std::size_t>& states, double t, std::span<const double> x);
  void judge(const CoupledModes& group, double t, std::span<const double> x, double step, bool zero,
             std::vector<bool>& unstable);
  bool grows_by_differences(double t, std::span<const double> x, const std::vector<std::size_t>& states,
                            double rate);

  OdeSystem& system_;
  const SolverSettings& settings_;
  double span_;
  int steps_between_;  ///< looks at a Jacobian
  double near_part_;   ///< of a state: nearer to an equilibrium the relative tolerance hides the distance
  /// Of each state, where its absolute tolerance is as large as its relative one [machine unit].
  std::vector<double> switch_over_;
  std::vector<double> before_, change_, jacobian_;
  ModeFinder small_modes_, modes_;  ///< of the states near zero, and of those near any equilibrium
  std::vector<double> growth_;    ///< of each state, in powers of e, while it is near an unstable equilibrium
  std::vector<double> distance_;  ///< the least since then
  std::vector<double> least_;     ///< of each state, while it is near zero: amplitude of those it acts with
  std::vector<std::size_t> acts_with_;  ///< how many these were
  std::vector<bool> near_, near_zero_;
  bool any_near_zero_ = false;
  double fastest_ = 0;  ///< growth of those that were near when it was judged [1/s]
  double time_ = 0, step_ = 0, judged_ = 0;
  int steps_ = 0;                 ///< since it was judged
  long looked_ = 0;               ///< Jacobians
  std::vector<bool> told_;        ///< of each state, whether it is among `found_`
  std::vector<bool> stood_;       ///< of each state: it stood still before the segment, and was known exactly
  std::vector<long> held_since_;  ///< Jacobian at which its growth was last found to be held by other states
  double fastest_held_ = 0;       ///< own growth of a state [1/s] that others have been found to hold
  int held_steps_ = 0;            ///< since that was looked at
  std::vector<UnseenGrowth> found_;
};

}  // namespace oblique::solve
