// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/layout.h>

#include <cmath>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/layout/layering.h>

#include "layout_check.h"

namespace oblique::draw {
namespace {

LayoutNode plain_box(std::size_t inputs, std::size_t outputs) {
  LayoutNode node;
  const double rows = static_cast<double>(std::max(inputs, outputs)) + 1;
  node.size = {64, 2 * kLayoutGrid * rows};
  for (std::size_t k = 0; k < inputs; ++k)
    node.inputs.push_back(2 * kLayoutGrid * static_cast<double>(k + 1));
  for (std::size_t k = 0; k < outputs; ++k)
    node.outputs.push_back(2 * kLayoutGrid * static_cast<double>(k + 1));
  return node;
}

//   a ──► b ──► c
TEST(Layout, AChainIsOneStraightLine) {
  const LayoutGraph graph{{plain_box(1, 1), plain_box(1, 1), plain_box(1, 1)}, {{0, 0, 1, 0}, {1, 0, 2, 0}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_EQ(layout.quality.bends, 0U);
  EXPECT_EQ(layout.quality.crossings, 0U);
  EXPECT_LT(layout.corners[0].x(), layout.corners[1].x());
  EXPECT_LT(layout.corners[1].x(), layout.corners[2].x());
  EXPECT_EQ(layout.corners[0].y(), layout.corners[2].y());
}

//   ┌──────────────┐
//   └─► a ──► b ──►┘      what is fed back runs around
TEST(Layout, ALoopGoesBackOnce) {
  const LayoutGraph graph{{plain_box(1, 1), plain_box(1, 1)}, {{0, 0, 1, 0}, {1, 0, 0, 0}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_EQ(layout.quality.feedbacks, 1U);
  EXPECT_EQ(layout.quality.bends, 4U);
  EXPECT_EQ(layout.quality.crossings, 0U);
}

TEST(Layout, ABlockMayFeedItself) {
  const LayoutGraph graph{{plain_box(2, 1)}, {{0, 0, 0, 1}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_EQ(layout.quality.feedbacks, 1U);
}

//   a ─┬─► b
//      └─► c      one junction, one wire up to it
TEST(Layout, WiresFromOneOutputShareTheirWay) {
  const LayoutGraph graph{{plain_box(0, 1), plain_box(1, 0), plain_box(1, 0)}, {{0, 0, 1, 0}, {0, 0, 2, 0}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  ASSERT_EQ(layout.nets.size(), 1U);
  EXPECT_EQ(layout.nets[0].junctions.size(), 1U);
}

// Inputs in the opposite order of the sources: the sources are turned round, so nothing crosses.
TEST(Layout, SourcesStandInTheOrderOfThePins) {
  const LayoutGraph graph{{plain_box(0, 1), plain_box(0, 1), plain_box(0, 1), plain_box(3, 0)},
                          {{0, 0, 3, 2}, {1, 0, 3, 1}, {2, 0, 3, 0}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_EQ(layout.quality.crossings, 0U);
  EXPECT_GT(layout.corners[0].y(), layout.corners[1].y());
}

// Two boxes exchange their signals crosswise: a circle of constraints in the channel.
TEST(Layout, CrossedPairsFindTheirWay) {
  const LayoutGraph graph{{plain_box(0, 2), plain_box(2, 0)}, {{0, 0, 1, 1}, {0, 1, 1, 0}}};
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  EXPECT_EQ(layout.quality.crossings, 1U);
}

TEST(Layout, TerminalsStandAtTheEdges) {
  LayoutGraph graph{{plain_box(0, 1), plain_box(1, 1), plain_box(1, 1), plain_box(1, 0)},
                    {{0, 0, 2, 0}, {1, 0, 2, 0}, {2, 0, 3, 0}}};
  graph.wires[1] = {2, 0, 1, 0};
  graph.nodes[0].rank = LayoutRank::first;
  graph.nodes[3].rank = LayoutRank::last;
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  for (const std::size_t v : {1U, 2U}) {
    EXPECT_LT(layout.corners[0].x() + 64, layout.corners[v].x());
    EXPECT_GT(layout.corners[3].x(), layout.corners[v].x() + 64);
  }
}

//           in ──┐
//   a ──► b ──► c      terminals stand at the edges wherever their wires lead, whichever has the first number
//   └──► out
TEST(Layout, LayersDoNotDependOnTheNumbersOfTheBoxes) {
  for (std::size_t shift = 0; shift < 5; ++shift) {
    const auto number = [&](std::size_t place) { return (place + shift) % 5; };
    const std::size_t in = number(0), a = number(1), b = number(2), c = number(3), out = number(4);
    LayoutGraph graph;
    graph.nodes.assign(5, plain_box(2, 1));
    graph.nodes[in] = plain_box(0, 1);
    graph.nodes[in].rank = LayoutRank::first;
    graph.nodes[out] = plain_box(1, 0);
    graph.nodes[out].rank = LayoutRank::last;
    graph.wires = {{a, 0, b, 0}, {b, 0, c, 0}, {in, 0, c, 1}, {a, 0, out, 0}};
    const std::vector<std::size_t> layers = layered::assign_layers(graph);
    for (std::size_t place = 0; place < 5; ++place) EXPECT_EQ(layers[number(place)], place) << shift;
  }
}

//   a ──► b ──► c ──► d      the wide w stands below c, the only one as wide
//   └───────► w ──────┘
TEST(Layout, WideBoxesStandInOneLayer) {
  for (std::size_t shift = 0; shift < 5; ++shift) {
    const auto number = [&](std::size_t place) { return (place + shift) % 5; };
    LayoutGraph graph;
    graph.nodes.assign(5, plain_box(2, 1));
    const std::size_t a = number(0), b = number(1), c = number(2), d = number(3), w = number(4);
    for (const std::size_t wide : {c, w}) graph.nodes[wide].size.x() = 400;
    graph.wires = {{a, 0, b, 0}, {b, 0, c, 0}, {c, 0, d, 0}, {a, 0, w, 0}, {w, 0, d, 1}};
    const std::vector<std::size_t> layers = layered::assign_layers(graph);
    EXPECT_EQ(layers[c], 2U) << shift;
    EXPECT_EQ(layers[w], 2U) << shift;
  }
}

TEST(Layout, NothingGivesNothing) {
  EXPECT_TRUE(lay_out({}).corners.empty());
}

// Any wiring at all: boxes apart, wires orthogonal, beside the boxes and never on each other, ends connected.
TEST(Layout, RandomGraphsAreSound) {
  std::mt19937 random(7);
  const auto draw = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (int round = 0; round < 150; ++round) {
    LayoutGraph graph;
    const std::size_t n = 2 + draw(25);
    for (std::size_t v = 0; v < n; ++v) graph.nodes.push_back(plain_box(1 + draw(4), 1 + draw(2)));
    for (std::size_t v = 0; v < n; ++v) {
      for (std::size_t k = 0; k < graph.nodes[v].inputs.size(); ++k) {
        if (draw(5) == 0) continue;
        const std::size_t from = draw(n);
        graph.wires.push_back({from, draw(graph.nodes[from].outputs.size()), v, k});
      }
    }
    const DiagramLayout layout = lay_out(graph);
    expect_sound(graph, layout);
    if (HasFailure()) FAIL() << "round " << round;
  }
}

// So many crossing wires that channels hold several circles of constraints at once, beside wires that merely
// wait.
TEST(Layout, DenseGraphsAreSound) {
  std::mt19937 random(7);
  const auto draw = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (int round = 0; round < 20; ++round) {
    LayoutGraph graph;
    const std::size_t n = 2 + draw(60);
    for (std::size_t v = 0; v < n; ++v) graph.nodes.push_back(plain_box(1 + draw(5), 1 + draw(3)));
    for (std::size_t v = 0; v < n; ++v) {
      for (std::size_t k = 0; k < graph.nodes[v].inputs.size(); ++k) {
        const std::size_t from = draw(n);
        graph.wires.push_back({from, draw(graph.nodes[from].outputs.size()), v, k});
      }
    }
    const DiagramLayout layout = lay_out(graph);
    expect_sound(graph, layout);
    if (HasFailure()) FAIL() << "round " << round;
  }
}

TEST(Layout, IsTheSameEveryTime) {
  LayoutGraph graph;
  for (int v = 0; v < 30; ++v) graph.nodes.push_back(plain_box(2, 1));
  for (std::size_t v = 0; v < 30; ++v) graph.wires.push_back({(7 * v + 3) % 30, 0, v, v % 2});
  const DiagramLayout one = lay_out(graph), two = lay_out(graph);
  EXPECT_EQ(one.corners, two.corners);
}

// Node 0 feeds a knot of loops whose node 1 gives more than it takes. Wires that close loops run back, and
// not the one from the source: neither where the knot beside it, in which the signals are followed the wrong
// way round, is at its best.
TEST(Layout, ASourceStandsBeforeTheLoopsThatItFeeds) {
  LayoutGraph graph;
  graph.nodes = {plain_box(0, 1), plain_box(2, 4), plain_box(1, 1), plain_box(1, 1), plain_box(1, 1),
                 plain_box(1, 1), plain_box(4, 1), plain_box(1, 1), plain_box(1, 1)};
  graph.wires = {{0, 0, 1, 0}, {6, 0, 1, 1}, {7, 0, 8, 0, 1}, {8, 0, 7, 0, 5}};
  for (std::size_t k = 0; k < 4; ++k) {
    graph.wires.push_back({1, k, 2 + k, 0});
    graph.wires.push_back({2 + k, 0, 6, k});
  }
  const std::vector<std::size_t> layers = layered::assign_layers(graph);
  EXPECT_LT(layers[8], layers[7]);
  EXPECT_LT(layers[0], layers[1]);
  EXPECT_LT(layers[1], layers[6]);
}

// A chain of boxes, wider than 2400 px, that are a third as high as it is wide.
TEST(Layout, AStripThreeTimesAsWideAsHighIsBrokenIntoRows) {
  const auto chain = [](std::size_t n, double height) {
    LayoutGraph graph;
    for (std::size_t k = 0; k < n; ++k) {
      graph.nodes.push_back(plain_box(k > 0 ? 1 : 0, k + 1 < n ? 1 : 0));
      graph.nodes.back().size.y() = height;
      if (k > 0) graph.wires.push_back({k - 1, 0, k, 0});
    }
    return graph;
  };
  const DiagramLayout pair = lay_out(chain(2, 80));
  const double pitch = pair.corners[1].x() - pair.corners[0].x();
  const auto n = static_cast<std::size_t>(2500 / pitch) + 2;
  const double width = pitch * static_cast<double>(n - 1) + 64;
  const double height = kLayoutGrid * std::round(width / 3 / kLayoutGrid);
  const LayoutGraph graph = chain(n, height);
  const DiagramLayout layout = lay_out(graph);
  expect_sound(graph, layout);
  std::set<double> rows;
  double right = 0;
  for (const Eigen::Vector2d& corner : layout.corners) {
    rows.insert(corner.y());
    right = std::max(right, corner.x() + 64);
  }
  EXPECT_EQ(rows.size(), 2U);
  EXPECT_LT(right, 0.7 * width);
}

}  // namespace
}  // namespace oblique::draw
