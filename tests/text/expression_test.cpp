// SPDX-License-Identifier: MIT
#include <oblique/text/expression.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "expression_trees.h"

namespace oblique::text {
namespace {

using test::value_of;

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

TEST(Expressions, AreEqualInAllTheirParts) {
  using test::call, test::name, test::node, test::number;
  using Kind = Expression::Kind;
  const std::vector<Expression> all{number(1),
                                    number(2),
                                    name("a"),
                                    name("b"),
                                    node(Kind::add, {name("a"), name("b")}),
                                    node(Kind::add, {name("b"), name("a")}),
                                    node(Kind::subtract, {name("a"), name("b")}),
                                    call(Function::sin, {name("a")}),
                                    call(Function::cos, {name("a")}),
                                    call(Function::sin, {name("b")})};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[i] == all[k], i == k) << i << " and " << k;
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
