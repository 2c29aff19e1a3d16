// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/ensemble/lanes/lane_kernels.h>
#include <oblique/ensemble/lanes/lane_program.h>

// Not installed.
namespace oblique::ensemble {

/// Lets the servo loops of machines run with the clock stopped until they hardly move, as a run by CVODES
/// does (solve::settle), in all lanes: implicit Euler steps, short at first so that they follow the way the
/// loops take, then ever longer. A step that changes a state much, or across which a pivot of 1/h − ∂F/∂u
/// changes its sign (there a loop is unstable), is taken again shorter. Each lane has a step of its own.
class LaneSettling {
 public:
  /// Both must outlive this.
  LaneSettling(const LaneProgram& program, const LaneKernels& kernels);

  /// `slots`: those of the integration, the loops where their amplifiers start. Those of `lanes` are changed;
  /// afterwards it holds those that have settled, to some eight digits.
  void run(LaneArray& slots, std::vector<bool>& lanes);

  /// Of the `lanes` leaves those whose servo loops would all return to rest where the slots are.
  void keep_stable(LaneArray& slots, std::vector<bool>& lanes);

 private:
  /// A lane on its way.
  struct Way {
    bool goes_on = false, rests = false;
    double unit = 0;      ///< time constant of the fastest loop [s]
    double shortest = 0;  ///< step [s]
  };

  void linearise(LaneArray& slots);
  void begin(LaneArray& slots, const std::vector<bool>& lanes);
  void factor();
  bool is_stable(std::size_t lane) const;
  double step_of_change(const LaneArray& slots, std::size_t lane) const;
  void judge(LaneArray& slots, std::size_t lane);

  const LaneProgram& program_;
  const LaneKernels& kernels_;
  std::size_t width_, n_;
  std::vector<Way> ways_;
  std::vector<bool> negative_;  ///< pivots, of each lane in short steps
  LaneArray before_, entries_, reciprocals_, rates_, change_, work_, growth_, h_, scale_;
};

}  // namespace oblique::ensemble
