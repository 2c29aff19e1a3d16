// SPDX-License-Identifier: MIT
// A machine that is held: against the runs that it must agree with, and closed forms where a pot is turned.
#include <oblique/console/console.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/solve/run.h>
#include <oblique/solve/run_state.h>

#include "../support/runs.h"

namespace oblique::console {
namespace {

using diagram::OperatingMode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

diagram::Diagram diagram_of(std::string_view blocks, std::string_view rest = "") {
  return diagram::parse_diagram(testing::diagram_text(blocks, rest), "d.toml");
}

Console console_of(std::string_view blocks, std::string_view rest = "") {
  return {diagram_of(blocks, rest), testing::shipped_blocks()};
}

const char* const kDecay = "x = { type = \"integrator\", in = \"-x\", initial = 1 }\n";

const char* const kRelayServo = R"(
half = { type = "constant", value = 0.3 }
x = { type = "integrator", in = "v", initial = 1 }
v = { type = "integrator", in = ["-u", "-half", "-0.2*v"] }
u = { type = "relay", coil = "x", make = "half", break = "-half", pull_in = 0.1, drop_out = -0.1 }
c = { type = "servo-amplifier", in = ["c", "-x"], gain = 1e4, bandwidth = 1e3 }
)";

// At the rows of a run the machine reads what the run has, to the last bit: also between its steps, at its
// events, and however often it was asked in between.
TEST(Console, ReadsWhatARunHas) {
  const diagram::Diagram diagram = diagram_of(kRelayServo, "[run]\nuntil = 20\n");
  const solve::Run run = solve::run(diagram, testing::shipped_blocks());
  ASSERT_GE(run.event_count, 4);
  for (const int stride : {1, 7, 100}) {
    Console console(diagram, testing::shipped_blocks());
    for (std::size_t row = 0; row < run.trajectory.rows(); row += static_cast<std::size_t>(stride)) {
      console.advance(run.trajectory.at(row, 0));
      for (std::size_t c = 1; c < run.trajectory.columns().size(); ++c)
        ASSERT_EQ(console.value(run.trajectory.columns()[c].name), run.trajectory.at(row, c)) << row;
    }
    EXPECT_THAT(console.events(), SizeIs(run.events.size()));
    EXPECT_THAT(console.warnings(), IsEmpty());
  }
}

// y = −0.3 − 2 f(y/2), f = −y/4 below zero and −0.875 above: y = −0.6 and y = 1.45.
TEST(Console, WarnsOfWhatNothingChoosesAtTheStart) {
  const Console console = console_of(R"(
y = { type = "summer", in = ["-0.3*one", "-2*f"] }
one = { type = "constant" }
f = { type = "function-generator", in = "0.5*y", points = [[-1, 0.5], [0, 0], [0, -0.875], [1, -0.875]] }
)");
  ASSERT_THAT(console.warnings(), SizeIs(1));
  EXPECT_THAT(console.warnings()[0].what,
              HasSubstr("' has several solutions: at t = 0 s the run begins with "));
}

// The same of every diagram that is shipped. The elements of an algebraic loop are sought from where they
// were evaluated last, which rows do in a run: there it is the same to the rounding of that search.
TEST(Console, ReadsWhatTheRunsOfTheShippedDiagramsHave) {
  for (const char* const folder : {"lessons", "historical"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder)) {
      if (entry.path().extension() != ".toml") continue;
      const diagram::Diagram diagram = diagram::read_diagram(entry.path());
      const solve::Run run = solve::run(diagram, testing::shipped_blocks());
      Console console(diagram, testing::shipped_blocks());
      const double rounding = run.state.unknowns.empty() ? 0 : 1e-13;
      const std::size_t rows = run.trajectory.rows();
      for (std::size_t row = 0; row < rows; row += std::max<std::size_t>(1, rows / 40)) {
        console.advance(run.trajectory.at(row, 0));
        for (std::size_t c = 1; c < run.trajectory.columns().size(); ++c) {
          const double has = run.trajectory.at(row, c);
          ASSERT_NEAR(console.value(run.trajectory.columns()[c].name), has, rounding * (1 + std::abs(has)))
              << entry.path() << " at row " << row;
        }
      }
    }
  }
}

