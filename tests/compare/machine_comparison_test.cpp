// SPDX-License-Identifier: MIT
#include <oblique/compare/machine_comparison.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/solve/solve_error.h>
#include <oblique/text/file.h>

#include "../support/compiled.h"
#include "four_bar.h"

namespace oblique::compare {
namespace {

using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

MachineComparison compared(const std::string& mechanism, const std::string& machine, double gain,
                           patch::PatchMethod method = patch::PatchMethod::triangles) {
  patch::PatchOptions options;
  options.gain = gain;
  options.method = method;
  return compare_on_machine(mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) +
                                                      "/diagrams/mechanisms/" + mechanism + ".toml"),
                            testing::shipped_blocks(), *diagram::find_machine(machine), options);
}

/// A shipped mechanism with further tables.
mechanism::Mechanism shipped_with(const std::string& name, const std::string& tables) {
  const std::string path = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name + ".toml";
  return mechanism::parse_mechanism(text::read_file(path) + "\n" + tables, name + ".toml");
}

struct MachineCase {
  const char* mechanism;
  const char* machine;
  patch::PatchMethod method;
};

void PrintTo(const MachineCase& tested, std::ostream* out) {
  *out << tested.mechanism << " on " << tested.machine << ", " << patch::method_name(tested.method);
}

class Budget : public ::testing::TestWithParam<MachineCase> {};
INSTANTIATE_TEST_SUITE_P(MachineComparison, Budget,
                         ::testing::Values(MachineCase{"four-bar", "ec-1", patch::PatchMethod::triangles},
                                           MachineCase{"four-bar", "tr-10", patch::PatchMethod::triangles},
                                           MachineCase{"four-bar", "ec-1", patch::PatchMethod::gradient},
                                           MachineCase{"four-bar", "tr-10", patch::PatchMethod::gradient},
                                           MachineCase{"jansen", "ec-1", patch::PatchMethod::triangles},
                                           MachineCase{"class-iii", "the-analog-thing",
                                                       patch::PatchMethod::triangles}));

// The errors are small beside the links, up to 4 %, so they add up but for products of two of them: those are
// smaller than the errors by as much, magnified where triangles are flat.
TEST_P(Budget, IsTheSumOfTheProfilesFigures) {
  const MachineCase& tested = GetParam();
  const MachineComparison result = compared(tested.mechanism, tested.machine, 1e3, tested.method);
  EXPECT_NEAR(result.explained(), 1, 0.02);
  EXPECT_TRUE(result.stable);
  EXPECT_GT(result.max_error, 10 * result.ideal_error);  // the machine's elements, not the method
  for (const FigureError& figure : result.figures) {
    EXPECT_LE(std::abs(figure.share), figure.alone * (1 + 1e-12)) << figure.figure;
  }
}

// The amplifiers' gain of 1000 alone moves the four-bar from the rest of gain 1e6 to that of gain 1000;
// beside that it lags by 0.2 % of it.
TEST(MachineComparison, FigureAloneIsItsClosedForm) {
  const MachineComparison result = compared("four-bar", "ec-1", 1e6);
  const auto servo = std::find_if(result.figures.begin(), result.figures.end(),
                                  [](const FigureError& f) { return f.block == "servo-amplifier"; });
  ASSERT_NE(servo, result.figures.end());
  EXPECT_EQ(servo->figure, "amplifier, open-loop gain");
  double expected = 0;
  for (int row = 0; row <= 360; ++row) {
    const double angle = row * pi / 180;
    expected = std::max(
        expected, (testing::rocker_end_at_rest(angle, 1e3) - testing::rocker_end_at_rest(angle, 1e6)).norm());
  }
  EXPECT_NEAR(servo->alone, expected, 0.003 * expected);
}

TEST(MachineComparison, TellsWhatTheMachineHasNotAndWhatItLeavesOut) {
  const MachineComparison without = compared("four-bar", "ec-1", 1e3);
  EXPECT_EQ(without.machine, "Heathkit EC-1");
  EXPECT_THAT(without.absent, ElementsAre("multipliers"));
  EXPECT_THAT(without.scatter, IsEmpty());
  EXPECT_NEAR(without.ideal_error, 6.015e-4,
              1e-6);  // ideal elements have the gain of the patch, not their default
  const MachineComparison with = compared("four-bar", "tr-10", 1e3);
  EXPECT_THAT(with.absent, IsEmpty());
  EXPECT_THAT(with.scatter, ElementsAre("resistors, tolerance", "capacitors, tolerance"));
}

// From 0 backwards the four-bar errs less and less, so that all is largest in the first row. What the machine
// adds is no less than what it errs by beyond ideal elements, and what a figure does no less than its share.
TEST(MachineComparison, SeesTheStartOfAMotion) {
  mechanism::Mechanism mechanism = shipped_with("four-bar", "[motion]\nuntil = 0.5\n");
  mechanism.drives.front().speed = -1;
  patch::PatchOptions options;
  options.gain = 1e3;
  options.samples = 5;
  const MachineComparison result =
      compare_on_machine(mechanism, testing::shipped_blocks(), *diagram::find_machine("ec-1"), options);
  EXPECT_EQ(result.worst.time, 0);
  EXPECT_GE(result.from_ideal, result.max_error - result.ideal_error);
  for (const FigureError& figure : result.figures)
    EXPECT_LE(std::abs(figure.share), figure.alone * (1 + 1e-12)) << figure.figure;  // rounding
}

// A machine without errors is the method alone.
TEST(MachineComparison, OfTheIdealMachineIsTheMethod) {
  const MachineComparison result = compared("four-bar", "ideal", 1e3);
  EXPECT_THAT(result.figures, IsEmpty());
  EXPECT_EQ(result.from_ideal, 0);
  EXPECT_EQ(result.max_error, result.ideal_error);
  EXPECT_NEAR(result.explained(), 1, 1e-12);      // rounding
  EXPECT_NEAR(result.max_error, 6.015e-4, 1e-6);  // that of the patch before it was put into elements
}

// A gradient servo of K = 1e6 · 2π · 20 Hz is faster than the summers in its loop, whose bandwidth is 200
// kHz.
TEST(MachineComparison, NamesTheRunThatFails) {
  const std::string message = testing::message_of<solve::SolveError>(
      [] { compared("four-bar", "tr-10", 1e6, patch::PatchMethod::gradient); });
  EXPECT_THAT(message,
              HasSubstr("four-bar.toml: with all figures of EAI PACE TR-10 (1959): the run stopped at t = "));
}

}  // namespace
}  // namespace oblique::compare
