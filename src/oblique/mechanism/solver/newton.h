// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <oblique/mechanism/solver/group_system.h>

namespace oblique::mechanism {

struct Closing {
  bool closed = false;
  double correction = 0;   ///< size of the first step over the group's size: how wrong the guess was
  double contraction = 0;  ///< which part of it the second one was; 0 where one was enough
};

/// Closes a guess by Newton's method: J dq = −g(q) is solved again and again, and q moved by dq.
///
/// * A step longer than half the group's size is shortened to that, since a pose so far away has nothing to
/// do with the
///   guess.
/// * Links turn by the angle of the step and keep cosine² + sine² = 1.
/// * Errors are squared from step to step. So it stops after a step of 1e-9 of the size: the next would be
///   rounding.
/// * At a dead centre, a double root, steps only halve, down to the root of the rounding. When they no longer
/// get smaller, what is
///   left of the conditions decides.
///
/// `state` holds the guess and then the last pose, closed or not.
Closing close_by_newton(GroupSystem& system, GroupState& state, std::span<const DriveState> drives,
                        const Configuration& here);

}  // namespace oblique::mechanism
