// SPDX-License-Identifier: MIT
#include <oblique/network/graph/expression_graph.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "../support/naive_value.h"

namespace oblique::network {
namespace {

using testing::naive_value;

class ExpressionGraphTest : public ::testing::Test {
 protected:
  ExpressionGraph g;
  NodeId x = g.variable(0);
  NodeId y = g.variable(1);
  NodeId zero = g.constant(0);
  NodeId one = g.constant(1);
  NodeId two = g.constant(2);
};

TEST_F(ExpressionGraphTest, SharesEqualExpressions) {
  EXPECT_EQ(g.variable(0), x);
  EXPECT_NE(x, y);
  EXPECT_EQ(g.constant(2), two);
  EXPECT_EQ(g.constant(-0.0), zero);
  EXPECT_EQ(g.apply(Op::sin, x), g.apply(Op::sin, x));
  EXPECT_NE(g.apply(Op::sin, x), g.apply(Op::cos, x));
  EXPECT_NE(g.apply(Op::sin, x), g.apply(Op::sin, y));
  EXPECT_EQ(g.apply(Op::add, x, y), g.apply(Op::add, y, x));
  EXPECT_EQ(g.apply(Op::multiply, x, y), g.apply(Op::multiply, y, x));
  EXPECT_EQ(g.apply(Op::hypot, x, y), g.apply(Op::hypot, y, x));
}

TEST_F(ExpressionGraphTest, KeepsTheOrderOfWhatDoesNotCommute) {
  for (const Op op : {Op::subtract, Op::divide, Op::power, Op::atan2}) {
    EXPECT_NE(g.apply(op, x, y), g.apply(op, y, x));
  }
}

TEST_F(ExpressionGraphTest, FoldsConstants) {
  const NodeId folded = g.apply(Op::sqrt, g.apply(Op::multiply, two, g.apply(Op::add, two, g.constant(6))));
  EXPECT_TRUE(g.is_constant(folded, 4));
  EXPECT_TRUE(g.is_constant(g.apply(Op::power, two, g.constant(10)), 1024));
  EXPECT_TRUE(std::isinf(g[g.apply(Op::divide, one, zero)].value));
}

TEST_F(ExpressionGraphTest, DropsNeutralOperands) {
  EXPECT_EQ(g.apply(Op::add, x, zero), x);
  EXPECT_EQ(g.apply(Op::add, zero, x), x);
  EXPECT_EQ(g.apply(Op::subtract, x, zero), x);
  EXPECT_EQ(g.apply(Op::subtract, x, x), zero);
  EXPECT_EQ(g.apply(Op::multiply, one, x), x);
  EXPECT_EQ(g.apply(Op::multiply, x, one), x);
  EXPECT_EQ(g.apply(Op::multiply, x, zero), zero);
  EXPECT_EQ(g.apply(Op::divide, x, one), x);
  EXPECT_EQ(g.apply(Op::divide, zero, x), zero);
  EXPECT_EQ(g.apply(Op::power, x, one), x);
  EXPECT_EQ(g.apply(Op::power, x, zero), one);
  EXPECT_EQ(g.apply(Op::power, x, two), g.apply(Op::multiply, x, x));
}

TEST_F(ExpressionGraphTest, MovesSignsOutward) {
  const NodeId minus_x = g.apply(Op::negate, x);
  const NodeId difference = g.apply(Op::subtract, y, x);
  EXPECT_EQ(g.apply(Op::negate, minus_x), x);
  EXPECT_EQ(g.apply(Op::subtract, zero, x), minus_x);
  EXPECT_EQ(g.apply(Op::multiply, x, g.constant(-1)), minus_x);
  EXPECT_EQ(g.apply(Op::add, y, minus_x), difference);
  EXPECT_EQ(g.apply(Op::add, minus_x, y), difference);
  EXPECT_EQ(g.apply(Op::subtract, y, minus_x), g.apply(Op::add, x, y));
  EXPECT_EQ(g.apply(Op::negate, difference), g.apply(Op::subtract, x, y));
  EXPECT_EQ(g.apply(Op::multiply, minus_x, g.apply(Op::negate, y)), g.apply(Op::multiply, x, y));
}

TEST_F(ExpressionGraphTest, CollectsConstantFactors) {
  const NodeId three_times_twice = g.apply(Op::multiply, g.constant(3), g.apply(Op::multiply, x, two));
  EXPECT_EQ(three_times_twice, g.apply(Op::multiply, g.constant(6), x));
}

TEST_F(ExpressionGraphTest, LeavesZeroPartialsOut) {
  EXPECT_TRUE(g.gradient(two).empty());
  const auto partials = g.gradient(g.apply(Op::subtract, g.apply(Op::add, x, y), x));
  ASSERT_EQ(partials.size(), 1U);
  EXPECT_EQ(partials[0].first, 1U);
  EXPECT_TRUE(g.is_constant(partials[0].second, 1));
}

/// Partial derivatives from a table of formulas, at a = 0.6, b = 0.8.
struct Formula {
  const char* name;
  Op op;
  double value, by_a, by_b;
};

constexpr double kA = 0.6;
constexpr double kB = 0.8;

// a² + b² = 1, √(1 − a²) = 0.8: most of these are rational.
// clang-format off
const std::array kFormulas{
    Formula{"add", Op::add, 1.4, 1, 1},
    Formula{"subtract", Op::subtract, -0.2, 1, -1},
    Formula{"multiply", Op::multiply, 0.48, 0.8, 0.6},
    Formula{"divide", Op::divide, 0.75, 1.25, -0.9375},
    Formula{"power", Op::power, std::pow(kA, kB), kB * std::pow(kA, kB - 1), std::pow(kA, kB) * std::log(kA)},
    Formula{"negate", Op::negate, -0.6, -1, 0},
    Formula{"sin", Op::sin, std::sin(kA), std::cos(kA), 0},
    Formula{"cos", Op::cos, std::cos(kA), -std::sin(kA), 0},
    Formula{"tan", Op::tan, std::tan(kA), 1 / (std::cos(kA) * std::cos(kA)), 0},
    Formula{"asin", Op::asin, std::asin(kA), 1.25, 0},
    Formula{"acos", Op::acos, std::acos(kA), -1.25, 0},
    Formula{"atan", Op::atan, std::atan(kA), 1 / 1.36, 0},
    Formula{"atan2", Op::atan2, std::atan2(kA, kB), 0.8, -0.6},
    Formula{"exp", Op::exp, std::exp(kA), std::exp(kA), 0},
    Formula{"log", Op::log, std::log(kA), 1 / kA, 0},
    Formula{"sqrt", Op::sqrt, std::sqrt(kA), 0.5 / std::sqrt(kA), 0},
    Formula{"hypot", Op::hypot, 1, 0.6, 0.8},
};
// clang-format on

TEST_F(ExpressionGraphTest, DifferentiatesEveryOperation) {
  const std::array point{kA, kB};
  // Each formula is a handful of roundings from the exact value.
  constexpr double kRounding = 1e-15;
  constexpr std::size_t kNoise = 2;  // it and its derivative, which noise_test holds
  EXPECT_EQ(kFormulas.size() + kNoise, text::operations().size()) << "an operation has no formula here";
  for (const Formula& formula : kFormulas) {
    const NodeId node = g.apply(formula.op, x, y);
    EXPECT_NEAR(naive_value(g, node, point), formula.value, kRounding) << formula.name;
    EXPECT_NEAR(evaluate(formula.op, kA, kB), formula.value, kRounding) << formula.name;
    std::array<double, 2> found{0, 0};
    for (const auto& [variable, partial] : g.gradient(node)) found[variable] = naive_value(g, partial, point);
    EXPECT_NEAR(found[0], formula.by_a, 4 * kRounding) << formula.name;
    EXPECT_NEAR(found[1], formula.by_b, 4 * kRounding) << formula.name;
  }
}

TEST_F(ExpressionGraphTest, HoldsEveryOperationOfTheTable) {
  for (const text::OperationInfo& info : text::operations()) {
    const Op op = op_of(info.operation);
    EXPECT_EQ(smooth_operation(op), info.operation) << info.name;
    EXPECT_EQ(operand_count(op), info.operands) << info.name;
    const Node node = g[g.apply(op, x, y)];
    EXPECT_EQ(node.op, op) << info.name;
    EXPECT_EQ(node.operand(0), x) << info.name;
  }
  for (const Op op :
       {Op::constant, Op::variable, Op::discrete_state, Op::select, Op::gate, Op::less, Op::table_value})
    EXPECT_EQ(smooth_operation(op), std::nullopt) << static_cast<int>(op);
}

TEST_F(ExpressionGraphTest, CountsEveryOccurrenceOfAVariable) {
  // the product rule: x³ sin x → 3x² sin x + x³ cos x
  const NodeId cube = g.apply(Op::power, x, g.constant(3));
  const auto partials = g.gradient(g.apply(Op::multiply, cube, g.apply(Op::sin, x)));
  ASSERT_EQ(partials.size(), 1U);
  const std::array point{0.7, 0.0};
  EXPECT_NEAR(naive_value(g, partials[0].second, point), 3 * 0.49 * std::sin(0.7) + 0.343 * std::cos(0.7),
              1e-15);
}

// Random smooth expressions, built twice: as a graph, and as a function of long doubles that knows no graph.

using Triple = std::array<long double, 3>;
using Smooth = std::function<long double(const Triple&)>;

struct Twin {
  NodeId node;
  Smooth value;
};

class Gardener {
 public:
  explicit Gardener(ExpressionGraph& graph) : g(graph) {}

