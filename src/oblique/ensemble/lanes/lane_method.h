// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/ensemble/lanes/lane_kernels.h>
#include <oblique/ensemble/lanes/lane_program.h>

// Not installed.
namespace oblique::ensemble {

/// Where all lanes are, and what a step of theirs gives. Arrays of variables hold a number for each variable
/// and lane, the others one for each lane.
struct LaneStates {
  LaneArray slots;     ///< on which the tapes of the integration run
  LaneArray t, h;      ///< before the step; how long it is [s]
  LaneArray u, after;  ///< variables, before and after it
  LaneArray error,
      growth;  ///< the step is good where the first is at most 1; the largest multiplier of its LU
  LaneArray theta, between;  ///< a place within the step, from 0 to 1; the variables there
};

/// A one-step method for all lanes at once.
class LaneMethod {
 public:
  LaneMethod() = default;
  LaneMethod(const LaneMethod&) = delete;
  LaneMethod& operator=(const LaneMethod&) = delete;
  virtual ~LaneMethod() = default;

  /// Tries a step of `h` from `u`: gives `after`, `error` and `growth`.
  virtual void step(LaneStates& lanes) = 0;
  /// Gives `between` at `theta`, within the step that was tried last.
  virtual void find_between(LaneStates& lanes) = 0;
  /// How long the next step of a lane is, of this one, by its error: within bounds.
  virtual double step_factor(double error) const = 0;
};

/// The method of a program. Both must outlive it.
std::unique_ptr<LaneMethod> make_lane_method(const LaneProgram& program, const LaneKernels& kernels,
                                             LaneStates& lanes);

/// 0.9 error^(−1/p) within bounds, by a polynomial for the root of a number from 1/2 to 1: the library's
/// power costs as much as what it is for. To 5e-5, which is more than is known of the next step. `powers`:
/// 2^(−k/p) for k = 0 … p − 1.
double step_factor_of(double error, int p, const double (&root)[5], const double* powers);

}  // namespace oblique::ensemble
