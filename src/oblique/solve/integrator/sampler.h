// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/integrator/runaway.h>
#include <oblique/solve/run.h>

namespace oblique::solve {

/// Collects what a run gives as the solver passes it: rows at the sample times, and extremes between them.
/// Not installed.
class Sampler {
 public:
  /// All must outlive the sampler.
  Sampler(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options,
          network::Workspace& workspace, Switching& switching);

  /// Adds every row from the last one up to `t`.
  void advance(double t, const Interpolant& solution);

  /// Looks for the extremes of the outputs in a segment without events.
  void watch(double from, double to, const Interpolant& solution);

  /// The states where a signal was no finite number; none where there was no such signal.
  std::span<const double> states_without_value() const {
    return found_no_value_ ? std::span(states_) : std::span<const double>();
  }

  /// What the rows alone warn of.
  std::vector<text::Diagnostic> warnings() const { return runaway_.warnings(diagram_.file); }

  /// Fills the columns of a row behind those of the outputs; set where there are some.
  std::function<void(double t, std::span<const double> states, std::span<double> columns)> further_columns;

  Run result;

 private:
  double sample_time(int k) const;
  void evaluate(double last, double time, const Interpolant& solution);
  double watch_part(double last, double from, double to, const Interpolant& solution);
  void keep_extremes(double time);

  const network::Program& program_;
  const diagram::FlatDiagram& diagram_;
  const RunOptions& options_;
  network::Workspace& workspace_;
  Switching& switching_;
  RunawayWatch runaway_;
  std::vector<double> states_, signals_, row_;
  std::vector<double> begin_, middle_;  ///< rows of `watch`
  bool found_no_value_ = false;
  int next_sample_ = 0;
  std::size_t next_extra_ = 0;
};

}  // namespace oblique::solve
