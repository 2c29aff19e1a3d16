// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw {

/// Moves boxes up or down by little where their wires become better by it; `size` is the room [px].
void nudge(const LayoutGraph& graph, DiagramLayout& layout, const Eigen::Vector2d& size);

}  // namespace oblique::draw
