// SPDX-License-Identifier: MIT
// noise(x, seed): a spline of degree 5 whose knots are the whole numbers, of unit root mean square.
#include <cmath>

#include <gtest/gtest.h>

#include <oblique/text/expression.h>
#include <oblique/text/noise.h>

namespace oblique::text {
namespace {

/// The polynomial of degree 5 through noise at six places from `begin` to `begin` + 1, at x (Lagrange's
/// formula).
double continued(double begin, double seed, double x) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) {
    const double place = begin + (0.5 + i) / 6;
    double weight = 1;
    for (int j = 0; j < 6; ++j) {
      if (j != i) weight *= (x - begin - (0.5 + j) / 6) * 6 / (i - j);
    }
    sum += weight * noise(place, seed);
  }
  return sum;
}

// Within a stretch the polynomial is noise itself; beyond a knot it leaves it by the jump of the fifth
// derivative only, some tens times 0.01⁵/120 = 1e-12. Lagrange's weights magnify rounding some hundred times.
TEST(Noise, IsAPolynomialBetweenKnotsAndGoesOnSmoothlyAcrossThem) {
  for (const double knot : {-3.0, 0.0, 1.0, 7.0, 1000.0}) {
    EXPECT_NEAR(continued(knot, 4, knot + 0.91), noise(knot + 0.91, 4), 1e-10) << knot;
    EXPECT_NEAR(continued(knot, 4, knot + 1.01), noise(knot + 1.01, 4), 1e-9) << knot;
    EXPECT_NEAR(continued(knot, 4, knot - 0.01), noise(knot - 0.01, 4), 1e-9) << knot;
  }
}

// Central differences with 1e-4: the third derivative, some tens, times 1e-8/6.
TEST(Noise, HasItsDerivative) {
  for (double x = -2.95; x < 3; x += 0.17) {
    EXPECT_NEAR(noise(x, 2, 1), (noise(x + 1e-4, 2) - noise(x - 1e-4, 2)) / 2e-4, 3e-7) << x;
  }
}

// Of 40 000 places a knot apart, of which about a third are independent: the mean scatters by 0.01, the mean
// square by sqrt(2/13 000) = 0.012; four times that.
TEST(Noise, HasZeroMeanAndUnitMeanSquare) {
  constexpr int kPlaces = 40'000;
  double sum = 0, squares = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const double value = noise(k + std::fmod(0.618 * k, 1), 11);
    sum += value / kPlaces;
    squares += value * value / kPlaces;
  }
  EXPECT_NEAR(sum, 0, 0.04);
  EXPECT_NEAR(squares, 1, 0.05);
}

}  // namespace
}  // namespace oblique::text
