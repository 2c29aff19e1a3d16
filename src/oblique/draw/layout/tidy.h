// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw {

/// Lays wires anew that can be straighter or cross fewer others, and takes out rows and columns of the grid
/// that nothing stands on. Wires of very large layouts stay.
void tidy(const LayoutGraph& graph, DiagramLayout& layout);

}  // namespace oblique::draw
