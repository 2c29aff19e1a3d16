// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/program/compilation.h>

// The order in which the positions of switches follow from each other, and between what they choose.
namespace oblique::network {

/// The position of each switch that an evaluation may come to is a node, whether anything reads it or not.
void find_positions(Compilation& c);

/// Writes each ordered switch after those on whose positions it depends. Leaves out what follows from
/// algebraic loops, and what depends on its own position.
void write_switch_order(Compilation& c);

/// Of each switch the two pieces between which each `select` chooses by its position, as far as the equations
/// read them; nothing where its position is read in another way.
void write_pieces(Compilation& c);

}  // namespace oblique::network
