// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <oblique/compare/yield.h>
#include <oblique/ensemble/engine/ensemble.h>
#include <oblique/ensemble/study/scatter.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/solve/trajectory.h>

namespace oblique::compare {

/// How often, and how, the elements of a diagram are drawn anew.
struct MonteCarloOptions {
  std::vector<diagram::BlockFigure> scatters;
  int runs = 1000;
  std::uint64_t seed = 1;
  std::uint64_t first_run = 0;  ///< number of the first run: with `runs` = 1 it repeats one
  int threads = 1;              ///< at most as many as there are runs; the result does not depend on it
  int positions = 361;  ///< of a mechanism: rows over one turn, both ends included, as those of a comparison
  std::optional<double> good_below;  ///< machines of a smaller error are good [length unit]
  /// With `good_below`: the runs end where the part of good machines is known within ± this, at whole
  /// hundreds of them, and at `runs` in any case.
  std::optional<double> until_within;
  /// Called from the calling thread; what it throws ends the runs of all threads.
  std::function<void(double fraction)> progress;
};

/// A run that gave no error.
struct FailedRun {
  std::uint64_t number = 0;
  std::string message;  ///< the first line of what was thrown
};

/// The largest errors over the turn of many machines that differ in the tolerances of their elements.
struct MonteCarlo {
  std::size_t drawn = 0;  ///< parameters that every run draws
  double tolerance = 0;   ///< relative, of the solver in these runs
  std::vector<std::optional<double>>
      errors;                              ///< of each run from the first on [length unit]; none: it failed
  std::vector<FailedRun> failures;         ///< in the order of their numbers
  ensemble::EnsembleCount count;           ///< by what they were run
  std::optional<Yield> yield;              ///< where it is asked for; a failed machine is not good
  std::optional<std::uint64_t> worst_run;  ///< number of the one with the largest error
  std::vector<double> drive;               ///< value of the first drive in each row [rad] or [length unit]
  /// The largest distance of any moving point in each row, of each of the first kMostAlong runs [length
  /// unit]; no rows: it failed. The draws of runs are independent: the first ones stand for all.
  std::vector<std::vector<double>> along;
  static constexpr std::size_t kMostAlong = 10'000;

  /// The error that this part [%] of the runs does not exceed, failed ones left out: that of a run, by the
  /// nearest rank. Nothing where all failed.
  std::optional<double> percentile(double percent) const;
  /// The same for each row by itself, of the runs in `along`; nothing where all of these failed.
  std::vector<double> percentile_along(double percent) const;
};

/// Runs the diagram of a mechanism (as `patch` gives it) with elements drawn anew for each run, and measures
/// the largest distance of any moving point from its exact place. The solver is a thousand times finer than
/// the narrowest scatter, 1e-6 at the most, and up to a hundred times finer where a run fails; a run that
/// takes a hundred times the steps of the undisturbed one has failed. Throws as `flatten`, `solve_motion`,
/// and as `run` where the undisturbed run fails.
MonteCarlo monte_carlo(const mechanism::Mechanism& whole, const diagram::Diagram& diagram,
                       const diagram::BlockLibrary& library, const MonteCarloOptions& options);

/// The same of any diagram: the largest distance of any output from that of `reference`, a run, in its rows,
/// over the largest value of the output there. `drive` holds the times.
MonteCarlo monte_carlo(const solve::Trajectory& reference, const diagram::Diagram& diagram,
                       const diagram::BlockLibrary& library, const MonteCarloOptions& options);

}  // namespace oblique::compare
