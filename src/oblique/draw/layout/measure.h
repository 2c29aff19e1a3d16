// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw {

/// The lower right corner of all boxes and wires [px].
Eigen::Vector2d extent_of(const LayoutGraph& graph, const DiagramLayout& layout);

/// Fills in junctions, size and quality from corners and pieces.
void measure(const LayoutGraph& graph, DiagramLayout& layout);

}  // namespace oblique::draw
