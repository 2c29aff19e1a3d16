// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/settling.h>

#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/stability/linear_factors.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

// r = c − b holds c at μ/(1 + μ) of b: along a chain the share to the power of the place.
TEST(Settling, FollowsAChainOfLoops) {
  std::string text = "b0 = { type = \"constant\", value = 1 }\n";
  for (int k = 1; k <= 100; ++k) {
    text += fmt::format(
        "b{} = {{ type = \"servo-amplifier\", in = [\"b{}\", \"-b{}\"], gain = 20, bandwidth = 5 }}\n", k, k,
        k - 1);
  }
  const testing::Compiled chain(text);
  network::Workspace workspace(chain.program);
  const StateGroups groups = servo_groups(chain.program);
  EXPECT_EQ(groups.size(), 100U);
  std::vector<double> states = chain.program.start();
  ASSERT_TRUE(settle(chain.program, workspace, 0, groups, states));
  for (std::size_t i = 0; i < states.size(); ++i) {
    const int k = std::stoi(chain.program.states()[i].name.substr(1));
    EXPECT_NEAR(states[i], std::pow(20.0 / 21, k), 1e-12) << k;  // rounding
  }
}

// An ideal divider behind a real summer, which stands at zero until it is brought to rest: before that the
// loop of the quotient is singular.
TEST(Settling, LetsALoopWaitForWhatItIsMadeOf) {
  const testing::Compiled made(R"(one = { type = "constant" }
s = { type = "summer", in = ["0.5*one"], bandwidth = "10 kHz" }
q = { type = "servo-amplifier", in = ["p", "-0.25*one"], gain = "inf", bandwidth = "inf" }
p = { type = "multiplier", in = ["q", "s"] }
x = { type = "integrator", in = "q" }
)");
  const oblique::solve::Run result = testing::run_of(made, {.until = 1, .samples = 2});
  EXPECT_NEAR(testing::row_values(result, "q").front(), 0.5, 1e-12);  // rounding
  EXPECT_NEAR(testing::row_values(result, "x").back(), 0.5, 1e-10);
}

// Each of a ring of x = −μ (x − x⁺/2 − 0.1) rests at 0.1 μ/(1 + μ/2): one group, whose factors are sparse.
TEST(Settling, FindsTheRestOfALargeRing) {
  constexpr int kRing = 100;
  std::string text = "one = { type = \"constant\", value = 1 }\n";
  for (int k = 0; k < kRing; ++k) {
    text += fmt::format(
        "b{} = {{ type = \"servo-amplifier\", in = [\"b{}\", \"-0.5*b{}\", \"-0.1*one\"], gain = 20, "
        "bandwidth = 5 }}\n",
        k, k, (k + 1) % kRing);
  }
  const testing::Compiled ring(text);
  network::Workspace workspace(ring.program);
  const StateGroups groups = servo_groups(ring.program);
  ASSERT_EQ(groups.size(), 1U);
  std::vector<double> states = ring.program.start();
  ASSERT_TRUE(settle(ring.program, workspace, 0, groups, states));
  for (const double state : states) EXPECT_NEAR(state, 0.1 * 20 / (1 + 10), 1e-12);
}

// Two loops that both grow have a matrix whose determinant is positive: they do not rest for that.
TEST(Settling, IsNotDeceivedByTwoUnstableLoops) {
  const testing::Compiled made(R"(
a = { type = "servo-amplifier", in = ["-a"], gain = 20, bandwidth = 5, initial = 0.1 }
b = { type = "servo-amplifier", in = ["-b"], gain = 20, bandwidth = 5, initial = 0.1 }
)");
  network::Workspace workspace(made.program);
  std::vector<double> states = made.program.start();
  EXPECT_FALSE(settle(made.program, workspace, 0, servo_groups(made.program), states));
}

// The direction of what has no length rests at a length of zero, and so do all that follow it: exactly, for
// they are at an unstable equilibrium, out of which rounding would grow.
TEST(Settling, LeavesNoRounding) {
  const testing::Compiled made(R"(
d = { type = "vector-direction", x = "-0.5*b", y = "-0.5*a", gain = 6000, bandwidth = 2 }
b = { type = "transfer-lag", in = "-0.5*d.sin", time_constant = 0.84 }
a = { type = "servo-amplifier", in = ["i", "a"], gain = 14100, bandwidth = 17, initial = 0.75 }
i = { type = "integrator", in = "-0.2*b", rate = 0.9 }
)");
  network::Workspace workspace(made.program);
  std::vector<double> states = made.program.start();
  ASSERT_TRUE(settle(made.program, workspace, 0, servo_groups(made.program), states));
  for (std::size_t s = 0; s < states.size(); ++s) {
    const std::string& name = made.program.states()[s].name;
    if (name == "a" || name == "d.side") {
      EXPECT_EQ(states[s], 0) << name;
    }
  }
}

// A cyclic shift of n rows, one of them negated, has the determinant (−1)ⁿ: dense factors and sparse ones.
TEST(LinearFactors, KnowTheSignOfTheDeterminant) {
  for (const int n : {1, 2, 3, 64, 65, 100}) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) entries.emplace_back((i + 1) % n, i, i == 0 ? -1e200 : 1e200);
    const LinearFactors factors(n, entries);
    EXPECT_EQ(factors.sign(), n % 2 == 0 ? 1 : -1) << n;
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(n, 1, n);
    const Eigen::VectorXd found = factors.solve(right);
    for (int i = 0; i < n; ++i) EXPECT_DOUBLE_EQ(found[i], (i == 0 ? -1e-200 : 1e-200) * ((i + 1) % n + 1));
    entries.emplace_back(1 % n, 0, 1e200);  // the first column is nothing then
    EXPECT_EQ(LinearFactors(n, entries).sign(), 0) << n;
  }
}

}  // namespace
}  // namespace oblique::solve
