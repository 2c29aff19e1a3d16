// SPDX-License-Identifier: MIT
// Outputs that show nothing but the errors of the states.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/solve/readings/error_signs.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const char* const kReciprocal = R"(
one = { type = "constant", value = 1 }
x = { type = "integrator", in = "-x", initial = 1 }
y = { type = "divider", numerator = "1e-18*one", denominator = "x", gain = inf, bandwidth = inf }
)";

const char* const kDifference = R"(
one = { type = "constant", value = 1 }
x = { type = "integrator", in = ["one", "-x"] }
d = { type = "summer", in = ["one", "-x"] }
y = { type = "divider", numerator = "1e-12*one", denominator = "d", gain = inf, bandwidth = inf }
)";

// x = 1 − e^(−t), y = 1e-12 e^t: 1 − x is known to the relative tolerance of x, 1e-10 here in each step,
// which it passes at t = 23.
TEST(LostOutput, IsToldOfWhereItDividesByADifferenceThatComesToZero) {
  const testing::Compiled made(kDifference, "[outputs]\ny = { signal = \"y\" }\n");
  const oblique::solve::Run known = testing::run_of(made, {.until = 13});
  EXPECT_THAT(known.warnings, IsEmpty());
  // e^13 times the errors of some steps, 1e-10 each, is 1e-3 of the denominator at most.
  EXPECT_NEAR(1e12 * testing::row_values(known, "y").back() / std::exp(13), 1, 1e-3);

  const oblique::solve::Run lost = testing::run_of(made, {.until = 28});
  ASSERT_THAT(lost.warnings, SizeIs(1));
  const double last = testing::row_values(lost, "y").back();
  ASSERT_GT(std::abs(1e12 * last / std::exp(28) - 1), 0.3) << "it is known after all";
  EXPECT_THAT(text::to_string(lost.warnings.front()),
              HasSubstr("no digit of the output 'y' is known: at t = "));
  EXPECT_THAT(text::to_string(lost.warnings.front()),
              HasSubstr("and the errors that the tolerance leaves to the states move it by "));
  EXPECT_THAT(
      text::to_string(lost.warnings.front()),
      HasSubstr("remedy: look for a division by what comes to zero, or a difference of what is nearly "
                "alike; where it is meant, a finer 'tolerance' in [run] carries further"));
}

// The same read by a switch for two tenths of a second alone, from t = 26.9 on: neither a step at which it is
// looked at nor the end of the run need lie there.
TEST(LostOutput, IsToldOfWhereItIsReadBetweenTwoEventsAlone) {
  const std::string window =
      "g = { type = \"sine-source\", amplitude = 1, frequency = \"1/108\" }\n"
      "s = { type = \"electronic-switch\", on = \"d\", off = \"one\", control = \"g\", threshold = 0.99999 "
      "}\n"
      "z = { type = \"divider\", numerator = \"1e-12*one\", denominator = \"s\", gain = inf, bandwidth = inf "
      "}\n";
  const std::string difference = kDifference;
  const oblique::solve::Run lost =
      testing::run_of(testing::Compiled(difference.substr(0, difference.find("y = ")) + window,
                                        "[outputs]\nz = { signal = \"z\" }\n"),
                      {.until = 40});
  ASSERT_THAT(lost.events, SizeIs(2));
  ASSERT_THAT(lost.warnings, SizeIs(1));
  EXPECT_THAT(
      lost.warnings.front().what,
      HasSubstr(fmt::format("no digit of the output 'z' is known: at t = {:.6g} s", lost.events[0].time)));
}

const char* const kLogarithms = R"toml(
x = { type = "integrator", in = "-x", initial = 1 }
rate = { type = "time-function", formula = "30*cos(time)" }
grown = { type = "multiplier", in = ["rate", "y"] }
y = { type = "integrator", in = "grown", initial = 1 }
log_x = { type = "logarithm", in = "x" }
log_y = { type = "logarithm", in = "y" }
)toml";

// x = e^(−t) itself is known relatively where an output needs it: 1e-18/x, and the logarithm beside what
// takes short steps (y = e^(30 sin t)), by which x is good far below its absolute tolerance anyway.
TEST(LostOutput, OfADecayIsNone) {
  const oblique::solve::Run reciprocal =
      testing::run_of(testing::Compiled(kReciprocal, "[outputs]\ny = { signal = \"y\" }\n"), {.until = 40});
  EXPECT_THAT(reciprocal.warnings, IsEmpty());
  // 1000 times the tolerance, as the errors of the steps add up.
  EXPECT_NEAR(1e18 * testing::row_values(reciprocal, "y").back() / std::exp(40), 1, 1e-5);
  const testing::Compiled made(kLogarithms,
                               "[outputs]\nlog_x = { signal = \"log_x\" }\nlog_y = { signal = \"log_y\" }\n");
  const oblique::solve::Run logarithms = testing::run_of(made, {.until = 60, .samples = 61});
  const std::vector<double> t = testing::row_values(logarithms, "t"),
                            log_x = testing::row_values(logarithms, "log_x"),
                            log_y = testing::row_values(logarithms, "log_y");
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(log_x[k], -t[k], 1e-5) << t[k];
    EXPECT_NEAR(log_y[k], 30 * std::sin(t[k]), 1e-5) << t[k];
  }
  EXPECT_FALSE(std::any_of(logarithms.warnings.begin(), logarithms.warnings.end(), [](const auto& warning) {
    return warning.what.find("no digit") != std::string::npos;
  }));
}

