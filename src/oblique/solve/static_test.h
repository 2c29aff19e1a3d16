// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace oblique::network {
class Program;
}

namespace oblique::solve {

/// What a meter shows at one element in initial condition.
struct StaticReading {
  std::string signal;  ///< path
  double output = 0;   ///< [machine unit]
  std::optional<double>
      derivative;        ///< d output/dt [machine unit/s], of a state: what its integrator is fed with
  bool at_rest = false;  ///< a servo amplifier: brought to rest, so that its derivative is 0 to rounding
};

/// The static test: every output in initial condition at t = 0, servo loops brought to rest, and the
/// derivative of every state, in the order of the program's signals; states that are no output come last.
/// Nothing is run. `file` is for messages. Throws SolveError where loops do not settle or have no solution.
std::vector<StaticReading> static_test(const network::Program& program, const std::string& file);

}  // namespace oblique::solve
