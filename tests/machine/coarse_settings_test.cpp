// SPDX-License-Identifier: MIT
#include <oblique/machine/coarse_settings.h>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>

#include "../support/compiled.h"

namespace oblique::machine {
namespace {

std::vector<CoarseSetting> on(const std::string& machine, const std::string& settings) {
  std::string blocks = "one = { type = \"constant\" }\n";
  int number = 0;
  for (std::size_t from = 0; from < settings.size();) {
    const std::size_t end = std::min(settings.find(' ', from), settings.size());
    blocks += "p" + std::to_string(++number) +
              " = { type = \"potentiometer\", in = \"one\", setting = " + settings.substr(from, end - from) +
              " }\n";
    from = end + 1;
  }
  const diagram::FlatDiagram flat = diagram::flatten(
      diagram::parse_diagram(testing::diagram_text(blocks, "[machine]\nprofile = \"" + machine + "\"\n"),
                             "d.toml"),
      testing::shipped_blocks());
  return coarse_settings(flat, *diagram::find_machine(machine));
}

// A TR-10's have 4000 steps (0.025 %): ten of them are 0.0025. A pot that is shut, or at ten steps, is fine.
TEST(CoarseSettings, AreBelowTenStepsOfThePublishedResolution) {
  const std::vector<CoarseSetting> found = on("tr-10", "0.5 0.0008 0 0.0025 0.00249");
  ASSERT_EQ(found.size(), 2);
  EXPECT_EQ(found[0].number, "P2");
  EXPECT_EQ(found[0].signal, "p2");
  EXPECT_EQ(found[0].setting, 0.0008);
  EXPECT_DOUBLE_EQ(found[0].step, 0.00025);
  EXPECT_TRUE(found[0].is_published);
  EXPECT_EQ(found[0].in_series, 2);  // √0.0008 = 0.028
  EXPECT_EQ(found[1].signal, "p5");
}

// 11 bits and a sign: 2047 steps. 1e-6 takes three behind each other: its square root is 2 steps, its cube
// root 20.
TEST(CoarseSettings, HaveAsManyInSeriesAsBringEachToTenSteps) {
  const std::vector<CoarseSetting> found = on("lucidac", "0.004 1e-6 0.005");
  ASSERT_EQ(found.size(), 2);
  EXPECT_DOUBLE_EQ(found[0].step, 1.0 / 2047);
  EXPECT_EQ(found[1].in_series, 3);
}

// Nothing is published of a Model-1's: what the sheet can say is 0.0001.
TEST(CoarseSettings, AreBelowTenStepsOfTheSheetWhereNothingIsPublished) {
  const std::vector<CoarseSetting> found = on("model-1", "0.0011 1e-8 0.00099");
  ASSERT_EQ(found.size(), 2);
  EXPECT_EQ(found[0].setting, 1e-8);
  EXPECT_EQ(found[0].step, 1e-4);
  EXPECT_FALSE(found[0].is_published);
  EXPECT_EQ(found[0].in_series, 3);  // of 0.0022
  EXPECT_TRUE(on("ideal", "1e-8").empty());
}

}  // namespace
}  // namespace oblique::machine
