// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/ideal_machine.h>

namespace oblique::solve {

/// A feedback loop that servo amplifiers close.
struct ServoLoop {
  std::vector<std::size_t> servos;  ///< states of the amplifiers
  std::vector<std::size_t> states;  ///< all states on the loop, ascending: the servos, and what they wait for
};

/// The servo loops of a diagram: amplifiers that act on each other or on themselves while all other states
/// are held; and open amplifiers whose loop closes through other states (lags, integrators), all that belong
/// together in one. An amplifier with a pole of its own that no loop goes through, or a summer or multiplier
/// that the problem's own feedback goes through, is no servo loop.
std::vector<ServoLoop> servo_loops(const network::Program& program, const SignalFlow& flow,
                                   const std::vector<Instant>& instants);

}  // namespace oblique::solve
