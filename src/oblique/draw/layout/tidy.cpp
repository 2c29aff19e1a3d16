// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/tidy.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <oblique/draw/layout/measure.h>
#include <oblique/draw/layout/nudge.h>
#include <oblique/draw/layout/route_all.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

/// Points of the grid up to which wires are laid anew: the grid of 1000 blocks would fill the memory.
constexpr double kMostPoints = 3e5;

void route_anew(const LayoutGraph& graph, DiagramLayout& layout, const Vector2d& size) {
  WireRouter router(graph, layout.corners, nets_of(graph, layout.corners, layout.nets),
                    {Vector2d::Zero(), size});
  std::vector<std::size_t> order(layout.nets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  improve(router, order);
  for (std::size_t k = 0; k < layout.nets.size(); ++k) layout.nets[k].pieces = router.net(k).pieces;
}

/// Where the lines of a grid go when the second and further ones of any that follow each other and have
/// nothing on them are taken out.
class Squeeze {
 public:
  void occupy(double from, double to) {
    const auto last = static_cast<long>(std::ceil(to / kLayoutGrid));
    for (auto at = static_cast<long>(std::floor(from / kLayoutGrid)); at <= last; ++at) occupied_.insert(at);
  }

  double shifted(double at) const {
    long removed = 0, last = -1;
    for (const long line : occupied_) {
      if (static_cast<double>(line) * kLayoutGrid > at) break;
      removed += std::max(0L, line - last - 2);
      last = line;
    }
    return at - static_cast<double>(removed) * kLayoutGrid;
  }

 private:
  std::set<long> occupied_;
};

void squeeze(const LayoutGraph& graph, DiagramLayout& layout) {
  Squeeze x, y;
  for (std::size_t v = 0; v < layout.corners.size(); ++v) {
    const Vector2d low = layout.corners[v], high = low + graph.nodes[v].size;
    x.occupy(low.x(), high.x());
    y.occupy(low.y(), high.y());
  }
  for (const RoutedNet& net : layout.nets) {
    for (const WirePiece& piece : net.pieces) {
      if (piece.horizontal()) {
        y.occupy(piece.from.y(), piece.from.y());
      } else {
        x.occupy(piece.from.x(), piece.from.x());
      }
    }
  }
  const auto move = [&](Vector2d& at) { at = {x.shifted(at.x()), y.shifted(at.y())}; };
  for (Vector2d& corner : layout.corners) move(corner);
  for (RoutedNet& net : layout.nets) {
    for (WirePiece& piece : net.pieces) {
      move(piece.from);
      move(piece.to);
    }
  }
}

}  // namespace

void tidy(const LayoutGraph& graph, DiagramLayout& layout) {
  const Vector2d size = extent_of(graph, layout);
  if (size.x() / kLayoutGrid * size.y() / kLayoutGrid <= kMostPoints) {
    route_anew(graph, layout, size);
    nudge(graph, layout, size);
    route_anew(graph, layout, size);
  }
  squeeze(graph, layout);
}

}  // namespace oblique::draw
