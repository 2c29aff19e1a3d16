// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/integrator/overload.h>
#include <oblique/solve/integrator/phase_clock.h>
#include <oblique/solve/integrator/sampler.h>
#include <oblique/solve/integrator/source_watch.h>
#include <oblique/solve/run.h>

namespace oblique::solve {

/// The smooth segments of a run, and what lies between them: switches that turn over, phases of the timeline,
/// ends of branches of algebraic loops. Whoever makes the steps gives each of them to `take_step`, looks at
/// it piece by piece, and starts anew where the end of a piece has settled something. Between `look_ahead`
/// and `pass` the solution of the piece can be read up to its end. A clock whose edge has acted on nothing
/// that is integrated (it counts, samples, paces a recording) ends no further segment: its edges are then
/// looked for within the steps, and it does so again from the first one on that acts. Not installed.
class Segments {
 public:
  /// What a run is made of; `overloads` only where they are watched.
  struct Parts {
    const network::Program& program;
    const diagram::FlatDiagram& diagram;
    const RunOptions& options;
    network::Workspace& workspace;
    Switching& switching;
    PhaseClock& clock;
    BranchWatch& branches;
    SourceWatch& sources;
    Sampler& sampler;
    std::optional<OverloadWatch>& overloads;
    std::vector<double>& states;
  };
  /// All of them must outlive this.
  explicit Segments(const Parts& parts);

  /// Begins the phases that are due at t.
  void follow_phases(double t);
  /// Sets the end of the smooth segment that begins at t; settles what turns over at t itself.
  void begin(double t);
  /// When it ends at the latest, and how long it is [s].
  double end() const { return end_; }
  double length() const { return length_; }

  /// Takes a step from `from` to t. `sample_times` are times at which to look at least; they and `solution`
  /// must last until the last piece of the step is passed.
  void take_step(double from, double t, std::span<const double> sample_times, const Interpolant& solution);
  /// Finds the next piece of the step, up to where a switch turns over or the step ends, and samples it; when
  /// it ends [s].
  double look_ahead();
  /// Where a step is when a piece of it has been passed.
  enum class Passed {
    piece,    ///< there is another
    step,     ///< at its end, and the next may follow
    segment,  ///< something was settled, or the segment ends: the solver must start anew
  };
  /// Settles what ends the piece; t is then when that was [s].
  Passed pass(double& t);
  /// Settles what there is at t, where a branch ends, the states having gone straight on from `last`.
  void end_branch(double from, const std::vector<double>& last, double& t);
  /// Whether an overload has ended the run.
  bool halted() const { return parts_.overloads && parts_.overloads->halted(); }

 private:
  void settle(double t, bool at_branch_end);
  void settle_turn(double t);
  void pass_end(double& t, std::optional<double> branch_end, bool settled);
  bool turns_before(double from, double& t, const Interpolant& solution);
  double look_through(double begin, double end, std::span<const double> sample_times,
                      const Interpolant& solution);
  bool turns_without_effect(double at, std::span<const double> sample_times, const Interpolant& solution);
  std::optional<double> search(const std::vector<double>& times);
  void find_branch_end();
  std::optional<double> find_event();
  bool stands(double t);
  bool follows_sensitivities() const { return !parts_.options.sensitivity.empty(); }
  std::vector<double> rates_behind(double t);

  /// The step that was taken, from the beginning of its next piece, and what ends that.
  struct Step {
    double begin = 0, end = 0;  ///< [s]
    std::vector<double> times;  ///< at which to look at least
    const Interpolant* solution = nullptr;
    std::optional<double> branch_end, event;  ///< [s]
    double reached = 0;                       ///< [s] by the samples
    int edges_at_begin = 0;                   ///< of clocks, one after the other
    std::span<const double> times_left() const;
  };

  Parts parts_;
  bool memories_act_;
  double end_ = 0, length_ = 0;  ///< [s]
  Step step_;
};

}  // namespace oblique::solve
