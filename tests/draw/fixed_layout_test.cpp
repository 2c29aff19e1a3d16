// SPDX-License-Identifier: MIT
// Boxes whose places are given, and the wires among them.
#include <oblique/draw/layout/layout.h>

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layout_check.h"

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

LayoutNode box(std::size_t inputs, std::size_t outputs, std::optional<Vector2d> place = {}) {
  LayoutNode node;
  node.size = {64, 2 * kLayoutGrid * static_cast<double>(std::max(inputs, outputs) + 1)};
  for (std::size_t k = 0; k < inputs; ++k)
    node.inputs.push_back(2 * kLayoutGrid * static_cast<double>(k + 1));
  for (std::size_t k = 0; k < outputs; ++k)
    node.outputs.push_back(2 * kLayoutGrid * static_cast<double>(k + 1));
  node.place = place;
  return node;
}

//   b ──► a      against the reading direction, as the places say
TEST(FixedLayout, PlacesWinOverTheFlowOfSignals) {
  const LayoutGraph graph{{box(1, 1, Vector2d(400, 80)), box(1, 1, Vector2d(160, 80))},
                          {{0, 0, 1, 0}, {1, 0, 0, 0}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_TRUE(layout.lost.empty());
  EXPECT_EQ(layout.corners[0] - layout.corners[1], Vector2d(240, 0));
  EXPECT_EQ(layout.quality.bends, 4U) << "straight forward, and around on the way back";
}

TEST(FixedLayout, KeepsTheOriginWhereNothingIsLeftOfIt) {
  const LayoutGraph graph{{box(1, 1, Vector2d(160, 80)), box(1, 1, Vector2d(400, 80))}, {{0, 0, 1, 0}}};
  EXPECT_EQ(lay_out(graph).corners[0], Vector2d(160, 80));
}

//   a ──► c          places: a, c
//   └─► b            b has none: it stands below them
TEST(FixedLayout, BoxesWithoutPlacesStandBelow) {
  const LayoutGraph graph{{box(0, 1, Vector2d(0, 0)), box(1, 1), box(2, 0, Vector2d(240, 0))},
                          {{0, 0, 1, 0}, {0, 0, 2, 0}, {1, 0, 2, 1}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_EQ(layout.corners[2] - layout.corners[0], Vector2d(240, 0));
  EXPECT_GT(layout.corners[1].y(), layout.corners[2].y() + graph.nodes[2].size.y());
}

TEST(FixedLayout, TerminalsStandAtTheSides) {
  LayoutGraph graph{{box(0, 1), box(1, 1, Vector2d(0, 0)), box(1, 1, Vector2d(160, 40)), box(1, 0)},
                    {{0, 0, 1, 0}, {1, 0, 2, 0}, {2, 0, 3, 0}}};
  graph.nodes[0].rank = LayoutRank::first;
  graph.nodes[3].rank = LayoutRank::last;
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_LT(layout.corners[0].x() + 64, layout.corners[1].x());
  EXPECT_GT(layout.corners[3].x(), layout.corners[2].x() + 64);
  EXPECT_EQ(layout.quality.bends, 2U) << "terminals stand at the height of their pins";
}

// Boxes 16 px apart in a dense square: the wires between them have one track each.
TEST(FixedLayout, SaysWhichWiresFindNoWay) {
  LayoutGraph graph;
  for (std::size_t v = 0; v < 25; ++v)
    graph.nodes.push_back(
        box(3, 3, Vector2d(80 * static_cast<double>(v % 5), 80 * static_cast<double>(v / 5))));
  for (std::size_t v = 0; v < 25; ++v) {
    for (std::size_t k = 0; k < 3; ++k) graph.wires.push_back({(7 * v + 3 * k + 5) % 25, k, v, k});
  }
  const DiagramLayout layout = lay_out(graph);
  EXPECT_FALSE(layout.lost.empty());
  for (std::size_t n = 0; n < layout.nets.size(); ++n) {
    const bool is_lost = std::find(layout.lost.begin(), layout.lost.end(), n) != layout.lost.end();
    EXPECT_EQ(layout.nets[n].pieces.empty(), is_lost) << "net " << n;
  }
}

// Any places with room between them.
TEST(FixedLayout, RandomPlacesAreSound) {
  std::mt19937 random(11);
  const auto draw = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (int round = 0; round < 60; ++round) {
    LayoutGraph graph;
    const std::size_t n = 2 + draw(14);
    for (std::size_t v = 0; v < n; ++v) {
      const Vector2d shift(static_cast<double>(draw(8)), static_cast<double>(draw(8)));
      const Vector2d cell(static_cast<double>(v % 4), static_cast<double>(v / 4));
      graph.nodes.push_back(box(1 + draw(3), 1 + draw(2), Vector2d(240 * cell + kLayoutGrid * shift)));
      if (draw(6) == 0) graph.nodes.back().place.reset();
    }
    for (std::size_t v = 0; v < n; ++v) {
      for (std::size_t k = 0; k < graph.nodes[v].inputs.size(); ++k) {
        const std::size_t from = draw(n);
        graph.wires.push_back({from, draw(graph.nodes[from].outputs.size()), v, k});
      }
    }
    const DiagramLayout layout = lay_out(graph);
    ASSERT_TRUE(layout.lost.empty()) << "round " << round;
    expect_sound(graph, layout);
    if (HasFailure()) FAIL() << "round " << round;
  }
}

// A long chain goes on in the next row.
TEST(Layout, LongLayoutsAreWrapped) {
  LayoutGraph graph;
  for (std::size_t v = 0; v < 40; ++v) graph.nodes.push_back(box(1, 1));
  for (std::size_t v = 1; v < 40; ++v) graph.wires.push_back({v - 1, 0, v, 0});
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_LT(layout.size.x(), 2400);
  EXPECT_EQ(layout.corners[0].y(), layout.corners[1].y());
  EXPECT_GT(layout.corners[39].y(), layout.corners[0].y() + graph.nodes[0].size.y());
  EXPECT_LE(layout.quality.bends, 8U) << "four for each wire down to the next row";
}

}  // namespace
}  // namespace oblique::draw
