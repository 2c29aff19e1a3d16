// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/events/resting_comparisons.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/events/switch_settling.h>
#include <oblique/solve/readings/event_functions.h>

namespace oblique::solve {

/// Event functions that are let lie on the side on which their switches do not stand: for a moment, or
/// within their errors, by which a switch turns over late or never. Not installed.
class WrongSides {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  WrongSides(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
             const SwitchSettling& settling, EventFunctions& event_functions, EventLog& log, double span);

  /// Where an event function, evaluated after all was settled, still lies there, it goes back at once: that
  /// is no event of its own.
  void allow();
  /// Of the event functions, evaluated last, that lie there because their slack lets them: takes what is more
  /// than their errors there. Whether any lies there by more than that.
  bool limit_slack();
  /// Another step has been taken, by a method that damps what is fast, or one by which only the look at what
  /// is near to zero does (DampedSolution).
  void take_step(bool damps) {
    steps_damp_ = damps;
    std::fill(cuts_.begin(), cuts_.end(), 0);
  }
  /// Tells of those, evaluated at (t, x), that have lain there for long, where the other position would make
  /// something else; those apart that rest at their levels.
  void tell(const RestingComparisons& resting, double t, std::span<const double> x);

 private:
  const network::Program& program_;
  network::Workspace& workspace_;
  const SlidingMode& slide_;
  const SwitchSettling& settling_;
  EventFunctions& event_functions_;
  EventLog& log_;
  double span_;
  std::vector<bool> told_;                            ///< of each unit
  std::vector<std::optional<double>> clearly_since_;  ///< when each was first surely there [s]
  std::vector<int> cuts_;                             ///< of the slack of each switch, in this step
  bool steps_damp_ = false;
};

}  // namespace oblique::solve
