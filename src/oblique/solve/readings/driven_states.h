// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>

// Not installed.
namespace oblique::solve {

/// The states whose rates at (t, x) depend on which side the switches of these units stand, or those that
/// follow them, and all that depend on such states: of the others the Jacobian is as it is while the units
/// slide. All where the rates have no value on some side.
std::vector<bool> driven_states(const network::Program& program, std::span<const std::uint32_t> units,
                                double t, std::span<const double> x, network::Workspace workspace);

}  // namespace oblique::solve
