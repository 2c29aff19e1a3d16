// SPDX-License-Identifier: MIT
#include <oblique/text/expression.h>
#include <oblique/text/expression_parser.h>
#include <oblique/text/expression_printer.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace oblique::text {
namespace {

using Kind = Expression::Kind;

Expression number(double value) {
  Expression e;
  e.number = value;
  return e;
}

Expression name(std::string text) {
  Expression e;
  e.kind = Kind::name;
  e.name = std::move(text);
  return e;
}

Expression node(Kind kind, std::vector<Expression> operands) {
  Expression e;
  e.kind = kind;
  e.operands = std::move(operands);
  return e;
}

Expression call(Function function, std::vector<Expression> operands) {
  Expression e = node(Kind::call, std::move(operands));
  e.function = function;
  return e;
}

double value_of(std::string_view text) {
  return evaluate(parse_expression(text));
}

std::string reprinted(std::string_view text) {
  return to_string(parse_expression(text));
}

/// The whole message of a malformed expression: "column: what; expected …; remedy".
std::string message_of(std::string_view text) {
  try {
    evaluate(parse_expression(text));
  } catch (const ExpressionError& error) {
    std::string message = std::to_string(error.column) + ": " + error.what;
    if (!error.expected.empty()) message += "; expected " + error.expected;
    if (!error.remedy.empty()) message += "; " + error.remedy;
    return message;
  }
  return "no error";
}

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
class DeepExpression : public testing::TestWithParam<const char*> {};

TEST_P(DeepExpression, IsRefusedAndNotACrash) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += GetParam();
  text += "1";
  EXPECT_THAT(
      message_of(text),
      testing::AnyOf(testing::HasSubstr("the expression is nested too deeply; expected at most 200 levels"),
                     testing::HasSubstr("the expression is too long; expected at most 1000 operators; "
                                        "split it over several blocks")));
}

INSTANTIATE_TEST_SUITE_P(Repeated, DeepExpression,
                         testing::Values("- ", "+", "+-", "not ", "(", "2^", "2^-", "sin(", "max(1,",
                                         "if(1,2,", "1+", "1/", "a and ", "not 1 or "));

