// SPDX-License-Identifier: MIT
#include <oblique/report/run_text.h>

#include <array>

#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::report {
namespace {

using testing::Compiled;

constexpr const char* kDecay = R"toml(x = { type = "integrator", in = ["-x"], initial = 1 }
)toml";

TEST(RunText, ShowsTheFirstColumnsOfRowsFromFirstToLast) {
  solve::Trajectory trajectory({{"t", "s"}, {"x", "1"}, {"y", "V"}});
  for (int k = 0; k <= 100; ++k) trajectory.add_row(std::array{0.5 * k, 2.0 * k, 7.0});
  const auto rows = rows_of(trajectory, 2).rows();
  ASSERT_EQ(rows.size(), 2U + 21U);  // names, units and as many rows as a terminal shows without scrolling
  EXPECT_EQ(rows[0], (std::vector<std::string>{"t", "x"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"[s]", "[1]"}));
  EXPECT_EQ(rows[2], (std::vector<std::string>{"0", "0"}));
  EXPECT_EQ(rows.back(), (std::vector<std::string>{"50", "200"}));
}

TEST(RunText, CountsTheEventsThatWereNotKept) {
  const std::vector<solve::EventRecord> events{{0.125, "'a' closes"}, {2, "'a' opens"}};
  EXPECT_EQ(events_text(events, 2), "t [s]       event\n0.125  'a' closes\n    2   'a' opens\n");
  EXPECT_EQ(events_text(events, 5), events_text(events, 2) + "(3 more)\n");
  // The condition of a delay line is a sum of 24 comparisons: one such would make all lines so long.
  const std::string end = std::string(44, 'y') + "ü";
  EXPECT_EQ(events_text({{1, "ä" + std::string(43, 'x') + std::string(300, '+') + end}}, 1),
            "t [s]" + std::string(88, ' ') + "event\n    1  ä" + std::string(43, 'x') + " … " +
                end.substr(1) + "\n");
}

TEST(RunText, NamesStatesAndWhatIsBroughtToRestInAStaticTest) {
  EXPECT_EQ(static_test_text({{"c", 0.5, {}, false}, {"x", 1, -0.25, false}, {"amp", 0.3, 0, true}}),
            "element                           output              d/dt\n"
            "                          [machine unit]  [machine unit/s]\n"
            "c                                    0.5\n"
            "x        state                         1             -0.25\n"
            "amp      brought to rest             0.3                 0\n");
}

TEST(RunText, SaysTheWorkAndTheMethod) {
  const Compiled made(kDecay, "");
  solve::Run run;
  run.statistics.steps = 1;
  run.seconds = 0.0125;
  run.method = {diagram::IntegrationMethod::bdf, "it is asked for"};
  solve::RunOptions options;
  options.tolerance = 1e-5;
  EXPECT_EQ(solver_text(made.program, run, options),
            "1 state, 0 algebraic loops; 1 step (relative tolerance 1e-05), 12.5 ms\n"
            "method bdf: it is asked for\n");
}

TEST(RunText, SpellsTheSettingsOfWarningsAsTheHostDoes) {
  solve::Run run;
  run.warnings = {{{"d.toml", {}}, "the run is short", {}, {"set ", text::Setting{"until"}}}};
  const text::Vocabulary buttons{[](const text::Setting& s) { return "[" + s.name + "]"; }, {}};
  EXPECT_EQ(warnings_text(run, buttons), "warning: d.toml: the run is short\n  remedy: set [until]\n");
}

TEST(RunText, TellsEachOverloadOrTheOneThatEndedTheRun) {
  const Compiled made(kDecay, "");
  solve::Run run;
  run.overloads = {{0, 0.25, 1.5, {-3.5, 1}, 0.2}, {0, 0.75, 0.5, {2, 1}, 0.5}};
  EXPECT_EQ(overloads_text(made.program, run),
            "overload: 'x' leaves ±1 machine unit at t = 0.25 s, peak -3.5, 1.5 s in all\n"
            "overload: 'x' leaves ±1 machine unit at t = 0.75 s, peak 2, 0.5 s in all\n");
  run.halted = true;
  EXPECT_EQ(overloads_text(made.program, run),
            "overload: 'x' leaves ±1 machine unit at t = 0.25 s; the run ends there\n");
}

TEST(RunText, GivesTheDigitsThatAnErrorLeaves) {
  solve::Trust trust;
  EXPECT_EQ(trust_text(trust), "trust: no estimate of the errors: interrupted\n");
  trust.failure = "too many steps";
  EXPECT_EQ(trust_text(trust), "trust: no estimate of the errors: too many steps\n");
  trust.checks = {{1e-8, diagram::IntegrationMethod::bdf}, {1e-6, diagram::IntegrationMethod::adams}};
  trust.outputs = {{"x", 1, 2e-5, 2e-7, {}}, {"y", 1, 0.5, 0.5, 3.0}};
  trust.event_shift = 1e-4;
  trust.events_part = 8;
  EXPECT_EQ(
      trust_text(trust),
      "trust: errors of the outputs, from a run at a tolerance of 1e-08 by bdf and a run at a tolerance "
      "of 1e-06 by adams\n"
      "output  size  largest error  digits  digits at the end  no digit from [s]\n"
      "     x     1        2.0e-05       4                  6\n"
      "     y     1        5.0e-01       0                  0                  3\n"
      "trust: the times of events differ by 1.0e-04 s at most\n"
      "warning: from t = 8 s on the runs do not have the same events\n"
      "trust: one more run ended early: too many steps\n");
  trust.has_states = false;
  EXPECT_NE(
      trust_text(trust).find("trust: the diagram integrates nothing, so that these runs round alike: what it "
                             "makes of rounding, from event to event, is not in them\n"),
      std::string::npos);
}

}  // namespace
}  // namespace oblique::report