// A machine that failed tells so again, and nothing else changes it: x′ = x² from 1 is infinite at t = 1.
TEST(Console, StandsWhereTheMachineFailed) {
  Console console = console_of(
      "s = { type = \"squarer\", in = \"x\" }\nx = { type = \"integrator\", in = \"s\", initial = 1 }\n");
  const solve::RunState start = console.save();
  EXPECT_THROW(console.advance(3), solve::SolveError);
  EXPECT_NEAR(console.time(), 1, 1e-3);
  EXPECT_THROW(console.advance(3), solve::SolveError);
  console.restore(start);
  console.advance(0.5);
  EXPECT_NEAR(console.value("x"), 2, 1e-7);
}

// Beyond the end of [run] the machine goes on: e^(−t).
TEST(Console, GoesOnBeyondTheEndOfARun) {
  Console console = console_of(kDecay, "[run]\nuntil = 1\n");
  for (const double t : {0.5, 1.0, 1.5, 7.0}) {
    console.advance(t);
    EXPECT_NEAR(console.value("x"), std::exp(-t), 1e-8) << t;  // the tolerance of the run
  }
}

// x′ = −k x with k turned from 1 to 3 at t = 1, and to 0 at t = 2.
TEST(Console, TurnsAPotWhileItRuns) {
  Console console = console_of(
      "p = { type = \"potentiometer\", in = \"x\", setting = 0.5 }\n"
      "x = { type = \"integrator\", in = \"-2*p\", initial = 1 }\n");
  console.advance(1);
  EXPECT_EQ(console.value("p.setting"), 0.5);
  console.turn("p.setting", "0.25");
  EXPECT_EQ(console.value("p.setting"), 0.25);
  EXPECT_EQ(console.time(), 1);
  console.advance(2);
  EXPECT_NEAR(console.value("x"), std::exp(-1.5), 1e-8);
  console.turn("x.in[1]", "0");
  console.advance(9);
  EXPECT_NEAR(console.value("x"), std::exp(-1.5), 1e-8);
}

// From 1 in initial condition, whose pot is turned there: e^(−t)/2 from then on.
TEST(Console, TakesAnInitialValueThatIsTurnedInInitialCondition) {
  Console console = console_of(kDecay);
  console.set_mode(OperatingMode::initial);
  console.advance(1);
  console.turn("x.initial", "0.5");
  EXPECT_EQ(console.value("x"), 0.5);
  console.advance(2);
  console.set_mode(OperatingMode::operate);
  console.turn("x.initial", "0.7");
  EXPECT_EQ(console.value("x"), 0.5) << "in operation it does not go there";
  console.advance(3);
  EXPECT_NEAR(console.value("x"), 0.5 * std::exp(-1), 1e-8);
}

// What counts how often its group came into initial condition counts no turn of a pot.
TEST(Console, CountsAModeOnceWhateverIsTurnedInIt) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("visits", R"toml([outputs]
out = {}
[memories]
n = 0
[equations]
out = "n"
[[events]]
when = "in_initial"
set = { n = "n + 1" }
)toml");
  Console console(diagram_of(std::string(kDecay) + "n = { type = \"visits\" }\n"), library);
  console.set_mode(OperatingMode::initial);
  console.advance(1);
  EXPECT_EQ(console.value("n"), 1);
  console.turn("x.initial", "0.5");
  console.advance(2);
  EXPECT_EQ(console.value("n"), 1);
  EXPECT_EQ(console.value("x"), 0.5);
}

