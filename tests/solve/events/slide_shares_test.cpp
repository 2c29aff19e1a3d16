// SPDX-License-Identifier: MIT
#include <oblique/solve/events/slide_shares.h>

#include <array>
#include <cstddef>

#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

/// Two relays that nothing couples.
constexpr const char* kTwoRelays = R"(a = { type = "sign", in = "x" }
b = { type = "sign", in = "y" }
x = { type = "integrator", in = "-a" }
y = { type = "integrator", in = "-b" }
)";

constexpr std::array<std::size_t, 2> kBoth = {0, 1};

class SharesOfTwo : public ::testing::Test {
 protected:
  SharesOfTwo() : sides_(made_.program.switch_structure()) {}

  /// Gives every side the rates of both event functions by the sides (0 or 1) on which the units are.
  template <class Rates>
  void set_rates(const Rates& rates) {
    const network::SwitchStructure& structure = made_.program.switch_structure();
    for (SlideSide& side : sides_) {
      side.event_functions.assign(made_.program.switches().size(), 0.0);
      side.rates.assign(made_.program.switches().size(), 0.0);
      const auto values = rates((side.bits & 1U) != 0 ? 1.0 : 0.0, (side.bits & 2U) != 0 ? 1.0 : 0.0);
      for (std::size_t unit = 0; unit < 2; ++unit) {
        const std::uint32_t s = structure.members[unit].front();
        side.rates[s] = structure.opposite[s] ? -values[unit] : values[unit];
      }
    }
  }

  const Compiled made_{kTwoRelays};
  SlideSides sides_;
};

// A side for all that are below, and of each cluster one for every other combination.
TEST_F(SharesOfTwo, MixCoupledUnitsInAllCombinations) {
  sides_.make({0, 1}, {});
  EXPECT_EQ(sides_.size(), 3U);
  EXPECT_FALSE(sides_.is_coupled(0));
  sides_.make({0, 1}, {{0, 1}});
  EXPECT_EQ(sides_.size(), 4U);
  EXPECT_TRUE(sides_.is_coupled(0));
  sides_.weigh(std::vector<double>{0.25, 0.5});
  std::vector<double> weights(4);
  for (const SlideSide& side : sides_) weights[side.bits] = side.weight;
  EXPECT_EQ(weights, (std::vector<double>{0.375, 0.125, 0.375, 0.125}));  // products of the shares
}

// ẋ goes as 1 − 4a and ẏ as 0.5 + 4a − 3b + 2ab by the shares a and b: both vanish at a = 1/4, b = 3/5. The
// tolerance is some roundings of rates below 8.
TEST_F(SharesOfTwo, HoldBothSwitchingSurfaces) {
  sides_.make({0, 1}, {{0, 1}});
  set_rates([](double a, double b) {
    return std::vector<double>{1 - 4 * a, 0.5 + 4 * a - 3 * b + 2 * a * b};
  });
  const auto shares = shares_of_coupled(sides_, {0.5, 0.5}, kBoth, 1, 1e-6);
  ASSERT_TRUE(shares);
  EXPECT_NEAR((*shares)[0], 0.25, 1e-13);
  EXPECT_NEAR((*shares)[1], 0.6, 1e-13);
}

// Both sides of the second unit drive its event function up alike: no share holds it.
TEST_F(SharesOfTwo, AreNoneWhereBothSidesDriveAlike) {
  sides_.make({0, 1}, {});
  set_rates([](double a, double /*b*/) { return std::vector<double>{1 - 4 * a, 2}; });
  EXPECT_FALSE(shares_of_coupled(sides_, {0.5, 0.5}, kBoth, 1, 1e-6));
}

// An event function that is 0.01 off goes back by rate · 0.01, and no faster than it may.
TEST_F(SharesOfTwo, TakeADriftBack) {
  sides_.make({0, 1}, {});
  set_rates([](double a, double b) { return std::vector<double>{1 - 4 * a, 1 - 4 * b}; });
  for (SlideSide& side : sides_) {
    for (const std::uint32_t s : made_.program.switch_structure().members[0]) side.event_functions[s] = 0.01;
  }
  const double sign =
      made_.program.switch_structure().opposite[made_.program.switch_structure().members[0][0]] ? -1 : 1;
  EXPECT_DOUBLE_EQ(way_back(sides_, 0, 2, 1), sign * 0.02);
  EXPECT_DOUBLE_EQ(way_back(sides_, 0, 2, 0.005), sign * 0.005);
}

// y³ − y = 2 sign x: on either side of the slide another branch of the loop, of which the one ends before the
// other's solution. The mean of x′ is 0, so that sign x = 0.3 sin t, and that of y as many times its root.
// (The solution on one side was sought from that on the other, and the branch was lost.)
TEST(Slide, KeepsEachSideOnItsOwnBranchOfALoop) {
  const Compiled made(R"toml(
u = { type = "time-function", formula = "0.3*sin(time)" }
s = { type = "sign", in = "x" }
x = { type = "integrator", in = ["-s", "u"], initial = 0.5 }
yy = { type = "squarer", in = "y" }
yyy = { type = "multiplier", x = "yy", y = "y" }
y = { type = "servo-amplifier", in = ["yyy", "-y", "-2*s"], initial = 1.5, gain = inf, bandwidth = inf }
area = { type = "integrator", in = "y" }
)toml");
  double begins = 0.5, root = 1.5;
  for (int k = 0; k < 50; ++k) begins = 0.5 + 0.3 * (1 - std::cos(begins));  // contracts by 0.3 sin t
  for (int k = 0; k < 50; ++k) root = std::cbrt(root + 2);                   // by 1/(3 y²)
  for (const auto method : {diagram::IntegrationMethod::adams, diagram::IntegrationMethod::bdf,
                            diagram::IntegrationMethod::rodas}) {
    const oblique::solve::Run result = run_of(made, {.until = 3, .samples = 4, .method = method});
    EXPECT_NEAR(row_values(result, "area").back(), root * (begins + 0.3 * (std::cos(begins) - std::cos(3.0))),
                1e-6);
  }
}

}  // namespace
}  // namespace oblique::solve
