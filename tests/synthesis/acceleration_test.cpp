// SPDX-License-Identifier: MIT
// The accelerations that a fit tells.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fitting.h"

namespace oblique::synthesis {
namespace {

using namespace test;

/// The largest angular acceleration of coupler and rocker over a turn [squares of the crank's speed], by
/// second differences of the angles over thousandths of a turn: good to (2π/1000)²/12 of the fourth
/// derivative.
double largest_acceleration(const FourBar& four_bar) {
  constexpr int kParts = 1000;
  const double h = 2 * std::numbers::pi / kParts;
  const auto angles_at = [&](double angle) {
    FourBar foot = four_bar;
    foot.along = foot.left = 0;
    FourBar end = foot;
    end.along = four_bar.coupler;
    const Eigen::Vector2d b = foot.point(angle), c = end.point(angle);
    return Eigen::Vector2d(std::atan2(c.y() - b.y(), c.x() - b.x()),
                           std::atan2(c.y(), c.x() - four_bar.frame));
  };
  double largest = 0;
  for (int k = 0; k < kParts; ++k) {
    const Eigen::Vector2d bent = angles_at((k - 1) * h) - 2 * angles_at(k * h) + angles_at((k + 1) * h);
    largest = std::max(largest, bent.lpNorm<Eigen::Infinity>() / (h * h));
  }
  return largest;
}

TEST(Fit, TellsTheAccelerationsBeforeAndAfter) {
  const FourBar wanted{83, 146, 156, 200, 53, 42};
  const Fit found = fit(FourBar{}.text(), {"AB", "BCF", "CD", "BCF.F"},
                        csv_of(wanted, angles_of_a_turn(24), Timing::given));
  // a row each degree passes a peak by half a degree: some 1e-4 of it
  EXPECT_NEAR(found.acceleration_before, largest_acceleration(FourBar{}), 1e-3);
  EXPECT_NEAR(found.acceleration_after, largest_acceleration(wanted), 1e-3);
}

// The eighteen points of Kunjur and Krishnamurty (1997). From the last place that was searched, far within
// wide bounds, no walk leads back in steps that assemble: the accelerations were 0 then.
TEST(Fit, TellsTheAccelerationsWhereverTheSearchEnded) {
  const std::string text = R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [1.5, 0]
[bodies]
crank = { points = ["A", "K"], length = 1, marks = { B = [0.4, 0.1] } }
BC = { points = ["B", "C"], length = 1.2, marks = { P = [0.5, 0.5] } }
CD = { points = ["C", "D"], length = 1 }
[drives]
crank = { turns = "crank", about = "A", speed = 1, start = 0 }
[sketch]
C = [1.4, 0.95]
)";
  constexpr std::array<std::array<double, 2>, 18> kPoints{{{0.5, 1.1},
                                                           {0.4, 1.1},
                                                           {0.3, 1.1},
                                                           {0.2, 1},
                                                           {0.1, 0.9},
                                                           {0.05, 0.75},
                                                           {0.02, 0.6},
                                                           {0, 0.5},
                                                           {0, 0.4},
                                                           {0.03, 0.3},
                                                           {0.1, 0.25},
                                                           {0.15, 0.2},
                                                           {0.2, 0.3},
                                                           {0.3, 0.4},
                                                           {0.4, 0.5},
                                                           {0.5, 0.7},
                                                           {0.6, 0.9},
                                                           {0.6, 1}}};
  std::string csv = "crank,P.x,P.y\n";
  for (std::size_t k = 0; k < kPoints.size(); ++k)
    csv += fmt::format("{},{},{}\n", static_cast<double>(k) * std::numbers::pi / 9, kPoints[k][0],
                       kPoints[k][1]);
  const Fit found = fit(text,
                        {"A.x=-5..5", "A.y=-5..5", "D.x=-5..5", "D.y=-5..5", "crank.B.x=-2..2",
                         "crank.B.y=-2..2", "BC=0.05..5", "CD=0.05..5", "BC.P.x=-3..3", "BC.P.y=-3..3"},
                        csv, 3);
  ASSERT_TRUE(found.turns_fully);
  const FourBar given{std::hypot(0.4, 0.1), 1.2, 1, 1.5, 0, 0};
  EXPECT_NEAR(found.acceleration_before, largest_acceleration(given), 1e-3);
  const std::vector<double> v = values_of(found);
  const FourBar made{std::hypot(v[4], v[5]), v[6], v[7], std::hypot(v[2] - v[0], v[3] - v[1]), 0, 0};
  EXPECT_NEAR(found.acceleration_after, largest_acceleration(made), 1e-3);
}

}  // namespace
}  // namespace oblique::synthesis
