// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/plan.h>

namespace oblique::draw::layered {

/// Moves boxes and long wires one by one where that takes bends away; their order stays. Part of
/// `place_slots`.
void straighten(Plan& plan);

}  // namespace oblique::draw::layered
