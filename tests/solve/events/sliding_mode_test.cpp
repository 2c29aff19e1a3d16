// SPDX-License-Identifier: MIT
#include <oblique/solve/events/sliding_mode.h>

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::solve {
namespace {

// Two relays that drive x and y back to zero slide together. Where the second compares y + 0.3 sign(x), that
// is 0 with the first relay below and 0.6 with it above, at y = 0.3: no shares hold it at zero.
TEST(SlidingMode, DoesNotBeginWhereOneSwitchMakesTheOtherJump) {
  for (const double jump : {0.0, 0.3}) {
    const testing::Compiled made(fmt::format(R"(a = {{ type = "sign", in = "x" }}
s = {{ type = "summer", in = ["y", "{}*a"] }}
b = {{ type = "sign", in = "s" }}
x = {{ type = "integrator", in = "-a" }}
y = {{ type = "integrator", in = "-b" }}
)",
                                             jump));
    network::Workspace workspace(made.program);
    EdgeValues edges(made.program, workspace, 1);
    IndependentUnits independent(made.program);
    SlidingMode slide(made.program, workspace, edges, independent, 1);
    ASSERT_EQ(made.program.states()[1].name, "y");
    EXPECT_EQ(slide.begin({0, 1}, {}, 0, std::vector<double>{0, jump}), jump == 0);
  }
}

}  // namespace
}  // namespace oblique::solve
