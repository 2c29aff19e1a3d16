// SPDX-License-Identifier: MIT
#include <oblique/text/expression_printer.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "expression_trees.h"

namespace oblique::text {
namespace {

using Kind = Expression::Kind;
using test::call, test::name, test::node, test::number, test::value_of;

std::string reprinted(std::string_view text) {
  return to_string(parse_expression(text));
}

TEST(ExpressionPrinter, UsesAsFewParenthesesAsItCan) {
  EXPECT_EQ(reprinted("((a))+(b*c)"), "a + b*c");
  EXPECT_EQ(reprinted("a-(b-c)"), "a - (b - c)");
  EXPECT_EQ(reprinted("(a-b)-c"), "a - b - c");
  EXPECT_EQ(reprinted("(-x)^2"), "(-x)^2");
  EXPECT_EQ(reprinted("-(x^2)"), "-x^2");
  EXPECT_EQ(reprinted("(2)^(-3)"), "2^-3");
  EXPECT_EQ(reprinted("(a^b)^c"), "(a^b)^c");
  EXPECT_EQ(reprinted("not (a and b)"), "not (a and b)");
  EXPECT_EQ(reprinted("not (a < b)"), "not a < b");
  EXPECT_EQ(reprinted("(a < b) < c"), "(a < b) < c");
  EXPECT_EQ(reprinted("min(a,b , 2*c)"), "min(a, b, 2*c)");
  EXPECT_EQ(to_string(node(Kind::negate, {number(2)})), "-(2)");
}

TEST(ExpressionPrinter, PrintsInfinityAsTheName) {
  EXPECT_EQ(to_string(number(std::numeric_limits<double>::infinity())), "inf");
  EXPECT_EQ(value_of("-inf"), -std::numeric_limits<double>::infinity());
}

rc::Gen<Expression> random_expression(int depth) {
  const auto leaf = rc::gen::oneOf(
      // All finite doubles, negative ones too.
      rc::gen::map(rc::gen::suchThat(rc::gen::arbitrary<double>(), [](double x) { return std::isfinite(x); }),
                   number),
      rc::gen::map(rc::gen::inRange(0, 10), [](int n) { return number(n); }),
      rc::gen::map(rc::gen::element<std::string>("x", "phi", "a.b", "tri.amp.out", "pi", "_1", "nota", "e5"),
                   name));
  if (depth == 0) return leaf;
  return rc::gen::oneOf(
      leaf,
      rc::gen::mapcat(rc::gen::element(Kind::negate, Kind::logical_not),
                      [=](Kind kind) {
                        return rc::gen::map(random_expression(depth - 1),
                                            [=](Expression a) { return node(kind, {std::move(a)}); });
                      }),
      rc::gen::mapcat(rc::gen::element(Kind::add, Kind::subtract, Kind::multiply, Kind::divide, Kind::power,
                                       Kind::less, Kind::less_equal, Kind::greater, Kind::greater_equal,
                                       Kind::equal, Kind::not_equal, Kind::logical_and, Kind::logical_or),
                      [=](Kind kind) {
                        return rc::gen::map(
                            rc::gen::pair(random_expression(depth - 1), random_expression(depth - 1)),
                            [=](std::pair<Expression, Expression> operands) {
                              return node(kind, {std::move(operands.first), std::move(operands.second)});
                            });
                      }),
      rc::gen::mapcat(rc::gen::inRange<std::size_t>(0, functions().size()), [=](std::size_t index) {
        const FunctionInfo& info = functions()[index];
        const std::size_t count = info.function == Function::table ? 5 : info.min_arguments;
        return rc::gen::map(
            rc::gen::container<std::vector<Expression>>(count, random_expression(depth - 1)),
            [&info](std::vector<Expression> operands) { return call(info.function, std::move(operands)); });
      }));
}

// The tree itself is the oracle, and equality of numbers is exact: the printer writes the shortest digits
// that round-trip.
RC_GTEST_PROP(ExpressionPrinter, IsReadBackUnchanged, ()) {
  const Expression expression = *random_expression(4);
  const std::string text = to_string(expression);
  RC_LOG(text);
  RC_ASSERT(parse_expression(text) == expression);
}

}  // namespace
}  // namespace oblique::text
