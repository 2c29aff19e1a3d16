// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/rate_probe.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/readings/thresholds.h>

namespace oblique::solve {

/// What lies at its level, where no comparison holds: neither of what is compared nor of its negative. Not
/// installed.
class LevelRest {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  LevelRest(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
            const Thresholds& thresholds, double span);

  /// Whether the equations jump by comparisons of a unit and by comparisons of its negative: its two sides
  /// are then not all that it can be, for at zero none of them holds.
  bool is_third_position(std::uint32_t unit) const;

  /// Whether a rate takes the event function of a switch out of its rounding nowhere in the run.
  bool stands_still(std::uint32_t s, double rate) const;

  /// Puts the switches of a unit at (t, x) where none of their comparisons holds, those of the units `beside`
  /// it and what slides where they are, and all others where they then go. True where its event function is
  /// as before and stays so, now and a moment later, and the units beside it go to their sides, beside a
  /// state as fast as `fastest`; else nothing is changed.
  bool take(std::uint32_t unit, const std::vector<std::uint32_t>& beside, double fastest, double t,
            std::span<const double> x);

 private:
  bool stays(std::uint32_t unit, const std::vector<std::uint32_t>& beside, double event_function,
             double fastest, double t, std::span<const double> x);

  const network::Program& program_;
  network::Workspace& workspace_;
  const SlidingMode& slide_;
  const Thresholds& thresholds_;
  double span_;
  RateProbe probe_;
  std::vector<bool> placed_;
  std::vector<double> event_functions_;
};

}  // namespace oblique::solve
