// SPDX-License-Identifier: MIT
// [groups] and [timeline] on a machine.
#include <oblique/machine/mode_control.h>

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/scaled_realisation.h>

#include "machine_runs.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using ::testing::HasSubstr;
using testing::inverting_machine;
using ::testing::Not;
using testing::shipped_blocks;
using testing::trajectory_of;

diagram::MachineProfile machine_with_modes() {
  diagram::MachineProfile machine = inverting_machine();
  machine.rates = {1, 10, 100, 1000};
  return machine;
}

diagram::MachineProfile machine_of_one_mode() {
  diagram::MachineProfile machine = machine_with_modes();
  machine.title = "Desk";
  machine.figures.push_back({"integrators, modes", "common: one switch", "its manual"});
  return machine;
}

diagram::Diagram diagram_with_modes(const std::string& text) {
  return diagram::parse_diagram("format = \"oblique-diagram/1\"\n" + text, "test.toml");
}

ScaledRealisation made_with_modes(const std::string& text,
                                  const diagram::MachineProfile& machine = machine_with_modes()) {
  return realise_scaled(diagram_with_modes(text), shipped_blocks(), machine);
}

double last_of(const solve::Trajectory& run, const char* output) {
  return run.at(run.rows() - 1, run.find(output).value());
}

TEST(HasModeGroups, IsToldByAFigureOrUnknown) {
  EXPECT_EQ(has_mode_groups(machine_with_modes()), std::nullopt);
  EXPECT_EQ(has_mode_groups(machine_of_one_mode()), false);
  EXPECT_EQ(has_mode_groups(*diagram::find_machine("ideal")), true);
  EXPECT_EQ(has_mode_groups(*diagram::find_machine("the-analog-thing")), false);
  EXPECT_EQ(has_mode_groups(*diagram::find_machine("model-1")), std::nullopt);
}

// x' = 10 from −20 in initial condition for 0.5 s; it operates until it is 30, 5 s later, and holds. Time
// passes a thousand times as fast at 0.001 s, and x is carried with either sign and as a part of the unit.
TEST(Modes, OfATimelineKeepTheirConditionsInAnyScale) {
  const std::string text = R"toml(
[run]
until = 8
[timeline]
phases = [
  { mode = "initial", for = 0.5 },
  { mode = "operate", until = "x > 30" },
  { mode = "hold", for = 10 },
]
[blocks]
one = { type = "constant" }
x   = { type = "integrator", in = "10*one", initial = -20 }
y   = { type = "integrator", in = "one" }
[outputs]
x = "x"
y = "y"
)toml";
  for (const double time : {1.0, 0.001, 50.0}) {
    ScalingOptions options;
    options.time = time;
    const ScaledRealisation made =
        realise_scaled(diagram_with_modes(text), shipped_blocks(), machine_with_modes(), options);
    const solve::Trajectory run = trajectory_of(made.diagram);
    EXPECT_NEAR(run.at(run.rows() - 1, 0), 8 * time, 1e-9 * time);
    EXPECT_NEAR(last_of(run, "x"), 30, 1e-6);
    EXPECT_NEAR(last_of(run, "y"), 5, 1e-6);
    EXPECT_TRUE(diagram::parse_diagram(diagram::write_diagram(made.diagram), "made.toml") == made.diagram);
  }
}

