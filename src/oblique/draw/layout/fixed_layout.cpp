// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/fixed_layout.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <oblique/draw/layout/layered_layout.h>
#include <oblique/draw/layout/route_all.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kGap = 4 * kLayoutGrid;  // between the boxes with places and the others

bool is_free(const LayoutNode& node) {
  return node.rank == LayoutRank::free && !node.place;
}

double padding(const LayoutNode& node) {
  return kLayoutGrid * static_cast<double>(std::max(node.inputs.size(), node.outputs.size()));
}

/// Boxes without a place, laid out by themselves below the others.
void add_free_boxes(const LayoutGraph& graph, std::vector<Vector2d>& corners, const Vector2d& low,
                    const Vector2d& high) {
  LayoutGraph rest;
  std::map<std::size_t, std::size_t> index;
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) {
    if (!is_free(graph.nodes[v])) continue;
    index[v] = rest.nodes.size();
    rest.nodes.push_back(graph.nodes[v]);
    LayoutNode& node = rest.nodes.back();  // with room for the wires to boxes that have places
    const double around = padding(graph.nodes[v]);
    node.size += 2 * Vector2d(around, around);
    for (double& pin : node.inputs) pin += around;
    for (double& pin : node.outputs) pin += around;
  }
  if (rest.nodes.empty()) return;
  for (const LayoutWire& wire : graph.wires) {
    if (index.contains(wire.from) && index.contains(wire.to))
      rest.wires.push_back({index[wire.from], wire.output, index[wire.to], wire.input, wire.weight});
  }
  const DiagramLayout below = layered::lay_out_in_layers(rest);
  for (const auto& [v, k] : index)
    corners[v] =
        Vector2d(low.x(),
                 high.y() + kGap + kLayoutGrid * std::floor(static_cast<double>(graph.wires.size()) / 8)) +
        below.corners[k] + Vector2d::Constant(padding(graph.nodes[v]));
}

/// Terminals of one side, at the heights of what they are wired to, apart from each other.
void add_terminals(const LayoutGraph& graph, LayoutRank rank, double edge, std::vector<Vector2d>& corners) {
  std::vector<std::pair<double, std::size_t>> heights;
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) {
    if (graph.nodes[v].rank != rank) continue;
    double height = std::numeric_limits<double>::max();
    for (const LayoutWire& wire : graph.wires) {
      const bool from_here = wire.from == v, to_here = wire.to == v;
      const std::size_t other = from_here ? wire.to : wire.from;
      if (from_here == to_here || graph.nodes[other].rank != LayoutRank::free) continue;
      const double pin = from_here
                             ? graph.nodes[other].inputs[wire.input] - graph.nodes[v].outputs[wire.output]
                             : graph.nodes[other].outputs[wire.output] - graph.nodes[v].inputs[wire.input];
      height = std::min(height, corners[other].y() + pin);
    }
    heights.emplace_back(height == std::numeric_limits<double>::max() ? 0 : height, v);
  }
  std::sort(heights.begin(), heights.end());
  const double room = 2 * kLayoutGrid + kLayoutGrid * static_cast<double>(heights.size());
  double next = std::numeric_limits<double>::lowest();
  for (const auto& [height, v] : heights) {
    const double y = std::max(height, next);
    const bool left = rank == LayoutRank::first;
    corners[v] = {left ? edge - room - graph.nodes[v].size.x() : edge + room, y};
    next = y + graph.nodes[v].size.y() + kLayoutGrid;
  }
}

}  // namespace

DiagramLayout lay_out_around(const LayoutGraph& graph) {
  DiagramLayout layout;
  const double infinity = std::numeric_limits<double>::max();
  layout.corners.assign(graph.nodes.size(), Vector2d::Zero());
  Vector2d low(infinity, infinity), high = -low;
  const auto include = [&](std::size_t v) {
    low = low.cwiseMin(layout.corners[v]);
    high = high.cwiseMax(layout.corners[v] + graph.nodes[v].size);
  };
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) {
    if (!graph.nodes[v].place) continue;
    layout.corners[v] = *graph.nodes[v].place;
    include(v);
  }
  add_free_boxes(graph, layout.corners, low, high);
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) {
    if (is_free(graph.nodes[v])) include(v);
  }
  add_terminals(graph, LayoutRank::first, low.x(), layout.corners);
  add_terminals(graph, LayoutRank::last, high.x(), layout.corners);
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) include(v);
  std::vector<NetToRoute> nets = nets_of(graph, layout.corners, layout.nets);
  const double margin = kLayoutGrid * static_cast<double>(2 + std::min<std::size_t>(nets.size(), 40));
  const Vector2d room(margin, margin);
  layout.lost = route_all(graph, layout.corners, {low - room, high + room}, nets);
  for (const NetToRoute& net : nets) {
    for (const WirePiece& piece : net.pieces) low = low.cwiseMin(piece.from);
  }
  const Vector2d shift = (-low).cwiseMax(Vector2d::Zero());
  for (Vector2d& corner : layout.corners) corner += shift;
  for (std::size_t k = 0; k < nets.size(); ++k) {
    for (const WirePiece& piece : nets[k].pieces)
      layout.nets[k].pieces.push_back({piece.from + shift, piece.to + shift});
  }
  return layout;
}

}  // namespace oblique::draw
