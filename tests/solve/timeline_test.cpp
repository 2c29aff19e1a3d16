// SPDX-License-Identifier: MIT
// Modes of operation and phases.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::message_of;
using testing::row_values;
using testing::run_of;
using testing::shipped_blocks_and;

/// An integrator that knows its modes, and nothing else.
diagram::BlockLibrary library_with_modes() {
  return shipped_blocks_and("mode-integrator", R"toml([inputs]
in = { sum = true }
[outputs]
out = {}
[parameters]
initial = {}
[equations]
"der(out)" = "if(in_operate, in, 0)"
[start]
out = "initial"
[[events]]
when = "in_initial"
set = { out = "initial" }
)toml");
}

constexpr const char* kRamp = R"(one = { type = "constant" }
x = { type = "mode-integrator", in = ["one"], initial = 0.25 }
)";

TEST(Timeline, LeadsThroughItsPhases) {
  const diagram::BlockLibrary library = library_with_modes();
  const Compiled made(kRamp, R"([timeline]
phases = [{ mode = "potset", for = 1 }, { mode = "initial", for = 1 }, { mode = "operate", for = 2 }, { mode = "hold", for = 1 }]
cycles = 2
)",
                      library);
  EXPECT_EQ(made.diagram.run.until, 10) << "the whole timeline, where [run] does not say otherwise";
  const auto result = run_of(made, {.until = 10, .samples = 101});
  const auto t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t r = 0; r < t.size(); ++r) {
    const double in_cycle = t[r] > 5 ? t[r] - 5 : t[r];  // a row at an event shows the side before it
    const double ramp = std::clamp(in_cycle - 2, 0.0, 2.0);
    EXPECT_NEAR(x[r], 0.25 + ramp, 1e-12) << t[r];  // a ramp, to rounding
  }
}

/// Two integrators that take their values from each other by turns; `front` follows `next`, a function of x.
Compiled memory_pair(const std::string& next) {
  return Compiled(
      "one = { type = \"constant\" }\nxx = { type = \"squarer\", in = \"x\" }\n"
      "next = { type = \"summer\", in = [" +
          next +
          "] }\n"
          "front = { type = \"integrator\", in = [], start = \"next\" }\n"
          "x = { type = \"integrator\", in = [], start = \"front\", initial = 0.25 }\n",
      R"([groups]
a = ["front"]
b = ["x"]
[timeline]
phases = [{ mode = "operate", a = "initial", b = "hold", for = 1 }, { mode = "operate", a = "hold", b = "initial", for = 1 }]
)");
}

TEST(Timeline, StartsThatFollowFromEachOtherAreToldOf) {
  // x = front + 0.25 and front = 0.5 x + 1 agree at x = 2.5; one that is held would not take part.
  const auto agreed = run_of(memory_pair("\"0.5*x\", \"one\""), {.until = 2});
  ASSERT_EQ(agreed.warnings.size(), 1U);
  EXPECT_EQ(agreed.warnings[0].what,
            "the initial values of 'front', 'x' follow from each other in a circle: the run begins where "
            "they agree, "
            "at front = 2.25");
  EXPECT_EQ(agreed.warnings[0].remedy,
            "give one of them a fixed 'initial', or cut the circle at the start with an electronic-switch");
  // x -> 2 x + 1 runs away, and x -> 4 x (1 - x) as well, from 0.25 on beyond all numbers.
  for (const char* const next : {"\"2*x\", \"one\"", "\"4*x\", \"-4*xx\""}) {
    EXPECT_THAT(
        message_of<SolveError>([&] { run_of(memory_pair(next), {.until = 2}); }),
        HasSubstr("the initial values of 'front', 'x' follow from each other in a circle; expected initial "
                  "values that agree"))
        << next;
  }
}

