// SPDX-License-Identifier: MIT
#include <oblique/machine/operating_sheets.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/compiled.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::Compiled;
using ::testing::ElementsAre;
using testing::inverting_machine;

diagram::MachineProfile of_ten_volts() {
  diagram::MachineProfile machine = inverting_machine();
  machine.unit = 10;
  return machine;
}

const char* const kTwo = R"(
plus = { type = "constant" }
x    = { type = "integrator", in = "plus" }
s    = { type = "summer", in = "x" }
y    = { type = "integrator", in = "s" }
k    = { type = "comparator", in = "x" }
)";

// 1 machine unit of x is 300 m, so that 1 V is 30 m; 1 V of s is 32 + 1.8 · 5 degrees Fahrenheit.
TEST(OutputSheet, SaysWhereToReadWhat) {
  const Compiled made(kTwo, R"(
[outputs]
way  = { signal = "x", scale = 300, unit = "m" }
heat = { signal = "s", scale = 50, offset = 20, unit = "K" }
)");
  const Sheet sheet = output_sheet(made.flat, of_ten_volts());
  EXPECT_THAT(sheet.columns, ElementsAre("output", "element", "signal", "1 V is", "0 V is", "unit"));
  EXPECT_THAT(sheet.rows, ElementsAre(ElementsAre("way", "A1", "x", "30", "0", "m"),
                                      ElementsAre("heat", "A2", "s", "25", "20", "K")));
  const Sheet units = output_sheet(made.flat, inverting_machine());
  EXPECT_EQ(units.columns[3], "1 machine unit is");
  EXPECT_EQ(units.rows[0][3], "300");
}

TEST(ModeSheet, SaysHowLongItOperates) {
  const Sheet sheet = mode_sheet(Compiled(kTwo).flat, 2.5, of_ten_volts());
  EXPECT_EQ(sheet.title, "modes of operation");
  EXPECT_THAT(sheet.columns, ElementsAre("group", "integrators", "initial by", "hold by", "for 2.5 s"));
  EXPECT_THAT(sheet.rows, ElementsAre(ElementsAre("all", "A1, A3", "", "", "operate")));
}

TEST(ModeSheet, HasAColumnForEachPhase) {
  const Sheet sheet = mode_sheet(Compiled(kTwo, R"(
[groups]
slow = { blocks = ["y"], hold = "k" }
[timeline]
phases = [
  { mode = "initial", slow = "hold", for = 0.1 },
  { mode = "operate", until = "x > 0.5" },
  { mode = "hold", for = 2, until = "x < 0.2" },
]
cycles = 8
)")
                                     .flat,
                                 1, of_ten_volts());
  EXPECT_EQ(sheet.title, "modes of operation, 8 cycles");
  EXPECT_THAT(sheet.columns, ElementsAre("group", "integrators", "initial by", "hold by", "for 0.1 s",
                                         "until A1 > 5 V", "for 2 s or until A1 < 2 V", "cycles"));
  EXPECT_THAT(sheet.rows, ElementsAre(ElementsAre("main", "A1", "", "", "initial", "operate", "hold", "8"),
                                      ElementsAre("slow", "A3", "", "K1", "hold", "operate", "hold", "8")));
}

}  // namespace
}  // namespace oblique::machine
