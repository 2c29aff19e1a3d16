// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include <oblique/diagram/diagram.h>
#include <oblique/network/program.h>

namespace oblique {

/// The method of a run and why.
struct MethodChoice {
  IntegrationMethod method = IntegrationMethod::bdf;  ///< bdf or adams
  std::string reason;
};

/// Chooses between BDF and Adams where the diagram leaves it open (`automatic`), from the equations
/// linearised at the start: BDF for servo loops, for decays that are fast beside others or beside the time
/// that the run lasts (`until` [s]), and for many states; Adams where the fastest mode oscillates or nothing
/// is fast. Adams keeps the amplitude of an oscillation; BDF takes long steps past a decay.
MethodChoice choose_method(IntegrationMethod asked, const Program& program, Workspace& workspace,
                           std::span<const double> start, double until);

}  // namespace oblique
