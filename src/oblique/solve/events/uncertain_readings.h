// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/events/sliding_mode.h>

namespace oblique::solve {

/// Tells of events that set something by a signal whose value at that instant is a matter of order: one that
/// jumps at the same instant (a store that closes as a step comes), of which the value after the jump is
/// taken, and one that hangs on a switch that slides, and takes both of its values without end. To see it,
/// what the events set is computed once more with those switches in their other positions. Not installed.
class UncertainReadings {
 public:
  /// All must outlive this; `file` names the diagram in messages.
  UncertainReadings(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
                    EventLog& log, const std::string& file);

  /// A new instant: no switch has turned over at it yet.
  void begin_instant() { turned_.clear(); }
  /// Which switches have turned over at this instant before any event has come: those of another position
  /// than in `before`, the discrete states just before it.
  void note_turns(std::span<const double> before);

  /// Looks at events that come at (t, x), whose actions are to set `values`, one after the other.
  void look(std::span<const std::size_t> events, std::span<const double> values, double t,
            std::span<const double> x);

 private:
  struct Turned {
    std::uint32_t switch_index;
    double before;
  };
  /// What the events would set with other positions of switches; empty where that has no value.
  std::vector<double> values_with(std::span<const Turned> positions, std::span<const std::size_t> events,
                                  double t, std::span<const double> x);
  bool sets_off(std::uint32_t s, std::size_t event) const;
  void tell(std::span<const std::size_t> events, std::span<const double> values,
            std::span<const double> others, double t, const std::string& sliding);

  const network::Program& program_;
  network::Workspace& workspace_;
  const SlidingMode& slide_;
  EventLog& log_;
  const std::string& file_;
  std::vector<Turned> turned_;
  std::vector<bool> told_;  ///< of each event
  std::vector<double> signals_;
};

}  // namespace oblique::solve