  /// Every operation; arguments are kept where it is smooth.
  Twin grow(int depth) {
    if (depth == 0) return leaf();
    const Twin a = grow(depth - 1);
    const Twin b = *rc::gen::arbitrary<bool>() ? grow(depth - 1) : leaf();
    const NodeId sine = g.apply(Op::sin, b.node);
    const Smooth f = a.value, h = b.value;
    const Smooth s = [h](const Triple& v) { return std::sin(h(v)); };
    const Twin above{g.apply(Op::add, sine, g.constant(2)), [s](const Triple& v) { return 2 + s(v); }};
    const Twin inside{g.apply(Op::multiply, sine, g.constant(0.5)),
                      [s](const Triple& v) { return s(v) / 2; }};
    const Smooth p = above.value, q = inside.value;
    using V = const Triple&;
    // clang-format off
    switch (*rc::gen::inRange(0, 17)) {
      case 0: return {g.apply(Op::add, a.node, b.node), [=](V v) { return f(v) + h(v); }};
      case 1: return {g.apply(Op::subtract, a.node, b.node), [=](V v) { return f(v) - h(v); }};
      case 2: return {g.apply(Op::multiply, a.node, b.node), [=](V v) { return f(v) * h(v); }};
      case 3: return {g.apply(Op::divide, a.node, above.node), [=](V v) { return f(v) / p(v); }};
      case 4: return {g.apply(Op::power, above.node, inside.node), [=](V v) { return std::pow(p(v), q(v)); }};
      case 5: return {g.apply(Op::negate, a.node), [=](V v) { return -f(v); }};
      case 6: return {g.apply(Op::sin, a.node), [=](V v) { return std::sin(f(v)); }};
      case 7: return {g.apply(Op::cos, a.node), [=](V v) { return std::cos(f(v)); }};
      case 8: return {g.apply(Op::tan, inside.node), [=](V v) { return std::tan(q(v)); }};
      case 9: return {g.apply(Op::asin, inside.node), [=](V v) { return std::asin(q(v)); }};
      case 10: return {g.apply(Op::acos, inside.node), [=](V v) { return std::acos(q(v)); }};
      case 11: return {g.apply(Op::atan, a.node), [=](V v) { return std::atan(f(v)); }};
      case 12: return {g.apply(Op::atan2, a.node, above.node), [=](V v) { return std::atan2(f(v), p(v)); }};
      case 13: return {g.apply(Op::exp, inside.node), [=](V v) { return std::exp(q(v)); }};
      case 14: return {g.apply(Op::log, above.node), [=](V v) { return std::log(p(v)); }};
      case 15: return {g.apply(Op::sqrt, above.node), [=](V v) { return std::sqrt(p(v)); }};
      default: return {g.apply(Op::hypot, a.node, above.node), [=](V v) { return std::hypot(f(v), p(v)); }};
    }
    // clang-format on
  }

