// SPDX-License-Identifier: MIT
#include <oblique/text/expression_parser.h>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "expression_trees.h"

namespace oblique::text {
namespace {

using Kind = Expression::Kind;
using test::call, test::message_of, test::name, test::node, test::number, test::value_of;

// The tree each text must give is built by hand: the oracle of precedence and of grouping.

TEST(ExpressionParser, BindsProductsTighterThanSums) {
  EXPECT_EQ(parse_expression("a+b*c"),
            node(Kind::add, {name("a"), node(Kind::multiply, {name("b"), name("c")})}));
  EXPECT_EQ(parse_expression("(a+b)*c"),
            node(Kind::multiply, {node(Kind::add, {name("a"), name("b")}), name("c")}));
}

TEST(ExpressionParser, GroupsToTheLeftExceptPowers) {
  EXPECT_EQ(parse_expression("a-b-c"),
            node(Kind::subtract, {node(Kind::subtract, {name("a"), name("b")}), name("c")}));
  EXPECT_EQ(parse_expression("a/b/c"),
            node(Kind::divide, {node(Kind::divide, {name("a"), name("b")}), name("c")}));
  EXPECT_EQ(parse_expression("a^b^c"),
            node(Kind::power, {name("a"), node(Kind::power, {name("b"), name("c")})}));
}

TEST(ExpressionParser, MinusBindsLooserThanPowers) {
  EXPECT_EQ(parse_expression("-x^2"), node(Kind::negate, {node(Kind::power, {name("x"), number(2)})}));
  EXPECT_EQ(parse_expression("-2^2"), node(Kind::negate, {node(Kind::power, {number(2), number(2)})}));
  EXPECT_EQ(parse_expression("2^-3"), node(Kind::power, {number(2), number(-3)}));
  EXPECT_EQ(parse_expression("2^-x^2"),
            node(Kind::power, {number(2), node(Kind::negate, {node(Kind::power, {name("x"), number(2)})})}));
  EXPECT_EQ(parse_expression("a*-b"), node(Kind::multiply, {name("a"), node(Kind::negate, {name("b")})}));
}

TEST(ExpressionParser, AMinusBeforeALoneNumberBelongsToIt) {
  EXPECT_EQ(parse_expression("-2"), number(-2));
  EXPECT_EQ(parse_expression("- 2*abc"), node(Kind::multiply, {number(-2), name("abc")}));
  EXPECT_EQ(parse_expression("-(2)"), node(Kind::negate, {number(2)}));
  EXPECT_EQ(parse_expression("--2"), node(Kind::negate, {number(-2)}));
  EXPECT_EQ(parse_expression("+2"), number(2));
}

TEST(ExpressionParser, ReadsLogicBelowComparisonsBelowSums) {
  const Expression less = node(Kind::less, {node(Kind::add, {name("a"), number(1)}), name("b")});
  const Expression negated = node(Kind::logical_not, {node(Kind::greater_equal, {name("c"), name("d")})});
  EXPECT_EQ(parse_expression("a + 1 < b and not c >= d or e == f"),
            node(Kind::logical_or,
                 {node(Kind::logical_and, {less, negated}), node(Kind::equal, {name("e"), name("f")})}));
  EXPECT_EQ(parse_expression("a<=b").kind, Kind::less_equal);
  EXPECT_EQ(parse_expression("a>b").kind, Kind::greater);
  EXPECT_EQ(parse_expression("a!=b").kind, Kind::not_equal);
}

TEST(ExpressionParser, WordsAreOperatorsOnlyWhenWhole) {
  EXPECT_EQ(parse_expression("orbit"), name("orbit"));
  EXPECT_EQ(parse_expression("android*nothing"), node(Kind::multiply, {name("android"), name("nothing")}));
}

TEST(ExpressionParser, NamesMayBePaths) {
  EXPECT_EQ(parse_expression("tri.amp.out"), name("tri.amp.out"));
  EXPECT_EQ(parse_expression("a.b*2"), node(Kind::multiply, {name("a.b"), number(2)}));
  EXPECT_EQ(message_of("a."), "2: '.' does not belong here; expected an operator or the end");
  EXPECT_EQ(message_of("a.1"), "2: '.1' does not belong here; expected an operator or the end");
  EXPECT_EQ(message_of("a..b"), "2: '..b' does not belong here; expected an operator or the end");
}

TEST(ExpressionParser, ReadsCallsAndNumbers) {
  EXPECT_EQ(parse_expression("atan2(y, x)"), call(Function::atan2, {name("y"), name("x")}));
  EXPECT_EQ(parse_expression("if (a < b, 1, 2)").function, Function::if_);
  EXPECT_EQ(parse_expression(".5e1"), number(5));
  EXPECT_EQ(parse_expression(" 1.25E-2\t\r\n"), number(0.0125));
  EXPECT_EQ(parse_expression("5."), number(5));
}

TEST(ExpressionParser, PrefixStopsBeforeAUnit) {
  std::size_t rest = 0;
  EXPECT_EQ(parse_expression_prefix("30 deg", rest), number(30));
  EXPECT_EQ(rest, 3U);
  EXPECT_EQ(parse_expression_prefix("1/2 s", rest), node(Kind::divide, {number(1), number(2)}));
  EXPECT_EQ(rest, 4U);
}

TEST(ExpressionParser, ColumnsPointAtTheOperator) {
  const Expression e = parse_expression("ab + -cd*3");
  EXPECT_EQ(e.column, 4);
  EXPECT_EQ(e.operands[0].column, 1);
  EXPECT_EQ(e.operands[1].column, 9);
  EXPECT_EQ(e.operands[1].operands[0].column, 6);
}

TEST(ExpressionMessages, PointAtTheMistake) {
  EXPECT_EQ(message_of(""), "1: the expression ends too early; expected a number, a name or '('");
  EXPECT_EQ(message_of("a +"), "4: the expression ends too early; expected a number, a name or '('");
  EXPECT_EQ(message_of("2*(3+1"), "7: a parenthesis is not closed; expected ')'");
  EXPECT_EQ(message_of("2*)"), "3: ')' cannot start a value; expected a number, a name or '('");
  EXPECT_EQ(message_of("2*φ"), "3: 'φ' cannot start a value; expected a number, a name or '('");
  EXPECT_EQ(message_of("2 pi"),
            "3: 'pi' does not belong here; expected an operator or the end; a product is written with '*'");
  EXPECT_EQ(message_of("2)"), "2: ')' does not belong here; expected an operator or the end");
  EXPECT_EQ(message_of("1 ; aaaaaaaaaaaaaaaaaφaaaaaaaaaaa"),
            "3: '; aaaaaaaaaaaaaaaaa…' does not belong here; expected an operator or the end");
}

// Germans, Frenchmen and Russians write them. Within a call a comma may part arguments.
TEST(ExpressionMessages, AskForADecimalPoint) {
  EXPECT_EQ(message_of("-0,5*x"),
            "3: there is a comma in the number; expected a decimal point; write -0.5*x");
  EXPECT_EQ(message_of("max(1, 2)*1,5 + 0,25"),
            "12: there is a comma in the number; expected a decimal point; write max(1, 2)*1.5 + 0.25");
  EXPECT_EQ(
      message_of("sqrt(0,5)"),
      "1: sqrt was given 2 arguments; expected 1; square root; a number has a decimal point, not a comma");
  EXPECT_EQ(message_of("1, 2"), "2: ', 2' does not belong here; expected an operator or the end");
}

TEST(ExpressionMessages, KnowTheFunctions) {
  EXPECT_EQ(message_of("sinn(1)"), "1: there is no function 'sinn'; did you mean 'sin'?");
  EXPECT_EQ(message_of("1+sin()"), "3: sin was given 0 arguments; expected 1; sine of an angle in radians");
  EXPECT_EQ(message_of("atan2(1)"),
            "1: atan2 was given 1 argument; expected 2; atan2(y, x): angle of the vector (x, y)");
  EXPECT_EQ(message_of("min()"), "1: min was given 0 arguments; expected 1 to 1000; smallest argument");
  EXPECT_EQ(message_of("sin(1"), "6: the parenthesis after sin is not closed; expected ',' or ')'");
  EXPECT_EQ(message_of("table(1, 0,0, 1)"),
            "1: the table has no two points; table(x, x1, y1, x2, y2, …) or table(x, points): straight lines "
            "through the points");
  EXPECT_EQ(message_of("table(1, 2)"),
            "1: the table has no two points; table(x, x1, y1, x2, y2, …) or table(x, points): straight lines "
            "through the points");
  EXPECT_EQ(
      message_of("table(1, 0,0, 1,1, 2)"),
      "1: a point of the table has no second coordinate; table(x, x1, y1, x2, y2, …) or table(x, points): "
      "straight lines through the points");
}

TEST(ExpressionMessages, RefuseComparisonsThatChain) {
  EXPECT_EQ(message_of("0 < x < 1"),
            "7: comparisons do not chain; join two comparisons with 'and': a < b and b < c");
  EXPECT_EQ(message_of("(0 < 1) < 1"), "no error");
}

TEST(ExpressionMessages, RefuseOperatorsAsNames) {
  EXPECT_EQ(message_of("2*and"),
            "3: 'and' is an operator and cannot stand here; expected a number, a name or '('");
  EXPECT_EQ(message_of("2*or"),
            "3: 'or' is an operator and cannot stand here; expected a number, a name or '('");
  EXPECT_EQ(message_of("2*not 1"),
            "3: 'not' is an operator and cannot stand here; expected a number, a name or '('");
}

TEST(ExpressionMessages, KnowTheLimitsOfNumbers) {
  const std::string range =
      "1: the number is out of range; expected a magnitude between 2.3e-308 and 1.7e308";
  EXPECT_EQ(message_of("1e400"), range);
  EXPECT_EQ(message_of("1e-400"), range);
  EXPECT_EQ(message_of("."), "1: '.' is not a number; expected a digit before or after the point");
  EXPECT_EQ(message_of("1e308"), "no error");
}

TEST(ExpressionMessages, SayWhatConstantsThereAre) {
  EXPECT_EQ(message_of("2*gain"), "3: 'gain' is not a known constant; expected a number, 'pi' or 'inf'");
  EXPECT_EQ(message_of("sin"),
            "1: 'sin' is not a known constant; expected a number, 'pi' or 'inf'; a function needs its "
            "argument: sin(…)");
}

// Each text would overflow the stack by far, were it parsed, walked or freed without a limit.
class DeepExpression : public ::testing::TestWithParam<const char*> {};

TEST_P(DeepExpression, IsRefusedAndNotACrash) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += GetParam();
  text += "1";
  EXPECT_THAT(message_of(text),
              ::testing::AnyOf(
                  ::testing::HasSubstr("the expression is nested too deeply; expected at most 200 levels"),
                  ::testing::HasSubstr("the expression is too long; expected at most 1000 operators; "
                                       "split it over several blocks")));
}

INSTANTIATE_TEST_SUITE_P(Repeated, DeepExpression,
                         ::testing::Values("- ", "+", "+-", "not ", "(", "2^", "2^-", "sin(", "max(1,",
                                           "if(1,2,", "1+", "1/", "a and ", "not 1 or "));

TEST(DeepExpression, UpToTheLimitIsRead) {
  const std::string open(198, '(');
  const std::string close(198, ')');
  EXPECT_EQ(value_of(open + "1" + close), 1);
  std::string sum = "1";
  for (int i = 0; i < 1000; ++i) sum += "+1";
  EXPECT_EQ(value_of(sum), 1001);
}

}  // namespace
}  // namespace oblique::text
