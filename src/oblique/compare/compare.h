// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

namespace oblique::compare {

/// What to compare: every method with every bandwidth and every gain.
struct CompareOptions {
  std::vector<patch::PatchMethod> methods{patch::PatchMethod::triangles};
  std::vector<double> gains{1e2, 1e3, 1e4, 1e5, 1e6};
  std::vector<double> bandwidths;       ///< [Hz]; none: the `default_bandwidth` of the mechanism alone
  std::vector<std::string> split = {};  ///< of a triad, and
  std::optional<double> slower = {};    ///< the speed of its outer loop, as PatchOptions has them
  int positions = 361;                  ///< rows over one turn, both ends included
  int threads = 1;  ///< runs at a time; but for their wall clocks the result does not depend on it
  /// Called from the calling thread; what it throws ends the runs of all threads.
  std::function<void(double fraction)> progress;
};

/// A signal that left ±1 machine unit.
struct Overload {
  std::string signal;
  solve::Peak peak;
};

/// The row and the point at which a run errs most.
struct WorstPlace {
  std::string point;
  double time = 0;     ///< [s]
  double drive = 0;    ///< value of the first drive there [rad] or [length unit]
  std::string reason;  ///< what is the worst of the turn there as well; empty: nothing that was measured
};

/// Where the largest error of a run comes from. With q_run, q_tight and q_rest where the worst point stands
/// in the run, in a run of a hundredth of its tolerance (a tenth where rounding takes over), and with the
/// cranks stopped there and all loops at rest:
///
///     q_run − q_exact = (q_rest − q_exact) + (q_tight − q_rest) + (q_run − q_tight)
///
/// Each part is taken along the whole error, so that together they are its magnitude; a part against it is
/// negative [length unit].
struct ErrorParts {
  double at_rest = 0;  ///< static: what the finite gain leaves
  double lag = 0;      ///< what the loops are behind for their finite speed
  double solver = 0;   ///< what the tolerance of the run leaves
};

/// One patched diagram held against the exact motion.
struct ComparedRun {
  patch::PatchMethod method = patch::PatchMethod::triangles;
  double gain = 0;
  double bandwidth = 0;  ///< of the amplifiers [Hz]
  double max_error = 0;  ///< largest distance of any moving point from its exact place [length unit]
  double rms_error = 0;  ///< root of the mean square of these distances, all points and rows [length unit]
  WorstPlace worst;
  std::vector<double> error_along;  ///< largest distance in each row [length unit]
  std::optional<ErrorParts> parts;  ///< of max_error; nothing where the loops do not rest, or the run of
                                    ///< tighter tolerance fails
  std::int64_t steps = 0;
  double seconds = 0;  ///< of the run, wall clock
  std::vector<Overload> overloads;
  /// The first drive where its loops first hold another assembly mode than the mechanism's [rad] or [length
  /// unit]: what it errs there is none of its gain.
  std::optional<double> left_branch;
  bool stable = true;       ///< every servo loop would return to rest, at every tenth row
  double slowest_pole = 0;  ///< largest real part of the servo loops' eigenvalues over these rows [1/s]
};

/// What was asked for and could not be had: a method that does not fit the mechanism, or a run that fails.
struct RefusedRun {
  patch::PatchMethod method = patch::PatchMethod::triangles;
  std::optional<double> bandwidth;  ///< [Hz]; nothing: the default
  std::optional<double> gain;       ///< of the run that failed; nothing: the patch was refused
  text::Diagnostic why;
};

/// What the runs of one method and one bandwidth tell together.
struct GainSeries {
  patch::PatchMethod method = patch::PatchMethod::triangles;
  double bandwidth = 0;          ///< [Hz]
  std::size_t first = 0, n = 0;  ///< its runs in Comparison::runs
  /// Largest error with amplifiers of gain 1e12: what tolerance alone leaves [length unit]; nothing where
  /// that run fails, which is none of those that were asked for.
  std::optional<double> floor;
  /// Slope of log error over log gain; none with fewer than two runs above the floor and on the branch.
  std::optional<double> order;
};

/// Whether an error tells of the gain and not of the tolerance: it is at least ten times the floor of its
/// series. The order is fitted to such errors.
bool stands_clear(double error, double floor);

/// Least-squares slope of log error over log gain among the runs of one series that stand clear of its floor
/// and are on the branch; nothing with fewer than two of them.
std::optional<double> fitted_order(std::span<const ComparedRun> runs, double floor);

struct Comparison {
  std::string mechanism;           ///< title
  std::string unit;                ///< of lengths
  double size = 0;                 ///< largest link length [length unit]
  bool closed_form = true;         ///< of all groups' exact motion; false: of some by Newton's method
  bool turning = true;             ///< the first drive turns a link: it is told by its angle
  std::vector<double> drive;       ///< value of the first drive in each row [rad] or [length unit]
  std::vector<ComparedRun> runs;   ///< method by method, bandwidth by bandwidth, in the order of the gains
  std::vector<GainSeries> series;  ///< in the order of the runs
  std::vector<RefusedRun> refused;

  std::span<const ComparedRun> runs_of(const GainSeries& of) const {
    return std::span(runs).subspan(of.first, of.n);
  }
};

/// A signal may pass 1 machine unit by this much before it counts as an overload: cosines that stand at 1
/// overshoot by the tolerance of the run.
inline constexpr double kOverloadMargin = 1e-6;

/// Patches a mechanism with each method, bandwidth and gain, runs the diagrams over one turn, and measures
/// them against the exact motion. What is refused, or fails, leaves the others. Where nothing is left it
/// throws what the first one did: as `patch` or, with the gain in the message, as `run`.
Comparison compare(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                   const CompareOptions& options = {});

}  // namespace oblique::compare
