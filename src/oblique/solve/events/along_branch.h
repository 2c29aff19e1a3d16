// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Evaluates at `to` what was evaluated at `from` last: in one step or, where the branch of an algebraic loop
/// is lost on the way (near its end the unknowns go far in a moment), in as many as it takes. `evaluate`
/// takes a time, and tells whether there was a value. The time that was reached: `to`, or nearest to it with
/// a value. Not installed.
template <class Evaluate>
double evaluate_along_branch(double from, double to, const network::Workspace& workspace,
                             const Evaluate& evaluate) {
  constexpr int kMostSteps = 5000;
  if (evaluate(to)) return to;
  double at = from, step = (to - from) / 2;
  for (int k = 0; k < kMostSteps && at + step != at; ++k) {
    const double target = std::abs(step) < std::abs(to - at) ? at + step : to;
    if (evaluate(target)) {
      if (target == to) return to;
      at = target;
      step *= 2;
    } else {
      if (workspace.trouble().failure != network::LoopFailure::lost) break;
      step = (target - at) / 2;
    }
  }
  return at;
}

}  // namespace oblique::solve
