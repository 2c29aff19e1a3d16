// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run_records.h>

namespace oblique::solve {

/// Leads a run through the phases of its timeline: sets the modes of operation of all groups.
class PhaseClock {
 public:
  using Position = PhasePosition;
  /// The first phase begins at time t. All arguments must outlive the clock.
  PhaseClock(const network::Program& program, const diagram::FlatTimeline& timeline,
             network::Workspace& workspace, double t);

  /// When the phase ends at the latest [s]; infinite for the last one.
  double end() const;
  /// How long it still lasts from t on at the most [s]: exactly where it begins there, though the time may
  /// not show it.
  double time_left(double t) const;

  /// Whether the phase is over at t, of which `here` was evaluated: its time, or its condition. The last
  /// phase is never over.
  bool is_over(double t, const network::Evaluation& here) const;

  /// Begins the next phase at t.
  void advance(double t);

  const Position& position() const { return position_; }
  /// Goes on from a position of an earlier run.
  void restore(const Position& position);

 private:
  bool is_last() const;
  void set_modes();

  const network::Program& program_;
  const diagram::FlatTimeline& timeline_;
  network::Workspace& workspace_;
  Position position_;
};

}  // namespace oblique::solve
