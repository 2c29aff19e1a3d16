// SPDX-License-Identifier: MIT
// Eigenvalues along a run against those of the differential equations written down.
#include <oblique/solve/stability/poles_along.h>

#include <numbers>

#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

// x″ = −9x turns round for ever, a problem's own mode ±3i. The amplifier follows x: τ ẏ = −y − μ (y − x), a
// pole at −(1 + μ)/τ with τ = 1/(2π · 10 Hz), which the machine has and the problem has not.
TEST(PolesAlong, TellsTheProblemsModesFromTheMachines) {
  const Compiled compiled(R"(v = { type = "integrator", in = "-9*x", initial = 0 }
x = { type = "integrator", in = "v", initial = 1 }
y = { type = "servo-amplifier", in = ["y", "-x"], gain = 1e3, bandwidth = 10 }
)");
  const std::vector<Instant> instants{{0, std::vector<double>(3, 0.5)}, {2, std::vector<double>(3, 0.25)}};
  const std::vector<PoleAt> poles = poles_along(compiled.flat, compiled.program, instants);
  ASSERT_EQ(poles.size(), 4U);
  std::size_t own = 0;
  for (std::size_t k = 0; k < poles.size(); ++k) {
    const PoleAt& pole = poles[k];
    EXPECT_EQ(pole.time, k < 2 ? 0 : 2);
    if (pole.of_problem) {
      ++own;
      EXPECT_NEAR(pole.value.real(), 0, 1e-12);  // rounding of numbers of size 9
      EXPECT_NEAR(pole.value.imag(), 3, 1e-12);
      continue;
    }
    const double expected = -(1 + 1e3) * 2 * std::numbers::pi * 10;
    EXPECT_NEAR(pole.value.real(), expected, 1e-12 * std::abs(expected));
    EXPECT_EQ(pole.value.imag(), 0);
    EXPECT_EQ(compiled.program.states()[pole.state].name, "y");
  }
  EXPECT_EQ(own, 2U);
}

}  // namespace
}  // namespace oblique::solve
