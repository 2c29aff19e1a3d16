// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/measure.h>

#include <oblique/draw/schematic/wire_pieces.h>

namespace oblique::draw {

using Eigen::Vector2d;

Vector2d extent_of(const LayoutGraph& graph, const DiagramLayout& layout) {
  Vector2d size(0, 0);
  for (std::size_t v = 0; v < layout.corners.size(); ++v)
    size = size.cwiseMax(layout.corners[v] + graph.nodes[v].size);
  for (const RoutedNet& net : layout.nets) {
    for (const WirePiece& piece : net.pieces) size = size.cwiseMax(piece.to);
  }
  return size;
}

void measure(const LayoutGraph& graph, DiagramLayout& layout) {
  layout.quality = {};
  for (RoutedNet& net : layout.nets) {
    WireJoints joints = joints_of(net.pieces);
    net.junctions = std::move(joints.junctions);
    layout.quality.bends += joints.bends;
    for (const WirePiece& piece : net.pieces) layout.quality.wire_length += (piece.to - piece.from).norm();
  }
  layout.quality.crossings = count_crossings(layout.nets);
  for (const LayoutWire& wire : graph.wires) {
    const double from = layout.corners[wire.from].x() + graph.nodes[wire.from].size.x();
    if (layout.corners[wire.to].x() <= from) ++layout.quality.feedbacks;
  }
  layout.size = extent_of(graph, layout);
}

}  // namespace oblique::draw
