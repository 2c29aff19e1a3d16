// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/layout/layout.h>

namespace oblique::draw::layered {

/// All these steps, one after the other; nothing of the result's quality is measured yet.
DiagramLayout lay_out_in_layers(const LayoutGraph& graph);

}  // namespace oblique::draw::layered
