// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_method.h>

#include <algorithm>
#include <cmath>

#include <oblique/ensemble/lanes/rosenbrock_lanes.h>
#include <oblique/ensemble/lanes/verner_lanes.h>

namespace oblique::ensemble {

std::unique_ptr<LaneMethod> make_lane_method(const LaneProgram& program, const LaneKernels& kernels,
                                             LaneStates& lanes) {
  if (program.is_explicit) return std::make_unique<VernerLanes>(program, kernels, lanes);
  return std::make_unique<RosenbrockLanes>(program, kernels, lanes);
}

double step_factor_of(double error, int p, const double (&root)[5], const double* powers) {
  constexpr double kSafety = 0.9, kLeast = 0.2, kMost = 6;
  constexpr int kShift = 1000;  // makes exponents positive
  if (!std::isfinite(error)) return kLeast;
  if (error < 1e-9) return kMost;
  if (error > 1e9) return kLeast;
  int exponent = 0;
  const double x = 2 * std::frexp(error, &exponent) - 1.5;  // error = (x + 1.5) 2^(exponent − 1)
  const double y = root[0] + x * (root[1] + x * (root[2] + x * (root[3] + x * root[4])));
  const int k = exponent - 1 + p * kShift;
  return std::clamp(kSafety * y * powers[k % p] * std::ldexp(1.0, kShift - k / p), kLeast, kMost);
}

}  // namespace oblique::ensemble
