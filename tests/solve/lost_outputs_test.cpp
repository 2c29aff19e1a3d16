// SPDX-License-Identifier: MIT
// Outputs that show nothing but the errors of the states.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const char* const kReciprocal = R"(
one = { type = "constant", value = 1 }
x = { type = "integrator", in = "-x", initial = 1 }
y = { type = "divider", numerator = "1e-4*one", denominator = "x", gain = inf, bandwidth = inf }
)";

// x = e^(−t), y = 1e-4 e^t: x is known to a part of its size down to its absolute tolerance, 1e-12 here,
// which it passes at t = 27.6.
TEST(LostOutput, IsToldOfWhereItDividesByWhatHasDecayed) {
  const testing::Compiled made(kReciprocal, "[outputs]\ny = { signal = \"y\" }\n");
  const oblique::solve::Run known = testing::run_of(made, {.until = 13});
  EXPECT_THAT(known.warnings, IsEmpty());
  // e^13 = 4e5 times the absolute tolerance is a part of 4e-7 of the denominator in each of some steps
  EXPECT_NEAR(1e4 * testing::row_values(known, "y").back() / std::exp(13), 1, 1e-5);

  const oblique::solve::Run lost = testing::run_of(made, {.until = 40});
  ASSERT_THAT(lost.warnings, SizeIs(1));
  const double last = testing::row_values(lost, "y").back();
  ASSERT_GT(std::abs(1e4 * last / std::exp(40) - 1), 0.3) << "it is known after all";
  EXPECT_THAT(text::to_string(lost.warnings.front()),
              HasSubstr("no digit of the output 'y' is known: at t = "));
  EXPECT_THAT(text::to_string(lost.warnings.front()),
              HasSubstr("and the errors that the tolerance leaves to the states move it by "));
  EXPECT_THAT(
      text::to_string(lost.warnings.front()),
      HasSubstr("remedy: look for a division by what comes to zero, or a difference of what is nearly "
                "alike; where it is meant, a finer 'tolerance' in [run] carries further"));
}

// The same read by a switch for two tenths of a second alone, from t = 33.9 on: neither a step at which it is
// looked at nor the end of the run need lie there.
TEST(LostOutput, IsToldOfWhereItIsReadBetweenTwoEventsAlone) {
  const std::string window =
      "g = { type = \"sine-source\", amplitude = 1, frequency = 0.0073529411764705881 }\n"
      "s = { type = \"electronic-switch\", on = \"x\", off = \"one\", control = \"g\", threshold = 0.99999 "
      "}\n"
      "z = { type = \"divider\", numerator = \"1e-4*one\", denominator = \"s\", gain = inf, bandwidth = inf "
      "}\n";
  const oblique::solve::Run lost = testing::run_of(
      testing::Compiled(kReciprocal + window, "[outputs]\nz = { signal = \"z\" }\n"), {.until = 40});
  ASSERT_THAT(lost.events, SizeIs(2));
  ASSERT_THAT(lost.warnings, SizeIs(1));
  EXPECT_THAT(
      lost.warnings.front().what,
      HasSubstr(fmt::format("no digit of the output 'z' is known: at t = {:.6g} s", lost.events[0].time)));
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
