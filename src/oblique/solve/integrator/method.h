// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>

#include <oblique/diagram/diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run_records.h>

namespace oblique::solve {

/// Chooses between BDF and Adams where the diagram leaves it open (`automatic`), from the equations
/// linearised at the start (t, states): BDF for servo loops, for decays that are fast beside what oscillates
/// or grows, and where nothing does so, beside slower decays or beside the time that the run lasts (`span`
/// [s]); and for more states that act on each other than it can look at. Adams in all other cases: it keeps
/// the amplitude of an oscillation; BDF takes long steps past a decay. Eigenvalues at zero are integrators
/// and decide nothing.
MethodChoice choose_method(diagram::IntegrationMethod asked, const network::Program& program,
                           network::Workspace& workspace, double t, std::span<const double> states,
                           double span);

/// The method for a run that Adams' formulas have begun, from the equations linearised at (t, states), if it
/// is another: a switch may have let in a fast decay.
std::optional<MethodChoice> stiff_method(const network::Program& program, network::Workspace& workspace,
                                         double t, std::span<const double> states, double span);

}  // namespace oblique::solve
