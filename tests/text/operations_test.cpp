// SPDX-License-Identifier: MIT
#include <oblique/text/operations.h>

#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <oblique/text/expression.h>
#include <oblique/text/expression_parser.h>
#include <oblique/text/partial_derivative.h>

namespace oblique::text {
namespace {

/// Plain numbers, on which nothing is simplified.
struct Number {
  double value;

  Number number(double other) const { return {other}; }
  Number apply(Operation operation, const Number& second) const {
    return {evaluate(operation, value, second.value)};
  }
};

/// Where every operation is smooth.
constexpr std::array kFirst{0.3, 0.6, 0.85};
constexpr std::array kSecond{0.4, 1.7};

TEST(Operations, HaveTheDerivativesThatDifferencesHave) {
  for (const OperationInfo& info : operations()) {
    if (info.operation == Operation::noise_derivative) continue;  // its derivative nobody asks for
    for (const double a : kFirst) {
      for (const double b : kSecond) {
        const Number f{evaluate(info.operation, a, b)};
        const auto derivative = [&](int operand) {
          return partial_derivative(info.operation, operand, Number{a}, Number{b}, f).value;
        };
        constexpr double kStep = 1e-5;
        const auto difference = [&](double da, double db) {
          return (evaluate(info.operation, a + da, b + db) - evaluate(info.operation, a - da, b - db)) /
                 (2 * kStep);
        };
        // The third derivative is below 80 (of the logarithm at 0.3), which makes 2e-9; rounding 1e-11.
        constexpr double kTruncation = 1e-8;
        EXPECT_NEAR(derivative(0), difference(kStep, 0), kTruncation) << info.name << " " << a << " " << b;
        // A seed is a whole number: noise has no derivative by it.
        const double by_second = info.operation == Operation::noise ? 0 : difference(0, kStep);
        EXPECT_NEAR(derivative(1), by_second, kTruncation) << info.name << " " << a << " " << b;
      }
    }
  }
}

TEST(Operations, StandInTheOrderOfTheirEnumeration) {
  for (std::size_t i = 0; i < operations().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(operations()[i].operation), i) << operations()[i].name;
    EXPECT_EQ(&info_of(operations()[i].operation), &operations()[i]);
  }
}

// What depends on the second operand has two, and what commutes says so.
TEST(Operations, HaveTheOperandsOnWhichTheirValuesDepend) {
  for (const OperationInfo& info : operations()) {
    bool depends = false, commutes = true;
    for (const double a : kFirst) {
      for (const double b : kSecond) {
        depends = depends || evaluate(info.operation, a, b) != evaluate(info.operation, a, b + 1);
        commutes = commutes && evaluate(info.operation, a, b) == evaluate(info.operation, b, a);
      }
    }
    EXPECT_EQ(info.operands, depends ? 2 : 1) << info.name;
    EXPECT_EQ(info.is(kCommutative), depends && commutes) << info.name;
  }
}

TEST(Operations, RepeatOrMakePeaks) {
  std::set<std::string> periodic, peaks, peaks_by_divisor;
  for (const OperationInfo& info : operations()) {
    if (info.is(kPeriodic)) periodic.emplace(info.name);
    if (info.is(kPeaks)) peaks.emplace(info.name);
    if (info.is(kPeaksByDivisor)) peaks_by_divisor.emplace(info.name);
  }
  EXPECT_EQ(periodic, (std::set<std::string>{"cos", "noise", "sin", "tan"}));
  EXPECT_EQ(peaks, (std::set<std::string>{"atan", "atan2", "exp", "power", "tan"}));
  EXPECT_EQ(peaks_by_divisor, (std::set<std::string>{"divide"}));
}

TEST(Operations, AreTheSmoothFunctionsOfTheLanguage) {
  for (const FunctionInfo& info : functions()) {
    const auto operation = smooth_operation(info.function);
    EXPECT_EQ(operation.has_value(), !info.switches && info.function != Function::weights) << info.name;
    if (!operation) continue;
    EXPECT_EQ(info_of(*operation).name, info.name);
    EXPECT_EQ(static_cast<std::size_t>(info_of(*operation).operands), info.min_arguments) << info.name;
    EXPECT_EQ(evaluate(info.function, std::array{0.6, 0.8}), evaluate(*operation, 0.6, 0.8)) << info.name;
  }
}

// The words in the first column of the page's table.
TEST(Operations, AreDocumented) {
  std::ifstream page(std::string(OBLIQUE_SOURCE_DIR) + "/docs/blocks.md");
  std::set<std::string> documented;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    in_table = line.starts_with("| function |") || (in_table && line.starts_with("|"));
    if (!in_table) continue;
    std::string word;
    for (const char c : line.substr(1, line.find('|', 1))) {
      if (is_identifier(word + c)) {
        word += c;
        continue;
      }
      documented.insert(std::exchange(word, {}));
    }
  }
  for (const FunctionInfo& info : functions())
    EXPECT_TRUE(documented.contains(std::string(info.name))) << info.name << " is not in docs/blocks.md";
}

TEST(Operations, AreAtTheRootOfSmoothExpressions) {
  const auto root = [](const char* text) { return smooth_operation(parse_expression(text)); };
  EXPECT_EQ(root("x + 1"), Operation::add);
  EXPECT_EQ(root("x - 1"), Operation::subtract);
  EXPECT_EQ(root("x * 2"), Operation::multiply);
  EXPECT_EQ(root("x / 2"), Operation::divide);
  EXPECT_EQ(root("x ^ 2"), Operation::power);
  EXPECT_EQ(root("-x"), Operation::negate);
  EXPECT_EQ(root("hypot(x, 2)"), Operation::hypot);
  for (const char* const text : {"1", "x", "x < 1", "x == 1", "x > 0 and y > 0", "not x > 0", "abs(x)"})
    EXPECT_EQ(root(text), std::nullopt) << text;
}

}  // namespace
}  // namespace oblique::text