// A clock that is turned goes on from its last pulse: one at 10 s, then each 2 s (at 12 s), or each half a
// second.
TEST(Console, TurnsAClockWhileItRuns) {
  const auto counted = [](const char* period, double until) {
    Console console = console_of(
        "p = { type = \"pulse-train\", period = 1, width = 0.2 }\n"
        "n = { type = \"counter\", clock = \"p\" }\n");
    console.advance(10.1);
    console.turn("p.period", period);
    console.advance(until);
    return console.value("n.out");
  };
  EXPECT_EQ(counted("2", 11.9), 11);
  EXPECT_EQ(counted("2", 12.1), 12);
  EXPECT_EQ(counted("2", 20.1), 16);
  EXPECT_EQ(counted("0.5", 10.45), 11);
  EXPECT_EQ(counted("0.5", 10.55), 12);
  EXPECT_EQ(counted("0.5", 20.1), 31);
}

// A line of the time itself, at 10 s or between two pulses: its samples go on at the new pace, until it is
// the new delay late.
TEST(Console, TurnsADelayWhileItRuns) {
  for (const double when : {10.0, 10.03}) {
    for (const double delay : {0.5, 2.0}) {
      Console console = console_of(
          "u = { type = \"ramp\" }\n"
          "d = { type = \"delay-line\", in = \"u\", delay = 1, stages = 10, straight = 1 }\n");
      console.advance(when);
      EXPECT_NEAR(console.value("d"), when - 1, 1e-9);
      console.turn("d.delay", std::to_string(delay));
      console.advance(when + delay + 0.2);
      EXPECT_NEAR(console.value("d"), when + 0.2, 1e-9) << when << " " << delay;
    }
  }
}

// A finite gain makes the amplifier a state, an infinite one an element of a loop: c = μ/(1 + μ) b either
// way.
TEST(Console, CarriesAnAmplifierFromOneCaseToTheOther) {
  Console console = console_of(
      "b = { type = \"constant\", value = 0.5 }\n"
      "c = { type = \"servo-amplifier\", in = [\"c\", \"-b\"], gain = 99, bandwidth = 1000 }\n");
  console.advance(0.1);
  EXPECT_NEAR(console.value("c"), 0.495, 1e-9);
  console.turn("c.gain", "inf");
  EXPECT_NEAR(console.value("c"), 0.5, 1e-12);
  console.advance(0.2);
  console.turn("c.gain", "49");
  EXPECT_NEAR(console.value("c"), 0.5, 1e-12) << "it is carried over, and moves from there";
  console.advance(0.3);
  EXPECT_NEAR(console.value("c"), 0.49, 1e-9);
}

// The rows of a probe are what the voltmeter shows at these times, and it changes nothing.
TEST(Console, RecordsWithProbes) {
  const diagram::Diagram diagram = diagram_of(kRelayServo, "[run]\nuntil = 20\n");
  Console watched(diagram, testing::shipped_blocks()), other(diagram, testing::shipped_blocks());
  ProbeSettings settings;
  settings.names = {"x", "u"};
  settings.interval = 0.125;
  const std::size_t rows = watched.set_probe(settings);
  settings.interval = 0;
  const std::size_t steps = watched.set_probe(settings);
  settings.trigger = Trigger{"u", 0, Trigger::Slope::falling, 0};
  settings.length = 0.5;
  const std::size_t scope = watched.set_probe(settings);
  watched.advance(0.7);
  watched.advance(20);
  const Trace& trace = watched.traces(rows).front();
  ASSERT_THAT(trace.times, SizeIs(161));
  for (std::size_t k = 0; k < trace.times.size(); ++k) {
    other.advance(trace.times[k]);
    EXPECT_EQ(trace.values[0][k], other.value("x"));
    EXPECT_EQ(trace.values[1][k], other.value("u"));
  }
  // The relay turns over by jumps, which have two rows.
  const Trace& every = watched.traces(steps).front();
  std::vector<double> jumps;
  for (std::size_t k = 1; k < every.times.size(); ++k) {
    if (every.times[k] == every.times[k - 1] && every.values[1][k] < every.values[1][k - 1])
      jumps.push_back(every.times[k]);
  }
  EXPECT_THAT(jumps, SizeIs(1));
  ASSERT_THAT(watched.traces(scope), SizeIs(jumps.size()));
  for (std::size_t k = 0; k < jumps.size(); ++k) EXPECT_EQ(watched.traces(scope)[k].begin, jumps[k]);
  watched.remove_probe(rows);
  EXPECT_EQ(
      testing::message_of<ConsoleError>([&] { watched.traces(rows); }),
      "d.toml: there is no probe number 0; expected a number that 'set_probe' has given, of a probe that "
      "is not taken away");
}

