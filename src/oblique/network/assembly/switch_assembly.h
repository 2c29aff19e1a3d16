// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/assembly/assembly.h>

// Switches: what the equations compare.
namespace oblique::network {

/// The position of the switch that compares these two in a block; what it compares is built later.
NodeId switch_of(Assembly& a, std::size_t block, const text::Expression& left, const text::Expression& right,
                 Turning turning);

/// Adds a switch, which names its discrete state.
void add_switch(Assembly& a, Switch made);

/// The event functions of all switches; building one may call for another.
void define_switches(Assembly& a);

}  // namespace oblique::network
