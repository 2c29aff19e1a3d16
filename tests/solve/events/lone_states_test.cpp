// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/lone_states.h>

#include <string_view>

#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

/// Of the switch of block `s`: the name of its state, or nothing.
std::string lone_state_of(const char* blocks) {
  const Compiled made(blocks);
  const std::vector<std::optional<std::size_t>> found = lone_states(made.program);
  for (std::size_t s = 0; s < made.program.switches().size(); ++s) {
    if (made.program.switches()[s].block != "s") continue;
    const auto state = found[made.program.switch_structure().unit[s]];
    return state ? made.program.states()[*state].name : "";
  }
  return "no switch";
}

TEST(LoneStates, AreThoseOfLevelsOfOneState) {
  constexpr const char* kStates =
      "v = { type = \"integrator\", in = \"-v\" }\nx = { type = \"integrator\", in = \"v\" }\n"
      "one = { type = \"constant\" }\n";
  const auto of = [&](std::string_view blocks) {
    return lone_state_of((std::string(kStates) + std::string(blocks)).c_str());
  };
  EXPECT_EQ(of("s = { type = \"sign\", in = \"v\" }"), "v");
  EXPECT_EQ(of("s = { type = \"comparator\", in = [\"2*v\", \"-0.3*one\"] }"), "v");
  EXPECT_EQ(of("q = { type = \"squarer\", in = \"x\" }\ns = { type = \"sign\", in = \"q\" }"), "x");
  EXPECT_EQ(of("s = { type = \"comparator\", in = [\"v\", \"x\"] }"), "");
  EXPECT_EQ(of("a = { type = \"absolute-value\", in = \"v\" }\ns = { type = \"comparator\", in = [\"a\", "
               "\"-one\"] }"),
            "");
  EXPECT_EQ(of("y = { type = \"servo-amplifier\", in = [\"y\", \"-v\"], gain = inf }\ns = { type = \"sign\", "
               "in = \"y\" }"),
            "");
}

}  // namespace
}  // namespace oblique::solve
