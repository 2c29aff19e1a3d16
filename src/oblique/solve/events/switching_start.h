// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/readings/event_functions.h>
#include <oblique/solve/solve_error.h>

// How a run with switches starts. Not installed.
namespace oblique::solve {

/// Starts the states that start from signals. Those that start from each other in a circle begin where they
/// agree, which is not what integrators do that take their values by turns: that is told. `file` names the
/// diagram in messages. Throws SolveError.
void take_starts(const network::Program& program, network::Workspace& workspace, double t,
                 std::vector<double>& x, EventLog& log, const std::string& file);

/// The error of initial values of `states` that follow from each other and do not agree.
SolveError starts_in_circle(const network::Program& program, const std::vector<std::size_t>& states, double t,
                            const std::string& file);

/// Brings servo loops to rest with all limits let loose, and tells whether they rest there, within them; else
/// nothing has changed. An amplifier's guess may be far off only because the elements in its loop have not
/// settled yet; at a limit it has no gain, and may stay there for good.
bool rests_within_limits(const network::Program& program, network::Workspace& workspace,
                         EventFunctions& event_functions, const Announced& announced, double t,
                         std::vector<double>& x, const std::function<void()>& bring_to_rest);

}  // namespace oblique::solve