TEST(Console, RefusesBadProbes) {
  Console console = console_of(kDecay);
  const auto refusal = [&](ProbeSettings settings) {
    return testing::message_of<ConsoleError>([&] { console.set_probe(std::move(settings)); });
  };
  ProbeSettings settings;
  EXPECT_EQ(refusal(settings), "d.toml: a probe cannot be set: it has no names; expected at least one");
  settings.names = {"y"};
  EXPECT_EQ(
      refusal(settings),
      "d.toml: there is no signal 'y' for a probe; expected the name of an output, a block or one of its "
      "outputs\n  remedy: known: x");
  settings.names = {"x"};
  settings.interval = std::nan("");
  EXPECT_EQ(refusal(settings),
            "d.toml: a probe cannot be set: its interval is no time; expected 0 or more seconds");
  settings.interval = 0;
  settings.length = 0;
  EXPECT_EQ(refusal(settings),
            "d.toml: a probe cannot be set: its traces have no length; expected more than 0 seconds");
  settings.length = 1;
  settings.trigger = Trigger{"x", 0, Trigger::Slope::rising, -1};
  EXPECT_EQ(refusal(settings),
            "d.toml: a probe cannot be set: its hold-off is no time; expected 0 or more seconds");
}

// A pot that is turned between two reads acts once, from the time at which the machine stands; what cannot
// be solved is told by those who run it, until the pot is turned again.
TEST(Console, GoesOnOnceAPotCanBeSolvedAgain) {
  Console console = console_of(
      "b = { type = \"constant\", value = 0.5 }\n"
      "p = { type = \"potentiometer\", in = \"s\", setting = 0.5 }\n"
      "s = { type = \"summer\", in = [\"b\", \"p\"] }\n"
      "x = { type = \"integrator\", in = \"s\" }\n");
  console.advance(1);
  EXPECT_NEAR(console.value("x"), 1, 1e-12);  // s = 0.5/(1 − 0.5)
  EXPECT_EQ(console.turn("p.setting", "0.75"), Turned::at_once);
  EXPECT_EQ(console.turn("p.setting", "1"), Turned::compiled_anew);
  EXPECT_THROW(console.advance(2), solve::SolveError);
  EXPECT_THROW(console.value("s"), solve::SolveError);
  console.turn("p.setting", "0.75");
  console.advance(2);
  EXPECT_NEAR(console.value("x"), 1 + 2, 1e-12);
}

// In machine units, also where an output has the name of a signal.
TEST(Console, GivesAllSignalsAtOnce) {
  Console console(
      diagram_of("a = { type = \"constant\", value = 0.5 }\nx = { type = \"integrator\", in = \"a\" }\n",
                 "[outputs]\nx = { signal = \"x\", scale = 10, unit = \"m\" }\n"),
      testing::shipped_blocks());
  console.advance(2);
  EXPECT_NEAR(console.value("x"), 10, 1e-6);
  ASSERT_THAT(console.signal_names(), ::testing::ElementsAre("a", "x"));
  EXPECT_EQ(console.signals()[0], 0.5);
  EXPECT_EQ(console.signals()[1], console.signal("x"));
  console.turn("a.value", "0.25");
  EXPECT_EQ(console.signals()[0], 0.25);
}

