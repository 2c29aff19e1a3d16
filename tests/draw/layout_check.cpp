// SPDX-License-Identifier: MIT
#include "layout_check.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

struct Rectangle {
  Vector2d low, high;
};

bool touch(const Rectangle& a, const Rectangle& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

bool overlap(const Rectangle& a, const Rectangle& b) {
  return (a.low.array() < b.high.array()).all() && (b.low.array() < a.high.array()).all();
}

Rectangle rectangle(const WirePiece& piece) {
  return {piece.from, piece.to};
}

bool lies_on(const Vector2d& point, const WirePiece& piece) {
  return touch({point, point}, rectangle(piece));
}

/// Whether the pieces of a net lead from one point to another.
bool connects(const RoutedNet& net, const Vector2d& from, const Vector2d& to) {
  std::vector<bool> seen(net.pieces.size());
  std::vector<std::size_t> stack;
  const auto visit = [&](std::size_t k) {
    if (seen[k]) return;
    seen[k] = true;
    stack.push_back(k);
  };
  for (std::size_t k = 0; k < net.pieces.size(); ++k) {
    if (lies_on(from, net.pieces[k])) visit(k);
  }
  while (!stack.empty()) {
    const WirePiece& piece = net.pieces[stack.back()];
    stack.pop_back();
    if (lies_on(to, piece)) return true;
    for (std::size_t k = 0; k < net.pieces.size(); ++k) {
      if (touch(rectangle(piece), rectangle(net.pieces[k]))) visit(k);
    }
  }
  return false;
}

}  // namespace

void expect_sound(const LayoutGraph& graph, const DiagramLayout& layout) {
  ASSERT_EQ(layout.corners.size(), graph.nodes.size());
  std::vector<Rectangle> boxes;
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) {
    boxes.push_back({layout.corners[v], layout.corners[v] + graph.nodes[v].size});
    EXPECT_TRUE(boxes[v].low.x() >= 0 && boxes[v].low.y() >= 0) << "box " << v;
    EXPECT_TRUE(boxes[v].high.x() <= layout.size.x() && boxes[v].high.y() <= layout.size.y()) << "box " << v;
    for (std::size_t u = 0; u < v; ++u) EXPECT_FALSE(touch(boxes[u], boxes[v])) << "boxes " << u << ", " << v;
  }
  for (std::size_t n = 0; n < layout.nets.size(); ++n) {
    for (const WirePiece& piece : layout.nets[n].pieces) {
      EXPECT_NE(piece.from.x() == piece.to.x(), piece.from.y() == piece.to.y()) << "net " << n;
      for (std::size_t v = 0; v < boxes.size(); ++v) {
        const bool across =
            piece.horizontal()
                ? overlap({piece.from - Vector2d(0, 0.1), piece.to + Vector2d(0, 0.1)}, boxes[v])
                : touch(rectangle(piece), boxes[v]);
        EXPECT_FALSE(across) << "net " << n << ", box " << v;
      }
      for (std::size_t m = 0; m < n; ++m) {
        for (const WirePiece& other : layout.nets[m].pieces) {
          if (other.horizontal() == piece.horizontal()) {
            EXPECT_FALSE(touch(rectangle(piece), rectangle(other))) << "nets " << m << ", " << n;
          }
        }
      }
    }
  }
  for (const LayoutWire& wire : graph.wires) {
    const auto net = std::find_if(layout.nets.begin(), layout.nets.end(), [&](const RoutedNet& routed) {
      return routed.from == wire.from && routed.output == wire.output;
    });
    ASSERT_NE(net, layout.nets.end());
    const Vector2d from(boxes[wire.from].high.x(),
                        boxes[wire.from].low.y() + graph.nodes[wire.from].outputs[wire.output]);
    const Vector2d to(boxes[wire.to].low.x(),
                      boxes[wire.to].low.y() + graph.nodes[wire.to].inputs[wire.input]);
    EXPECT_TRUE(connects(*net, from, to)) << "wire from " << wire.from << " to " << wire.to;
  }
}

}  // namespace oblique::draw
