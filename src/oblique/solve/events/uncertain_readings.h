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
/// taken, or that before it where both come by the time (a delay line that samples at the edge of a pulse),
/// and one that hangs on a switch that slides, and takes both of its values without end. To see it, what the
/// events set is computed once more with what they read as it else could be. Not installed.
class UncertainReadings {
 public:
  /// All must outlive this; `file` names the diagram in messages.
  UncertainReadings(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
                    EventLog& log, const std::string& file);

  /// A new instant, with the discrete states as they are before it.
  void begin_instant(std::span<const double> before) { before_.assign(before.begin(), before.end()); }

  /// Looks at events that come at (t, x), whose actions are to set `values`, one after the other.
  void look(std::span<const std::size_t> events, std::span<const double> values, double t,
            std::span<const double> x);

 private:
  struct Put {
    std::uint32_t discrete_state;
    double value;
  };
  /// Words for what else an event could set.
  struct Doubt {
    std::string by, other, remedy;
  };
  std::vector<Put> as_before(std::span<const std::size_t> events) const;
  std::vector<Put> as_after(std::span<const std::size_t> events, std::span<const double> values,
                            const std::string& block) const;
  std::vector<Put> led_to_by(std::vector<Put> puts, double t, std::span<const double> x);
  /// What the events would set with other discrete states; empty where that has no value.
  std::vector<double> values_with(std::span<const Put> others, std::span<const std::size_t> events, double t,
                                  std::span<const double> x);
  void tell(std::span<const std::size_t> events, std::span<const double> values,
            std::span<const double> others, double t, const Doubt& doubt);

  const network::Program& program_;
  network::Workspace& workspace_;
  const SlidingMode& slide_;
  EventLog& log_;
  const std::string& file_;
  std::vector<double> before_;  ///< the discrete states
  std::vector<bool> told_;      ///< of each event
  std::vector<bool> of_time_;   ///< of each event: it comes at a time of its own
  std::vector<double> signals_;
};

}  // namespace oblique::solve
