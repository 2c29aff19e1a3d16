// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/draw/layout/layout.h>

namespace oblique::draw::layered {

/// The layer of each node: signals go to the right but for the few wires that close loops.
std::vector<std::size_t> assign_layers(const LayoutGraph& graph);

}  // namespace oblique::draw::layered
