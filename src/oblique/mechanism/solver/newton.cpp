// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/newton.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::mechanism {

using Eigen::Index;

Closing close_by_newton(GroupSystem& system, GroupState& state, std::span<const DriveState> drives,
                        const Configuration& here) {
  Closing result;
  constexpr int kMostSteps = 60;
  constexpr double kLongestStep = 0.5;  // of the group's size: no guess of a step is so wrong
  // Errors are squared from step to step: after one this small the next would be rounding.
  constexpr double kLastStep = 1e-9;
  const double size = system.size();
  const Eigen::VectorXd& solution = system.solution();
  double before = std::numeric_limits<double>::infinity();
  const double rounding = 64 * std::numeric_limits<double>::epsilon() * state.farthest(size);
  for (int step = 0; step < kMostSteps; ++step) {
    system.evaluate(state, drives, here);
    system.evaluate_jacobian(state, here);
    if (!system.solve()) return result;
    const double length = solution.lpNorm<Eigen::Infinity>();
    if (step == 0) result.correction = length / size;
    if (step == 1) result.contraction = length / before;
    // a step that is too long is shortened, so that the search does not leap into the far
    const double most = kLongestStep * size;
    const double factor = length > most ? most / length : 1;
    Index k = 0;
    for (GroupState::Platform& platform : state.platforms) {
      platform.origin.position += factor * solution.segment<2>(k);
      const double angle = factor * solution(k + 2) / size;
      const double c = platform.cosine - angle * platform.sine;
      const double s = platform.sine + angle * platform.cosine;
      const double norm = 1 / std::sqrt(c * c + s * s);
      platform.cosine = c * norm;
      platform.sine = s * norm;
      k += 3;
    }
    for (PointState& point : state.free) {
      point.position += factor * solution.segment<2>(k);
      k += 2;
    }
    if (length <= std::max(kLastStep * size, rounding)) {
      result.closed = true;
      return result;
    }
    // at a double root the steps only halve, down to the root of the rounding
    if (step > 20 && length > 0.9 * before && factor == 1) break;
    before = length;
  }
  system.evaluate(state, drives, here);
  result.closed = system.right().lpNorm<Eigen::Infinity>() <= rounding;
  return result;
}

}  // namespace oblique::mechanism
