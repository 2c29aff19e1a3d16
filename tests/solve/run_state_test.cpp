// SPDX-License-Identifier: MIT
// Runs that are saved and gone on with.
#include <oblique/solve/run_state.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::message_of;
using testing::row_values;
using testing::run_of;

constexpr const char* kVanDerPol = R"(one = { type = "constant" }
xx   = { type = "multiplier", in = ["x", "x"] }
damp = { type = "summer", in = ["one", "-xx"] }
dy   = { type = "multiplier", in = ["damp", "y"] }
x = { type = "integrator", in = ["y"], initial = 0.5 }
y = { type = "integrator", in = ["dy", "-x"] }
)";

Run run_from(const Compiled& made, const RunState& state, double until) {
  RunOptions options;
  options.until = until;
  options.samples = 2;
  options.from = parse_run_state(to_text(state), "s.toml");
  return run(made.program, made.flat, options);
}

TEST(RunState, GoingOnGivesWhatAnUninterruptedRunGives) {
  const Compiled made(kVanDerPol);
  const auto whole = run_of(made, {.until = 30, .samples = 2});
  const auto half = run_of(made, {.until = 11.7, .samples = 2});
  const auto rest = run_from(made, half.state, 30);
  EXPECT_EQ(rest.trajectory.at(0, 0), 11.7);
  for (const char* const name : {"x", "y"}) {  // tolerance 1e-8 over five periods of a stable cycle
    EXPECT_NEAR(row_values(rest, name).back(), row_values(whole, name).back(), 1e-6) << name;
  }
}

TEST(RunState, KeepsDiscreteStatesAndPhases) {
  const Compiled made(
      R"(one = { type = "constant" }
x = { type = "integrator", in = ["one"], initial = 0.25 }
)",
      "[timeline]\nphases = [{ mode = \"initial\", for = 1 }, { mode = \"operate\", for = 2 }]\ncycles = "
      "4\n");
  const auto whole = run_of(made, {.until = 12, .samples = 2});
  const auto half = run_of(made, {.until = 8, .samples = 2});
  const auto rest = run_from(made, half.state, 12);
  EXPECT_NEAR(row_values(rest, "x").back(), row_values(whole, "x").back(), 1e-12);
  EXPECT_NEAR(row_values(rest, "x").front(), 0.25 + 1, 1e-12);
}

// A tank of level h whose outflow q is the root of it runs dry at t = 2 s, and stays so: there the loop of q
// has no derivative, and a run that goes on begins with that.
TEST(RunState, KeepsATankDry) {
  const Compiled made(R"(h = { type = "integrator", in = "-q", initial = 1 }
q = { type = "servo-amplifier", in = ["m", "-h"], gain = "inf", bandwidth = "inf", initial = 1 }
a = { type = "absolute-value", in = "q" }
m = { type = "multiplier", in = ["a", "q"] }
)");
  const auto rest = run_from(made, run_of(made, {.until = 3, .samples = 2}).state, 5);
  EXPECT_EQ(rest.trajectory.at(0, 0), 3);
  EXPECT_NEAR(row_values(rest, "h").back(), 0, 1e-10);  // the absolute tolerance
  EXPECT_EQ(row_values(rest, "q").back(), 0);
}

// The window exp(−1/(1 − s²)), |s| < 1, has no value beyond its end at 77.71 s, where this run goes on. Its
// integral is 0.443993816168079 of its half width, by quadrature with mpmath.
TEST(RunState, GoesOnAtTheEndOfWhatHasNoValueBehind) {
  const Compiled made(
      "window = { type = \"time-function\", formula = \"if(abs(time - 77.7) < 0.01, exp(-1/(1 - (100*(time - "
      "77.7))^2)), 0)\" }\narea = { type = \"integrator\", in = \"window\" }\n");
  const auto rest = run_from(made, run_of(made, {.until = 77.71, .samples = 2}).state, 100);
  EXPECT_NEAR(row_values(rest, "area").back(), 0.01 * 0.443993816168079, 5e-8);  // as the whole run's
}

TEST(RunState, IsReadAsItWasWritten) {
  RunState state;
  state.time = 0.1 + 0.2;
  state.states = {{"x", -1.0 / 3}, {"tri.\"odd\"", 1e-300}};
  state.memories = {{"in > 0.5", 1}};
  state.conditions = {true, false};
  state.position = {2, 5, 0.7};
  const RunState again = parse_run_state(to_text(state), "s.toml");
  EXPECT_EQ(again.time, state.time);
  EXPECT_EQ(again.states, state.states);
  EXPECT_EQ(again.memories, state.memories);
  EXPECT_EQ(again.conditions, state.conditions);
  EXPECT_EQ(again.position.phase, 2U);
  EXPECT_EQ(again.position.begin, 0.7);
}

TEST(RunState, WithConditionsThatAreNoNumbersIsRefused) {
  RunState state;
  state.conditions = {true, false};
  const std::string text = to_text(state);
  const auto refusal = [&](const std::string& by) {
    std::string changed = text;
    const std::string of = "conditions = [1, 0]";
    changed.replace(changed.find(of), of.size(), by);
    return message_of<text::ReadError>([&] { parse_run_state(changed, "s.toml"); });
  };
  EXPECT_EQ(refusal("conditions = [1, \"no\"]"),
            "s.toml:4:18: an element of 'conditions' is a string; expected a number");
  EXPECT_EQ(refusal("conditions = 1"), "s.toml:4:14: 'conditions' is a number; expected an array of numbers");
}

TEST(RunState, OfAnotherDiagramIsRefused) {
  const Compiled made(kVanDerPol);
  const Compiled other(
      "x = { type = \"integrator\", in = [\"z\"] }\nz = { type = \"integrator\", in = [\"-x\"] }\n");
  const auto half = run_of(made, {.until = 1, .samples = 2});
  EXPECT_EQ(message_of<text::ReadError>([&] { run_from(other, half.state, 2); }),
            "d.toml: this is the state of another diagram: it has the state 'y' where the diagram has 'z'; "
            "expected the state of a run of this diagram\n"
            "  remedy: parameters may change between runs, blocks and wires may not");
  EXPECT_THAT(
      message_of<text::ReadError>([] { parse_run_state("format = \"oblique-diagram/1\"\n", "s.toml"); }),
      HasSubstr(
          "s.toml:1:10: the format is 'oblique-diagram/1'; expected 'oblique-state/1', the state of a run"));
}

}  // namespace
}  // namespace oblique::solve
