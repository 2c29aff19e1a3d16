// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/integrator/phase_clock.h>
#include <oblique/solve/run_state.h>

namespace oblique::solve {

/// The parts of a run that make its state. Not installed.
struct RunParts {
  const network::Program& program;
  std::vector<double>& states;
  network::Workspace& workspace;
  Switching& switching;
  PhaseClock& clock;
};

/// A RunState without names, which is quick to take at every step.
class RunSnapshot {
 public:
  RunSnapshot() = default;
  /// The state in which the parts are at time t.
  RunSnapshot(double t, const RunParts& parts);
  explicit RunSnapshot(const RunState& state);

  double time() const { return time_; }
  /// Brings the parts back to this state; what slides is to be resumed.
  void restore(const RunParts& parts) const;
  /// Brings only the states and the unknowns of loops back.
  void restore_values(const RunParts& parts) const;
  RunState named(const network::Program& program) const;

 private:
  double time_ = 0;
  std::vector<double> states_, discrete_states_, unknowns_;
  std::vector<bool> conditions_, sliding_;
  PhaseClock::Position position_;
};

}  // namespace oblique::solve
