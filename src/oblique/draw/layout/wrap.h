// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw {

/// Breaks a long layout into rows, one below the other; where that is no better it stays.
void wrap(const LayoutGraph& graph, DiagramLayout& layout);

}  // namespace oblique::draw
