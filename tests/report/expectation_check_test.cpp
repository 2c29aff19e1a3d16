// SPDX-License-Identifier: MIT
#include <oblique/report/expectation_check.h>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::report {
namespace {

using testing::Compiled;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::run_of;

constexpr const char* kCircle = R"toml(x = { type = "integrator", in = ["-y"], initial = 1 }
y = { type = "integrator", in = ["x"] }
)toml";

std::vector<ExpectationResult> check(const Compiled& made) {
  solve::RunOptions options = solve::options_of(made.diagram.run);
  ask_for_expectations(made.diagram, options);
  return check_expectations(made.diagram, solve::run(made.program, made.flat, options));
}

TEST(Expectations, AreHeldAgainstTheRun) {
  const Compiled made(kCircle, R"toml([run]
until = 4
[expect]
"x at 2"    = { value = -0.4161468365, within = 1e-6 }
"y at 0.05" = { value = 0.06, within = 0.01 }
"x minimum" = { value = -1, within = 1e-5 }
"y maximum" = { value = 1, within = 1e-5 }
"y minimum" = { value = -0.7568024953, within = 1e-6 }
"x at 0"    = { value = 1, within = 1e-12 }
)toml");
  const auto results = check(made);
  ASSERT_EQ(results.size(), 6U);
  const auto result_of = [&](const std::string& text) {
    for (const auto& result : results) {
      if (result.expectation.text == text) return result;
    }
    throw std::out_of_range(text);
  };
  for (const auto& result : results) EXPECT_EQ(result.met, result.expectation.text != "y at 0.05");
  EXPECT_NEAR(result_of("y at 0.05").actual, std::sin(0.05), 1e-6);  // the run's tolerance, some steps
  EXPECT_NEAR(result_of("x at 2").actual, std::cos(2), 1e-6);
  EXPECT_EQ(result_of("x at 0").actual, 1);
}

// A ring of 3 rad/s turns in 2π/3: the passages are cubics of some hundred rows a period, 1e-8 of it, and the
// run errs by 1e-8 a period or less. A comparator's rises are known to a row, 100 s/32768. What rises once,
// or not at all, has no period, and the first half of the run has no part in it where the second has two
// rises.
TEST(Expectations, FindPeriods) {
  const Compiled made(R"toml(
x     = { type = "integrator", in = ["3*y"], initial = 0.3 }
y     = { type = "integrator", in = ["-3*x"] }
c     = { type = "comparator", in = ["x"] }
decay = { type = "integrator", in = ["-decay"], initial = 1 }
slow  = { type = "time-function", formula = "-cos(0.1*time)" }
late  = { type = "time-function", formula = "if(time < 45, sin(9*time), 2 + sin(time))" }
)toml",
                      R"toml([run]
until = 100
[expect]
"x period"     = { value = "2*pi/3", within = 1e-8 }
"c period"     = { value = "2*pi/3 * 1000 ms", within = 1e-5 }
"late period"  = { value = "2*pi", within = 1e-6 }
"slow period"  = { value = "20*pi", within = 1e-6 }
"decay period" = { value = 1, within = 9 }
)toml");
  const auto results = check(made);
  ASSERT_EQ(results.size(), 5U);
  for (const auto& result : results)
    EXPECT_EQ(result.met, result.expectation.output != "decay") << to_text({result});
  EXPECT_EQ(to_text({results.back()}), "FAILED  decay period = not known, expected 1 ± 9\n");
}

// A tone of 3 kHz in a run of 20 s, whose rows are 0.6 ms apart, looked like one of 277 Hz, and pulses of 0.1
// ms came once in five; a clock of 50 Hz has more events than are on record, and one of 0.5 Hz has them at
// rows. Truth: by definition.
TEST(Expectations, FindNoPeriodBetweenRows) {
  const Compiled made(R"toml(
tone   = { type = "sine-source", frequency = 3000 }
short  = { type = "pulse-train", period = 0.7, width = 1e-4 }
clock  = { type = "pulse-train", period = 0.02, width = 0.006 }
second = { type = "pulse-train", period = 2, width = 1 }
)toml",
                      R"toml([run]
until = 20
[expect]
"tone period"   = { value = 1, within = 9 }
"short period"  = { value = 1, within = 9 }
"clock period"  = { value = 0.02, within = 1e-12 }
"second period" = { value = 2, within = 1e-12 }
)toml");
  const auto results = check(made);
  ASSERT_EQ(results.size(), 4U);
  for (const auto& result : results) {
    const bool is_known = result.expectation.output == "clock" || result.expectation.output == "second";
    EXPECT_EQ(result.met, is_known) << to_text({result});
    EXPECT_EQ(std::isnan(result.actual), !is_known) << to_text({result});
  }
}

// An ideal amplifier falls from fold to fold of y − y³/3 = −x; x′ = −y leads it there and back in 3 − 2 ln 2
// s (van der Pol 1926). The row before a jump and that behind it are 0.6 ms apart.
TEST(Expectations, FindPeriodsByJumpsOfLoops) {
  const Compiled made(R"toml(
y2 = { type = "squarer", in = "y" }
y3 = { type = "multiplier", in = ["y", "y2"] }
y  = { type = "servo-amplifier", in = ["-y", "0.3333333333333333*y3", "-x"], gain = "inf", initial = 2 }
x  = { type = "integrator", in = "-y", initial = 0.6666666666666666 }
)toml",
                      R"toml([run]
until = 20
[expect]
"y period" = { value = "3 - 2*log(2)", within = 1e-6 }
)toml");
  const auto results = check(made);
  EXPECT_TRUE(results.front().met) << to_text(results);
}

TEST(Expectations, AskForEachTimeOnceInOrder) {
  const Compiled made(kCircle, R"toml([run]
until = 4
[expect]
"x at 3"    = { value = 0, within = 9 }
"y at 1"    = { value = 0, within = 9 }
"y at 3"    = { value = 0, within = 9 }
"x maximum" = { value = 0, within = 9 }
)toml");
  EXPECT_THAT(expectation_times(made.diagram, 4), ElementsAre(1, 3));
  EXPECT_EQ(check(made).size(), 4U);
}

TEST(Expectations, RefuseATimeOutsideOfAShorterRun) {
  const Compiled made(kCircle,
                      "[run]\nuntil = 4\n[expect]\n\"x at 3\" = { value = 0, within = 9 }\n"
                      "\"y at 1\" = { value = 0, within = 9 }\n");
  EXPECT_EQ(message_of<diagram::DiagramError>([&] { expectation_times(made.diagram, 2); }),
            "d.toml:8:1: 'x at 3' is at t = 3 s, outside the run; expected a time from 0 to 2 s\n"
            "  remedy: let the run last longer: 'until'");
}

TEST(Expectations, RefuseAnUnknownOutputAndSuggestOne) {
  const Compiled made(kCircle, "[outputs]\nheight = \"y\"\n");
  diagram::Diagram changed = made.diagram;
  diagram::Expectation wrong;
  wrong.text = "heigth maximum";
  wrong.output = "heigth";
  wrong.kind = diagram::Expectation::Kind::maximum;
  wrong.place = {"d.toml", {9, 1}};
  changed.expectations = {wrong};
  const std::string message =
      message_of<diagram::DiagramError>([&] { check_expectations(changed, run_of(made)); });
  EXPECT_THAT(message, HasSubstr("d.toml:9:1: 'heigth maximum': there is no output 'heigth'"));
  EXPECT_THAT(message, HasSubstr("did you mean 'height'?"));
}

}  // namespace
}  // namespace oblique::report