// A screen that takes the traces off sees the same ones as a probe that keeps them, and none twice.
TEST(Console, GivesTracesThatHaveEnded) {
  ProbeSettings settings;
  settings.names = {"x"};
  settings.interval = 0.1;
  settings.length = 1;
  settings.trigger = Trigger{"x", 0, Trigger::Slope::rising, 0};
  const std::string circle =
      "x = { type = \"integrator\", in = [\"y\"] }\ny = { type = \"integrator\", in = [\"-x\"], initial = 1 "
      "}\n";
  Console kept = console_of(circle), taken = console_of(circle);
  const std::size_t keeping = kept.set_probe(settings), taking = taken.set_probe(settings);
  std::vector<Trace> all;
  for (int k = 1; k <= 300; ++k) {
    kept.advance(0.1 * k);  // the pieces of the search for the trigger are the same, so that each bit is
    taken.advance(0.1 * k);
    for (Trace& trace : taken.take_traces(taking)) all.push_back(std::move(trace));
  }
  const std::vector<Trace>& whole = kept.traces(keeping);
  ASSERT_THAT(all, SizeIs(5));  // x = sin t rises through 0 at 0, 2π … 8π
  ASSERT_THAT(whole, SizeIs(5));
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].begin, whole[k].begin);
    EXPECT_EQ(all[k].values, whole[k].values);
  }
  EXPECT_THAT(testing::message_of<ConsoleError>([&] { taken.take_traces(7); }),
              ::testing::HasSubstr("there is no probe number 7"));
}

TEST(Console, ShowsOverloads) {
  Console console =
      console_of("a = { type = \"constant\", value = 1.5 }\nx = { type = \"integrator\", in = \"a\" }\n");
  ASSERT_THAT(console.overloads(), SizeIs(1));
  EXPECT_EQ(console.overloads()[0].signal, "a");
  console.advance(1);
  EXPECT_THAT(console.overloads(), SizeIs(2));
}

TEST(Console, HasTheModesOfAMachine) {
  Console console = console_of(kDecay);
  console.advance(1);
  console.set_mode(OperatingMode::hold);
  console.advance(3);
  EXPECT_NEAR(console.value("x"), std::exp(-1), 1e-8);
  console.set_mode(OperatingMode::operate);
  console.advance(4);
  EXPECT_NEAR(console.value("x"), std::exp(-2), 2e-8);
  console.set_mode(OperatingMode::initial);
  EXPECT_EQ(console.value("x"), 1);
  console.advance(5);
  EXPECT_EQ(console.value("x"), 1);
  console.set_mode(OperatingMode::operate);
  console.advance(6);
  EXPECT_NEAR(console.value("x"), std::exp(-1), 1e-8);
}

// From 1 down to e^(−2) again and again, half a second in initial condition between.
TEST(Console, Repeats) {
  Console console = console_of(kDecay);
  console.advance(1);
  console.repeat(0.5, 2);
  console.advance(1.25);
  EXPECT_NEAR(console.value("x"), 1, 1e-12);
  for (int cycle = 0; cycle < 3; ++cycle) {
    console.advance(1 + 2.5 * cycle + 0.5 + 1.5);
    EXPECT_NEAR(console.value("x"), std::exp(-1.5), 1e-8) << cycle;
  }
  console.set_mode(OperatingMode::operate);
  const double x = console.value("x"), t = console.time();
  console.advance(t + 3);
  EXPECT_NEAR(console.value("x"), x * std::exp(-3), 1e-8) << "no more repeated";
  EXPECT_EQ(testing::message_of<ConsoleError>([&] { console.repeat(0, 1); }),
            "d.toml: the machine cannot repeat with a phase of 0 s; expected two times above 0: in initial "
            "condition, and in operation");
}

TEST(Console, LeavesTheModesToATimeline) {
  Console console = console_of(
      kDecay, "[timeline]\nphases = [{ mode = \"operate\", for = 1 }, { mode = \"hold\", for = 1 }]\n");
  try {
    console.set_mode(OperatingMode::hold);
    FAIL() << "it was set";
  } catch (const ConsoleError& error) {
    EXPECT_STREQ(error.what(),
                 "d.toml: the timeline of the diagram says which mode is on; expected a diagram without "
                 "[timeline]\n  remedy: remove the timeline to set the modes by hand");
  }
  console.advance(5);
  EXPECT_NEAR(console.value("x"), std::exp(-1), 1e-8);
}

