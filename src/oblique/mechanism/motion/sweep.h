// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/mechanism/motion/scan.h>

namespace oblique::mechanism {

/// A stretch of a turn in which something stays within 1 % of its stroke: a band of 1/100 of the way between
/// its extremes, wherever that lies. Only stretches of at least 1/8 of the turn's time count: a harmonic
/// motion stays 1/16 of its turn within 1 % of either end, and that is no dwell. Its length is known to half
/// a degree of the fastest drive; where a band a little aside gives a stretch as long, it may lie there.
struct Dwell {
  double begin = 0, end = 0;              ///< [s]; the end may lie in the next turn
  double begin_drive = 0, end_drive = 0;  ///< the first drive at the ends [rad] or [length unit]
};

/// How a link or a prismatic joint moves over a motion range: values are angles [rad] or positions [length
/// unit].
struct Sweep {
  enum class Kind {
    turns,                 ///< a link that gains whole turns and never turns back
    turns_with_reversals,  ///< a link that gains whole turns, and turns back on the way
    oscillates,            ///< between two ends
    monotone,              ///< from one end of the motion range to the other without turning back
    stationary,            ///< it keeps its direction or its place
  };
  Kind kind = Kind::oscillates;
  bool is_slide = false;
  std::size_t index = 0;  ///< in Mechanism::bodies or Mechanism::slides
  Reading least, greatest;
  double gain = 0;  ///< last − first value
  std::size_t reversals = 0;
  double rising = 0, falling = 0;  ///< how long its value rises and falls [s]
  /// Of a closed motion range with two reversals: the time of the slower stroke over that of the faster one,
  /// ≥ 1.
  std::optional<double> time_ratio = {};
  std::vector<Dwell> dwells = {};

  double stroke() const { return greatest.value - least.value; }
};

/// What a link or a prismatic joint is as a signal.
Signal body_signal(std::size_t body);
Signal slide_signal(const Mechanism& mechanism, std::size_t slide);

/// A swing from its scan.
Sweep sweep_of(const RangeWalk& walk, const SignalScan& scan, bool is_slide, std::size_t index);

/// The dwells of something with one or two coordinates, given at u = k/samples; `stroke` is the way between
/// the extremes of the coordinate that goes farthest, and a dwell stays within 1 % of it in each. None in a
/// motion range that is no turn, or does not close.
std::vector<Dwell> find_dwells(const RangeWalk& walk,
                               const std::vector<const std::vector<double>*>& coordinates, double stroke);

}  // namespace oblique::mechanism
