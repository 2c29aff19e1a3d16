// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/plan.h>

namespace oblique::draw::layered {

/// Gives every slot its y so that wires run straight where they can.
void place_slots(Plan& plan);

}  // namespace oblique::draw::layered
