// SPDX-License-Identifier: MIT
#include <oblique/network/program/tape.h>

#include <array>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "../support/naive_value.h"

namespace oblique::network {
namespace {

using testing::naive_value;

/// Who reads each node: the others of the graph, and the world outside for the roots.
std::vector<std::uint32_t> uses_of(const ExpressionGraph& g, const std::vector<NodeId>& roots) {
  std::vector<std::uint32_t> uses(g.size(), 0);
  for (NodeId id = 0; id < g.size(); ++id) {
    if (operand_count(g[id].op) >= 1) ++uses[g[id].a];
    if (operand_count(g[id].op) == 2) ++uses[g[id].b];
  }
  for (const NodeId root : roots) ++uses[root];
  return uses;
}

std::vector<NodeId> all_of(const ExpressionGraph& g) {
  std::vector<NodeId> nodes(g.size());
  std::iota(nodes.begin(), nodes.end(), NodeId{0});
  return nodes;
}

/// The slots after a run of everything written, with these values of the variables.
std::vector<double> run_all(const TapeWriter& writer, std::span<const double> variables) {
  std::vector<double> slots = writer.initial_slots();
  std::copy(variables.begin(), variables.end(), slots.begin());
  run_tape(writer.instructions(), slots.data());
  return slots;
}

constexpr std::array kPoint{0.5, 0.25, -0.75};

class TapeTest : public ::testing::Test {
 protected:
  ExpressionGraph g;
  NodeId x = g.variable(0), y = g.variable(1), z = g.variable(2);
  NodeId xy = g.apply(Op::multiply, x, y);

  /// The value of `root` by a tape on which the whole graph stands, with `roots` read from outside.
  double value(NodeId root, const std::vector<NodeId>& roots, std::size_t expected_instructions) {
    TapeWriter writer(g, 3, 0, {}, uses_of(g, roots));
    writer.write(all_of(g));
    const std::uint32_t slot = writer.slot(root);
    EXPECT_EQ(writer.instructions().size(), expected_instructions);
    return run_all(writer, kPoint)[slot];
  }
};

// x = 1/2, y = 1/4, z = −3/4 and all results are exact in binary.

TEST_F(TapeTest, FusesAProductIntoTheSumThatAloneReadsIt) {
  const NodeId sum = g.apply(Op::add, xy, z);
  EXPECT_EQ(value(sum, {sum}, 1), -0.625);
}

TEST_F(TapeTest, FusesASubtractedProduct) {
  const NodeId difference = g.apply(Op::subtract, z, xy);
  EXPECT_EQ(value(difference, {difference}, 1), -0.875);
}

TEST_F(TapeTest, DoesNotFuseAProductThatIsSubtractedFrom) {
  const NodeId difference = g.apply(Op::subtract, xy, z);
  EXPECT_EQ(value(difference, {difference}, 2), 0.875);
}

TEST_F(TapeTest, FusesOneOfTwoProducts) {
  const NodeId sum = g.apply(Op::add, xy, g.apply(Op::multiply, y, z));
  EXPECT_EQ(value(sum, {sum}, 2), -0.0625);
}

TEST_F(TapeTest, KeepsAProductThatTwoSumsRead) {
  const NodeId sum = g.apply(Op::add, xy, z);
  const NodeId difference = g.apply(Op::subtract, z, xy);
  EXPECT_EQ(value(sum, {sum, difference}, 3), -0.625);
  EXPECT_EQ(value(difference, {sum, difference}, 3), -0.875);
}

TEST_F(TapeTest, KeepsAProductThatIsReadFromOutside) {
  const NodeId sum = g.apply(Op::add, xy, z);
  EXPECT_EQ(value(xy, {sum, xy}, 2), 0.125);
}

TEST_F(TapeTest, KeepsAProductThatOneSumReadsTwice) {
  const NodeId twice = g.apply(Op::add, xy, xy);
  EXPECT_EQ(value(twice, {twice}, 2), 0.25);
}

TEST_F(TapeTest, DoesNotFuseAcrossSegments) {
  // Where the second segment runs more often than the first, the product is there already.
  const NodeId sum = g.apply(Op::add, xy, z);
  TapeWriter writer(g, 3, 0, {}, uses_of(g, {sum}));
  const TapeRange first = writer.write(std::array{xy});
  const TapeRange second = writer.write(std::array{sum});
  EXPECT_EQ(first.end, 1U);
  EXPECT_EQ(second.begin, 1U);
  EXPECT_EQ(second.end, 2U);
  EXPECT_EQ(writer.instructions()[0].code, Instruction::Code::multiply);
  EXPECT_EQ(writer.instructions()[1].code, Instruction::Code::add);
  const std::uint32_t slot = writer.slot(sum);
  EXPECT_EQ(run_all(writer, kPoint)[slot], -0.625);
}

TEST(Tape, RunsEveryOperation) {
  const std::array point{0.6, 0.8};
  for (const text::OperationInfo& info : text::operations()) {
    ExpressionGraph g;
    const NodeId a = g.variable(0), b = g.variable(1);
    const NodeId root = g.apply(op_of(info.operation), a, b);
    TapeWriter writer(g, 2, 0, {}, uses_of(g, {root}));
    writer.write(all_of(g));
    const std::uint32_t slot = writer.slot(root);
    EXPECT_EQ(run_all(writer, point)[slot], naive_value(g, root, point)) << info.name;
  }
}

RC_GTEST_PROP(Tape, GivesWhatTheGraphMeans, ()) {
  ExpressionGraph g;
  std::vector<NodeId> pool{g.variable(0), g.variable(1), g.variable(2), g.constant(0.5), g.constant(-3)};
  const int n = *rc::gen::inRange(1, 40);
  for (int i = 0; i < n; ++i) {
    const auto op =
        *rc::gen::elementOf(std::vector{Op::add, Op::subtract, Op::multiply, Op::multiply, Op::sin});
    const NodeId a = *rc::gen::elementOf(pool);
    const NodeId b = *rc::gen::elementOf(pool);
    pool.push_back(g.apply(op, a, b));
    if (std::abs(naive_value(g, pool.back(), kPoint)) > 100) pool.pop_back();
  }
  std::vector<NodeId> roots{pool.back()};
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) roots.push_back(*rc::gen::elementOf(pool));

  TapeWriter writer(g, 3, 0, {}, uses_of(g, roots));
  const std::vector<NodeId> nodes = all_of(g);
  const auto cut = static_cast<std::ptrdiff_t>(*rc::gen::inRange<std::size_t>(0, nodes.size() + 1));
  writer.write(std::span(nodes).first(static_cast<std::size_t>(cut)));
  writer.write(std::span(nodes).subspan(static_cast<std::size_t>(cut)));
  std::vector<std::uint32_t> slots;
  for (const NodeId root : roots) slots.push_back(writer.slot(root));
  const std::vector<double> values = run_all(writer, kPoint);
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const double naive = naive_value(g, roots[i], kPoint);
    // A machine that fuses multiply-add in hardware rounds once less: one ulp of at most 1e4 a step.
    RC_ASSERT(std::abs(values[slots[i]] - naive) <= 1e-10);
  }
}

}  // namespace
}  // namespace oblique::network
