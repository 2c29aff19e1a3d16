// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/schematic/schematic.h>

namespace oblique::draw::schematic {

/// Gives every servo loop a number: a block with an open amplifier, and what lies on a way from its output
/// back to its inputs that leads through no other amplifier with a memory of its own.
void find_servo_loops(Schematic& schematic);

}  // namespace oblique::draw::schematic
