// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/ensemble/lanes/lane_method.h>

// Not installed.
namespace oblique::ensemble {

/// Verner's method of order 7 in lanes: for what is not stiff and has no algebraic unknowns.
class VernerLanes final : public LaneMethod {
 public:
  VernerLanes(const LaneProgram& program, const LaneKernels& kernels, const LaneStates& lanes);

  void step(LaneStates& lanes) override;
  void find_between(LaneStates& lanes) override;
  double step_factor(double error) const override;

 private:
  void find_stage(LaneStates& lanes, std::size_t stage);

  const LaneProgram& program_;
  const LaneKernels& kernels_;
  std::size_t width_;
  std::uint32_t n_;   ///< variables
  std::size_t size_;  ///< of an array of variables
  LaneArray stages_, error_, weights_;
  bool all_known_ = false;            ///< also the stages between the ends
  std::vector<const double*> stage_;  ///< where they stand
};

}  // namespace oblique::ensemble
