// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw {

/// Lays out a graph some of whose boxes have places.
DiagramLayout lay_out_around(const LayoutGraph& graph);

}  // namespace oblique::draw
