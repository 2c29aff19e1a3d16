// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/ensemble/lanes/lane_program.h>

// Not installed.
namespace oblique::ensemble {

/// Sees in the rows of machines what a run by CVODES warns of, or fails for: signals that are no number, that
/// leave the machine by far, that grow without end (solve::RunawayWatch).
class SignalWatch {
 public:
  /// `program` must outlive this.
  SignalWatch(const LaneProgram& program, std::size_t width);

  void begin();
  /// Takes a row of all lanes: slots of the outputs, at this part of the run.
  void look_at(double part, const LaneArray& slots);
  /// What there was in a lane; empty: nothing.
  std::string finding(std::size_t lane) const;

 private:
  const LaneProgram& program_;
  std::size_t width_, n_;
  LaneArray largest_;  ///< of each signal in each eighth of the run
  LaneArray doubt_;    ///< no number where a signal was none
};

}  // namespace oblique::ensemble
