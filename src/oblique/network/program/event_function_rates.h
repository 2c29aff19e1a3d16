// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program/compilation.h>

// How quickly the event functions of switches move, and what turns below them.
namespace oblique::network {

/// Adds d(event function)/dt of every switch to the graph, and the rates of the arguments of periodic
/// functions below the event functions. The rates of states and unknowns are numbers that are put in, as if
/// they were discrete states.
void differentiate_event_functions(Compilation& c);

/// What the rates are made of.
std::vector<NodeId> rate_roots(const Compilation& c);

/// In the order of the loops: what needs no rate of their unknowns, then loop by loop those rates and what
/// they are needed for.
void write_rates(Compilation& c);

}  // namespace oblique::network
