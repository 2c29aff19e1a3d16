// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

/// What `lay_out` does besides the layers. Not installed.
namespace oblique::draw {

/// Lays wires anew that can be straighter or cross fewer others, and takes out rows and columns of the grid
/// that nothing stands on. Wires of very large layouts stay.
void tidy(const LayoutGraph& graph, DiagramLayout& layout);

/// Moves boxes up or down by little where their wires become better by it; `size` is the room [px].
void nudge(const LayoutGraph& graph, DiagramLayout& layout, const Eigen::Vector2d& size);

/// Breaks a long layout into rows, one below the other; where that is no better it stays.
void wrap(const LayoutGraph& graph, DiagramLayout& layout);

/// Lays out a graph some of whose boxes have places.
DiagramLayout lay_out_around(const LayoutGraph& graph);

/// Fills in junctions, size and quality from corners and pieces.
void measure(const LayoutGraph& graph, DiagramLayout& layout);

}  // namespace oblique::draw
