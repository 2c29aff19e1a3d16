// SPDX-License-Identifier: MIT
// Blocks without memory: each against the function that it is named after, over a sweep of its input.
#include <cmath>
#include <functional>
#include <ostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/network/program/program.h>
#include "../support/runs.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

struct Case {
  std::string name;
  std::string block;  ///< its type and parameters
  double from, to;
  std::function<double(double)> exact;

  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

const std::vector<Case> kCases{
    {"Gain", R"(type = "gain", factor = -3.5)", -1, 1, [](double x) { return -3.5 * x; }},
    {"GainOfOneByDefault", R"(type = "gain")", -1, 1, [](double x) { return x; }},
    {"Squarer", R"(type = "squarer")", -1, 1, [](double x) { return x * x; }},
    {"ArcTangent", R"(type = "arc-tangent")", -20, 20, [](double x) { return std::atan(x); }},
    {"Exponential", R"(type = "exponential")", -5, 1, [](double x) { return std::exp(x); }},
    {"ExponentialToScale", R"(type = "exponential", scale = 0.2)", -1, 0,
     [](double x) { return std::exp(5 * x); }},
    {"Logarithm", R"(type = "logarithm")", 0.01, 3, [](double x) { return std::log(x); }},
    {"CommonLogarithm", R"toml(type = "logarithm", scale = "1/log(10)")toml", 0.1, 1,
     [](double x) { return std::log10(x); }},
};

class FunctionBlock : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Blocks, FunctionBlock, ::testing::ValuesIn(kCases),
                         [](const auto& tested) { return tested.param.name; });

/// The input rises at a constant rate, so that it is exact; it is read where it is, so only rounding is left.
TEST_P(FunctionBlock, IsItsFunction) {
  const Case& c = GetParam();
  const Compiled made(fmt::format(R"toml(one = {{ type = "constant" }}
u   = {{ type = "integrator", in = ["{}*one"], initial = {} }}
out = {{ {}, in = "u" }}
)toml",
                                  c.to - c.from, c.from, c.block));
  const auto result = run_of(made, {.samples = 101});
  const auto u = row_values(result, "u"), out = row_values(result, "out");
  EXPECT_NEAR(u.back(), c.to, 1e-12);
  for (std::size_t r = 0; r < u.size(); ++r) {
    EXPECT_NEAR(out[r], c.exact(u[r]), 1e-15 * (1 + std::abs(c.exact(u[r])))) << u[r];
  }
}

/// In y′ = f(y) the derivative of the block is the whole Jacobian.
TEST_P(FunctionBlock, HasTheDerivativeOfItsFunction) {
  const Case& c = GetParam();
  const Compiled made(fmt::format(R"toml(y = {{ type = "integrator", in = ["f"], initial = {} }}
f = {{ {}, in = "y" }}
)toml",
                                  (c.from + c.to) / 2, c.block));
  network::Workspace workspace(made.program);
  const double y = 0.3 * c.from + 0.7 * c.to;
  std::vector<double> derivative(1), jacobian(1);
  ASSERT_TRUE(made.program.jacobian(0, &y, jacobian.data(), workspace));
  const double step = 1e-5 * (1 + std::abs(y));
  const double difference = (c.exact(y + step) - c.exact(y - step)) / (2 * step);
  EXPECT_NEAR(jacobian[0], difference, 1e-8 * (1 + std::abs(difference)));  // step² f‴/6 and rounding/step
}

TEST(Logarithm, OfANegativeInputEndsTheRun) {
  const Compiled made(R"toml(one = { type = "constant" }
u   = { type = "integrator", in = ["-one"], initial = 0.5 }
out = { type = "logarithm", in = "u" }
)toml");
  const auto failure = testing::failure_of(made);
  ASSERT_TRUE(failure);
  EXPECT_NEAR(failure->time, 0.5, 2e-3);  // the next of 1001 rows
  EXPECT_NE(failure->message.find("'out'"), std::string::npos) << failure->message;
}

TEST(Exponential, UndoesALogarithmOfItsScale) {
  const Compiled made(R"toml(one  = { type = "constant" }
u    = { type = "integrator", in = ["one"], initial = 0.01 }
log  = { type = "logarithm", in = "u", scale = 0.2 }
back = { type = "exponential", in = "log", scale = 0.2 }
)toml");
  const auto result = run_of(made, {.samples = 11});
  const auto u = row_values(result, "u"), back = row_values(result, "back");
  for (std::size_t r = 0; r < u.size(); ++r)
    EXPECT_NEAR(back[r], u[r], 5e-15) << u[r];  // rounding of ln u ≤ 4.6
}

}  // namespace
}  // namespace oblique::test
