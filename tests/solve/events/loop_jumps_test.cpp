// SPDX-License-Identifier: MIT
#include <oblique/solve/events/loop_jumps.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using ::testing::AllOf;
using testing::Compiled;
using ::testing::HasSubstr;
using testing::row_values;
using testing::run_of;
using ::testing::StartsWith;

constexpr double kNewton = 1e-9;  ///< loops are solved to rounding; what is compared here is of order 1

/// The same blocks in both orders.
std::vector<std::string> both_orders(const std::vector<std::string>& blocks) {
  std::string forward, backward;
  for (const std::string& block : blocks) {
    forward += block + "\n";
    backward.insert(0, block + "\n");
  }
  return {forward, backward};
}

// Where the store begins to track, at t = 0.5, the loop closes: z = 1.7 atan(1.7 z) has the roots 0, from
// which the elements run away (its slope there is 2.89), and ±2.23. They go to the one on the side of the
// −0.375 that was stored, as they do one after the other.
TEST(LoopJumps, GoWhereTheElementsOfALoopTakeItThatAnEventCloses) {
  double truth = -0.375;
  for (int k = 0; k < 100; ++k) truth = 1.7 * std::atan(1.7 * truth);
  for (const std::string& blocks : both_orders(
           {R"(z = { type = "track-and-store", in = "-1.7*a", track = "g", initial = -0.375 })",
            R"(a = { type = "arc-tangent", in = "-1.7*z" })", R"(g = { type = "ramp", slope = 1 })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 5});
    EXPECT_TRUE(result.warnings.empty());
    const std::vector<double> z = row_values(result, "z");
    EXPECT_NEAR(z[1], -0.375, kNewton);
    EXPECT_NEAR(z[4], truth, kNewton) << blocks;
  }
}

// y = c − 0.18 y² where c steps from 7.8 to 0.44: y falls to the nearer root (√(1 + 0.72 c) − 1)/0.36. From
// the other one, −(√(1 + 0.72 c) + 1)/0.36, the elements run away.
TEST(LoopJumps, FallToTheNearerSolutionOfAParabola) {
  for (const std::string& blocks : both_orders(
           {R"(y = { type = "summer", in = ["c", "-2*q"] })", R"(q = { type = "squarer", in = "0.3*y" })",
            R"(c = { type = "step", at = 0.5, from = 7.8, to = 0.44 })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 5});
    const std::vector<double> y = row_values(result, "y");
    const auto root = [](double c) { return (std::sqrt(1 + 0.72 * c) - 1) / 0.36; };
    EXPECT_NEAR(y[1], root(7.8), kNewton) << blocks;
    EXPECT_NEAR(y[4], root(0.44), kNewton) << blocks;
  }
}

// y = 2 atan 4y + 1.088 at −1.77, at −0.18, from which the elements run away, and at 4.06. From the guess, 0,
// they go up.
TEST(LoopJumps, LeaveNoStartFromWhichTheElementsRunAway) {
  double truth = 0;
  for (int k = 0; k < 100; ++k) truth = 2 * std::atan(4 * truth) + 1.088;
  for (const std::string& blocks :
       both_orders({R"(y = { type = "summer", in = ["-2*a", "1.088*one"] })",
                    R"(a = { type = "arc-tangent", in = "-2*d" })",
                    R"(d = { type = "gain", in = "y", factor = 2 })", R"(one = { type = "constant" })"})) {
    EXPECT_NEAR(row_values(run_of(Compiled(blocks)), "y").front(), truth, kNewton) << blocks;
  }
}

/// T(u): 0 below 0, where it rises by 2 to 1 at 0.5, and falls by 3.25 to −0.625 at 1 and on.
constexpr const char* kTable = "points = [[-1, 0], [0, 0], [0.5, 1], [1, -0.625]]";

// u = b + T(u) has, for b from −0.5 to 0, three solutions: u = b, one on the rising line, from which the
// elements run away, and one beyond. b = −|t − 0.5| touches 0, where the first two meet: u stays with b.
TEST(LoopJumps, KeepToABranchThatMerelyTouchesItsEnd) {
  for (const std::string& blocks : both_orders(
           {R"(g = { type = "ramp", slope = 1, initial = -0.5 })",
            R"(b = { type = "absolute-value", in = "g" })", R"(u = { type = "summer", in = ["-b", "c"] })",
            std::string(R"(c = { type = "function-generator", in = "u", )") + kTable + " }"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 11});
    const std::vector<double> t = row_values(result, "t"), u = row_values(result, "u");
    for (std::size_t row = 0; row < t.size(); ++row)
      EXPECT_NEAR(u[row], -std::abs(t[row] - 0.5), kNewton) << blocks;
  }
}

// The same with b = t − 0.5: where it passes 0, at t = 0.5, u jumps over the rising line to the falling one,
// u = (b + 1 + 3.25/2)/4.25.
TEST(LoopJumps, GoOverTheLinesOfATableWhereNoneOfThemHoldsThem) {
  for (const std::string& blocks :
       both_orders({R"(b = { type = "ramp", slope = 1, initial = -0.5 })",
                    R"(u = { type = "summer", in = ["b", "c"] })",
                    std::string(R"(c = { type = "function-generator", in = "u", )") + kTable + " }"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 11});
    const std::vector<double> t = row_values(result, "t"), u = row_values(result, "u");
    for (std::size_t row = 0; row < t.size(); ++row) {
      if (t[row] == 0.5) continue;  // both lines meet there
      const double b = t[row] - 0.5;
      EXPECT_NEAR(u[row], b < 0 ? b : (b + 1 + 3.25 / 2) / 4.25, kNewton) << blocks;
    }
  }
}

// The block counts how often its input has passed 0.25. The table's argument is −c = 1 all along, so that its
// value is −0.5; on the line where it stands before the start has settled it would be 1.
TEST(LoopJumps, AreNoEventsOfWhatReadsATableThatIsNotSettledYet) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("times", R"toml(
[inputs]
in = { doc = "a plain number" }
[outputs]
out = { doc = "how often" }
[memories]
n = 0
[equations]
out = "n"
[[events]]
when = "in > 0.25"
set = { n = "n + 1" }
)toml");
  const Compiled made(
      "c = { type = \"constant\", value = -1 }\n"
      "f = { type = \"function-generator\", in = \"-c\", points = [[-1, -1], [0, 0], [0.5, 0.5], [1, -0.5]] "
      "}\n"
      "n = { type = \"times\", in = \"f\" }\n",
      "", library);
  EXPECT_EQ(row_values(run_of(made), "n").back(), 0);
}

// y = −0.3 − 2 f(y/2), f = −y/4 below zero and −0.875 above: y = −0.6 and y = 1.45, in linear equations of
// which the jump chooses one.
TEST(LoopJumps, OfALinearLoopWithAJumpThatHasTwoSolutionsAreTold) {
  for (
      const std::string& blocks : both_orders(
          {R"(y = { type = "summer", in = ["-0.3*one", "-2*f"] })", R"(one = { type = "constant" })",
           R"(f = { type = "function-generator", in = "0.5*y", points = [[-1, 0.5], [0, 0], [0, -0.875], [1, -0.875]] })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1});
    const double y = row_values(result, "y").front();
    EXPECT_NEAR(y, y < 0 ? -0.6 : 1.45, 1e-12);  // rounding
    ASSERT_EQ(result.warnings.size(), 1U) << blocks;
    EXPECT_THAT(result.warnings[0].what,
                HasSubstr("' has several solutions: at t = 0 s the run begins with "));
  }
}

/// Two gates of which each is low while the other, or its own input, is high.
std::vector<std::string> latch(const std::string& set) {
  return {R"(q = { type = "comparator", in = ["0.5*one", "-r", "-p"] })",
          R"(p = { type = "comparator", in = ["0.5*one", ")" + set + R"(", "-q"] })",
          R"(one = { type = "constant" })", R"(s = { type = "step", at = 0.5, from = 1, to = 0 })",
          R"(r = { type = "constant", value = 0 })"};
}

TEST(LoopJumps, OfALatchThatNothingSetsAreTold) {
  for (const std::string& blocks : both_orders(latch("-r"))) {
    const auto result = run_of(Compiled(blocks));
    EXPECT_EQ(row_values(result, "q").back() + row_values(result, "p").back(), 1);
    ASSERT_EQ(result.warnings.size(), 1U) << blocks;
    EXPECT_THAT(result.warnings[0].what,
                AllOf(StartsWith("the loop of the switches of '"),
                      HasSubstr("' has several solutions: at t = 0 s the run goes on with '"),
                      HasSubstr("' (in > 0) "), HasSubstr("; nothing in the diagram chooses between them")));
    EXPECT_EQ(result.warnings[0].remedy,
              "set the latch by one of its inputs then, or give one of its comparators a hysteresis and an "
              "'initial'");
  }
}

// a = −sign b, b = −sign a holds for ±1: each sign reads what another one has decided, not the unknown of the
// loop.
TEST(LoopJumps, OfSignsThatReadEachOtherAreTold) {
  for (const std::string& blocks : both_orders({R"(a = { type = "sign", in = "-b" })",
                                                R"(half = { type = "gain", in = "a", factor = 0.5 })",
                                                R"(b = { type = "sign", in = "-half" })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 2});
    ASSERT_EQ(result.warnings.size(), 1U) << blocks;
    EXPECT_THAT(result.warnings[0].what,
                HasSubstr("' has several solutions: at t = 0 s the run begins with "));
  }
}

// q = b q comes to 0 whichever way the comparator stands that is b: its own 0.3 b holds it on either side.
TEST(LoopJumps, OfASwitchThatStandsOtherwiseWithTheSameUnknownsAreTold) {
  for (const std::string& blocks :
       both_orders({R"(d = { type = "diode", in = "0.3*q" })",
                    R"(b = { type = "comparator", in = ["d", "0.3*b"], low = -0.25, high = 1.0625 })",
                    R"(q = { type = "multiplier", x = "-0.5*d", y = "0.5*b" })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 2});
    ASSERT_EQ(result.warnings.size(), 1U) << blocks;
    EXPECT_THAT(result.warnings[0].what,
                AllOf(HasSubstr(" has several solutions: at t = 0 s the run begins with b = "),
                      HasSubstr("-0.25"), HasSubstr("1.0625")));
  }
}

// One side alone of the latch of two signs leaves z = min(−4.9 z², 0.3 sign) a solution: there z rests at 0,
// and the elements run away from the other one, −1/4.9.
TEST(LoopJumps, GoFromTheGuessWhereAnotherLoopHasToBeginElsewhere) {
  for (const std::string& blocks :
       both_orders({R"(q = { type = "squarer", in = "-1.7*z" })",
                    R"(z = { type = "minimum", x = "-1.7*q", y = "0.3*a" })",
                    R"(a = { type = "sign", in = "b" })", R"(b = { type = "sign", in = "0.5*a" })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 2});
    EXPECT_NEAR(row_values(result, "z").back(), 0, kNewton) << blocks;
  }
}

// A pulse at t = 0 closes m = 4 sin m + 1.2, and m goes up from 0 to its root; Newton's method alone would
// find the one at −0.41 first, at which the counter counts.
TEST(LoopJumps, GoWhereTheirElementsTakeThemBeforeWhatFollowsAtTheStartIsServed) {
  double truth = 2;
  for (int k = 0; k < 200; ++k) truth += 0.1 * (4 * std::sin(truth) + 1.2 - truth);
  for (const std::string& blocks : both_orders(
           {R"(one = { type = "constant" })", R"(p = { type = "pulse-train", period = 2, width = 1.5 })",
            R"(s = { type = "sine", in = "-m" })", R"(y = { type = "summer", in = ["s", "-0.3*one"] })",
            R"(m = { type = "multiplier", x = "-4*y", y = "p" })",
            R"(n = { type = "counter", clock = "-2*m" })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 2});
    EXPECT_NEAR(row_values(result, "m").back(), truth, kNewton) << blocks;
    EXPECT_EQ(row_values(result, "n.out").back(), 0) << blocks;
  }
}

// A register of two stores that lies at the level with which it is compared: nothing closes the loop, and at
// its level the comparison does not hold.
TEST(LoopJumps, OfARegisterAtItsLevelAreNotTold) {
  for (const std::string& blocks : both_orders(
           {R"(a = { type = "pulse-train", period = 0.1, width = 0.03, delay = 0.02 })",
            R"(b = { type = "pulse-train", period = 0.1, width = 0.03, delay = 0.07 })",
            R"(h = { type = "constant", value = 0.5 })", R"(c = { type = "comparator", in = ["r", "-h"] })",
            R"(m = { type = "track-and-store", in = "c", track = "a", initial = 0.5 })",
            R"(r = { type = "track-and-store", in = "m", track = "b", initial = 0.5 })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 11});
    EXPECT_TRUE(result.warnings.empty()) << blocks;
    EXPECT_EQ(row_values(result, "r").back(), 0) << blocks;
  }
}

// A pulse at the start sets it: what it would be before that is nobody's choice.
TEST(LoopJumps, OfALatchThatAPulseSetsAtTheStartAreNotTold) {
  for (const std::string& blocks : both_orders(
           {R"(q = { type = "comparator", in = ["0.5*one", "-r", "-p"] })",
            R"(p = { type = "comparator", in = ["0.5*one", "-s", "-q"] })", R"(one = { type = "constant" })",
            R"(s = { type = "pulse-train", period = 1, width = 0.1, delay = 0.5 })",
            R"(r = { type = "pulse-train", period = 1, width = 0.1 })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 0.9, .samples = 3});
    EXPECT_TRUE(result.warnings.empty()) << blocks;
    EXPECT_EQ(row_values(result, "q").front(), 0);
    EXPECT_EQ(row_values(result, "q").back(), 1);
  }
}

// It is set where the run starts, and keeps that when the input falls.
TEST(LoopJumps, OfALatchThatIsSetAreItsOwn) {
  for (const std::string& blocks : both_orders(latch("-s"))) {
    const auto result = run_of(Compiled(blocks));
    EXPECT_TRUE(result.warnings.empty());
    for (const std::size_t row : {std::size_t{0}, std::size_t{1000}}) {
      EXPECT_EQ(row_values(result, "q")[row], 1);
      EXPECT_EQ(row_values(result, "p")[row], 0);
    }
  }
}

// y = clip(2 y + f) has three solutions at f = 0. The guess is the one in the middle, exactly, from which the
// elements would run away: it begins at another, and is told of, be they near or beyond the points from which
// they are sought.
TEST(LoopJumps, LeaveAnUnstableSolutionThatIsExactlyTheGuess) {
  for (const int gain : {2, 10}) {
    const Compiled made(fmt::format(R"toml(f = {{ type = "time-function", formula = "1.5*sin(time)" }}
s = {{ type = "summer", in = ["{}*y", "f"] }}
y = {{ type = "limiter", in = "s" }}
)toml",
                                    gain));
    const auto result = testing::run_of(made, {.until = 0.5});
    EXPECT_EQ(std::abs(row_values(result, "y").front()), 1);
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_EQ(result.warnings[0].what,
              fmt::format("the algebraic loop of 's', 'y' has several solutions: at t = 0 s the run begins "
                          "with s = -{0}, and {0} is another; nothing in the diagram chooses between them",
                          gain));
  }
}

// y = (c − 2y)² where c steps from 1 to −0.06: y, as the unknown, would go up from 0.25 for ever, and
// Newton's method finds 0.185, from which y and s = c − 2y both run away (the gain is 1.72). At 0.00486 they
// stay.
TEST(LoopJumps, KeepToNoSolutionFromWhichElementsRunAwayWhileThereIsAnother) {
  for (const std::string& blocks :
       both_orders({R"(z = { type = "integrator", in = ["y"] })", R"(y = { type = "squarer", in = "s" })",
                    R"(s = { type = "summer", in = ["c", "-2*y"] })",
                    R"(c = { type = "step", at = 1, from = 1, to = -0.06 })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 2, .samples = 3});
    EXPECT_NEAR(row_values(result, "y")[2], (1 - 0.24 - std::sqrt(1 - 0.48)) / 8, kNewton) << blocks;
  }
}

// At t = 0 the table lies at its jump, and the loop that another address would close leads it back from where
// its own event leads it: the run begins all the same, with the side to which b goes.
TEST(LoopJumps, LeadNoTableRoundAndRoundAtTheStart) {
  for (
      const std::string& blocks : both_orders(
          {R"toml(b = { type = "multiplexer", in0 = "-1.7*u", in1 = "-2*s", address = "-0.5*u", step = 1.125 })toml",
           R"toml(f = { type = "function-generator", in = "-0.5*b", points = [[-1, 0.5], [0, 0], [0, -0.25], [1, -0.25]] })toml",
           R"toml(s = { type = "summer", in = ["-0.5*f"] })toml",
           R"toml(u = { type = "time-function", formula = "sin(time)" })toml"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 2});
    EXPECT_EQ(row_values(result, "f"), std::vector<double>(2, -0.25)) << blocks;
  }
}

// An amplifier that runs away from between its limits goes to −1, whatever lies at a level of its own beside
// it.
TEST(LoopJumps, GoToALimitBesideWhatIsNotDecidedYet) {
  const Compiled made(R"toml(u = { type = "constant", value = 0.7 }
v = { type = "constant" }
x = { type = "integrator", in = ["v"] }
s = { type = "comparator", in = ["x"] }
y = { type = "servo-amplifier", in = ["-0.5*y", "u"], gain = 1e6, bandwidth = inf, limit = 1 }
)toml");
  const auto result = run_of(made, {.until = 1, .samples = 2});
  EXPECT_EQ(row_values(result, "y"), std::vector<double>(2, -1));
  EXPECT_EQ(row_values(result, "s"), std::vector<double>(2, 1));
}

// u goes to its other limit where s comes to ±0.8, whatever slides behind it: b, a backlash of 0.1, follows
// 0.05 behind.
TEST(LoopJumps, GoFromALimitThatIsLeftToRounding) {
  const Compiled made(R"toml(s = { type = "sine-source", frequency = 0.3, amplitude = 1 }
u = { type = "servo-amplifier", in = ["-0.8*u", "s"], gain = inf, bandwidth = inf, limit = 1 }
b = { type = "backlash", in = "u" }
)toml");
  using diagram::IntegrationMethod;
  for (const auto method : {IntegrationMethod::adams, IntegrationMethod::bdf, IntegrationMethod::rodas}) {
    const auto result = run_of(made, {.until = 5, .tolerance = 1e-9, .samples = 11, .method = method});
    const std::vector<double> u = row_values(result, "u"), b = row_values(result, "b");
    EXPECT_EQ(u[4], -1);  // t = 2; s = 0.8 at 0.4919, −0.8 at 2.1586, 0.8 at 3.8253
    EXPECT_EQ(u[6], 1);
    EXPECT_EQ(u[9], -1);
    EXPECT_NEAR(b[9], -0.95, 1e-9);
  }
}

/// Of an ideal amplifier behind a step from `from` to `to` at t = 0.5: what it gives before and after.
std::pair<double, double> across(const std::string& loop, double from, double to) {
  const std::string blocks = fmt::format(
      "u = {{ type = \"step\", at = 0.5, from = {}, to = {} }}\none = {{ type = \"constant\" }}\n{}", from,
      to, loop);
  const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 3});
  EXPECT_TRUE(result.warnings.empty()) << loop;
  const auto q = row_values(result, "q");
  return {q.front(), q.back()};
}

// q|q| + q = u: with the magnitude latched there is no solution for the other sign of u.
TEST(LoopJumps, AreMadeByAmplifiersWhoseLoopHasNoSolutionOnItsSide) {
  const auto [before, after] = across(R"(a = { type = "absolute-value", in = "q" }
qa = { type = "multiplier", x = "q", y = "a" }
q = { type = "servo-amplifier", in = ["qa", "q", "-u"], gain = "inf", bandwidth = "inf" })",
                                      1, -1);
  const double golden = (std::sqrt(5.0) - 1) / 2;
  EXPECT_NEAR(before, golden, kNewton);
  EXPECT_NEAR(after, -golden, kNewton);
}

// The inverse of a function given by points, of which the line for 0.244 lies beyond two others.
TEST(LoopJumps, LeadAnAmplifierFromLineToLine) {
  const auto [before, after] = across(
      R"(s = { type = "function-generator", in = "q", points = [[-2, -1.878], [-1.432, -0.993], [-0.73, 1.281], [0.359, 1.507]] }
q = { type = "servo-amplifier", in = ["s", "-u"], gain = "inf", bandwidth = "inf" })",
      2.449, 0.244);
  EXPECT_NEAR(before, 0.359 + (2.449 - 1.507) * (0.359 + 0.73) / (1.507 - 1.281), kNewton);
  EXPECT_NEAR(after, -1.432 + (0.244 + 0.993) * (1.432 - 0.73) / (1.281 + 0.993), kNewton);
}

// s(q) + q/20 = 1 where the run starts, and u is −1 later on: the step does not stand yet where the table is
// sought first.
TEST(LoopJumps, FindTheStartOfATableBehindAStep) {
  const auto [before, after] = across(
      R"(s = { type = "function-generator", in = "q", points = [[-2, -3], [-0.5, -0.4], [0.3, 0.1], [0.9, 1.2], [2, 1.5]] }
q = { type = "servo-amplifier", in = ["s", "0.05*q", "-u"], gain = "inf", bandwidth = "inf" })",
      1, -1);
  EXPECT_NEAR(before, (1 - 0.1 + 0.3 * 1.1 / 0.6) / (1.1 / 0.6 + 0.05), kNewton);
  EXPECT_NEAR(after, (-1 + 0.4 - 0.5 * 2.6 / 1.5) / (2.6 / 1.5 + 0.05), kNewton);
}

// q² = 0.2 + clip(u): as long as the limiter has not turned over the amplifier would run to its other limit.
// It goes from where it was when all has.
TEST(LoopJumps, OfAnAmplifierBeginWhereItWasBeforeTheInstant) {
  const auto [before, after] = across(R"(a = { type = "limiter", in = "u", low = 0, high = 2 }
d = { type = "summer", in = ["0.2*one", "a"] }
qq = { type = "squarer", in = "q" }
q = { type = "servo-amplifier", in = ["qq", "-d"], initial = 0.5, gain = "inf", limit = 2 })",
                                      1, -0.6);
  EXPECT_NEAR(before, std::sqrt(1.2), kNewton);
  EXPECT_NEAR(after, std::sqrt(0.2), kNewton);
}

// d jumps from 1/2 to 0.8 by a pulse, which is a memory, and a step, which is none: with either alone the
// root has no value, or another.
TEST(LoopJumps, WaitForAllThatComesAtOneInstant) {
  for (const std::string& blocks :
       both_orders({R"(p = { type = "pulse-train", delay = 0.55, width = 0.5 })",
                    R"(u = { type = "step", at = 0.55, from = 0.5, to = -0.2 })",
                    R"(d = { type = "summer", in = ["p", "u"] })",
                    R"(q = { type = "square-root", in = "d", gain = "inf", bandwidth = "inf" })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 3});
    EXPECT_TRUE(result.warnings.empty()) << blocks;
    EXPECT_NEAR(row_values(result, "q").front(), std::sqrt(0.5), kNewton);
    EXPECT_NEAR(row_values(result, "q").back(), std::sqrt(0.8), kNewton);
  }
}

// d goes from 0.1 to −0.1 by a step of −1.2 and a pulse of 1 at one instant: q³ − q = d keeps to its upper
// branch, which d = −1.1 alone would end.
TEST(LoopJumps, KeepToABranchThatOnlyAPartOfAnInstantWouldEnd) {
  for (
      const std::string& blocks : both_orders(
          {R"(p = { type = "pulse-train", delay = 0.55, width = 0.5 })",
           R"(u = { type = "step", at = 0.55, from = 0.1, to = -1.1 })",
           R"(d = { type = "summer", in = ["p", "u"] })", R"(q2 = { type = "squarer", in = "q" })",
           R"(q3 = { type = "multiplier", x = "q2", y = "q" })",
           R"(q = { type = "servo-amplifier", in = ["q3", "-q", "-d"], initial = 1, gain = "inf", limit = 3 })"})) {
    const auto q = row_values(run_of(Compiled(blocks), {.until = 1, .samples = 3}), "q");
    EXPECT_NEAR(q.back() * q.back() * q.back() - q.back(), -0.1, kNewton) << blocks;
    EXPECT_GT(q.back(), 0.9) << blocks;
  }
}

// 1 is divided by 1/2 by repeated subtraction, x and its copy m in stores that track by turns: at x = 1/2 the
// difference jumps to zero, within a loop that is never closed, and c does not hold.
TEST(LoopJumps, LeaveNothingHoldingThatIsPutOnItsLevel) {
  for (const std::string& blocks : both_orders(
           {R"(a = { type = "pulse-train", period = 0.1, width = 0.03, delay = 0.02 })",
            R"(b = { type = "pulse-train", period = 0.1, width = 0.03, delay = 0.07 })",
            R"(y = { type = "constant", value = 0.5 })", R"(c = { type = "comparator", in = ["x", "-y"] })",
            R"(cy = { type = "multiplier", x = "c", y = "y" })",
            R"(n = { type = "summer", in = ["x", "-cy"] })",
            R"(m = { type = "track-and-store", in = "n", track = "a", initial = 1 })",
            R"(x = { type = "track-and-store", in = "m", track = "b", initial = 1 })"})) {
    const auto result = run_of(Compiled(blocks), {.until = 1, .samples = 11});
    EXPECT_EQ(row_values(result, "x").back(), 0.5) << blocks;
    EXPECT_EQ(row_values(result, "c").back(), 0) << blocks;
  }
}

// q³ − q = d, which nothing integrates, is thrown to its lower branch by a pulse between two rows.
TEST(LoopJumps, AreMadeAtEventsAlsoWhereNothingNeedsThem) {
  const Compiled made(R"(u = { type = "sine-source", frequency = 1 }
c = { type = "comparator", in = ["u", "-0.9*one"] }
one = { type = "constant" }
d = { type = "summer", in = ["0.2*one", "-1.2*c"] }
q2 = { type = "squarer", in = "q" }
q3 = { type = "multiplier", x = "q2", y = "q" }
q = { type = "servo-amplifier", in = ["q3", "-q", "-d"], initial = 1, gain = "inf" }
)");
  for (const int samples : {3, 6, 101}) {
    const double q = row_values(run_of(made, {.until = 1, .samples = samples}), "q").back();
    EXPECT_NEAR(q * q * q - q, 0.2, 1e-9) << samples;
    EXPECT_LT(q, -0.8) << samples;
  }
}

// q³ − q = d has one solution above 1 and, for d = 0.2, two more: the amplifier starts from 1, whatever comes
// later.
TEST(LoopJumps, OfAnAmplifierKnowNothingOfAStepToCome) {
  const auto [before, after] = across(R"(q2 = { type = "squarer", in = "q" }
q3 = { type = "multiplier", x = "q2", y = "q" }
q = { type = "servo-amplifier", in = ["q3", "-q", "-u"], initial = 1, gain = "inf", limit = 3 })",
                                      0.2, -1);
  EXPECT_NEAR(before * before * before - before, 0.2, kNewton);
  EXPECT_GT(before, 1);
  EXPECT_NEAR(after * after * after - after, -1, kNewton);
}

// 2 max(y, 0) − max(−y, 0) = sin(t + φ) is solved by sin/2 above zero and by sin below. At the corner none of
// its comparisons holds, as where the loop begins, and with none of them y is not in it at all.
TEST(LoopJumps, BeginAtACornerAtWhichNothingHolds) {
  const auto truth = [](double phase, const oblique::solve::Run& result) {
    const std::vector<double> t = row_values(result, "t"), y = row_values(result, "y");
    for (std::size_t row = 0; row < t.size(); ++row) {
      const double sine = std::sin(t[row] + phase);
      EXPECT_NEAR(y[row], sine > 0 ? sine / 2 : sine, kNewton) << t[row] << ' ' << phase;
    }
  };
  for (const double phase : {0.0, 0.5, -0.5}) {
    truth(phase, run_of(Compiled(fmt::format(R"toml(
u = {{ type = "time-function", formula = "sin(time + {})" }}
zero = {{ type = "constant", value = 0 }}
m = {{ type = "inverter", in = "y" }}
p = {{ type = "maximum", x = "y", y = "zero" }}
n = {{ type = "maximum", x = "m", y = "zero" }}
y = {{ type = "servo-amplifier", in = ["2*p", "-n", "-u"], gain = "inf", bandwidth = "inf" }}
)toml",
                                             phase)),
                        {.until = 10}));
    for (const double start : {0.0, 0.1, -0.1}) {
      const diagram::BlockLibrary library = testing::shipped_blocks_and("corner", fmt::format(R"toml(
[outputs]
y = {{ doc = "Solution." }}
[implicit]
y = "2*max(y, 0) - max(-y, 0) - sin(time + {})"
[start]
y = {}
)toml",
                                                                                              phase, start));
      truth(phase, run_of(Compiled("y = { type = \"corner\" }", "", library), {.until = 10}));
    }
  }
}

// y = lim(u + g y²) of a fast u = a sin(ωt + 20°), a hundred turns of it over 38 rows. From below it goes
// along y = (1 − √(1 − 4 g u))/(2 g) until that ends at u = 1/(4 g), and jumps to the limit; this it leaves
// at u = 1 − g. Rows tell nothing of a turn that lies between them, and with g = 0.6 and a = 0.5 the jump
// takes a quarter of one.
TEST(LoopJumps, GoWhereABranchEndsBetweenTheRows) {
  constexpr double kTurns = 100, kPhase = 20 * std::numbers::pi / 180;
  struct Case {
    double amplitude, gain;
  };
  for (const auto& [amplitude, gain] : {Case{0.5, 0.6}, Case{1, 0.6}, Case{1, 1.8}, Case{5, 1.8}}) {
    const Compiled made(
        fmt::format(R"toml(u = {{ type = "sine-source", amplitude = {}, frequency = {}, phase = {} }}
q = {{ type = "squarer", in = "y" }}
s = {{ type = "summer", in = ["u", "{}*q"] }}
y = {{ type = "limiter", in = "s", low = -1, high = 1 }}
)toml",
                    amplitude, kTurns, kPhase, gain));
    const std::vector<double> y = row_values(run_of(made, {.samples = 38}), "y");
    for (std::size_t row = 0; row < y.size(); ++row) {
      const double angle = 2 * std::numbers::pi * kTurns * static_cast<double>(row) / 37 + kPhase;
      const double u = amplitude * std::sin(angle), end = 1 / (4 * gain), back = 1 - gain;
      const bool is_at_limit = u > end || (u > back && std::cos(angle) < 0);
      const double below = is_at_limit ? 1 : (1 - std::sqrt(1 - 4 * gain * u)) / (2 * gain);
      EXPECT_NEAR(y[row], std::max(-1.0, below), kNewton) << amplitude << ", " << gain << ", row " << row;
    }
  }
}

}  // namespace
}  // namespace oblique::solve
