// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/disturbance_growth.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

/// Rows of a run whose states do not matter, for equations that are linear.
std::vector<Instant> rows_of(const Compiled& made, int n) {
  std::vector<Instant> rows;
  for (int k = 0; k < n; ++k)
    rows.push_back({static_cast<double>(k) / (n - 1), std::vector<double>(made.program.n_states(), 0)});
  return rows;
}

// δ′ = 10 F(t) δ, with F = exp(−exp((0.6 − t)/0.01)) the distribution of Gumbel, which is 0 to the last bit
// up to half the time: its integral to 1 is 1 − its mean, 0.6 + 0.01 γ, less what is below the last bit.
// Beside it one that changes from the beginning, and decays.
TEST(DisturbanceGrowth, IsThatOfAGroupThatChangesLate) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("late", R"toml(
[outputs]
out = {}
[equations]
"der(out)" = "10*exp(-exp(60 - 100*time))*out"
[start]
out = 0
)toml");
  diagram::BlockLibrary both = library;
  both.add(diagram::parse_block(R"toml(format = "oblique-block/1"
title = "early"
[outputs]
out = {}
[equations]
"der(out)" = "-(1 + time)*out"
[start]
out = 0
)toml",
                                "early.toml", "early"));
  for (const char* const blocks : {"a = { type = \"early\" }\nb = { type = \"late\" }\n",
                                   "a = { type = \"late\" }\nb = { type = \"early\" }\n"}) {
    const Compiled made(blocks, "", both);
    const auto growth = disturbance_growth(made.program, rows_of(made, 401));
    ASSERT_TRUE(growth);
    // over the second half; the trapezoids of a bell as wide as four rows are exact to 1e-6
    EXPECT_NEAR(growth->late_growth(), 10 * (1 - (0.6 + 0.01 * std::numbers::egamma)), 1e-4);
  }
}

// δx′ = −δx + 10 δy + 0 · t, δy′ = −δy − 0.01 δx: e^(−1) times a rotation by √0.1 with the axes 10 and 0.1 of
// its ellipse, [cos, √1000 sin; −sin/√1000, cos], of which the largest singular value is √((a + √(a² −
// 4))/2), a the sum of the squares of its elements (its determinant is 1).
TEST(DisturbanceGrowth, IsThatOfTheLargestDisturbanceItself) {
  diagram::BlockLibrary library = testing::shipped_blocks_and("first", R"toml(
[inputs]
in = {}
[outputs]
out = {}
[equations]
"der(out)" = "-out + 10*in + 1e-12*time*out"
[start]
out = 0
)toml");
  library.add(diagram::parse_block(R"toml(format = "oblique-block/1"
title = "second"
[inputs]
in = {}
[outputs]
out = {}
[equations]
"der(out)" = "-out - 0.01*in"
[start]
out = 0
)toml",
                                   "second.toml", "second"));
  const Compiled made("x = { type = \"first\", in = \"y\" }\ny = { type = \"second\", in = \"x\" }\n", "",
                      library);
  const auto growth = disturbance_growth(made.program, rows_of(made, 401));
  ASSERT_TRUE(growth);
  const double angle = std::sqrt(0.1), c = std::cos(angle), s = std::sin(angle);
  const double a = 2 * c * c + 1000 * s * s + s * s / 1000;
  EXPECT_NEAR(growth->factor, std::exp(-1) * std::sqrt((a + std::sqrt(a * a - 4)) / 2),
              1e-9);  // rounding, 1e-12 t
}

// A ring of n states, each x′ = t x and a little of its neighbour.
TEST(DisturbanceGrowth, IsToldOfSixtyStatesAndNotOfMore) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("grower", R"toml(
[inputs]
in = {}
[outputs]
out = {}
[equations]
"der(out)" = "time*out + 1e-9*in"
[start]
out = 0
)toml");
  for (const int n : {60, 61}) {
    std::string blocks;
    for (int k = 0; k < n; ++k)
      blocks += fmt::format("x{} = {{ type = \"grower\", in = \"x{}\" }}\n", k, (k + 1) % n);
    const Compiled made(blocks, "", library);
    const auto growth = disturbance_growth(made.program, rows_of(made, 9));
    ASSERT_EQ(growth.has_value(), n == 60);
    // ∫ t dt from 1/2 to 1; the trapezoids of a line are exact
    EXPECT_NEAR(growth.value_or(DisturbanceGrowth{.exponent = 0.75, .to = 1}).late_growth(), 3.0 / 8, 1e-6);
  }
}

}  // namespace
}  // namespace oblique::solve
