// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program/compilation.h>

// What a solver may miss between two steps (see Source).
namespace oblique::network {

/// Finds the largest parts of the equations that follow the time alone, and not linearly, those that can be a
/// peak of states, and the event functions of states that bend. An integrator of what only events change is a
/// clock, and tells the time as well.
void find_sources(Compilation& c);

/// What they are made of.
std::vector<NodeId> source_roots(const Compilation& c);

void write_sources(Compilation& c);

}  // namespace oblique::network
