// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <oblique/mechanism/motion/motion_range.h>

namespace oblique::mechanism {

/// A quantity and its rate by time.
struct SignalValue {
  double value = 0;
  double rate = 0;
};

/// Something that is followed over a motion range.
struct Signal {
  std::function<SignalValue(const RangeWalk&)> at;
  double scale = 1;      ///< differences far below this are rounding
  bool has_rate = true;  ///< otherwise extremes are found from values alone
};

/// A place of a motion range and a value there.
struct Reading {
  double value = 0;
  double place = 0;  ///< u
  double time = 0;   ///< [s]
  double drive = 0;  ///< value of the first drive [rad] or [length unit]
};

/// A place where the rate of a signal changes its sign.
struct TurningPoint : Reading {
  bool is_greatest = false;  ///< of its neighbourhood; otherwise least
};

struct SignalScan {
  std::vector<double> values;       ///< at u = k/samples
  std::vector<TurningPoint> turns;  ///< in order; of a closed motion range one at its beginning is at its end
  Reading first, last;              ///< at the ends of the motion range
  Reading least, greatest;          ///< ends included
};

/// Follows signals over a whole motion range. Where a rate changes its sign between two samples its zero is
/// found to the last bits of u; of signals without a rate only the least and the greatest value are refined,
/// to about 1e-8 of u.
std::vector<SignalScan> scan(RangeWalk& walk, const std::vector<Signal>& signals);

/// A reading of a value where the walk stands.
Reading read(const RangeWalk& walk, double value);

}  // namespace oblique::mechanism
