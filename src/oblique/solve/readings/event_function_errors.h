// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/readings/error_damping.h>

namespace oblique::solve {

/// How far the event functions of switches are off zero by the errors that the solver leaves to the states.
/// Not installed.
class EventFunctionErrors {
 public:
  /// `tolerance` is the relative one of the states, `absolute_tolerance` that of those without one of their
  /// own. `program` must outlive this.
  EventFunctionErrors(const network::Program& program, double tolerance, double absolute_tolerance);

  /// The size [machine unit] down to which each state is known relatively; 0: as its absolute tolerance says.
  void know_states(std::span<const double> reach) { reach_.assign(reach.begin(), reach.end()); }

  /// The most for some combinations of the signs of the errors; `here` is what was evaluated at `states`.
  /// With `damping`, what that leaves of them where it is much less.
  void weigh(const network::Evaluation& here, std::span<const double> states, ErrorDamping* damping);

  /// Where they were weighed last.
  double operator[](std::size_t s) const { return errors_[s]; }
  /// The same without damping, as they soon are on another branch.
  double undamped(std::size_t s) const { return undamped_[s]; }

  /// The states that are hardly known and move the event function of a switch, itself or by the states that
  /// they drive; the others as for `weigh`.
  std::vector<std::size_t> states_behind(std::uint32_t s, const network::Evaluation& here,
                                         std::span<const double> states) const;

 private:
  double error_of_state(std::size_t i) const;
  double change(double rate, double still) const;

  const network::Program& program_;
  double tolerance_, absolute_tolerance_;
  std::vector<double> reach_;  ///< see `know_states`
  std::vector<double> errors_, undamped_;
};

}  // namespace oblique::solve
