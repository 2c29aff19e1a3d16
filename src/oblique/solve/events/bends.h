// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/rate_probe.h>
#include <oblique/solve/events/sliding_mode.h>

namespace oblique::solve {

/// Whether the equations only bend with a switch where `here` was evaluated; or with a unit of switches.
bool switch_only_bends(const network::Program& program, const network::Evaluation& here, std::uint32_t s);
bool only_bends(const network::Program& program, const network::Evaluation& here, std::uint32_t unit);

/// Units of switches at which the equations only bend. Wherever these stand, dx/dt at that instant is the
/// same, so that they need no trials: each goes where its event function goes, in the order in which the
/// derivatives of the event functions depend on their positions (lexicographic derivatives: Nesterov 2005).
/// Not installed.
class Bends {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  Bends(const network::Program& program, network::Workspace& workspace, double span);

  void clear();
  /// Adds a unit; `preferred` are the positions of the program's switches to be taken where either is right.
  void add(std::uint32_t unit, const std::vector<double>& preferred);
  bool any() const { return !positions_.empty(); }

  /// The switches, and the positions that they prefer.
  const std::vector<std::pair<std::uint32_t, double>>& positions() const { return positions_; }

  /// Turns them to where their event functions go from (t, x), all others where they are and `here` evaluated
  /// there; then evaluates the event functions anew. One that stays at zero keeps its position, and so does
  /// one whose rate is what rounding makes of something fast. Nothing where a loop has no solution.
  std::optional<network::Evaluation> follow(const network::Evaluation& here, double t,
                                            std::span<const double> x, std::vector<double>& event_functions);
  /// The units that the last `follow` found to stay at zero.
  const std::vector<std::uint32_t>& resting() const { return resting_; }

  /// Lets those rest whose event functions stay at zero along with a slide that has begun; `rates` are those
  /// of its mixture, and `fastest` is the rate of the fastest state. False where one would go to the other
  /// side.
  bool rest_with(SlidingMode& slide, const std::vector<double>& rates, double fastest) const;

 private:
  void keep_where_both_sides_lead_back(double t, std::span<const double> x, const std::vector<bool>& decided);

  const network::Program& program_;
  network::Workspace& workspace_;
  double span_;
  std::vector<std::pair<std::uint32_t, double>> positions_;  ///< see `positions`
  std::vector<bool> is_one_;                                 ///< of each switch: it is one of them
  std::vector<std::uint32_t> resting_;
  std::vector<double> first_rates_;  ///< of their event functions
  std::vector<double> event_functions_, derivatives_, moved_;
  RateProbe probe_;
};

}  // namespace oblique::solve
