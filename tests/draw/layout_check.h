// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw {

/// Checks a layout by its geometry alone: no two boxes overlap, all wires are orthogonal, none crosses a box,
/// wires of different nets never lie on each other, and every wire connects its two pins.
void expect_sound(const LayoutGraph& graph, const DiagramLayout& layout);

}  // namespace oblique::draw
