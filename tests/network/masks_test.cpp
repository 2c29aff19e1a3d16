// SPDX-License-Identifier: MIT
// What makes nothing of the position of a switch, by the truth tables of conditions.
#include <oblique/network/program/masks.h>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using testing::shipped_blocks_and;

/// Of the comparison "in*in > 1" in a condition what masks it; "no source" where it is none.
std::vector<std::string> masks_in(const std::string& condition) {
  const diagram::BlockLibrary library = shipped_blocks_and(
      "own", "[inputs]\nin = {}\n[outputs]\nout = {}\n[equations]\nout = \"if(" + condition + ", in, 1)\"\n");
  const Compiled made("o = { type = \"own\", in = \"x\" }\nx = { type = \"integrator\", in = \"-o\" }\n", "",
                      library);
  for (const Source& source : made.program.sources()) {
    if (!source.switch_index || made.program.switches()[*source.switch_index].comparison != "in*in > 1")
      continue;
    std::vector<std::string> masks;
    for (const Mask& mask : source.masks) {
      const std::string& name = made.program.discrete_states()[mask.discrete_state].name;
      masks.push_back(name.substr(name.find("in")) + (mask.value == 1 ? " holds" : " fails"));
    }
    return masks;
  }
  return {"no source"};
}

// By the truth tables of the conditions. Of two that bend and mask each other both are looked at.
TEST(Masks, OfAComparisonAreKnown) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(masks_in("in*in > 1"), Names());
  EXPECT_EQ(masks_in("in > 2 and in*in > 1"), Names{"in > 2 fails"});
  EXPECT_EQ(masks_in("in > 2 or in*in > 1"), Names{"in > 2 holds"});
  EXPECT_EQ(masks_in("not (in > 2) and in*in > 1"), Names{"in > 2 holds"});
  EXPECT_EQ(masks_in("in > 2 and (in > 3 or in*in > 1)"), (Names{"in > 3 holds", "in > 2 fails"}));
  EXPECT_EQ(masks_in("(in > 2 and in*in > 1) or (in > 2 and in > 3 and not (in*in > 1))"),
            Names{"in > 2 fails"});
  EXPECT_EQ(masks_in("(in > 2 and in*in > 1) or (in > 3 and not (in*in > 1))"), Names());
  EXPECT_EQ(masks_in("in*in*in > 1 and in*in > 1"), Names());
}

// What drives an integrator matters beyond its limits alone.
TEST(Masks, AreTheLimitsOfAnIntegratorForWhatDrivesIt) {
  const Compiled made(R"(q = { type = "squarer", in = "x" }
x = { type = "integrator", in = "q", initial = 0.1, limit = 1 }
)");
  ASSERT_EQ(made.program.sources().size(), 2U);
  for (const Source& source : made.program.sources()) EXPECT_EQ(source.masks.size(), 1U);
}

}  // namespace
}  // namespace oblique::network
