// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/bends.h>
#include <oblique/solve/events/combinations.h>
#include <oblique/solve/events/rate_probe.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/readings/thresholds.h>

namespace oblique::solve {

/// What follows from every combination of the sides on which units of switches may stand that lie on their
/// event functions: where these event functions go. In a combination the bit of a unit is set where it stands
/// on its upper side. Not installed.
class SideTrials {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  SideTrials(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
             const Thresholds& thresholds, double span);

  /// Tries all combinations of the sides of `units` at (t, x), each with every other switch where it then
  /// goes: `bends` where they follow, what slides as it does, the rest where their event functions ask for
  /// it.
  void run(std::vector<std::uint32_t> units, Bends& bends, double t, std::span<const double> x);

  const std::vector<std::uint32_t>& units() const { return units_; }
  Combination combinations() const { return 1U << units_.size(); }

  /// Places all switches as a combination has them, from where they were before `run`. False where nothing
  /// agrees with it.
  std::optional<network::Evaluation> place(Combination sides, Bends& bends, double t,
                                           std::span<const double> x);
  /// Places them as they were, and the loops.
  void take_back();

  /// Whether the solution goes from every switching surface to the side that its unit stands on. Where the
  /// equations only bend there, both sides are right to the rounding of the event function, unless it is
  /// asked for strictly.
  bool stands(Combination sides, bool strictly) const;
  /// Whether every unit whose event function stays at zero is where it is preferred: nothing asks it to turn
  /// over. Not one that moves others there by what does not hold at zero.
  bool keeps(Combination sides, Combination preferred) const;
  /// Whether the event function of a unit stays at zero.
  bool rests(Combination sides, std::size_t unit) const { return direction(sides, unit) == 0; }
  /// Whether a unit that is at zero exactly, and stays so on either of its sides, moves others by a
  /// comparison that would hold there.
  bool drives_at_zero(Combination sides, std::size_t unit) const;
  /// Whether it is zero exactly and stays so, but moves where another unit stands on its other side.
  bool is_flat(Combination sides, std::size_t unit) const;
  /// Whether both sides of the switching surface of a unit lead away from it: then either is a solution.
  bool is_undecided(Combination sides, std::size_t unit) const;

  /// On which side of zero a unit lies, 1 or −1, where the others have moved its level away; 0 at zero.
  int off_zero(Combination sides, std::size_t unit) const;
  /// Whether a unit is where it switches, whichever of its sides it stands on.
  bool is_at_zero(Combination sides, std::size_t unit) const;

  /// What the comparisons of a unit do where another unit turns over, at a corner of what they compare.
  struct AtCorner {
    bool turns = true;                  ///< some hold on one of its sides and not on the other
    std::vector<std::uint32_t> silent;  ///< the switches that hold on neither: there it is flat, or below
  };
  /// The same as without a corner where the unit does not follow the other alone.
  AtCorner at_corner(Combination sides, std::size_t unit, std::size_t corner) const;

  /// Whether the solution crosses the switching surface of a unit, wherever the others stand: nothing holds
  /// it there.
  bool crosses(std::size_t unit) const;

  /// Whether the equations jump with any of these units.
  bool any_jumps(Combination units) const;
  /// Whether the event functions of these units do not depend on their own positions.
  bool is_independent(Combination units) const;

  /// The largest rate of the event function of a unit in any trial, at least rounding.
  double largest_rate(std::size_t unit) const { return scales_[unit].rate; }
  /// Of all dx/dt in the trials.
  double fastest() const { return fastest_; }
  /// Of values of switches, that of a unit: above zero on its upper side.
  double of_unit(const std::vector<double>& of_switches, std::size_t unit) const;

 private:
  /// What one combination of sides leads to.
  struct Trial {
    std::vector<double> event_functions;  ///< of each unit, as their rates
    std::vector<ProbedRate> rates;
  };

  bool lower_what_came_to_zero(const std::vector<bool>& placed);
  std::optional<Trial> attempt(Combination sides, Bends& bends, double t, std::span<const double> x);
  void find_scales();
  void find_broken();
  double largest_jump(std::size_t unit, std::size_t with) const;
  int direction(Combination sides, std::size_t unit) const;
  bool jumps(std::size_t unit) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  const SlidingMode& slide_;
  const Thresholds& thresholds_;
  double span_;
  std::vector<std::uint32_t> units_;
  std::vector<std::uint64_t> broken_by_;      ///< of each of them, see SlidingMode
  std::vector<double> before_, unknowns_;     ///< discrete states, and unknowns of loops
  std::vector<std::optional<Trial>> trials_;  ///< of each combination; nothing where it has no values
  double fastest_ = 0;
  std::vector<RateScale> scales_;  ///< of each unit, in all trials
  RateProbe probe_;
  std::vector<double> event_functions_, event_functions_before_;
};

}  // namespace oblique::solve