// What was saved is the state that a run goes on from, and the other way round.
TEST(Console, SavesAndRestores) {
  Console console = console_of(kRelayServo);
  console.advance(3);
  const solve::RunState state = solve::parse_run_state(solve::to_text(console.save()), "s.toml");
  console.advance(8);
  const double x = console.value("x");
  console.restore(state);
  EXPECT_EQ(console.time(), 3);
  console.advance(8);
  EXPECT_NEAR(console.value("x"), x, 1e-6);  // a hundred tolerances: the solver's own past is not kept

  const diagram::Diagram diagram = diagram_of(kRelayServo);
  solve::RunOptions options = solve::options_of(diagram.run);
  options.from = state;
  options.until = 8;
  const solve::Run run = solve::run(diagram, testing::shipped_blocks(), options);
  EXPECT_NEAR(testing::row_values(run, "x").back(), x, 1e-6);
}

// x = e^−t while it operates. A console that has just begun takes what another one saved, in whatever mode
// that was, and the other way round.
TEST(Console, RestoresTheModeWithTheState) {
  using diagram::OperatingMode;
  Console saving = console_of(kDecay);
  const solve::RunState begins = saving.save();
  saving.set_mode(OperatingMode::operate);
  saving.advance(1);
  const solve::RunState operates = saving.save();
  saving.set_mode(OperatingMode::hold);
  saving.advance(2);
  const solve::RunState holds = saving.save();
  saving.repeat(0.5, 3);
  saving.advance(3.25);  // from 2 to 2.5 in initial condition, then in operation
  const solve::RunState repeats = saving.save();

  const auto goes_on = [](Console& console, const solve::RunState& state, double x_after_one) {
    console.restore(state);
    EXPECT_EQ(console.time(), state.time);
    console.advance(state.time + 1);
    EXPECT_NEAR(console.value("x"), x_after_one, 1e-7);  // the run's tolerance is 1e-9
  };
  for (const bool by_hand : {false, true}) {
    for (const auto& [state, x] : {std::pair{begins, std::exp(-1)},
                                   {operates, std::exp(-2)},
                                   {holds, std::exp(-1)},
                                   {repeats, std::exp(-1.75)}}) {
      Console fresh = console_of(kDecay);
      if (by_hand) fresh.set_mode(OperatingMode::initial);
      goes_on(fresh, state, x);
    }
  }
  goes_on(saving, holds, std::exp(-1));
}

TEST(Console, RefusesWhatItCannotDo) {
  Console console = console_of(kDecay);
  console.advance(2);
  const auto message = [&](const auto& work) -> std::string {
    try {
      work();
    } catch (const text::Error& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(message([&] { console.advance(1); }),
            "d.toml: the machine cannot run until 1 s; expected a time from 2 s on, where it stands\n"
            "  remedy: restore an earlier state to run from there again");
  EXPECT_THAT(message([&] { console.advance(std::nan("")); }), HasSubstr("cannot run until nan s"));
  EXPECT_THAT(message([&] { console.value("y"); }), HasSubstr("there is no signal or pot 'y'"));
  EXPECT_THAT(message([&] { console.turn("x.gian", "3"); }), HasSubstr("did you mean 'gain'?"));
  EXPECT_THAT(message([&] { console.turn("x.initial", "3 kg"); }), HasSubstr("kg"));
  solve::RunState other = console.save();
  other.states.front().first = "z";
  EXPECT_THAT(message([&] { console.restore(other); }), HasSubstr("this is the state of another diagram"));
  EXPECT_EQ(console.time(), 2);
  EXPECT_NEAR(console.value("x"), std::exp(-2), 1e-8) << "it stands where it was";
}

}  // namespace
}  // namespace oblique::console
