// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw::layered {

/// Layers, order, heights and wires of a graph, one step after the other; nothing of the result's quality is
/// measured yet.
DiagramLayout lay_out_in_layers(const LayoutGraph& graph);

}  // namespace oblique::draw::layered
