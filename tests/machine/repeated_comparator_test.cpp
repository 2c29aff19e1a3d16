// SPDX-License-Identifier: MIT
#include <oblique/machine/repeated_comparator.h>

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/machine/scaled_realisation.h>

#include "../support/compiled.h"
#include "profiles.h"

namespace oblique::machine {
namespace {

using testing::inverting_machine;
using testing::shipped_blocks;
using testing::shipped_blocks_and;

bool repeats(const std::string& settings, double weight, double offset,
             const diagram::BlockLibrary& library = shipped_blocks(),
             const std::string& type = "comparator") {
  const diagram::FlatDiagram flat = diagram::flatten(
      diagram::parse_diagram(testing::diagram_text("x = { type = \"integrator\", in = \"x\" }\n"
                                                   "k = { type = \"" +
                                                   type +
                                                   "\", in = \"x\", hysteresis = 0.1 }\n"
                                                   "c = { type = \"" +
                                                   type + "\", in = \"k\"" + settings + " }\n"),
                             "d.toml"),
      library);
  return only_repeats(flat.blocks[2], weight, offset, flat.blocks[1]);
}

// The source gives 0 or 1; c is high where weight · source + offset > 0.
TEST(RepeatedComparator, SwitchesBetweenTheLevelsOfItsSource) {
  EXPECT_TRUE(repeats("", 1, -0.5));
  EXPECT_TRUE(repeats("", 1, 0));  // at 0 it is low
  EXPECT_TRUE(repeats("", 0.2, -0.1));
  EXPECT_FALSE(repeats("", 1, -1));    // low always
  EXPECT_FALSE(repeats("", 1, 0.1));   // high always
  EXPECT_FALSE(repeats("", -1, 0.5));  // the other way round
  EXPECT_FALSE(repeats(", low = -1", 1, -0.5));
  EXPECT_FALSE(repeats(", high = 0.5", 1, -0.5));
  EXPECT_FALSE(repeats(", hysteresis = 0.2", 1, -0.5));  // it remembers
}

// One's own comparator that is low where the shipped one is high.
TEST(RepeatedComparator, GoesByWhatTheBlockComputes) {
  const diagram::BlockLibrary library = shipped_blocks_and("upside-down", R"toml(
role = "comparator"
[inputs]
in = { sum = true }
[outputs]
out = {}
[parameters]
low = { default = 0, unit = "machine unit" }
high = { default = 1, unit = "machine unit" }
hysteresis = { default = 0, unit = "machine unit" }
[equations]
out = "if(in > 0, low, high)"
)toml");
  EXPECT_FALSE(repeats("", 1, -0.5, library, "upside-down"));
  EXPECT_TRUE(repeats("", -1, 0.5, library, "upside-down"));
}

std::size_t comparators_of(const std::string& control) {
  const diagram::Diagram diagram =
      diagram::parse_diagram(testing::diagram_text(R"(
x   = { type = "integrator", in = "-y" }
y   = { type = "integrator", in = ["x", "0.1*s"], initial = 1 }
on  = { type = "comparator", in = "x", hysteresis = 0.2)" +
                                                       control + R"( }
s   = { type = "electronic-switch", on = "y", control = "on" }
)",
                                                   "[run]\nuntil = 5\n[outputs]\ny = \"y\"\n"),
                             "d.toml");
  const ScaledRealisation made = realise_scaled(diagram, shipped_blocks(), inverting_machine());
  return static_cast<std::size_t>(
      std::count_if(made.diagram.blocks.begin(), made.diagram.blocks.end(),
                    [](const diagram::BlockInstance& block) { return block.type == "comparator"; }));
}

TEST(RepeatedComparator, IsNotPatchedBeforeASwitch) {
  EXPECT_EQ(comparators_of(""), 1U);
  EXPECT_EQ(comparators_of(", low = -1"), 2U);
}

}  // namespace
}  // namespace oblique::machine
