// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/interruption.h>
#include <oblique/solve/readings/damped_solution.h>
#include <oblique/solve/readings/error_damping.h>
#include <oblique/solve/readings/event_function_errors.h>
#include <oblique/solve/readings/thresholds.h>

namespace oblique::solve {

/// Of each switch the position that it takes when everything is settled next; nothing: as its event function
/// is.
using Announced = std::vector<std::optional<double>>;

/// Where the announced ones of a unit of switches put one of them; nothing where none is.
std::optional<double> announced_position(const network::SwitchStructure& structure,
                                         const Announced& announced, std::size_t s);

/// The event functions of all switches at one instant, and how well they are known there. Not installed.
class EventFunctions {
 public:
  /// The tolerances are those of EventFunctionErrors. All but these must outlive this.
  EventFunctions(const network::Program& program, network::Workspace& workspace, double tolerance,
                 double absolute_tolerance, const std::string& file);

  /// Evaluates all at (t, x). Throws SolveError where an algebraic loop has no solution; but it may have one
  /// only where the switches that are due, announced or not, have turned over.
  void evaluate(double t, std::span<const double> x, const Announced& announced);
  /// `evaluate` then throws Interrupted.
  void end_when(const Interruption& interruption) { interruption_ = interruption; }
  void know_states(std::span<const double> reach) { errors_.know_states(reach); }
  /// See ErrorDamping; `sliding` are the units that slide along the steps.
  void take_steps(double length, const std::vector<std::uint32_t>& sliding);
  /// Whether any step was taken since the states jumped.
  bool any_step() const { return damping_.any(); }
  /// The solution within a step, at whose end all was evaluated: with its errors damped where some event
  /// function is so near to zero there that only its damped error tells its side.
  const Interpolant& within_step(const Interpolant& solution);

  // As `evaluate` has found them, whatever has been evaluated since:
  std::size_t size() const { return values_.size(); }
  double operator[](std::size_t s) const { return values_[s]; }
  std::span<const double> values() const { return values_; }
  bool is_off_zero(std::size_t s) const { return std::abs(values_[s]) > thresholds_[s]; }
  /// How far an event function lies on the side on which its switch does not stand.
  double against(std::size_t s) const;
  /// d(event function)/dt of a switch whose event function depends on time alone, linearly; nothing for
  /// another.
  std::optional<double> known_rate(std::size_t s) const { return known_rates_[s]; }
  bool is_known(std::size_t s) const { return program_.switches()[s].rate.has_value(); }

  /// What else `evaluate` has found, as long as nothing has been evaluated since and no switch turned over.
  const network::Evaluation& here() const { return here_.value(); }
  /// The errors there, weighed when they are first asked for: from `here`, so before a switch turns over.
  const EventFunctionErrors& weigh_errors();
  /// Those that were weighed last, here or where a switch turned over before.
  const EventFunctionErrors& last_errors() const { return errors_; }
  std::vector<std::size_t> states_behind(std::uint32_t s) const {
    return errors_.states_behind(s, here(), states_);
  }

  /// What a unit of switches lies off its level, as its time was found, counts as nothing until it has left
  /// that behind.
  void keep_at_level(std::uint32_t unit);

  /// States have jumped since these were the values: the errors of before are nothing to what lies elsewhere
  /// now. (What a jump has left alone has turned over, or not, as before.)
  void take_slack_since(std::span<const double> before);

  const Thresholds& thresholds() const { return thresholds_; }
  Thresholds& thresholds() { return thresholds_; }

 private:
  bool is_any_due(const Announced& announced) const;
  bool is_any_fine();
  void leave_what_slides();

  const network::Program& program_;
  network::Workspace& workspace_;
  const std::string& file_;
  Interruption interruption_;
  Thresholds thresholds_;
  EventFunctionErrors errors_;
  ErrorDamping damping_;
  DampedSolution damped_;
  std::optional<network::Evaluation> here_;
  std::vector<double> values_, states_;
  double time_ = 0;
  std::vector<std::optional<double>> known_rates_;
  std::vector<std::uint32_t> sliding_;  ///< units, whose states the damping leaves
  bool leaves_ = true;                  ///< whether that has been told to it
  bool weighed_ = false;                ///< whether the errors are those of `states_`
};

}  // namespace oblique::solve
