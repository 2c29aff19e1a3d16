// SPDX-License-Identifier: MIT
// What events keep of signals whose value at that instant is a matter of order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::row_values;
using testing::run_of;

std::vector<std::string> warnings_of(std::string_view blocks, double until = 3) {
  const Compiled made(blocks);
  std::vector<std::string> texts;
  for (const text::Diagnostic& warning : run_of(made, {.until = until}).warnings)
    texts.push_back(warning.what);
  return texts;
}

// The pulse that the store follows ends as the step comes, by two comparisons of the time of which none is
// the first.
TEST(UncertainReadings, OfAStoreThatClosesAsAStepComesAreToldOf) {
  EXPECT_THAT(
      warnings_of(R"(
u = { type = "step", at = 1, to = 0.8 }
p = { type = "pulse-train", period = 5, width = 1 }
s = { type = "track-and-store", in = "u", track = "p" })"),
      ElementsAre(
          "'s' sets what it keeps by a signal that jumps at the same instant: at t = 1 s it takes 0.8, "
          "from after the jump; before it that was 0"));
}

TEST(UncertainReadings, OfAFlipFlopWhoseInputsStepWithItsClockAreToldOf) {
  EXPECT_THAT(warnings_of(R"(
u = { type = "step", at = 1 }
p = { type = "pulse-train", period = 5, width = 1, delay = 1 }
zero = { type = "constant", value = 0 }
f = { type = "jk-flip-flop", j = "u", k = "zero", clock = "p" })"),
              ElementsAre(HasSubstr("'f' sets what it keeps by a signal that jumps at the same instant")));
}

// A pulse is stored at its end, by a pulse that ends with it.
TEST(UncertainReadings, OfASignalThatAnEventChangesTogetherWithTheControlAreToldOf) {
  EXPECT_THAT(
      warnings_of(R"(
control = { type = "pulse-train", period = 1, width = 0.5, delay = 0.25 }
u = { type = "pulse-train", period = 1, width = 0.5, delay = 0.25, high = 0.3 }
s = { type = "track-and-store", in = "u", track = "control" })"),
      ElementsAre(
          "'s' sets what it keeps by a signal that jumps at the same instant: at t = 0.75 s it takes 0, from "
          "after the jump; before it that was 0.3"));
}

// Nothing is uncertain where the step comes a little before, where what is stored is continuous, and where
// stores hand over to each other at one instant: each takes what the other one had.
TEST(UncertainReadings, OfWhatIsInOrderAreNotToldOf) {
  EXPECT_THAT(warnings_of(R"(
u = { type = "step", at = 0.999 }
p = { type = "pulse-train", period = 5, width = 1 }
s = { type = "track-and-store", in = "u", track = "p" })"),
              IsEmpty());
  EXPECT_THAT(warnings_of(R"(
u = { type = "ramp", stop = 1 }
v = { type = "ramp", slope = -1, start = 0 }
one = { type = "constant" }
w = { type = "summer", in = ["v", "one"] }
m = { type = "absolute-value", in = "w" }
p = { type = "pulse-train", period = 5, width = 1 }
um = { type = "summer", in = ["u", "m"] }
s = { type = "track-and-store", in = "um", track = "p" })"),
              IsEmpty());
  EXPECT_THAT(warnings_of(R"(
one = { type = "constant" }
clock = { type = "pulse-train", period = 0.5, width = 0.25 }
pause = { type = "summer", in = ["one", "-clock"] }
u = { type = "ramp" }
a = { type = "track-and-store", in = "u", track = "pause" }
b = { type = "track-and-store", in = "a", track = "clock" })"),
              IsEmpty());
}

// A delay line and a pulse train have their edges by the time alone, at one instant, and so have two lines of
// one clock, of which the second takes what the first one had.
TEST(UncertainReadings, OfADelayLineThatSamplesAtAnEdgeAreToldOf) {
  constexpr const char* kRest =
      " sets what it keeps by a signal that jumps at the same instant: at t = 0.5 s it takes 0, from before "
      "the "
      "jump; after it that is 1";
  EXPECT_THAT(
      warnings_of(R"(
line = { type = "delay-line", in = "u", delay = 0.5, stages = 1 }
next = { type = "delay-line", in = "line", delay = 0.5, stages = 1 }
u = { type = "pulse-train", period = 1, width = 0.3, delay = 0.5 }
c = { type = "comparator", in = ["2*u", "-one"] }
one = { type = "constant" }
behind = { type = "delay-line", in = "c", delay = 0.5, stages = 1 })"),
      ::testing::UnorderedElementsAre(std::string("'line'") + kRest, std::string("'behind'") + kRest));
  EXPECT_THAT(warnings_of(R"(
line = { type = "delay-line", in = "u", delay = 0.5, stages = 1 }
next = { type = "delay-line", in = "line", delay = 0.5, stages = 1 }
u = { type = "pulse-train", period = 1, width = 0.3, delay = 0.45 })"),
              IsEmpty());
}

// Events of one block see the values before them, as it is written.
TEST(UncertainReadings, OfWhatABlockSetsItselfAreNotToldOf) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("pair", R"(summary = "x"
[outputs]
out = { doc = "x" }
[memories]
a = 0
b = 0
[equations]
out = "b"
[[events]]
when = "time >= 1"
set = { a = 1 }
[[events]]
when = "time >= 1"
set = { b = "a" }
)");
  const Compiled made("p = { type = \"pair\" }\n", "", library);
  const oblique::solve::Run run = run_of(made, {.until = 2});
  EXPECT_TRUE(run.warnings.empty());
  EXPECT_EQ(row_values(run, "p").back(), 0);
}

// x' = −2 sign x + w slides along x = 0, and the relay's mean is w/2: a store that samples it takes ±1.
TEST(UncertainReadings, OfASlidingRelayAreToldOf) {
  EXPECT_THAT(
      warnings_of(R"(
x = { type = "integrator", in = ["-2*r", "w"], initial = 1 }
w = { type = "constant", value = 0.5 }
r = { type = "sign", in = "x" }
p = { type = "pulse-train", period = 0.5, width = 0.25 }
s = { type = "track-and-store", in = "r", track = "p" })"),
      ElementsAre(
          "'s' sets what it keeps by a signal of 'r', which slides along its switching surface: at t = "
          "0.75 s it takes 1, and as well it could be -1"));
}

}  // namespace
}  // namespace oblique::solve
