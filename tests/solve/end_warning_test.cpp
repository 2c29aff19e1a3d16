// SPDX-License-Identifier: MIT
// What a run says of points that it goes beyond, and of cycles that it does not come to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::run_of;

std::vector<std::string> warnings_of(const Compiled& made, double until) {
  std::vector<std::string> texts;
  for (const text::Diagnostic& warning : run_of(made, {.until = until}).warnings)
    texts.push_back(text::to_string(warning));
  return texts;
}

Compiled recording(const std::string& points, const std::string& beyond = "extrapolate") {
  return Compiled("u = { type = \"recording\", data = { points = " + points + ", beyond = \"" + beyond +
                  "\" } }\n");
}

constexpr const char* kPoints = "[[0, 0], [0.9, 0.3], [1, 0.5]]";

TEST(CoarseTolerance, IsToldOfAdamsAlone) {
  const Compiled made("x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n");
  const auto warnings = [&](double tolerance, diagram::IntegrationMethod method) {
    RunOptions options;
    options.tolerance = tolerance;
    options.method = method;
    std::vector<std::string> texts;
    for (const text::Diagnostic& warning : oblique::solve::run(made.program, made.flat, options).warnings)
      texts.push_back(text::to_string(warning));
    return texts;
  };
  EXPECT_THAT(warnings(0.01, diagram::IntegrationMethod::adams),
              ::testing::ElementsAre(
                  "d.toml: at a tolerance of 0.01 Adams lets oscillations grow; expected 1e-3 or less"));
  EXPECT_THAT(warnings(1e-3, diagram::IntegrationMethod::adams), ::testing::IsEmpty());
  EXPECT_THAT(warnings(0.01, diagram::IntegrationMethod::bdf), ::testing::IsEmpty());
}

TEST(InitialCondition, ThatIsTooShortToFollowAChangingStartIsTold) {
  const auto warnings = [](const std::string& start, const std::string& more, const std::string& length) {
    const Compiled made(
        "u = { type = \"sine-source\", frequency = 7e6 }\nc = { type = \"constant\" }\n"
        "h = { type = \"integrator\", in = \"c\" }\n"
        "x = { type = \"integrator\", in = \"c\", start = \"" +
            start + "\"" + more + " }\n",
        "[timeline]\nphases = [ { mode = \"initial\", for = \"" + length +
            "\" }, { mode = \"operate\", for = 5e-8 } ]\n");
    return warnings_of(made, 1e-7);
  };
  EXPECT_THAT(warnings("u", "", "50 ns"),
              ::testing::ElementsAre(::testing::HasSubstr(
                  "'x' follows its 'start' with a time constant of 1 µs, in a phase of 5e-08 s")));
  EXPECT_THAT(warnings("u", ", charging = 1e-12", "50 ns"), ::testing::IsEmpty());
  EXPECT_THAT(warnings("c", "", "50 ns"), ::testing::IsEmpty());
  EXPECT_THAT(warnings("h", "", "50 ns"), ::testing::IsEmpty());  // which does not operate then
  EXPECT_THAT(warnings("u", "", "1 ms"), ::testing::IsEmpty());
}

TEST(EndOfARecording, IsTold) {
  EXPECT_THAT(
      warnings_of(recording(kPoints), 10),
      ::testing::ElementsAre(
          "d.toml:3:1: the points of 'u' end at t = 1 s, the run at 10 s: between them the line through the "
          "last "
          "two points goes on; expected points over the whole run\n"
          "  remedy: beyond = \"hold\" in the table of the points makes the outermost values hold; another "
          "point, or a pause at the end, says what else should"));
  EXPECT_THAT(
      warnings_of(recording("[[0.5, 0], [2, 1]]"), 2),
      ::testing::ElementsAre(::testing::HasSubstr("the points of 'u' begin at t = 0.5 s, the run at 0 s: "
                                                  "between them the line through the first two")));
}

TEST(EndOfARecording, IsNotToldWhereNothingIsMadeUp) {
  EXPECT_THAT(warnings_of(recording(kPoints), 1), ::testing::IsEmpty());
  EXPECT_THAT(warnings_of(recording(kPoints, "hold"), 10), ::testing::IsEmpty());
  EXPECT_THAT(warnings_of(recording("[[0, 0], [0.9, 0.3], [1, 0.3]]"), 10), ::testing::IsEmpty())
      << "a pause";
  EXPECT_THAT(warnings_of(recording("[[0, 0], [0.1, 1], [0.3, 2]]"), 0.1 + 0.2), ::testing::IsEmpty())
      << "rounding";
}

TEST(EndOfARecording, IsWhereItSays) {
  EXPECT_NEAR(testing::row_values(run_of(recording(kPoints), {.until = 10}), "u").back(), 0.5 + 9 * 2, 1e-12);
  EXPECT_NEAR(testing::row_values(run_of(recording(kPoints, "hold"), {.until = 10}), "u").back(), 0.5, 1e-12);
}

Compiled cosine(const std::string& timeline) {
  return Compiled(
      "x = { type = \"integrator\", in = \"v\", initial = 1 }\nv = { type = \"integrator\", in = \"-x\" }\n",
      "[timeline]\n" + timeline + "\n");
}

constexpr const char* kHalfWaves =
    "phases = [{ mode = \"initial\", for = 0.01 }, { mode = \"operate\", until = \"x < 0\" }]\ncycles = 1000";

TEST(EndOfATimeline, IsTold) {
  EXPECT_THAT(
      warnings_of(cosine(kHalfWaves), 1),
      ::testing::ElementsAre(
          "d.toml: the run ends at t = 1 s in phase 2 of cycle 1 of its timeline; expected phase 2 of cycle "
          "1000, the last one\n"
          "  remedy: the length of such phases is not known in advance: give a later 'until' in [run], or "
          "'until'"));
  // A cycle is 0.01 s + π/2, so that 3 of them are over at 5 s.
  EXPECT_THAT(warnings_of(cosine(kHalfWaves), 5),
              ::testing::ElementsAre(::testing::HasSubstr("in phase 2 of cycle 4 of its timeline")));
  EXPECT_THAT(warnings_of(cosine(kHalfWaves), 5),
              ::testing::ElementsAre(::testing::HasSubstr("at the pace so far all cycles take 1.67e+03 s")));
}

TEST(EndOfATimeline, IsNotToldWhereItIsMeant) {
  EXPECT_THAT(warnings_of(cosine("phases = [{ mode = \"operate\", until = \"x < 0\" }]"), 1),
              ::testing::IsEmpty());
  EXPECT_THAT(warnings_of(cosine("phases = [{ mode = \"operate\", until = \"x < 0\" }]\ncycles = inf"), 1),
              ::testing::IsEmpty());
  EXPECT_THAT(warnings_of(cosine("phases = [{ mode = \"operate\", for = 1 }]\ncycles = 3"), 1),
              ::testing::IsEmpty());
}

}  // namespace
}  // namespace oblique::solve
