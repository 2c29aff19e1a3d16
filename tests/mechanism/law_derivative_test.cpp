// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/law_derivative.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/text/expression_parser.h>
#include <oblique/text/expression_printer.h>
#include <oblique/text/quantity.h>

namespace oblique::mechanism {
namespace {

double at(const text::Expression& e, double time) {
  return text::evaluate(
      e, [&](std::string_view name) { return name == "time" ? std::optional(time) : std::nullopt; });
}

/// Every function and operation that a law may have.
constexpr std::array kLaws{"3*time",
                           "2 + sin(3*time)",
                           "cos(time)*sin(2*time)",
                           "tan(time/2)",
                           "asin(time/3)",
                           "acos(time/3)",
                           "atan(2*time)",
                           "exp(-time)",
                           "log(1 + time)",
                           "sqrt(1 + time)",
                           "atan2(time, 2)",
                           "atan2(2, time)",
                           "hypot(time, 1 - time)",
                           "time^3",
                           "time^2",
                           "(1 + time)^0.5",
                           "2^time",
                           "(1 + time)^time",
                           "time^(2 - 1)",
                           "-time",
                           "-(time - 2*time^2)",
                           "1/time",
                           "sin(time)/(1 + time)",
                           "pi - time/2",
                           "17*pi/180*2*pi*cos(2*pi*time)"};

// Against central differences; their error is that of the
// third derivative, 1e-10 times up to some hundreds, and rounding, 1e-16/1e-5.
TEST(LawDerivative, AgreesWithDifferences) {
  for (const char* const text : kLaws) {
    const text::Expression law = text::parse_expression(text);
    const text::Expression derivative = law_derivative(law);
    for (const double t : {0.3, 0.7, 1.1}) {
      constexpr double kStep = 1e-5;
      const double difference = (at(law, t + kStep) - at(law, t - kStep)) / (2 * kStep);
      EXPECT_NEAR(at(derivative, t), difference, 1e-7) << text << " -> " << text::to_string(derivative);
    }
  }
}

// The acceleration of a drive is found by another way, without an expression for it; its speed is in units of
// the scale.
TEST(LawDerivative, IsTheAccelerationOfADrive) {
  for (const char* const text : kLaws) {
    Drive drive;
    drive.law = text::parse_expression(text);
    drive.law_scale = 3;
    for (const double t : {0.3, 0.7, 1.1}) {
      constexpr double kStep = 1e-5;
      const double difference = 3 * (at(*drive.law, t + kStep) - at(*drive.law, t - kStep)) / (2 * kStep);
      EXPECT_NEAR(law_at(drive, t).rate, 3 * at(*drive.law, t), 1e-14 * std::abs(at(*drive.law, t)) + 1e-14)
          << text;
      EXPECT_NEAR(law_at(drive, t).acceleration, difference, 3e-7) << text;
    }
  }
}

// Whatever function is added to the language is known here too, or refused.
TEST(LawDerivative, KnowsEveryFunctionThatALawMayHave) {
  const auto unit = text::parse_unit("rad/s");
  for (const text::FunctionInfo& info : text::functions()) {
    const std::string arguments = info.min_arguments == 1 ? "0.3 + time/4" : "0.3 + time/4, 1.2 - time/5";
    const auto law = [&]() -> std::optional<SpeedLaw> {
      try {
        return parse_law(fmt::format("{}({}) rad/s", info.name, arguments), *unit);
      } catch (const text::ExpressionError&) {
        return std::nullopt;
      }
    }();
    const bool lawful = !info.switches && info.name != "noise" && info.name != "weights";
    EXPECT_EQ(law.has_value(), lawful) << info.name;
    if (!law) continue;
    Drive drive;
    drive.law = law->speed;
    const text::Expression derivative = law_derivative(law->speed);
    for (const double t : {0.3, 0.7, 1.1}) {
      constexpr double kStep = 1e-5;
      const double difference = (at(law->speed, t + kStep) - at(law->speed, t - kStep)) / (2 * kStep);
      // the third derivative of a function of time/4 is below 1: 2e-11, and rounding 1e-11
      EXPECT_NEAR(at(derivative, t), difference, 1e-9) << info.name;
      EXPECT_NEAR(law_at(drive, t).acceleration, difference, 1e-9) << info.name;
    }
  }
}

TEST(LawDerivative, RefusesWhatHasNone) {
  const auto message = [](const char* text) -> std::string {
    try {
      return text::to_string(law_derivative(text::parse_expression(text)));
    } catch (const text::ExpressionError& error) {
      return fmt::format("{}: {}", error.column, error.what);
    }
  };
  EXPECT_EQ(message("2*noise(time, 1)"), "3: the derivative of noise has no expression");
  EXPECT_EQ(message("1 + abs(time)"), "5: what switches has no derivative");
  EXPECT_EQ(message("time < 1"), "6: what switches has no derivative");
}

// As in the graph, where x^0 is 1: at a base of 0 there is no infinity times zero.
TEST(LawDerivative, IsZeroOfAPowerThatIsConstant) {
  Drive drive;
  drive.law = text::parse_expression("time^0");
  EXPECT_EQ(law_at(drive, 0).acceleration, 0);
  drive.law = text::parse_expression("(time - 2)^3");  // whose logarithm is no number
  EXPECT_EQ(law_at(drive, 1).acceleration, 3);
}

TEST(LawDerivative, LeavesOutWhatIsZeroOrOne) {
  const auto derivative = [](const char* text) {
    return text::to_string(law_derivative(text::parse_expression(text)));
  };
  EXPECT_EQ(derivative("2 + sin(3*time)"), "cos(3*time)*3");
  EXPECT_EQ(derivative("time^2"), "2*time");
  EXPECT_EQ(derivative("time/4"), "1/4");
  EXPECT_EQ(derivative("0*time"), "0");
}

}  // namespace
}  // namespace oblique::mechanism
