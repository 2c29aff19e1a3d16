// SPDX-License-Identifier: MIT
// Where surfaces are left that are slid along, or rested on.
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

// dx/dt = −sign((0.5 − t) x) reaches x = 0 at t = 0.1 and is driven to it until t = 0.5, then away: x = ±(t −
// 0.5).
TEST(Slide, IsLeftWhereBothSidesBeginToDriveAway) {
  const Compiled made(R"toml(
g = { type = "ramp", slope = -1, initial = 0.5 }
p = { type = "multiplier", in = ["g", "x"] }
c = { type = "sign", in = "-p" }
x = { type = "integrator", in = ["c"], initial = 0.1 }
)toml");
  const oblique::Run result = run_of(made, {.until = 2, .samples = 41});  // one row at t = 0.5 itself
  const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t row = 0; row < t.size(); ++row) {
    const double truth = t[row] < 0.1 ? 0.1 - t[row] : std::max(t[row] - 0.5, 0.0);
    // Left where the sides drive apart by 1e-6 of what they drove together.
    EXPECT_NEAR(std::abs(x[row]), truth, 1e-6) << t[row];
  }
  ASSERT_EQ(result.warnings.size(), 1u);
  // It is told where the drive is below 1e-6 of what it was.
  double told = 0;
  ASSERT_EQ(std::sscanf(result.warnings.front().what.c_str(),
                        "'c' (in > 0) leaves the surface that it slides along at t = %lf s", &told),
            1);
  EXPECT_NEAR(told, 0.5, 1e-6);
  EXPECT_THAT(
      result.warnings.front().what,
      ::testing::EndsWith(" s, since both of its sides drive away from it from then on: rounding decides to "
                          "which side it goes"));
  EXPECT_EQ(result.warnings.front().remedy,
            "end the run before, or add the disturbance that decides it on the machine");
}

// Two switches lie on their surfaces at the start. Only that of the absolute value moves off, so only it may
// turn.
TEST(Switches, StayWhereTheyAreOnASurfaceThatRests) {
  const std::string rest = "r = { type = \"integrator\", in = \"-r\" }\n";
  const std::string sign = "s = { type = \"sign\", in = \"r\" }\n";
  const std::string magnitude = "m = { type = \"absolute-value\", in = \"x\" }\n";
  const std::string moving = "x = { type = \"integrator\", in = [\"-0.5*s\", \"-x\"] }\n";
  for (const std::string& blocks : {rest + sign + magnitude + moving, moving + magnitude + sign + rest}) {
    const Compiled made(blocks);
    const oblique::Run result = run_of(made, {.samples = 11});
    EXPECT_EQ(row_values(result, "s"), std::vector<double>(11, -1)) << blocks;
    EXPECT_NEAR(row_values(result, "x").back(), 0.5 * (1 - std::exp(-1)), 1e-7);  // ten tolerances
  }
}

}  // namespace
}  // namespace oblique
