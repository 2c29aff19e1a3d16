// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Evaluates at `to` what was evaluated at `from` last: in one step or, where the branch of an algebraic loop
/// is lost on the way (near its end the unknowns go far in a moment), in as many as it takes. `evaluate`
/// takes a time, and tells whether there was a value. The time that was reached: `to`, or nearest to it with
/// a value. Not installed.
template <class Evaluate>
double evaluate_along_branch(double from, double to, const network::Workspace& workspace,
                             const Evaluate& evaluate) {
  constexpr int kMostSteps = 200;
  if (evaluate(to)) return to;
  double at = from, step = (to - from) / 2;
  for (int k = 0; k < kMostSteps && at + step != at; ++k) {
    if (workspace.trouble().failure != network::LoopFailure::lost) break;
    if (!evaluate(at + step)) {
      step /= 2;
      continue;
    }
    at += step;
    if (evaluate(to)) return to;
    step = (to - at) / 2;
  }
  return at;
}

}  // namespace oblique::solve
