// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program/compilation.h>

// How quickly the surfaces of switches move, and what turns below them.
namespace oblique::network {

/// Adds d surface/dt of every switch to the graph, and the rates of the arguments of periodic functions below
/// the surfaces. The rates of states and unknowns are numbers that are put in, as if they were memories.
void differentiate_surfaces(Compilation& c);

/// What the rates are made of.
std::vector<NodeId> rate_roots(const Compilation& c);

/// In the order of the loops: what needs no rate of their unknowns, then loop by loop those rates and what
/// they are needed for.
void write_rates(Compilation& c);

}  // namespace oblique::network
