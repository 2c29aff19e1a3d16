// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/compare/compare.h>
#include <oblique/diagram/block_library.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>
#include <oblique/solve/stability/linearisation.h>

// What comparisons share; not installed.
namespace oblique::compare {

/// A run that takes so many times the steps of the undisturbed one, or of that on ideal elements, has failed.
inline constexpr std::int64_t kStepsOfAFailure = 100;

/// A mechanism's diagram with all that running it takes. The library must outlive it.
struct PatchedMechanism {
  PatchedMechanism(diagram::Diagram patched, const diagram::BlockLibrary& library);

  diagram::Diagram diagram;
  diagram::FlatDiagram flat;
  network::Program program;
};

/// The diagram of a mechanism under the mechanism's own file name: the diagram has none.
diagram::Diagram patch_named(const mechanism::Mechanism& mechanism, const patch::PatchOptions& options);

/// A run with the states at its rows.
struct RecordedRun {
  solve::Run run;
  std::vector<solve::Instant> instants;
};

/// Runs as the diagram asks, but with another relative tolerance; with the outputs at further `moments` [s],
/// ascending, as long as these go, and within `max_steps` of the solver. What is thrown begins with "with
/// `what`: ".
RecordedRun run_recorded(const PatchedMechanism& patched, const std::string& what, double tolerance,
                         const std::function<void(double)>& progress = {},
                         const std::vector<double>& moments = {}, std::optional<std::int64_t> max_steps = {});

/// The signals that left ±1 machine unit by more than the margin.
std::vector<Overload> overloads_of(const network::Program& program, const solve::Run& run,
                                   double margin = kOverloadMargin);

/// The largest real part of the servo loops' eigenvalues at every tenth of the instants [1/s]; NaN where one
/// of them has none.
double slowest_pole_of(const network::Program& program, const std::vector<solve::Instant>& instants);

/// The outputs that are the coordinates of a moving point.
struct PointOutputs {
  std::size_t point = 0;  ///< index in Mechanism::points
  std::size_t x = 0, y = 0;
};
std::vector<PointOutputs> point_outputs(const mechanism::Mechanism& mechanism,
                                        const diagram::FlatDiagram& flat);

/// How far the moving points of a run are from their exact places.
struct Distances {
  double largest = 0;  ///< [length unit]
  double rms = 0;      ///< root of the mean square, all points and rows [length unit]
  PointOutputs worst;  ///< the point of the largest
  std::size_t row = 0;
  std::vector<double> along;  ///< the largest of each row [length unit]
};
Distances distances(const mechanism::Mechanism& mechanism, const diagram::FlatDiagram& flat,
                    const solve::Trajectory& analog, const mechanism::Motion& exact);
/// The same of the rows of a run with so many columns, of the points of `point_outputs`.
Distances distances(const std::vector<PointOutputs>& points, std::span<const double> rows,
                    std::size_t columns, const mechanism::Motion& exact);

/// Where a point stands at an instant [length unit]; nothing where a loop has no solution.
std::optional<Eigen::Vector2d> place_in(const PatchedMechanism& patched, const PointOutputs& point,
                                        const solve::Instant& instant);

/// Where a point stands in a row of a run [length unit].
Eigen::Vector2d place_of(const PointOutputs& point, const solve::Trajectory& analog, std::size_t row);

/// The largest magnitude of a column.
double largest_of(const solve::Trajectory& run, std::size_t column);

/// How far the outputs of a run are from those of another run of as many rows, each over the largest value
/// that it has there; one that is 0 throughout is left out. `worst.point` is the output.
Distances relative_distances(std::span<const double> rows, const solve::Trajectory& reference);

}  // namespace oblique::compare
