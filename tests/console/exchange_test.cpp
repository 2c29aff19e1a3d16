// SPDX-License-Identifier: MIT
// A diagram that takes the place of another while the machine is held: against closed forms of both.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/console/console.h>
#include <oblique/diagram/diagram_reader.h>

#include "../support/runs.h"

namespace oblique::console {
namespace {

using diagram::OperatingMode;
using ::testing::HasSubstr;

constexpr double kNear = 1e-6;  // a hundred times the relative tolerance of a run, 1e-8

diagram::Diagram exchanged_diagram(std::string_view blocks, std::string_view rest = "") {
  return diagram::parse_diagram(testing::diagram_text(blocks, rest), "d.toml");
}

Console begun(std::string_view blocks, std::string_view rest = "") {
  return {exchanged_diagram(blocks, rest), testing::shipped_blocks()};
}

constexpr const char* kDecaying = "x = { type = \"integrator\", in = \"-x\", initial = 1 }\n";

TEST(Exchange, GoesOnFromWhereTheMachineStands) {
  Console console = begun(kDecaying);
  console.advance(1);
  console.exchange(exchanged_diagram("x = { type = \"integrator\", in = \"-2*x\", initial = 1 }\n"
                                     "z = { type = \"integrator\", in = \"x\", initial = 0.25 }\n"),
                   testing::shipped_blocks());
  EXPECT_EQ(console.time(), 1);
  EXPECT_NEAR(console.value("x"), std::exp(-1), kNear);
  EXPECT_EQ(console.value("z"), 0.25);  // new: it begins where it starts
  console.advance(1.5);
  const double x = std::exp(-1) * std::exp(-1);
  EXPECT_NEAR(console.value("x"), x, kNear);
  EXPECT_NEAR(console.value("z"), 0.25 + (std::exp(-1) - x) / 2, kNear);
}

TEST(Exchange, CarriesWhatWasRenamed) {
  const diagram::Diagram next =
      exchanged_diagram("y = { type = \"integrator\", in = \"-y\", initial = 1 }\n");
  Console console = begun(kDecaying);
  console.advance(1);
  console.exchange(next, testing::shipped_blocks(), {{"x", "y"}});
  EXPECT_NEAR(console.value("y"), std::exp(-1), kNear);
  console.advance(2);
  EXPECT_NEAR(console.value("y"), std::exp(-2), kNear);
  Console other = begun(kDecaying);
  other.advance(1);
  other.exchange(next, testing::shipped_blocks());  // a new one, for all that it knows
  EXPECT_EQ(other.value("y"), 1);
  // names that change places
  Console both = begun(
      "x = { type = \"integrator\", in = [], initial = 1 }\n"
      "y = { type = \"integrator\", in = [], initial = 2 }\n");
  both.exchange(
      exchanged_diagram("x = { type = \"integrator\", in = [] }\ny = { type = \"integrator\", in = [] }\n"),
      testing::shipped_blocks(), {{"x", "y"}, {"y", "x"}});
  EXPECT_EQ(both.value("x"), 2);
  EXPECT_EQ(both.value("y"), 1);
}

TEST(Exchange, KeepsTheMode) {
  Console console = begun(kDecaying);
  console.advance(1);
  console.set_mode(OperatingMode::hold);
  console.exchange(exchanged_diagram(std::string(kDecaying) + "a = { type = \"constant\", value = 2 }\n"),
                   testing::shipped_blocks());
  console.advance(3);
  EXPECT_NEAR(console.value("x"), std::exp(-1), kNear);
  console.set_mode(OperatingMode::operate);
  console.advance(4);
  EXPECT_NEAR(console.value("x"), std::exp(-2), kNear);
}

TEST(Exchange, KeepsPotsOfWhichTheFileSaysTheSame) {
  Console console = begun(
      "x = { type = \"integrator\", in = \"-x\", initial = 1 }\n"
      "a = { type = \"constant\", value = 0.5 }\nb = { type = \"constant\", value = 0.5 }\n"
      "s = { type = \"summer\", in = [\"a\", \"b\"] }\n");
  console.turn("x.rate", "3");
  console.turn("a.value", "0.75");
  console.turn("b.value", "0.125");
  console.turn("s.in[2]", "4");
  const auto kept =
      console.exchange(exchanged_diagram("speed = { type = \"integrator\", in = \"-speed\", initial = 1 }\n"
                                         "a = { type = \"constant\", value = 0.25 }\n"  // said anew
                                         "b = { type = \"constant\", value = 0.5, label = \"β\" }\n"
                                         "s = { type = \"summer\", in = [\"a\", \"-b\"] }\n"),
                       testing::shipped_blocks(), {{"x", "speed"}});
  EXPECT_EQ(console.value("speed.rate"), 3);
  EXPECT_EQ(console.value("a.value"), 0.25);
  EXPECT_EQ(console.value("b.value"), 0.125);
  EXPECT_EQ(console.value("s.in[2]"), -1);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].path, "speed.rate");
  EXPECT_EQ(kept[0].value, "3");
  EXPECT_EQ(kept[1].path, "b.value");
}

TEST(Exchange, TakesProbesAwayThatShowNothing) {
  Console console = begun(
      "x = { type = \"integrator\", in = \"-x\", initial = 1 }\n"
      "y = { type = \"integrator\", in = \"x\" }\n");
  const std::size_t on_x = console.set_probe({{"x"}, 0.25, {}});
  const std::size_t on_y = console.set_probe({{"y"}, 0.25, {}});
  console.advance(0.5);
  console.exchange(exchanged_diagram("a = { type = \"constant\", value = 2 }\n" + std::string(kDecaying)),
                   testing::shipped_blocks());
  console.advance(1);
  const Trace& trace = console.traces(on_x).back();
  EXPECT_EQ(trace.times.back(), 1);
  EXPECT_NEAR(trace.values[0].back(), std::exp(-1), kNear);
  EXPECT_THROW(console.traces(on_y), ConsoleError);
}

TEST(Exchange, ThatFailsLeavesTheMachineAsItWas) {
  Console console = begun(kDecaying);
  console.advance(1);
  EXPECT_THROW(console.exchange(exchanged_diagram("x = { type = \"integrator\", in = \"nobody\" }\n"),
                                testing::shipped_blocks()),
               diagram::DiagramError);
  try {
    console.exchange(exchanged_diagram(kDecaying, "[timeline]\nphases = [{ mode = \"operate\", for = 1 }]\n"),
                     testing::shipped_blocks());
    FAIL();
  } catch (const ConsoleError& error) {
    EXPECT_STREQ(
        error.what(),
        "d.toml: the timeline of the diagram is another one; expected the one with which the machine runs\n"
        "  remedy: begin again with the new one");
  }
  console.advance(2);
  EXPECT_NEAR(console.value("x"), std::exp(-2), kNear);
}

}  // namespace
}  // namespace oblique::console
