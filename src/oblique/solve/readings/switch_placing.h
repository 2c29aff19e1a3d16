// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/readings/thresholds.h>

// Not installed.
namespace oblique::solve {

/// Puts some switches of a program, and the tables that they move along, where its signals ask for them.
class SwitchPlacing {
 public:
  /// The program must outlive this.
  SwitchPlacing(const network::Program& program, std::vector<std::uint32_t> switches);

  /// The switches, and what they and their tables set.
  const std::vector<std::uint32_t>& switches() const { return switches_; }
  const std::vector<std::uint32_t>& discrete_states() const { return discrete_states_; }
  bool has_tables() const { return !tables_.empty(); }

  /// Puts them where the signals at (t, x) ask for them, again and again until all stand so; one whose event
  /// function is within its threshold, of rounding where none are given, stays. False where they lead each
  /// other in a circle, or an algebraic loop has no solution on the way.
  bool place(double t, const double* x, network::Workspace& workspace,
             const Thresholds* thresholds = nullptr);

 private:
  const network::Program& program_;
  std::vector<std::uint32_t> switches_;
  std::vector<std::size_t> tables_;  ///< the events that move them along
  std::vector<std::uint32_t> discrete_states_;
  Thresholds roundings_;
  std::vector<double> event_functions_, signals_;
};

}  // namespace oblique::solve
