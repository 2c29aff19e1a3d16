// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/published_check.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/report/expectation_check.h>

#include "../../support/runs.h"

namespace oblique::report {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;

// x = x₀ e^(−t): what is published of it is made up around that.
constexpr const char* kDecay = "x = { type = \"integrator\", in = [\"-x\"], initial = 0.5 }\n";
constexpr const char* kHead = R"toml([run]
until = 2
[outputs]
x = { signal = "x", scale = 10, unit = "V" }
[published]
author = "A. Author"
title = "A title"
)toml";

std::vector<PublishedResult> check(const std::string& values,
                                   const std::vector<diagram::ParameterOverride>& overrides = {}) {
  const Compiled made(kDecay, kHead + values);
  const diagram::BlockLibrary& library = testing::shipped_blocks();
  return check_published(made.diagram, library, overrides,
                         run_with(made.diagram, library, overrides, published_expectations(made.diagram)));
}

TEST(PublishedCheck, HoldsValuesInTheUnitInWhichTheyWerePublished) {
  const auto results = check(R"toml([[published.value]]
name = "x"
value = 1839.4
within = 0.1
unit = "mV"
at = 1
)toml");
  ASSERT_EQ(results.size(), 1U);
  EXPECT_NEAR(results[0].actual, 5000 * std::exp(-1), 1e-3);  // 1e-8 relative, some steps
  EXPECT_NEAR(results[0].in_uncertainties(), std::abs(1839.4 - 5000 * std::exp(-1)) / 0.1, 0.01);
  EXPECT_TRUE(results[0].met());
  EXPECT_EQ(to_text(results),
            "ok      x at 1 = 1839.397, published 1839.4 ± 0.1 mV: off by 0.028 times that\n");
}

// Each setting is a run of its own, after the settings of the first one; values keep their order.
TEST(PublishedCheck, RunsAgainForWhatIsSet) {
  const std::string values = R"toml([[published.value]]
name = "x"
value = 2
within = 0.1
set = { "x.initial" = 1 }
at = 1
[[published.value]]
name = "x"
value = 5
within = 0.1
at = "maximum"
[[published.value]]
name = "x"
value = 10
within = 0.1
set = { "x.initial" = 1 }
at = 0
)toml";
  const auto results = check(values);
  ASSERT_EQ(results.size(), 3U);
  EXPECT_NEAR(results[0].actual, 10 * std::exp(-1), 1e-5);
  EXPECT_NEAR(results[1].actual, 5, 1e-12);
  EXPECT_NEAR(results[2].actual, 10, 1e-12);
  const auto faster = check(values, {{"x.rate", "2"}, {"x.initial", "0.25"}});
  EXPECT_NEAR(faster[0].actual, 10 * std::exp(-2), 1e-5);
  EXPECT_NEAR(faster[1].actual, 2.5, 1e-12);
}

TEST(PublishedCheck, ForgivesOnlyWhatIsExplained) {
  const std::string value = "[[published.value]]\nname = \"x\"\nvalue = 1.5\nwithin = 0.1\nat = 1\n";
  const auto missed = check(value);
  EXPECT_FALSE(missed[0].met());
  EXPECT_FALSE(missed[0].is_explained());
  EXPECT_EQ(to_text(missed), "FAILED  x at 1 = 1.839, published 1.5 ± 0.1: off by 3.4 times that\n");
  const auto known = check(value + "because = \"the pot was misread\"\n");
  EXPECT_FALSE(known[0].met());
  EXPECT_TRUE(known[0].is_explained());
  EXPECT_EQ(to_text(known),
            "known   x at 1 = 1.839, published 1.5 ± 0.1: off by 3.4 times that\n"
            "        because the pot was misread\n");
}

TEST(PublishedCheck, ShowsTheDigitsThatMatter) {
  EXPECT_EQ(number_within(0.34459535116, 0.001), "0.3446");
  EXPECT_EQ(number_within(0.34459535116, 5e-9), "0.3445953512");
  EXPECT_EQ(number_within(-1234.5678, 100), "-1235");
  EXPECT_EQ(number_within(0.5, 10), "0.5");
  EXPECT_EQ(number_within(1e-17, 0.1), "0");
  EXPECT_EQ(number_within(std::nan(""), 0.1), "not known");
}

// Nobody else would tell of a run that is made for one value alone.
TEST(PublishedCheck, KeepsTheWarningsOfItsOwnRuns) {
  const Compiled made(
      "x = { type = \"integrator\", in = [\"-y\"], initial = 1 }\ny = { type = \"integrator\", in = [\"x\"] "
      "}\n",
      "[run]\nmethod = \"adams\"\ntolerance = 0.01\n[published]\nauthor = \"A\"\ntitle = \"T\"\n"
      "[[published.value]]\nname = \"x\"\nlabel = \"far\"\nvalue = 0.5\nwithin = 0.1\nat = 0\n"
      "set = { \"x.initial\" = 0.5 }\n");
  const auto results = check_published(made.diagram, testing::shipped_blocks(), {}, testing::run_of(made));
  ASSERT_EQ(results.size(), 1U);
  EXPECT_THAT(warnings_text(results, text::plain_vocabulary()), HasSubstr("warning: in the run for far: "));
}

TEST(PublishedCheck, IsNothingForADiagramOfItsOwn) {
  const Compiled made(kDecay);
  EXPECT_TRUE(published_expectations(made.diagram).empty());
  EXPECT_TRUE(check_published(made.diagram, testing::shipped_blocks(), {}, testing::run_of(made)).empty());
}

}  // namespace
}  // namespace oblique::report
