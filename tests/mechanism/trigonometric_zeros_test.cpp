// SPDX-License-Identifier: MIT
#include <oblique/mechanism/triad/trigonometric_zeros.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace oblique::mechanism::triad {
namespace {

using Complex = std::complex<double>;

/// ∏ sin((θ − αᵢ)/2) over six angles α: of degree 3, with these zeros and no other.
///
/// sin((θ − α)/2) = (z a⁻¹ − 1)·√(a/z)/2i with a = e^{iα}, so the product is z⁻³ times a polynomial in z.
TrigonometricCubic with_zeros(const std::array<double, 6>& angles) {
  std::array<Complex, 7> coefficients{Complex(1)};
  Complex root = 1;
  for (std::size_t i = 0; i < 6; ++i) {
    const Complex a = std::polar(1.0, angles[i]);
    root *= std::polar(1.0, angles[i] / 2) / Complex(0, 2);
    for (std::size_t k = i + 2; k-- > 0;) {
      coefficients[k] = (k > 0 ? coefficients[k - 1] / a : 0.0) - coefficients[k];
    }
  }
  TrigonometricCubic f;
  f.constant = (root * coefficients[3]).real();
  for (std::size_t k = 0; k < 3; ++k) f.harmonics[k] = 2.0 * root * coefficients[4 + k];
  return f;
}

double rounding_of(const TrigonometricCubic& f) {
  return 16 * std::numeric_limits<double>::epsilon() * f.size();
}

double distance(const Directions& found, double angle) {
  double least = INFINITY;
  for (int i = 0; i < found.count; ++i)
    least = std::min(least, std::abs(found.z[static_cast<std::size_t>(i)] - std::polar(1.0, angle)));
  return least;
}

TEST(TrigonometricZeros, AreSixSimpleOnes) {
  // the third at an end and the fourth in the middle of arcs; 1.0 and 1.001 in one arc
  const std::array<double, 6> angles = {-3.0, -2.0, std::numbers::pi / 12, std::numbers::pi / 6, 1.0, 1.001};
  const TrigonometricCubic f = with_zeros(angles);
  const Directions found = zeros(f, rounding_of(f));
  EXPECT_EQ(found.count, 6);
  // rounding 1e-16 of f over its slopes of 1e-2, and 1e-5 where two zeros are close
  for (const double angle : angles) EXPECT_LT(distance(found, angle), angle < 1 ? 1e-13 : 1e-10) << angle;
}

TEST(TrigonometricZeros, AreFoundAtPi) {
  const TrigonometricCubic f =
      with_zeros({std::numbers::pi, std::numbers::pi, std::numbers::pi / 2, -std::numbers::pi / 2, 0, 0.3});
  const Directions found = zeros(f, rounding_of(f));
  for (const double angle : {std::numbers::pi / 2, -std::numbers::pi / 2, 0.0, 0.3})
    EXPECT_LT(distance(found, angle), 1e-13);
  EXPECT_LT(distance(found, std::numbers::pi), 1e-7);  // double: the root of rounding
}

TEST(TrigonometricZeros, AreFoundHoweverManyMeet) {
  // An m-fold zero is known to the m-th root of rounding over the distances to the others.
  for (int meet = 2; meet <= 6; ++meet) {
    for (const double angle : {0.3, std::numbers::pi / 12, 0.0, 1.0, std::numbers::pi, -2.2}) {
      std::array<double, 6> angles = {angle + 1, angle + 2, angle + 3, angle + 4, angle + 5, angle};
      for (int i = 0; i < meet; ++i) angles[static_cast<std::size_t>(i)] = angle;
      const TrigonometricCubic f = with_zeros(angles);
      const Directions found = zeros(f, rounding_of(f));
      EXPECT_LT(distance(found, angle), 2 * std::pow(1e-15, 1.0 / meet)) << meet << " at " << angle;
      for (std::size_t i = static_cast<std::size_t>(meet); i < 5; ++i)
        EXPECT_LT(distance(found, angles[i]), 1e-9) << meet << " at " << angle;
    }
  }
}

TEST(TrigonometricZeros, AreNoneWhereItStaysAway) {
  EXPECT_EQ(zeros({1.5, {Complex(1), 0, Complex(0, 0.4)}}, 1e-15).count, 0);
  EXPECT_EQ(zeros({0.1, {0, 0, 0}}, 1e-15).count, 0);
}

TEST(TrigonometricZeros, AreThoseOfALowerDegree) {
  const Directions found = zeros({0.5, {Complex(1), 0, 0}}, 1e-15);  // cos θ = −1/2
  EXPECT_EQ(found.count, 2);
  EXPECT_LT(distance(found, 2 * std::numbers::pi / 3), 1e-15);
  EXPECT_LT(distance(found, -2 * std::numbers::pi / 3), 1e-15);
}

}  // namespace
}  // namespace oblique::mechanism::triad
