// SPDX-License-Identifier: MIT
// Comparisons that lie on the other side within the errors of what they compare.
#include <algorithm>
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

}  // namespace
}  // namespace oblique::solve