// The amplifiers between two stores are to rest before the next store takes its value from them, each with an
// offset: the values go on for ever, by so much each time.
TEST(Timeline, StartsThatFollowFromEachOtherThroughServoLoopsAreToldOf) {
  const Compiled made(R"(off = { type = "constant", value = 0 }
minus_next = { type = "summer", in = ["s", "10*off"] }
next = { type = "inverter", in = "minus_next" }
ahead = { type = "integrator", start = "next" }
s = { type = "integrator", start = "ahead" }
)",
                      R"([machine]
profile = "tr-10"
inverting = true
[groups]
ahead = { blocks = ["ahead"], initial = "off" }
s = { blocks = ["s"], initial = "off" }
)");
  EXPECT_THAT(
      message_of<SolveError>([&] { run_of(made, {.until = 1}); }),
      HasSubstr("the initial values of 'ahead', 's' follow from each other in a circle; expected initial "
                "values that agree"));
}

TEST(Timeline, AStartThatIsNoFiniteNumberIsNoCircle) {
  const Compiled made(
      "s = { type = \"time-function\", formula = \"1/time\" }\n"
      "x = { type = \"integrator\", in = [], start = \"s\" }\n");
  EXPECT_THAT(
      message_of<SolveError>([&] { run_of(made, {.until = 1}); }),
      HasSubstr(
          "'x' would start at inf, which the signals at its start give; expected a finite initial value"));
}

TEST(Timeline, AStartFromAChainOfSignalsIsNoCircle) {
  std::string blocks =
      "one = { type = \"constant\", value = 0.5 }\nx9 = { type = \"integrator\", in = [], start = \"one\" "
      "}\n";
  for (int k = 8; k >= 0; --k)
    blocks += "x" + std::to_string(k) + " = { type = \"integrator\", in = [], start = \"x" +
              std::to_string(k + 1) + "\" }\n";
  const Compiled made(blocks);
  const auto result = run_of(made, {.until = 1});
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_EQ(row_values(result, "x0").front(), 0.5);
}

TEST(Timeline, APhaseEndsByItsCondition) {
  // Repetitive operation: cos t until it falls below 0, π/2 each time.
  const diagram::BlockLibrary library = library_with_modes();
  const Compiled made(R"(x = { type = "mode-integrator", in = ["y"], initial = 1 }
y = { type = "mode-integrator", in = ["-x"] }
)",
                      R"([timeline]
phases = [{ mode = "initial", for = 0.5 }, { mode = "operate", until = "x < 0" }]
cycles = inf
[run]
until = 20
)",
                      library);
  const auto result = run_of(made, {.until = 20, .tolerance = 1e-10, .samples = 2});
  std::vector<double> ends;
  for (const EventRecord& event : result.events) {
    if (event.what == "timeline: x < 0 from now on") ends.push_back(event.time);
  }
  ASSERT_EQ(ends.size(), 9U);
  for (std::size_t k = 0; k < ends.size(); ++k) {  // a solver's error of about 1e-9 in each of nine cycles
    EXPECT_NEAR(ends[k], static_cast<double>(k + 1) * (0.5 + std::numbers::pi / 2), 1e-8);
  }
}

constexpr const char* kHeldUntilASineRises = R"toml(u = { type = "time-function", formula = "sin(time)" }
one = { type = "constant" }
x = { type = "integrator", in = ["one"] }
)toml";

// The second phase begins where sin t comes to 1/2, within a step, changes nothing, and ends 0.2 s later.
TEST(Timeline, APhaseEndsByItsTimeThatBeginsWithoutEffect) {
  for (const char* const mode : {"hold", "initial"}) {
    const Compiled made(kHeldUntilASineRises, fmt::format(R"toml([timeline]
phases = [
  {{ mode = "{0}", until = "u > 0.5" }}, {{ mode = "{0}", for = 0.2 }}, {{ mode = "operate", for = 9 }}
]
)toml",
                                                          mode));
    const auto result = run_of(made, {.until = 5, .samples = 2});
    EXPECT_NEAR(row_values(result, "x").back(), 5 - std::numbers::pi / 6 - 0.2, 1e-9);  // that of an event
  }
}

