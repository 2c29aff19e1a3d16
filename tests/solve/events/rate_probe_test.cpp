// SPDX-License-Identifier: MIT
#include <oblique/solve/events/rate_probe.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

TEST(RateProbe, LeavesALoopOnItsBranch) {
  // y³ − y = x: the lower branch ends at x = 2/(3√3), y = −1/√3.
  const double fold = 2 / (3 * std::sqrt(3.0));
  const Compiled made(R"toml(
one = { type = "constant" }
x = { type = "integrator", in = "one", initial = -0.6 }
yy = { type = "squarer", in = "y" }
yyy = { type = "multiplier", in = ["yy", "y"] }
y = { type = "servo-amplifier", in = ["yyy", "-y", "-x"], initial = -1.2, gain = inf, bandwidth = inf }
z = { type = "integrator", in = "y" }
c = { type = "comparator", in = "x" }
)toml");
  network::Workspace workspace(made.program);
  const std::vector<double> x{fold - 5e-7, 0};
  std::vector<double> event_functions(1);
  const auto here = made.program.event_functions(0, x.data(), event_functions.data(), workspace);
  RateProbe probe(made.program, workspace, 2);
  probe.begin(here.value(), 0);
  const double y = workspace.unknown(0);
  ASSERT_LT(y, -1 / std::sqrt(3.0));
  EXPECT_TRUE(probe.look(std::vector<std::uint32_t>{0}, 0, x));  // 1e-6 on
  EXPECT_EQ(workspace.unknown(0), y);
}

}  // namespace
}  // namespace oblique::solve