// The oscillator that a source becomes goes on while x waits: x = ∫ sin 2πt from 0.3 on.
TEST(Modes, LeaveWhatStandsForASourceInOperation) {
  const std::string text = R"toml(
[run]
until = 1.3
[timeline]
phases = [{ mode = "initial", for = 0.3 }, { mode = "operate", for = 1 }]
[blocks]
s = { type = "sine-source", frequency = "1 Hz" }
x = { type = "integrator", in = "s" }
[outputs]
x = "x"
s = "s"
)toml";
  const ScaledRealisation made = made_with_modes(text);
  EXPECT_THAT(diagram::write_diagram(made.diagram), HasSubstr("sources = \"operate\""));
  const solve::Trajectory run = trajectory_of(made.diagram);
  constexpr double kTurn = 2 * std::numbers::pi;
  EXPECT_NEAR(last_of(run, "s"), std::sin(kTurn * 1.3), 1e-6);
  EXPECT_NEAR(last_of(run, "x"), (std::cos(kTurn * 0.3) - std::cos(kTurn * 1.3)) / kTurn, 1e-6);
  try {
    made_with_modes(text, machine_of_one_mode());
    ADD_FAILURE() << "realised";
  } catch (const RealiseError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("test.toml: the machine Desk has one mode for all its integrators, and 's.sine', "
                  "'s.cosine' go on while others do not operate; expected one mode for all at any time\n"
                  "  remedy: choose another machine, or take [groups] or the [timeline] out"));
  }
}

// A stop watch that runs while x = cos t is above a half, which a signal of 5 for 1 says.
TEST(Modes, OfALineThatIsNoLogicGetAComparator) {
  const std::string text = R"toml(
[run]
until = 1.5
[groups]
watch = { blocks = ["passed"], hold = "below" }
[blocks]
one    = { type = "constant" }
v      = { type = "integrator", in = "-x" }
x      = { type = "integrator", in = "v", initial = 1 }
below  = { type = "summer", in = ["5.5*one", "-10*x"] }
passed = { type = "integrator", in = "one" }
[outputs]
passed = "passed"
)toml";
  const ScaledRealisation made = made_with_modes(text);
  const std::string written = diagram::write_diagram(made.diagram);
  EXPECT_THAT(written, HasSubstr("hold = \"watch_hold\""));
  // 5.5 − 10 x > 0.5 from x = 0.5 on: at π/3.
  EXPECT_NEAR(last_of(trajectory_of(made.diagram), "passed"), std::numbers::pi / 3, 1e-6);
  try {
    made_with_modes(text, machine_of_one_mode());
    ADD_FAILURE() << "realised";
  } catch (const RealiseError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the integrators of 'watch' have modes of their own"));
  }
}

/// A plant y′ = s − y whose input is sampled twice a second: s = 1.2 (10 − y), in the units of the problem.
std::string sampled(const std::string& store, const std::string& clock = "") {
  return "[run]\nuntil = 3\nsamples = 61\n[blocks]\n"
         "ten = { type = \"constant\", value = 10 }\n"
         "e = { type = \"summer\", in = [\"1.2*ten\", \"-1.2*y\"] }\n"
         "c = { type = \"pulse-train\", period = 0.5, width = 0.01" +
         clock +
         " }\n"
         "s = { type = \"track-and-store\", in = \"e\"" +
         store +
         " }\n"
         "y = { type = \"integrator\", in = [\"s\", \"-y\"] }\n"
         "[outputs]\ny = \"y\"\n";
}

// While it tracks, y′ = 12 − 2.2 y; while it stores, y′ = s − y: one exponential after the other.
TEST(Modes, OfAStoreAreThoseOfAnIntegrator) {
  const ScaledRealisation made = made_with_modes(sampled(", track = \"c\""));
  ASSERT_EQ(made.diagram.groups.size(), 1U);
  EXPECT_EQ(made.diagram.groups[0].blocks.size(), 1U);
  EXPECT_NE(made.diagram.groups[0].initial, "");
  double y = 0;
  const solve::Trajectory run = trajectory_of(made.diagram);
  for (std::size_t row = 0; row < run.rows(); row += 10) {
    EXPECT_NEAR(run.at(row, 1), y, 1e-4) << "an integrator follows its initial value within a microsecond";
    y = 12 / 2.2 + (y - 12 / 2.2) * std::exp(-2.2 * 0.01);
    const double stored = 1.2 * (10 - y);
    y = stored + (y - stored) * std::exp(-0.49);
  }
}

