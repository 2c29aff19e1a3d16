// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/mechanism/mechanism.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

namespace oblique {

/// What to compare.
struct CompareOptions {
  PatchMethod method = PatchMethod::triangles;
  std::vector<double> gains{1e2, 1e3, 1e4, 1e5, 1e6};
  int positions = 361;  ///< rows over one turn, both ends included
  std::function<void(double fraction)> progress;
};

/// A signal that left ±1 machine unit.
struct Overload {
  std::string signal;
  Peak peak;
};

/// One patched diagram held against the exact motion.
struct GainRun {
  double gain = 0;
  double max_error = 0;  ///< largest distance of any moving point from its exact place [length unit]
  double rms_error = 0;  ///< root of the mean square of these distances, all points and rows [length unit]
  std::string worst_point;
  double worst_time = 0;  ///< [s]
  long steps = 0;
  double seconds = 0;  ///< of the run, wall clock
  std::vector<Overload> overloads;
  bool stable = true;       ///< every servo loop would return to rest, at every tenth row
  double slowest_pole = 0;  ///< largest real part of the servo loops' eigenvalues over these rows [1/s]
};

struct Comparison {
  std::string mechanism;  ///< title
  PatchMethod method = PatchMethod::triangles;
  std::string unit;      ///< of lengths
  double size = 0;       ///< largest link length [length unit]
  double bandwidth = 0;  ///< of the amplifiers [Hz]
  double floor =
      0;  ///< largest error with amplifiers of gain 1e12: what tolerance alone leaves [length unit]
  std::vector<GainRun> runs;
  std::optional<double>
      order;  ///< slope of log error over log gain; none with fewer than two runs above the floor
};

/// A signal may pass 1 machine unit by this much before it counts as an overload: cosines that stand at 1
/// overshoot by the tolerance of the run.
inline constexpr double kOverloadMargin = 1e-6;

/// Patches a mechanism with each gain, runs the diagrams over one turn, and measures them against the exact
/// motion. The order is fitted where the error is at least ten times the floor. Throws as `patch`
/// and, with the gain in the message, as `run`.
Comparison compare(const Mechanism& mechanism, const BlockLibrary& library,
                   const CompareOptions& options = {});

}  // namespace oblique