// Phases that end by one condition keep one memory of it, under one name, and a run goes on from where it
// stood.
TEST(Timeline, PhasesOfOneConditionAreSavedAndGoOn) {
  const Compiled made(kHeldUntilASineRises, R"toml([timeline]
phases = [
  { mode = "hold", until = "u > 0.5" }, { mode = "operate", for = 1 }, { mode = "hold", until = "u > 0.5" }
]
cycles = inf
)toml");
  RunOptions options;
  options.until = 20;
  const oblique::solve::Run whole = run(made.program, made.flat, options);
  options.until = 8;
  const oblique::solve::Run first = run(made.program, made.flat, options);
  options.until = 20;
  options.from = parse_run_state(to_text(first.state), "state.toml");
  const oblique::solve::Run second = run(made.program, made.flat, options);
  EXPECT_NEAR(row_values(second, "x").back(), row_values(whole, "x").back(), 1e-9);
  EXPECT_GT(row_values(whole, "x").back(), 3);
}

// x starts from y, and z from x: all three come to 0.8 at once in each initial condition, whatever the order
// of the rows; x, from −0.2 a second, is at no time near zero, and nothing counts.
TEST(Timeline, InitialValuesInAChainAreTakenAtOnce) {
  const std::string one = "one = { type = \"constant\" }\n";
  const std::string y = "y = { type = \"integrator\", in = [\"-one\"], initial = 0.8 }\n";
  const std::string x = "x = { type = \"integrator\", in = [\"-0.2*one\"], start = \"y\" }\n";
  const std::string z = "z = { type = \"integrator\", in = [\"one\"], start = \"x\" }\n";
  const std::string count =
      "c = { type = \"comparator\", in = [\"x\"] }\nk = { type = \"counter\", clock = \"c\" }\n";
  for (const std::string& rows : {one + y + x + z + count, count + z + x + y + one}) {
    const Compiled made(
        rows,
        "[timeline]\nphases = [{ mode = \"operate\", for = 1 }, { mode = \"initial\", for = 0.5, "
        "until = \"x < 0.7\" }]\ncycles = 4\n");
    const auto result = run_of(made, {.until = 6, .samples = 600});
    const auto t = row_values(result, "t"), at_x = row_values(result, "x"), at_z = row_values(result, "z");
    for (std::size_t r = 0; r < t.size(); ++r) {
      const double since = std::fmod(t[r], 1.5);
      EXPECT_NEAR(at_x[r], since < 1 ? 0.8 - 0.2 * since : 0.8, 1e-12) << t[r];  // lines, to rounding
      EXPECT_NEAR(at_z[r], since < 1 ? 0.8 + since : 0.8, 1e-12) << t[r];
    }
    EXPECT_EQ(row_values(result, "k.out").back(), 0);
  }
}

TEST(Timeline, GroupsHaveModesOfTheirOwn) {
  const diagram::BlockLibrary library = library_with_modes();
  const Compiled made(R"(one = { type = "constant" }
x = { type = "mode-integrator", in = ["one"] }
y = { type = "mode-integrator", in = ["one"] }
)",
                      R"([groups]
slow = ["y"]
[timeline]
phases = [{ mode = "operate", slow = "hold", for = 1 }, { mode = "hold", slow = "operate", for = 2 }]
)",
                      library);
  const auto result = run_of(made, {.until = 3, .samples = 4});
  EXPECT_NEAR(row_values(result, "x").back(), 1, 1e-12);
  EXPECT_NEAR(row_values(result, "y").back(), 2, 1e-12);
}

TEST(Timeline, ModeLinesAreDrivenBySignals) {
  // y is held while the wave is above 0.5, a third of each turn, and reset while the other is.
  const diagram::BlockLibrary library = library_with_modes();
  const Compiled made(R"(one = { type = "constant" }
phase = { type = "integrator", in = ["one"] }
wave = { type = "cosine", in = "phase" }
y = { type = "mode-integrator", in = ["one"] }
z = { type = "mode-integrator", in = ["one"], initial = 3 }
)",
                      "[groups]\nheld = { blocks = [\"y\"], hold = \"wave\" }\nback = { blocks = [\"z\"], "
                      "initial = \"wave\" }\n",
                      library);
  const double turn = 2 * std::numbers::pi;
  const auto result = run_of(made, {.until = 4 * turn, .samples = 5});
  EXPECT_NEAR(row_values(result, "y").back(), 4 * turn * 2 / 3, 1e-9);
  EXPECT_NEAR(row_values(result, "z").back(), 3, 1e-12);
  EXPECT_EQ(result.event_count, 8 * 2 + 2 * 1 + 3)
      << "8 crossings of two lines, two at the start; z is set 5 times";
}

