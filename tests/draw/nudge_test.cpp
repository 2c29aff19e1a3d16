// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/nudge.h>

#include <gtest/gtest.h>

namespace oblique::draw {
namespace {

constexpr double kRise = 2 * kLayoutGrid;

/// Three boxes in a row; the wire from the second to the third goes up by a step.
struct Row {
  LayoutGraph graph;
  DiagramLayout layout;

  Row() {
    LayoutNode node;
    node.size = {64, 64};
    node.inputs = node.outputs = {32};
    graph.nodes = {node, node, node};
    graph.wires = {{1, 0, 2, 0}};
    layout.corners = {{0, 64}, {160, 64 + kRise}, {320, 64}};
    const double low = 96 + kRise, high = 96;
    layout.nets = {
        {1, 0, {{{224, low}, {272, low}}, {{272, high}, {272, low}}, {{272, high}, {320, high}}}, {}}};
  }
};

TEST(Nudge, StraightensAWireBesideABoxThatStaysAtTheEdge) {
  Row row;
  row.graph.nodes[0].rank = LayoutRank::first;
  nudge(row.graph, row.layout, {400, 200});
  EXPECT_EQ(row.layout.corners[1].y(), row.layout.corners[2].y());
  ASSERT_EQ(row.layout.nets[0].pieces.size(), 1U);
  EXPECT_TRUE(row.layout.nets[0].pieces[0].horizontal());
}

TEST(Nudge, LeavesTerminalsWhereTheyStand) {
  Row row;
  for (LayoutNode& node : row.graph.nodes) node.rank = LayoutRank::last;
  nudge(row.graph, row.layout, {400, 200});
  EXPECT_EQ(row.layout.corners, Row().layout.corners);
}

// The grid of one trial has more points there, 1750 × 1750, than all trials may have together.
TEST(Nudge, TriesNothingWhereATrialIsTooMuchWork) {
  Row row;
  nudge(row.graph, row.layout, {1750 * kLayoutGrid, 1750 * kLayoutGrid});
  EXPECT_EQ(row.layout.corners, Row().layout.corners);
}

}  // namespace
}  // namespace oblique::draw