// It holds 3 until the first pulse, though 12 stands at its input: y = 3 (1 − e⁻ᵗ). On a machine its input
// comes through a switch that the first pulse turns over for good; two stores of one clock share it.
TEST(Modes, OfAStoreThatHoldsSomethingElseAtTheStart) {
  std::string text = sampled(", track = \"c\", initial = 3", ", delay = 0.25");
  text.insert(text.find("y = {"),
              "other = { type = \"track-and-store\", in = \"-2*e\", track = \"c\", initial = 1 }\n");
  text += "s = \"s\"\nother = \"other\"\n";
  const ScaledRealisation made = made_with_modes(text);
  const std::string written = diagram::write_diagram(made.diagram);
  EXPECT_NE(written.find("_tracked "), std::string::npos);
  EXPECT_EQ(written.find("_tracked "), written.rfind("_tracked ")) << written;
  const solve::Trajectory run = trajectory_of(made.diagram);
  double y = 3 * (1 - std::exp(-0.25)), s = 3, other = 1;
  for (std::size_t row = 0; row < 25; ++row) {  // every 0.05 s, the pulses come at 0.25 and 0.75
    const double t = 0.05 * static_cast<double>(row);
    const bool before = row <= 5;
    double expected = 3 * (1 - std::exp(-t));
    if (row == 6 || row == 16) {
      y = 12 / 2.2 + (y - 12 / 2.2) * std::exp(-2.2 * 0.01);
      s = 1.2 * (10 - y);
      other = -2 * s;
    }
    if (!before) expected = s + (y - s) * std::exp(-(t - (row <= 15 ? 0.26 : 0.76)));
    if (row == 15) y = s + (y - s) * std::exp(-0.49);
    EXPECT_NEAR(run.at(row, 1), expected, 1e-4) << row << " within a microsecond, as above";
    if (row == 5 || row == 15) continue;  // where a pulse begins
    EXPECT_NEAR(run.at(row, 2), before ? 3 : s, 1e-4) << row;
    EXPECT_NEAR(run.at(row, 3), before ? 1 : other, 1e-4) << row;
  }
}

TEST(Modes, OfAStoreThatIsChargedToSomethingElseAreRefused) {
  const auto message = [](const std::string& store, const diagram::MachineProfile& machine) {
    try {
      made_with_modes(sampled(store), machine);
    } catch (const RealiseError& error) {
      return std::string(error.what());
    }
    return std::string("realised");
  };
  EXPECT_EQ(message(", track = \"c\", acquisition_time = 0.1, initial = 3", machine_with_modes()),
            "test.toml:9:1: 's' starts at 3, and an integrator that charges its capacitor would start at 0; "
            "expected a start that an integrator in track and store has\n"
            "  remedy: give it initial = 0");
  EXPECT_THAT(
      message(", track = \"c\"", machine_of_one_mode()),
      HasSubstr("the machine Desk has one mode for all its integrators, and the integrators of 's' have "
                "modes of their own; expected one mode for all at any time\n"
                "  remedy: choose another machine: a store is an integrator that has modes of its own"));
}

// A timeline alone is what any machine has: its integrators change their mode together.
TEST(Modes, OfAllIntegratorsTogetherSuitEveryMachine) {
  const ScaledRealisation made = made_with_modes(R"toml(
[run]
until = 3
[timeline]
phases = [{ mode = "initial", for = 0.5 }, { mode = "operate", for = 1 }]
cycles = 2
[blocks]
x = { type = "integrator", in = "-x", initial = 7 }
)toml",
                                                 machine_of_one_mode());
  EXPECT_THAT(diagram::write_diagram(made.diagram), Not(HasSubstr("[groups]")));
  EXPECT_NEAR(std::abs(trajectory_of(made.diagram).at(1000, 1)), 7 * std::exp(-1), 1e-6);
}

}  // namespace
}  // namespace oblique::machine
