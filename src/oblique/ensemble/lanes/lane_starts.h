// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/ensemble/lanes/lane_kernels.h>
#include <oblique/ensemble/lanes/lane_program.h>
#include <oblique/ensemble/lanes/lane_settling.h>

// Not installed.
namespace oblique::ensemble {

/// Puts what a machine has drawn into the slots of its lane.
void set_constants(const LaneSpace& space, std::size_t lane, std::span<const double> draws, std::size_t width,
                   LaneArray& slots);
/// The slots of a space as they are before a machine comes.
LaneArray slots_of(const LaneSpace& space, std::size_t width);

/// Finds where machines start, a batch of them at a time: servo loops and algebraic loops at rest. Near the
/// typical machine its rest leads there by Newton's method. Farther away servo loops are let run from where
/// their amplifiers start, as by CVODES; that is done only for diagrams without algebraic loops, whose
/// typical machine comes to its rest in this way too.
class LaneStarts {
 public:
  /// Both must outlive this. `typical`: what the typical machine draws.
  LaneStarts(const LaneProgram& program, const LaneKernels& kernels, std::span<const double> typical);

  struct Start {
    std::span<const double> draws;
    std::span<double> variables;  ///< the guess, and what is found
    bool is_near = true;          ///< the guess is the rest of a machine near by
    bool found = false;           ///< else no rest was found
    double first_step = 0;        ///< [s] in which the states change by a part of themselves
  };

  /// No more of them than there are lanes.
  void find(std::span<Start> starts);
  /// Whether a start may be far from that of the typical machine, where there is to be a rest.
  bool goes_far() const { return goes_far_; }

 private:
  bool typical_machine_settles(std::span<const double> typical);
  void bring_to_rest(std::span<Start> starts);
  bool take_step(std::size_t lane, Start& start, double& before);
  void find_first_steps(std::span<Start> starts);

  const LaneProgram& program_;
  const LaneKernels& kernels_;
  std::size_t width_, n_;
  LaneSettling settling_;
  bool goes_far_ = false;
  LaneArray slots_, entries_, reciprocals_, rates_, change_, work_, growth_, scale_;
};

}  // namespace oblique::ensemble
