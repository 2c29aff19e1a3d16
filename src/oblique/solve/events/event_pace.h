// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace oblique::solve {

/// How quickly an event comes again: ever faster is Zeno behaviour.
///
/// Events that come sooner and sooner, often enough in a row, show Zeno behaviour where the times left to
/// them, at the larger of the last two ratios, are together a vanishing part of the run, and the ratio is not
/// on its way to 1: events that crowd together and thin out again (two balls between a heavy one and a wall).
/// That is seen over intervals that become shorter by a factor: 1 less the ratio is then not much smaller
/// than it was.
struct EventPace {
  double last = 0;                 ///< when it came last [s]
  std::optional<double> interval;  ///< since it came before [s]; nothing where it came at once
  double ratio = 1;                ///< of the interval to the one before
  int shorter = 0;                 ///< how often in a row the interval has become shorter
  /// How often it has come within 1e-6 of the run, but in no such row, since it has not within 1e-5.
  int tiny = 0;
  /// An interval of the row [s]; 1 less the ratio of it to the one before, and whether that is still so.
  std::optional<double> longer;
  double approach = 0;
  bool steady = false;
  /// By when it was to come infinitely often when it last had long come ever faster [s]; nothing once it
  /// has come later.
  std::optional<double> due;

  /// The event comes at t in a run as long as `span` that ends at `end` [s]. Its interval [s] where
  /// it comes infinitely often before that end, and by when [s]; this one is then not counted.
  struct Zeno {
    double interval, at;
  };
  std::optional<Zeno> come(double t, double span, double end);
};

}  // namespace oblique::solve
