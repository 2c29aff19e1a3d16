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