TEST(Timeline, APhaseThatEndsFirstLeavesKnownTimesAlone) {
  const diagram::BlockLibrary library = library_with_modes();
  const Compiled made(
      R"(p = { type = "pulse-train", delay = 2.5, period = 10, width = 1 }
x = { type = "mode-integrator", in = ["p"] }
)",
      "[timeline]\nphases = [{ mode = \"hold\", for = 2 }, { mode = \"operate\", for = 8 }]\n", library);
  EXPECT_NEAR(row_values(run_of(made, {.until = 3, .samples = 2}), "x").back(), 0.5, 1e-9);
}

TEST(Timeline, PhasesThatEndAtOnceAreRefused) {
  const diagram::BlockLibrary library = library_with_modes();
  const std::string message = message_of<SolveError>([&] {
    run_of(Compiled(kRamp, "[timeline]\ncycles = inf\nphases = [{ mode = \"operate\", until = \"x > 0\" }]\n",
                    library));
  });
  EXPECT_THAT(message, HasSubstr("the phases of the timeline end at once, one after the other, at t = 0 s"));
}

TEST(Timeline, ImpossibleOnesAreRefusedTogether) {
  const auto refusal = [](const std::string& tables) {
    return message_of<diagram::DiagramError>([&] {
      const diagram::BlockLibrary library = library_with_modes();
      Compiled(kRamp, tables, library);
    });
  };
  const std::string message = refusal(R"([timeline]
phases = [{ for = 1 }, { mode = "run", for = 1 }, { mode = "hold", for = -1 }, { mode = "hold" }, { mode = "hold", until = "sin(x) > 1" }]
cycles = 0
)");
  EXPECT_THAT(message, HasSubstr("phase 1 has no 'mode'; expected potset, initial, operate or hold"));
  EXPECT_THAT(message, HasSubstr("phase 2: 'run' is no mode of operation"));
  EXPECT_THAT(message, HasSubstr("phase 3 lasts -1 s; expected a time above 0 [s]"));
  EXPECT_THAT(message, HasSubstr("phase 4 has no end; expected 'for', a time, or 'until', a condition"));
  EXPECT_THAT(message, HasSubstr("phase 5: 'sin(x) > 1' does not compare a signal with a number"));
  EXPECT_THAT(message, HasSubstr("'cycles' of [timeline] is 0; expected a whole number from 1 on, or inf"));
  EXPECT_THAT(refusal("[timeline]\n"), HasSubstr("[timeline] has no list of 'phases'"));
  EXPECT_THAT(refusal("[groups]\nfast = [\"y\"]\n"), HasSubstr("group 'fast': there is no block 'y'"));
  EXPECT_THAT(refusal("[groups]\na = [\"x\"]\nb = [\"x\"]\n"),
              HasSubstr("group 'b': 'x' is in group 'a' already"));
  EXPECT_THAT(refusal("[groups]\nmain = [\"x\"]\n"), HasSubstr("group 'main': a phase uses that key itself"));
  EXPECT_THAT(refusal("[groups]\na = { blocks = [\"x\"], hold = \"z\" }\n"),
              HasSubstr("group 'a': there is no signal 'z'"));
  EXPECT_THAT(refusal("[timeline]\nphases = [{ mode = \"hold\", until = \"z > 1\" }]\n"),
              HasSubstr("phase 1: there is no signal 'z'"));
}

TEST(Timeline, IsWrittenAsItIsRead) {
  const diagram::BlockLibrary library = library_with_modes();
  const Compiled made(kRamp, R"([groups]
slow = { blocks = ["x"], hold = "one" }
[timeline]
phases = [{ mode = "operate", slow = "hold", for = 1 }, { mode = "hold", until = "x > 0.5" }]
cycles = 3
)",
                      library);
  const diagram::Diagram again = diagram::parse_diagram(diagram::write_diagram(made.diagram), "again.toml");
  EXPECT_EQ(again, made.diagram);
}

}  // namespace
}  // namespace oblique::solve
