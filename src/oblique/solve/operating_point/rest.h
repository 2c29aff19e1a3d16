// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// The states that are brought to rest before the clock starts: those of servo amplifiers.
std::vector<std::size_t> rest_states(const network::Program& program);

/// The same in groups that act on each other, each after the groups whose signals it follows.
std::vector<std::vector<std::size_t>> servo_groups(const network::Program& program);

/// Brings servo loops to rest at time t while all other states are held, as an operator waits for the loops
/// to settle before he starts the clock: the loops run with the clock stopped, then Newton's method takes
/// them to dx/dt = 0. Changes `states` in place. Throws SolveError where a loop does not settle, would not
/// stay at rest (an unstable loop may balance for a moment), or an algebraic loop has no solution.
///
/// A loop may close through states that are held (a lag, an integrator), and be stable only when those move.
/// It has no rest before the clock starts, on no machine. It then starts where its `initial` says, and the
/// warnings that are given back say so.
std::vector<text::Diagnostic> bring_to_rest(const network::Program& program, network::Workspace& workspace,
                                            double t, std::vector<double>& states, const std::string& file);

/// Brings to rest at time t what is brought to rest before the clock starts, with the algebraic loops passed
/// over that have no solution yet; false, and `states` are as they were, where that does not settle.
bool rest_past_loops(const network::Program& program, network::Workspace& workspace, double t,
                     std::vector<double>& states);

/// The same where servo amplifiers run away from where they begin, with the switches as they stand: puts the
/// switches where the signals ask for them then, and brings the amplifiers to rest with these. So a Schmitt
/// trigger of a real amplifier goes to its limit. Nothing, and all is as it was, where they do not run away
/// or nothing holds them.
std::optional<std::vector<text::Diagnostic>> rest_where_they_run(const network::Program& program,
                                                                 network::Workspace& workspace, double t,
                                                                 std::vector<double>& states,
                                                                 const std::string& file);

}  // namespace oblique::solve