// So it is beside states that are known, wherever they stand among the blocks.
TEST(LostOutput, OfADecayBehindStatesThatStayIsNone) {
  const std::string stays =
      "a = { type = \"integrator\", in = \"b\", initial = 1 }\n"
      "b = { type = \"integrator\", in = \"-a\" }\n";
  const oblique::solve::Run run = testing::run_of(
      testing::Compiled(stays + kReciprocal, "[outputs]\ny = { signal = \"y\" }\n"), {.until = 40});
  EXPECT_THAT(run.warnings, IsEmpty());
  // 1000 times the tolerance, as the errors of the steps add up.
  EXPECT_NEAR(1e18 * testing::row_values(run, "y").back() / std::exp(40), 1, 1e-5);
}

// The decay has been lost before an event at 5π, from which on the steps are short enough to know it to 10 %
// or so: where that is seen must not hang on where it stands among the states.
TEST(LostOutput, OfADecayBesideASwingIsNoneInAnyOrder) {
  std::vector<std::string> blocks = {"e = { type = \"constant\", value = 1e-18 }\n",
                                     "l = { type = \"logarithm\", in = \"x\" }\n",
                                     "z = { type = \"integrator\", in = \"w\", initial = 1, rate = 0.1 }\n",
                                     "x = { type = \"integrator\", in = [\"-x\", \"e\"], initial = 1 }\n",
                                     "w = { type = \"integrator\", in = \"-z\", rate = 0.1 }\n",
                                     "c = { type = \"comparator\", in = \"z\" }\n",
                                     "y = { type = \"integrator\", in = \"c\" }\n"};
  const double truth = std::log(1e-18 + (1 - 1e-18) * std::exp(-30));
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const std::string text = std::accumulate(blocks.begin(), blocks.end(), std::string());
    for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf}) {
      const oblique::solve::Run run =
          testing::run_of(testing::Compiled(text, "[outputs]\nl = { signal = \"l\" }\n"),
                          {.until = 30, .samples = 3, .method = method});
      EXPECT_THAT(run.warnings, IsEmpty());
      // 100 times the tolerance, as the errors of the steps add up.
      EXPECT_NEAR(testing::row_values(run, "l").back(), truth, 1e-6) << text;
    }
    std::rotate(blocks.begin(), blocks.begin() + 1, blocks.end());
  }
}

// Of a thousand fair signs the sum is within 6 √1000 = 190 of 0, and two trials agree in half of them.
TEST(ErrorSigns, AreFairAndOthersInEachTrial) {
  const auto signs_of = [](std::uint64_t trial) {
    ErrorSigns signs(trial);
    std::vector<double> all(1000);
    for (double& sign : all) sign = signs.next();
    return all;
  };
  for (std::uint64_t a = 0; a < ErrorSigns::kTrials; ++a) {
    const std::vector<double> signs = signs_of(a);
    EXPECT_EQ(signs, signs_of(a));
    EXPECT_LE(std::abs(std::accumulate(signs.begin(), signs.end(), 0.0)), 190) << a;
    for (std::uint64_t b = 0; b < a; ++b) {
      const std::vector<double> others = signs_of(b);
      EXPECT_LE(std::abs(std::inner_product(signs.begin(), signs.end(), others.begin(), 0.0)), 190);
    }
  }
}

// What is not shown, a zero that is subtracted to rounding, and a state that is large are no such outputs.
TEST(LostOutput, IsNone) {
  EXPECT_THAT(
      testing::run_of(testing::Compiled(kReciprocal, "[outputs]\nx = { signal = \"x\" }\n"), {.until = 40})
          .warnings,
      IsEmpty());
  EXPECT_THAT(testing::run_of(testing::Compiled(R"(
x = { type = "integrator", in = "v", initial = 1 }
v = { type = "integrator", in = "-x" }
u = { type = "integrator", in = "w", initial = 1 }
w = { type = "integrator", in = "-u" }
d = { type = "summer", in = ["x", "-u"] }
e = { type = "gain", in = "x", factor = 1e6 }
)"),
                              {.until = 100})
                  .warnings,
              IsEmpty());
}

}  // namespace
}  // namespace oblique::solve