 private:
  Twin leaf() {
    const auto which = *rc::gen::inRange<std::uint32_t>(0, 4);
    if (which < 3) return {g.variable(which), [which](const Triple& v) { return v[which]; }};
    const double c = *rc::gen::inRange(-3, 4);
    return {g.constant(c), [c](const Triple&) { return static_cast<long double>(c); }};
  }

  ExpressionGraph& g;
};

RC_GTEST_PROP(ExpressionGraph, GradientsAgreeWithCentralDifferences, ()) {
  ExpressionGraph g;
  const Twin twin = Gardener(g).grow(*rc::gen::inRange(1, 5));
  std::array<double, 3> point{};
  Triple wide{};
  for (std::size_t i = 0; i < 3; ++i) wide[i] = point[i] = *rc::gen::inRange(-1000, 1001) / 1000.0;

  const auto value = static_cast<double>(twin.value(wide));
  RC_ASSERT(std::abs(naive_value(g, twin.node, point) - value) <= 1e-12 * (1 + std::abs(value)));

  std::array<double, 3> found{};
  for (const auto& [variable, partial] : g.gradient(twin.node))
    found[variable] = naive_value(g, partial, point);
  for (std::size_t i = 0; i < 3; ++i) {
    // Truncation is h² f‴/6; with long doubles rounding is 1e-19/h. f‴ of products four deep may reach 1e5.
    constexpr long double kStep = 1e-6L;
    Triple left = wide, right = wide;
    left[i] -= kStep;
    right[i] += kStep;
    const auto derivative = static_cast<double>((twin.value(right) - twin.value(left)) / (2 * kStep));
    RC_ASSERT(std::abs(found[i] - derivative) <= 1e-7 * (1 + std::abs(derivative)));
  }
}

}  // namespace
}  // namespace oblique::network