TEST(DeepExpression, UpToTheLimitIsRead) {
  const std::string open(198, '(');
  const std::string close(198, ')');
  EXPECT_EQ(value_of(open + "1" + close), 1);
  std::string sum = "1";
  for (int i = 0; i < 1000; ++i) sum += "+1";
  EXPECT_EQ(value_of(sum), 1001);
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

TEST(ExpressionValue, AgreesWithTheLibraryOnConstants) {
  EXPECT_EQ(value_of("2*pi/3"), 2 * std::numbers::pi / 3);
  EXPECT_EQ(value_of("sqrt(2)/2"), std::sqrt(2.0) / 2);
  EXPECT_EQ(value_of("-2^2"), -4);
  EXPECT_EQ(value_of("2^-1"), 0.5);
  EXPECT_EQ(value_of("2^3^2"), 512);
  EXPECT_EQ(value_of("hypot(3, -4)"), 5);
  EXPECT_EQ(value_of("inf"), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(value_of("inf - inf")));
  EXPECT_TRUE(std::isnan(value_of("sqrt(-1)")));
}

TEST(ExpressionValue, OfEveryFunctionIsItsDefinition) {
  // Exact: each case is a value that the definition gives without rounding.
  const std::vector<std::pair<std::string, double>> cases{
      {"sin(0)", 0},
      {"cos(0)", 1},
      {"tan(0)", 0},
      {"asin(0)", 0},
      {"acos(1)", 0},
      {"atan(0)", 0},
      {"atan2(0, 1)", 0},
      {"exp(0)", 1},
      {"log(1)", 0},
      {"sqrt(9)", 3},
      {"abs(-2)", 2},
      {"min(3, 1, 2)", 1},
      {"max(3, 1, 2)", 3},
      {"hypot(5, 12)", 13},
      {"sign(-3)", -1},
      {"sign(0)", 0},
      {"sign(3)", 1},
      {"clip(5, -1, 1)", 1},
      {"clip(-5, -1, 1)", -1},
      {"clip(0.5, -1, 1)", 0.5},
      {"deadzone(0.5, 1)", 0},
      {"deadzone(3, 1)", 2},
      {"deadzone(-3, 1)", -2},
      {"step(-1)", 0},
      {"step(0)", 1},
      {"step(1)", 1},
      {"table(0.5, 0, 0, 1, 10)", 5},
      {"table(3, 0, 0, 1, 10, 2, 30)", 50},
      {"table(-1, 0, 0, 1, 10)", -10},
      {"if(1 < 2, 3, 4)", 3},
      {"if(1 > 2, 3, 4)", 4},
  };
  for (const auto& [text, value] : cases) EXPECT_EQ(value_of(text), value) << text;
}

TEST(ExpressionValue, OfComparisonsAndLogicIsZeroOrOne) {
  const std::vector<std::pair<std::string, double>> cases{
      {"1 < 1", 0},
      {"1 <= 1", 1},
      {"1 > 1", 0},
      {"1 >= 1", 1},
      {"1 == 1", 1},
      {"1 != 1", 0},
      {"1 and 0", 0},
      {"2 and 3", 1},
      {"0 or 5", 1},
      {"0 or 0", 0},
      {"not 0", 1},
      {"not 7", 0},
      {"2 < 3 and not 3 < 2", 1},
  };
  for (const auto& [text, value] : cases) EXPECT_EQ(value_of(text), value) << text;
}

TEST(ExpressionValue, AsksTheLookupForNames) {
  const NameLookup lookup = [](std::string_view text) -> std::optional<double> {
    return text == "gain" ? std::optional(10.0) : std::nullopt;
  };
  EXPECT_EQ(evaluate(parse_expression("gain/4"), lookup), 2.5);
  try {
    evaluate(parse_expression("gain*width"), lookup);
    FAIL() << "'width' has no value";
  } catch (const ExpressionError& error) {
    EXPECT_EQ(error.what, "'width' is not a known constant");
    EXPECT_EQ(error.expected, "") << "other names than pi and inf are known here";
    EXPECT_EQ(error.column, 6);
  }
}

// How many arguments each has, and whether it has a kink or a jump.
TEST(Functions, TakeTheirArgumentsAndSwitchOrNot) {
  struct Known {
    const char* name;
    std::size_t least, most;
    bool switches;
  };
  constexpr std::size_t kAny = 1000;
  const std::vector<Known> known{
      {"sin", 1, 1, false},     {"cos", 1, 1, false},    {"tan", 1, 1, false},     {"asin", 1, 1, false},
      {"acos", 1, 1, false},    {"atan", 1, 1, false},   {"atan2", 2, 2, false},   {"exp", 1, 1, false},
      {"log", 1, 1, false},     {"sqrt", 1, 1, false},   {"abs", 1, 1, true},      {"min", 1, kAny, true},
      {"max", 1, kAny, true},   {"hypot", 2, 2, false},  {"sign", 1, 1, true},     {"clip", 3, 3, true},
      {"deadzone", 2, 2, true}, {"step", 1, 1, true},    {"table", 2, kAny, true}, {"if", 3, 3, true},
      {"noise", 2, 2, false},   {"weights", 1, 1, false}};
  ASSERT_EQ(functions().size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    const FunctionInfo& info = functions()[i];
    EXPECT_EQ(info.name, known[i].name);
    EXPECT_EQ(info.min_arguments, known[i].least) << info.name;
    EXPECT_EQ(info.max_arguments, known[i].most) << info.name;
    EXPECT_EQ(info.switches, known[i].switches) << info.name;
  }
}

TEST(Functions, StandInTheOrderOfTheirEnumeration) {
  for (std::size_t i = 0; i < functions().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(functions()[i].function), i) << functions()[i].name;
    EXPECT_LE(functions()[i].min_arguments, functions()[i].max_arguments) << functions()[i].name;
  }
}

TEST(Identifier, IsALetterAndThenLettersDigitsUnderscores) {
  EXPECT_TRUE(is_identifier("phi_2"));
  EXPECT_TRUE(is_identifier("_"));
  for (const char* const text : {"", "2phi", "a.b", "a-b", "a b", "φ"})
    EXPECT_FALSE(is_identifier(text)) << text;
}

}  // namespace
}  // namespace oblique::text
