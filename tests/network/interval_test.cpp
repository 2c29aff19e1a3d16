// SPDX-License-Identifier: MIT
#include <oblique/network/graph/interval.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <oblique/text/expression.h>
#include <oblique/text/noise.h>

#include "../support/naive_value.h"

namespace oblique::network {
namespace {

using testing::naive_value;

/// The range of a node where the variables lie in these intervals.
Interval range_of(const ExpressionGraph& graph, NodeId root, std::span<const Interval> variables) {
  TapeWriter writer(graph, variables.size(), 0, {}, std::vector<std::uint32_t>(graph.size(), 2));
  std::vector<NodeId> nodes(graph.size());
  std::iota(nodes.begin(), nodes.end(), NodeId{0});
  writer.write(nodes);
  const std::uint32_t slot = writer.slot(root);
  std::vector<Interval> slots;
  for (const double value : writer.initial_slots()) slots.push_back({value, value});
  std::copy(variables.begin(), variables.end(), slots.begin());
  run_tape(writer.instructions(), slots);
  return slots[slot];
}

TEST(Interval, AnAngleIsThatOfTheCornersUnlessItJumpsBetweenThem) {
  ExpressionGraph graph;
  const NodeId angle = graph.apply(Op::atan2, graph.variable(0), graph.variable(1));
  const auto of = [&](Interval y, Interval x) { return range_of(graph, angle, std::array{y, x}); };
  constexpr double kPi = std::numbers::pi;
  const Interval across_the_right = of({-1, 1}, {1, 2}), to_the_left = of({0, 1}, {-2, -1});
  EXPECT_DOUBLE_EQ(across_the_right.low, -kPi / 4);
  EXPECT_DOUBLE_EQ(across_the_right.high, kPi / 4);
  EXPECT_DOUBLE_EQ(to_the_left.low, 3 * kPi / 4);
  EXPECT_DOUBLE_EQ(to_the_left.high, kPi);
  for (const Interval& jumps : {of({-1, 1}, {-2, -1}), of({-1, 0}, {-2, -1}), of({-1, 1}, {-1, 1})}) {
    EXPECT_DOUBLE_EQ(jumps.low, -kPi);
    EXPECT_DOUBLE_EQ(jumps.high, kPi);
  }
}

TEST(Interval, ContainsTheValuesOfEveryOperation) {
  rc::check([&] {
    ExpressionGraph graph;
    const NodeId x = graph.variable(0), y = graph.variable(1);
    const auto number = [] { return *rc::gen::inRange(-4000, 4000) / 1000.0; };
    const double a = number(), b = number(), c = number(), d = number();
    const std::array box{Interval{std::min(a, b), std::max(a, b)}, Interval{std::min(c, d), std::max(c, d)}};
    const text::OperationInfo& info =
        text::operations()[*rc::gen::inRange<std::size_t>(0, text::operations().size())];
    const NodeId root = graph.apply(op_of(info.operation), x, y);
    const Interval range = range_of(graph, root, box);
    constexpr int kPoints = 7;
    for (int i = 0; i <= kPoints; ++i) {
      for (int k = 0; k <= kPoints; ++k) {
        const std::array point{box[0].low + box[0].width() * i / kPoints,
                               box[1].low + box[1].width() * k / kPoints};
        const double value = naive_value(graph, root, point);
        if (std::isnan(value)) continue;
        const double rounding = 1e-12 * (1 + std::abs(value));  // of the few operations of a point
        RC_ASSERT(value >= range.low - rounding);
        RC_ASSERT(value <= range.high + rounding);
      }
    }
  });
}

TEST(Interval, IsSharpForASingleOperation) {
  ExpressionGraph graph;
  const NodeId x = graph.variable(0);
  const std::array box{Interval{-1, 3}};
  const auto range = [&](NodeId root) { return range_of(graph, root, box); };
  const Interval square = range(graph.apply(Op::multiply, x, x));
  EXPECT_EQ(square.low, 0);
  EXPECT_EQ(square.high, 9);
  const Interval sine = range(graph.apply(Op::sin, x));
  EXPECT_DOUBLE_EQ(sine.low, std::sin(-1));
  EXPECT_EQ(sine.high, 1);
  const Interval cosine = range(graph.apply(Op::cos, x));
  EXPECT_DOUBLE_EQ(cosine.low, std::cos(3));
  EXPECT_EQ(cosine.high, 1);
  // narrow, about a top and a bottom of the cosine
  const auto narrow = [&](double low, double high) {
    return range_of(graph, graph.apply(Op::cos, x), std::array{Interval{low, high}});
  };
  EXPECT_EQ(narrow(6.0, 6.5).high, 1);
  EXPECT_DOUBLE_EQ(narrow(6.0, 6.5).low, std::cos(6.0));
  EXPECT_EQ(narrow(2.9, 3.3).low, -1);
  EXPECT_DOUBLE_EQ(narrow(2.9, 3.3).high, std::cos(2.9));
  const Interval bell = range(graph.apply(Op::exp, graph.apply(Op::negate, graph.apply(Op::multiply, x, x))));
  EXPECT_DOUBLE_EQ(bell.low, std::exp(-9));
  EXPECT_EQ(bell.high, 1);
}

// [1, 2] and [2, 3] meet in one point, where they are equal.
TEST(Interval, ComparesWhatMeetsInAPoint) {
  ExpressionGraph graph;
  const NodeId x = graph.variable(0), y = graph.variable(1);
  const auto truth = [&](Op op, Interval a, Interval b) {
    const Interval range = range_of(graph, graph.apply(op, x, y), std::array{a, b});
    return std::pair(range.low, range.high);
  };
  const std::pair no(0.0, 0.0), perhaps(0.0, 1.0), yes(1.0, 1.0);
  const Interval low{1, 2}, high{2, 3}, point{2, 2}, far{4, 5};
  EXPECT_EQ(truth(Op::less, low, high), perhaps);
  EXPECT_EQ(truth(Op::less, high, low), no);
  EXPECT_EQ(truth(Op::less, low, far), yes);
  EXPECT_EQ(truth(Op::less, point, point), no);
  EXPECT_EQ(truth(Op::less_equal, low, high), yes);
  EXPECT_EQ(truth(Op::less_equal, high, low), perhaps);
  EXPECT_EQ(truth(Op::less_equal, far, low), no);
  EXPECT_EQ(truth(Op::less_equal, point, point), yes);
  EXPECT_EQ(truth(Op::equal, low, high), perhaps);
  EXPECT_EQ(truth(Op::equal, high, low), perhaps);
  EXPECT_EQ(truth(Op::equal, low, far), no);
  EXPECT_EQ(truth(Op::equal, far, low), no);
  EXPECT_EQ(truth(Op::equal, point, point), yes);
}

TEST(Interval, KnowsNothingWhereAnOperationHasNoValue) {
  ExpressionGraph graph;
  const NodeId x = graph.variable(0);
  const std::array box{Interval{-1, 3}};
  for (const NodeId root : {graph.apply(Op::divide, graph.constant(1), x), graph.apply(Op::log, x),
                            graph.apply(Op::sqrt, x), graph.apply(Op::tan, x)}) {
    EXPECT_EQ(range_of(graph, root, box).low, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(range_of(graph, root, box).high, std::numeric_limits<double>::infinity());
  }
}

TEST(Interval, ContainsNoiseThatItSamples) {
  ExpressionGraph graph;
  const NodeId root = graph.apply(Op::noise, graph.variable(0), graph.constant(3));
  for (int k = 0; k < 200; ++k) {
    const std::array box{Interval{0.17 * k, 0.17 * k + 0.2}};
    const Interval range = range_of(graph, root, box);
    for (int i = 0; i <= 20; ++i) {
      const double value = text::noise(box[0].low + 0.01 * i, 3, 0);
      EXPECT_GE(value, range.low) << k;
      EXPECT_LE(value, range.high) << k;
    }
  }
}

// Enclosures that are no wider than they need be: 1 … 4 to the power of ½, and of −½ … ½.
TEST(Interval, APowerIsThatOfTheCornersAndOfZero) {
  ExpressionGraph graph;
  const NodeId power = graph.apply(Op::power, graph.variable(0), graph.variable(1));
  const auto of = [&](Interval x, Interval y) { return range_of(graph, power, std::array{x, y}); };
  const Interval root = of({1, 4}, {0.5, 0.5}), both = of({1, 4}, {-0.5, 0.5});
  EXPECT_DOUBLE_EQ(root.low, 1);
  EXPECT_DOUBLE_EQ(root.high, 2);
  EXPECT_DOUBLE_EQ(both.low, 0.5);
  EXPECT_DOUBLE_EQ(both.high, 2);
  EXPECT_EQ(of({-1, 4}, {0.5, 0.5}).high, std::numeric_limits<double>::infinity());
  const Interval square = of({-2, 3}, {2, 2});  // over zero a whole power has its least there, or a pole
  EXPECT_EQ(square.low, 0);
  EXPECT_DOUBLE_EQ(square.high, 9);
  EXPECT_EQ(of({-2, 3}, {-2, -2}).high, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace oblique::network
