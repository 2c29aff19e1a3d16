// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/bends.h>
#include <oblique/solve/events/combinations.h>
#include <oblique/solve/events/level_rest.h>
#include <oblique/solve/events/side_trials.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/readings/thresholds.h>

namespace oblique::solve {

/// Chooses the positions of switches that lie on their switching event functions: those from which the
/// solution goes to the side that they stand for. Where no combination does, they slide.
///
/// What slides already, independently of them, slides on.
///
/// Where an event function is at rest to first order, what it does a moment later decides; one along which
/// the solution runs by itself, while the other side drives to it, is slid along too, so that rounding makes
/// no events. Not installed.
class Positions {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  Positions(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
            const Thresholds& thresholds, double span);

  /// Places the units, and the switches that follow from them, at (t, x), of which `here` was evaluated;
  /// `preferred` are the positions of the program's switches to be taken where either is possible;
  /// `may_stop` are the units that stay at their level where they do so as long as no comparison holds.
  /// False, with nothing changed, where nothing agrees.
  bool choose(const std::vector<std::uint32_t>& units, const std::vector<double>& preferred,
              const std::vector<std::uint32_t>& may_stop, const network::Evaluation& here, double t,
              std::span<const double> x);

  /// The units that the last `choose` could as well have put on the other side: both sides drive away from
  /// the event function.
  const std::vector<std::uint32_t>& undecided() const { return undecided_; }

  /// Those whose event functions stay at zero where the last `choose` put them.
  const std::vector<std::uint32_t>& resting() const { return resting_; }
  /// Those of them that do so at zero exactly, behind a corner.
  const std::vector<std::uint32_t>& flat() const { return flat_; }
  /// Those of them that either side would lead away.
  const std::vector<std::uint32_t>& stopped() const { return stopped_; }

  /// Of so many `choose` tries all combinations; those at which the equations only bend do not count.
  static constexpr std::size_t kMostUnits = 10;

 private:
  std::vector<std::uint32_t> set_bends_apart(const std::vector<std::uint32_t>& units,
                                             const std::vector<double>& preferred,
                                             const network::Evaluation& here);
  Combination present_sides(const std::vector<std::uint32_t>& units) const;
  std::optional<Combination> standing(Combination preferred, bool keeping) const;
  bool take(Combination sides, const std::vector<double>& preferred, double t, std::span<const double> x);
  void prefer_where_nothing_changes(std::uint32_t unit, const std::vector<double>& preferred, double t,
                                    std::span<const double> x);
  void lower_at_zero(double t, std::span<const double> x);
  void stop(Combination sides, const std::vector<std::uint32_t>& may_stop, double t,
            std::span<const double> x);
  bool slide(Combination present, double t, std::span<const double> x);
  bool try_slide(Combination sliding, Combination sides, double t, std::span<const double> x);
  void let_others_rest(double t, std::span<const double> x);
  bool fits_slide(Combination sliding, Combination sides);

  const network::Program& program_;
  network::Workspace& workspace_;
  SlidingMode& slide_;
  const Thresholds& thresholds_;
  Bends bends_;  ///< apart from the units that are tried
  SideTrials trials_;
  LevelRest level_rest_;
  std::vector<std::uint32_t> undecided_, resting_, flat_, stopped_;
};

}  // namespace oblique::solve
