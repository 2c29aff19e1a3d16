// SPDX-License-Identifier: MIT
// Comparisons that lie on the other side within the errors of what they compare.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::row_values;
using testing::run_of;
using ::testing::StartsWith;

constexpr diagram::IntegrationMethod kMethods[] = {diagram::IntegrationMethod::adams,
                                                   diagram::IntegrationMethod::bdf};

/// x = 1 + a(sin 2πt − 1/2) is above 1 from t = 1/12 to t = 5/12. A relative tolerance of 1e-8 leaves it an
/// error of 1e-8.
Compiled swing_of(double a) {
  return Compiled(fmt::format(R"(
one = {{ type = "constant" }}
d = {{ type = "sine-source", amplitude = "2*pi*{0}", phase = "pi/2" }}
x = {{ type = "integrator", in = "d", initial = "1 - {0}/2" }}
always = {{ type = "comparator", in = ["x"] }}
c = {{ type = "comparator", in = ["x", "-one"] }}
)",
                              a));
}

/// No row lies nearer than 1/60 s to a turn, in which x moves by 3.6e-10 or more: 36 times what the finer of
/// the tolerances leaves it.
void expect_both_turns(const solve::Run& run) {
  const std::vector<double> t = row_values(run, "t"), c = row_values(run, "c");
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_EQ(c[k], t[k] > 1 / 12.0 && t[k] < 5 / 12.0 ? 1 : 0) << t[k];
}

// It comes back by 0.4 of its error, no farther than it had gone: the switch is told to be late.
TEST(WrongSides, AreToldOfWithinTheErrors) {
  const Compiled made = swing_of(4e-9);
  for (const diagram::IntegrationMethod method : kMethods) {
    const solve::Run run = run_of(made, {.tolerance = 1e-8, .samples = 21, .method = method});
    EXPECT_EQ(row_values(run, "c").back(), 1);
    const auto told =
        std::find_if(run.warnings.begin(), run.warnings.end(), [](const text::Diagnostic& warning) {
          return warning.what.find("lies on the other side") != std::string::npos;
        });
    ASSERT_NE(told, run.warnings.end());
    EXPECT_THAT(told->what, StartsWith("'c' (in > 0) holds from t = 0.4"));
    EXPECT_THAT(told->what, HasSubstr("by less than its error, 1e-08, so that it may be late"));
    EXPECT_THAT(told->remedy.words(), StartsWith("tighten 'tolerance'"));
  }
}

TEST(WrongSides, AreNotToldOfBeyondTheErrors) {
  const Compiled made = swing_of(4e-3);
  for (const diagram::IntegrationMethod method : kMethods) {
    const solve::Run run = run_of(made, {.tolerance = 1e-8, .samples = 21, .method = method});
    EXPECT_THAT(run.warnings, IsEmpty());
    expect_both_turns(run);
  }
}

TEST(WrongSides, AreNoMoreWithTheRemedy) {
  const Compiled made = swing_of(4e-9);
  for (const diagram::IntegrationMethod method : kMethods) {
    const solve::Run run = run_of(made, {.tolerance = 1e-11, .samples = 21, .method = method});
    EXPECT_THAT(run.warnings, IsEmpty());
    expect_both_turns(run);
  }
}

// A lag of 10 ns follows a sine by 1e-8 cos t, less than its error, and yet its sign turns over with the
// cosine: at π/2 and 5π/2 that of −cos t becomes positive, whatever method makes the steps, and
// whether it damps what is fast or not. A turn may be late by what the damped errors are (1e-13) over 1e-8 a
// second, and with the coarse tolerance by a part of a step.
TEST(WrongSides, OfWhatFollowsQuicklyTurnOverByAnyMethod) {
  const Compiled made(R"toml(
x = { type = "sine-source", frequency = "1/(2*pi)" }
l = { type = "transfer-lag", in = "x", time_constant = 1e-8 }
c = { type = "comparator", in = ["-x", "l"] }
n = { type = "counter", clock = "c" }
)toml");
  for (const double tolerance : {1e-5, 1e-8}) {
    for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                              diagram::IntegrationMethod::rodas}) {
      const solve::Run run = run_of(made, {.until = 8.5, .tolerance = tolerance, .method = method});
      EXPECT_EQ(row_values(run, "n.out").back(), 2) << tolerance << ' ' << static_cast<int>(method);
    }
  }
}

// The voltage over a diode of a billionth of its load is below its error all the time that it conducts: at 5
// s, behind v′ = −v/10 from where tan t = −10 on, nothing is left of what it let through.
TEST(WrongSides, OfADiodeEndItsConductionByAdams) {
  const Compiled made(R"toml(
u = { type = "sine-source", frequency = "1/(2*pi)" }
d = { type = "summer", in = ["u", "-v"] }
i = { type = "diode", in = "d", resistance = 1e-8 }
v = { type = "integrator", in = ["i", "-0.1*v"] }
)toml");
  const double ends = 3.141592653589793 - std::atan(10.0);
  const double at_end = std::sin(ends) * std::exp(-0.1 * (5 - ends));
  const solve::Run run =
      run_of(made, {.until = 5, .tolerance = 1e-8, .method = diagram::IntegrationMethod::adams});
  EXPECT_NEAR(row_values(run, "v").back(), at_end, 1e-6);  // 100 tolerances
}

// A lag that is 1e-8 s behind sin t differs from it by −1e-8 cos t, which is as much as a relative tolerance
// of 1e-8 leaves; and where it goes over to above zero, at π/2, its rate is less than what rounding makes of
// it. The way that sin t has gone until t = 4, the integral of |cos t|, is 2 − sin 4.
TEST(WrongSides, OfWhatIsAsSmallAsTheToleranceTurnOver) {
  const Compiled made(R"toml(
u = { type = "time-function", formula = "sin(time)" }
x = { type = "transfer-lag", in = "u", time_constant = 1e-8 }
d = { type = "summer", in = ["-u", "x"] }
m = { type = "absolute-value", in = "d" }
y = { type = "integrator", in = "m", rate = 1e8 }
c = { type = "comparator", in = "d" }
n = { type = "integrator", in = "c" }
)toml");
  using enum diagram::IntegrationMethod;
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    for (const auto method : {bdf, rodas}) {
      const oblique::solve::Run run =
          run_of(made, {.until = 4, .tolerance = tolerance, .samples = 21, .method = method});
      const std::vector<double> t = row_values(run, "t"), c = row_values(run, "c");
      for (std::size_t row = 0; row < t.size(); ++row)
        EXPECT_EQ(c[row], std::cos(t[row]) < 0 ? 1 : 0) << tolerance << ' ' << t[row];
      // A crossing is seen where what is compared is 1e-13, 1e-5 s behind it; of the way that is 1e-10.
      EXPECT_NEAR(row_values(run, "n").back(), 4 - std::numbers::pi / 2, 2e-5) << tolerance;
      EXPECT_NEAR(row_values(run, "y").back(), 2 - std::sin(4.0), 1e3 * tolerance + 1e-6) << tolerance;
    }
  }
}

}  // namespace
}  // namespace oblique::solve
