// SPDX-License-Identifier: MIT
// Poles, damping and participation of systems whose eigenvalues are known in closed form.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/linearisation.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

double share_of(const Mode& mode, std::size_t state) {
  for (const Participation& p : mode.participants) {
    if (p.state == state) return p.share;
  }
  return 0;
}

std::vector<Mode> modes_at_start(const Compiled& made) {
  network::Workspace workspace(made.program);
  const auto linear = Linearisation::at(made.program, workspace, {0, made.program.start()});
  std::vector<Mode> modes;
  for (const auto& group : coupled_groups(made.program)) {
    for (const Mode& mode : modes_of(linear->block(group), group)) modes.push_back(mode);
  }
  return modes;
}

// x″ + 2 ζ ω x′ + ω² x = 0.
TEST(Modes, OfADampedOscillatorHaveItsFrequencyAndDamping) {
  for (const double damping : {0.05, 0.5, 0.9}) {
    constexpr double kFrequency = 7;
    const Compiled made(
        fmt::format("x = {{ type = \"integrator\", in = [\"v\"] }}\n"
                    "v = {{ type = \"integrator\", in = [\"{}*v\", \"{}*x\"] }}\n",
                    -2 * damping * kFrequency, -kFrequency * kFrequency));
    const auto modes = modes_at_start(made);
    ASSERT_EQ(modes.size(), 1U);
    // Rounding of a 2 × 2 eigenvalue problem.
    EXPECT_NEAR(modes[0].natural_frequency(), kFrequency, 1e-13 * kFrequency);
    EXPECT_NEAR(modes[0].damping_ratio(), damping, 1e-13);
    EXPECT_NEAR(modes[0].pole.imag(), kFrequency * std::sqrt(1 - damping * damping), 1e-12);
  }
}

// A ring of 60 lags, 59 wires of which have the gain 5 and the last 1e-30: (λ + 1)⁶⁰ = 5⁵⁹ · 1e-30. To
// rounding the matrix without that wire is the same, and has −1 alone.
TEST(Modes, OfARingThatIsHardlyClosedAreKnown) {
  constexpr Eigen::Index n = 60;
  Eigen::MatrixXd a = -Eigen::MatrixXd::Identity(n, n);
  std::vector<std::size_t> group;
  for (Eigen::Index i = 0; i < n; ++i) {
    a(i, (i + 1) % n) = i + 1 < n ? 5 : 1e-30;
    group.push_back(static_cast<std::size_t>(i));
  }
  double rightmost = -1;
  for (const Mode& mode : modes_of(a, group)) rightmost = std::max(rightmost, mode.pole.real());
  // Powers of 2 leave the matrix so far from balanced that this mode is known to a tenth.
  EXPECT_NEAR(rightmost, std::pow(5, 59.0 / 60) * std::pow(10, -0.5) - 1, 0.1);
}

TEST(Modes, OfDecoupledSystemsShareNothing) {
  // A fast decay and an oscillator, in one matrix.
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 3);
  a(0, 0) = -50;
  a(1, 2) = 2;
  a(2, 1) = -2;
  const auto modes = modes_of(a, {4, 5, 6});
  ASSERT_EQ(modes.size(), 2U);
  for (const Mode& mode : modes) {
    const bool decay = mode.pole.imag() == 0;
    EXPECT_NEAR(share_of(mode, 4), decay ? 1 : 0, 1e-14);
    // An undamped oscillator is as much in its displacement as in its speed.
    EXPECT_NEAR(share_of(mode, 5), decay ? 0 : 0.5, 1e-14);
    EXPECT_NEAR(share_of(mode, 6), decay ? 0 : 0.5, 1e-14);
  }
}

TEST(Modes, ParticipationDependsOnNoScaling) {
  // [[a, b], [c, d]] with real poles: the share of state 1 in mode p is (p − d)/(2 p − a − d).
  Eigen::MatrixXd a(2, 2);
  a << -3, 1e6, 2e-6, -7;
  for (const Mode& mode : modes_of(a, {0, 1})) {
    const double p = mode.pole.real();
    EXPECT_NEAR(p * p + 10 * p + 19, 0, 1e-12);
    EXPECT_NEAR(share_of(mode, 0), (p + 7) / (2 * p + 10), 1e-12);
  }
}

// Two pairs, each of which sees only the other half of itself, one alike from the start and one apart by 2⁴⁰;
// then three of which only the first is to be doubled, as 8 to 2 (the others are 101 to 104). What rounds to
// the nearest power of 2 leaves at most a factor of √2 each way.
TEST(Balance, LeavesRowsAndColumnsAboutAlike) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(7, 7);
  a.diagonal() << -1, 1e9, 0, 3, -7, 0, 2;
  a(0, 1) = a(1, 0) = 1;
  a(2, 3) = 0x1p40;
  a(3, 2) = 1;
  a(4, 5) = a(4, 6) = 4;
  a(5, 4) = a(6, 4) = 1;
  a(5, 6) = a(6, 5) = 100;
  const Eigen::VectorXd scale = balance(a);
  const Eigen::MatrixXd balanced = scale.cwiseInverse().asDiagonal() * a * scale.asDiagonal();
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    int power = 0;
    EXPECT_EQ(std::frexp(scale[i], &power), 0.5) << i;  // a power of 2
    const double own = std::abs(balanced(i, i));
    const double row = balanced.row(i).lpNorm<1>() - own, column = balanced.col(i).lpNorm<1>() - own;
    EXPECT_LE(row, 2 * column) << i;
    EXPECT_LE(column, 2 * row) << i;
  }
}

TEST(Modes, LeaveOutIntegratorsWithoutFeedback) {
  const Compiled made(R"toml(one = { type = "constant" }
phi = { type = "integrator", in = ["one"] }
x   = { type = "integrator", in = ["phi", "-4*x"] }
)toml");
  const auto modes = modes_at_start(made);
  ASSERT_EQ(modes.size(), 1U);
  EXPECT_EQ(modes[0].pole, -4.0);
  EXPECT_EQ(modes[0].damping_ratio(), 1);
}

TEST(CoupledGroups, AreTheStatesThatActOnEachOther) {
  const Compiled made(R"toml(one = { type = "constant" }
z   = { type = "integrator", in = ["x"] }
x   = { type = "integrator", in = ["v", "one"] }
v   = { type = "integrator", in = ["-x"] }
)toml");
  const auto groups = coupled_groups(made.program);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0], (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(groups[1], (std::vector<std::size_t>{0}));
}

}  // namespace
}  // namespace oblique::solve
