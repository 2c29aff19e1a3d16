// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/draw/layout/wire_router.h>

namespace oblique::draw {

/// Lays every net anew as long as that makes the whole better, and is worth the work.
void improve(WireRouter& router, const std::vector<std::size_t>& order);

/// Lays the nets that have no wires, then improves all. Gives the nets that found no way.
std::vector<std::size_t> route_all(const LayoutGraph& graph, const std::vector<Eigen::Vector2d>& corners,
                                   const RoutingArea& area, std::vector<NetToRoute>& nets);

/// The nets of a graph, in the order of their outputs, with their pins.
std::vector<NetToRoute> nets_of(const LayoutGraph& graph, const std::vector<Eigen::Vector2d>& corners,
                                std::vector<RoutedNet>& routed);

}  // namespace oblique::draw
