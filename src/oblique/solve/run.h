// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/solve/run_records.h>
#include <oblique/solve/run_state.h>
#include <oblique/solve/trajectory.h>
#include <oblique/solve/trust.h>

namespace oblique::network {
class Program;
}

namespace oblique::solve {

/// The absolute tolerance in machine units over the relative one. At 1 the zero crossings of an oscillation
/// would be integrated more coarsely than the rest: a circle of 1000 turns then loses 100 times as much of
/// its amplitude.
inline constexpr double kAbsoluteTolerance = 1e-2;

/// How to run; `RunSettings` of the diagram are the usual source.
struct RunOptions {
  double until = 1;                          ///< [s]
  double tolerance = 1e-8;                   ///< relative, of the results; the solver's own is finer
  std::optional<double> absolute_tolerance;  ///< [machine unit]; else kAbsoluteTolerance of the relative one
  double max_step = std::numeric_limits<double>::infinity();  ///< [s]
  diagram::IntegrationMethod method = diagram::IntegrationMethod::automatic;
  int samples = 1001;  ///< rows, evenly spaced, both ends included
  std::int64_t max_steps = 10'000'000;
  bool settle = true;                 ///< bring servo loops to rest before the clock starts
  std::optional<RunState> from;       ///< goes on from there; `until` is then later than its time
  std::function<bool()> interrupted;  ///< asked all the time: true ends the run at its last whole step
  bool extremes = false;              ///< look for the extremes of the outputs between the rows too
  std::vector<double> extra_times;    ///< [s] ascending, within [0, until]: further rows, kept apart
  std::function<void(double fraction)>
      progress;  ///< called now and then with the part of the run that is done
  std::function<void(double t, std::span<const double> states, std::span<const double> discrete_states)>
      on_sample;                     ///< called at every row of the grid
  std::function<void()> on_restart;  ///< called where the run begins anew, finer: its rows come once more
  bool watch_overloads = false;   ///< look for overloads at every step, at the price of two evaluations each
  bool halt_on_overload = false;  ///< end the run at the first overload; watches too
  /// Parameters ("c.gain") and weights ("c.in[2]") by which the outputs are differentiated along the run.
  std::vector<std::string> sensitivity;
  bool trust = false;  ///< estimate the error of the outputs, at the price of further runs
};

/// The options that a diagram states.
RunOptions options_of(const diagram::RunSettings& settings);

/// The extremes of an output over the run.
struct Extremes {
  Peak maximum{-std::numeric_limits<double>::infinity(), 0};
  Peak minimum{std::numeric_limits<double>::infinity(), 0};
};

/// The columns of a run: `t`, then the outputs of the diagram.
std::vector<text::TableColumn> output_columns(const diagram::FlatDiagram& diagram);
/// The same and, where they are asked for, of each output its derivatives by the parameters:
/// "d(x)/d(c.gain)". Throws ReadError for a parameter that there is not.
std::vector<text::TableColumn> run_columns(const diagram::FlatDiagram& diagram, const RunOptions& options);

/// What came out of a run.
struct Run {
  Trajectory trajectory;            ///< with `run_columns`
  Trajectory extra;                 ///< the same columns at `extra_times`
  std::vector<EventRecord> events;  ///< the first thousand
  long event_count = 0;
  std::vector<double> event_times;  ///< [s] ascending, of the first million
  RunState state;                   ///< at the end: `until`, or earlier where the run was interrupted
  std::vector<Extremes> extremes;   ///< of every output, where asked for
  std::vector<Peak> peaks;          ///< of every signal of the program, in its order; at the rows, or watched
  std::vector<OverloadRecord> overloads;  ///< the first one first, where they were watched
  bool halted = false;                    ///< it ended at the first overload
  std::vector<text::Diagnostic>
      warnings;  ///< what the run may not have seen, or did in another way than asked
  SolverStatistics statistics;
  MethodChoice method;         ///< with which method, and why; nothing for a diagram without states
  std::optional<Trust> trust;  ///< how many digits stand, where asked for
  double seconds = 0;          ///< wall clock of the run itself, compilation and estimates apart
};

/// Runs a compiled diagram from t = 0: brings servo loops to rest, integrates with BDF, Adams or Rodas5P, and
/// samples the solver's own interpolant on an exact grid. A diagram without states is evaluated on that grid.
/// Throws SolveError.
Run run(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options);

/// All of it for a diagram as it was read: flattens, assembles and compiles it, and runs it as its [run]
/// says, or as `options` do. Throws DiagramError, NetworkError and SolveError.
Run run(const diagram::Diagram& diagram, const diagram::BlockLibrary& library);
Run run(const diagram::Diagram& diagram, const diagram::BlockLibrary& library, const RunOptions& options);

}  // namespace oblique::solve
