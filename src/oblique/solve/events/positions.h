// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/sliding_mode.h>

namespace oblique::solve {

/// Chooses the positions of switches that lie on their surfaces: those from which the solution goes to the
/// side that they stand for. Where no combination does, they slide.
///
/// Where a surface is at rest to first order, what it does a moment later decides; one along which the
/// solution runs by itself, while the other side drives to it, is slid along too, so that rounding makes no
/// events.
class Positions {
 public:
  /// All must outlive this; `thresholds` is of every switch how far from zero its surface counts as zero.
  Positions(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
            const std::vector<double>& thresholds, double span);

  /// Places the units, and the switches that follow from them, at (t, x); `preferred` is of each of them
  /// whether the upper side is taken where both are possible. False, with nothing changed, where nothing
  /// agrees.
  bool choose(const std::vector<std::uint32_t>& units, const std::vector<bool>& preferred, double t,
              std::span<const double> x);

  /// The units that the last `choose` could as well have put on the other side: both sides drive away from
  /// the surface.
  const std::vector<std::uint32_t>& undecided() const { return undecided_; }

  /// Those whose surfaces stay at zero where the last `choose` put them.
  const std::vector<std::uint32_t>& resting() const { return resting_; }

  /// Tries all combinations of `restless` and of the switches that share their algebraic loops, the nearest
  /// to the present one first. False where none agrees with itself.
  bool choose_any(std::vector<std::uint32_t> restless, double t, std::span<const double> x);

  /// Of so many `choose` tries all combinations; those at which the equations only bend do not count.
  static constexpr std::size_t kMostUnits = 10;

 private:
  /// What one combination of sides leads to.
  struct Trial {
    bool valid = false;
    std::vector<double> surfaces, rates, later;  ///< of each unit; `later` is the rate a moment on
  };

  Trial attempt(std::uint32_t bits, double t, std::span<const double> x);
  bool place(std::uint32_t bits, double t, std::span<const double> x);
  int direction(std::uint32_t bits, std::size_t unit) const;
  bool keeps(std::uint32_t bits, std::uint32_t preferred) const;
  void note_choice(std::uint32_t bits);
  bool stands(std::uint32_t bits, bool strictly) const;
  bool jumps(std::size_t unit) const;
  bool any_of_them_jumps(std::uint32_t units) const;
  bool only_bends(std::uint32_t unit) const;
  void set_apart(const std::vector<std::uint32_t>& units, const std::vector<bool>& preferred);
  bool follow_bends(double t, std::span<const double> x);
  void keep_where_both_sides_lead_back(double t, std::span<const double> x, const std::vector<bool>& decided);
  bool let_bends_rest();
  bool settle_others(const std::vector<bool>& placed, double t, std::span<const double> x);
  bool try_slide(std::uint32_t sliding, std::uint32_t bits, double t, std::span<const double> x);
  bool is_independent(std::uint32_t sliding) const;
  bool leaves_rounding(double rate) const;
  bool agrees(double t, std::span<const double> x);
  double of_unit(const std::vector<double>& of_switches, std::size_t unit) const;
  std::vector<std::uint32_t> nearest_first(std::uint32_t to) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  SlidingMode& slide_;
  const std::vector<double>& thresholds_;
  double span_;

  std::vector<std::uint32_t> units_, undecided_, resting_;
  std::vector<std::uint64_t> broken_by_;  ///< of each of `units_`, see SlidingMode
  /// Apart from `units_`: those at which the equations only bend.
  std::vector<std::uint32_t> bends_, resting_bends_;
  std::vector<std::pair<std::uint32_t, double>> bent_;  ///< their switches, and the positions they prefer
  std::vector<bool> bends_at_;                          ///< of each switch: it is one of them
  std::vector<double> first_rates_;                     ///< of their surfaces
  std::vector<double> before_;                          ///< memories
  std::vector<Trial> trials_;
  double fastest_ = 0;  ///< largest of all dx/dt in the trials
  std::vector<double> surfaces_, rates_, slopes_, moved_;
};

}  // namespace oblique::solve
