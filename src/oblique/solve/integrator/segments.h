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
#include <oblique/solve/run.h>

namespace oblique::solve {

/// The smooth segments of a run, and what lies between them: switches that turn over, phases of the timeline,
/// ends of branches of algebraic loops. Whoever makes the steps gives each of them to `finish_step`, and
/// starts anew where that settled something. Not installed.
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
    Sampler& sampler;
    std::optional<OverloadWatch>& overloads;
    std::vector<double>& states;
  };
  /// All of them must outlive this.
  explicit Segments(const Parts& parts) : parts_(parts) {}

  /// Begins the phases that are due at t.
  void follow_phases(double t);
  /// Sets the end of the smooth segment that begins at t; settles what turns over at t itself.
  void begin(double t);
  /// When it ends at the latest, and how long it is [s].
  double end() const { return end_; }
  double length() const { return length_; }

  /// Samples the step from `from` to t, and settles an event that cuts it short (t is then the time of the
  /// event) or ends the segment. `sample_times` are times at which to look at least. True where the solver
  /// must start anew.
  bool finish_step(double from, double& t, std::span<const double> sample_times, const Interpolant& solution);
  /// Settles what there is at t, where a branch ends, the states having gone straight on from `last`.
  void end_branch(double from, const std::vector<double>& last, double& t);
  /// Whether an overload has ended the run.
  bool halted() const { return parts_.overloads && parts_.overloads->halted(); }

 private:
  void settle(double t, bool at_branch_end);
  bool turns_before(double from, double& t, const Interpolant& solution);
  double look_through(double begin, double end, std::span<const double> sample_times,
                      const Interpolant& solution);
  bool turns_without_effect(double at, std::span<const double> sample_times, const Interpolant& solution);

  Parts parts_;
  double end_ = 0, length_ = 0;  ///< [s]
};

}  // namespace oblique::solve
