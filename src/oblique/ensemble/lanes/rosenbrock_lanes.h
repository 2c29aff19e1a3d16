// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/ensemble/lanes/lane_method.h>

// Not installed.
namespace oblique::ensemble {

/// Rodas5P in lanes: for what is stiff, and for algebraic unknowns.
class RosenbrockLanes final : public LaneMethod {
 public:
  RosenbrockLanes(const LaneProgram& program, const LaneKernels& kernels, const LaneStates& lanes);

  void step(LaneStates& lanes) override;
  void find_between(LaneStates& lanes) override;
  double step_factor(double error) const override;

 private:
  void correct_between(LaneStates& lanes);

  const LaneProgram& program_;
  const LaneKernels& kernels_;
  std::size_t width_;
  std::uint32_t n_;   ///< variables
  std::size_t size_;  ///< of an array of variables
  LaneArray stages_, right_side_, work_, by_time_, entries_, reciprocals_, bends_[3], slope_, change_;
  LaneArray scale_, inverse_, time_scale_;
  bool bends_known_ = false;
  std::vector<const double*> stage_, rate_;  ///< where they stand
};

}  // namespace oblique::ensemble
