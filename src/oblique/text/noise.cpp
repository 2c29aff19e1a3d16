// SPDX-License-Identifier: MIT
#include <oblique/text/noise.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace oblique::text {
namespace {

/// ∫ (quintic B-spline)², which is the value of the B-spline of degree 11 at its centre.
constexpr double kMeanSquare = 655177.0 / 1663200.0;

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input moves every bit of the
/// output.
std::uint64_t scramble(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Uniform in (0, 1).
double uniform(std::uint64_t bits) {
  constexpr double kUnit = 0x1p-53;
  return (static_cast<double>(bits >> 11) + 0.5) * kUnit;
}

/// A Gaussian random number of unit variance (Box and Muller 1958), a function of its arguments alone.
double gaussian(std::int64_t index, std::int64_t seed) {
  const std::uint64_t bits =
      scramble(static_cast<std::uint64_t>(index) ^ scramble(static_cast<std::uint64_t>(seed)));
  return std::sqrt(-2 * std::log(uniform(bits))) * std::cos(2 * std::numbers::pi * uniform(scramble(bits)));
}

/// Weights of the six knots around u ∈ [0, 1) in a uniform quintic B-spline, by the recurrence of Cox and de
/// Boor; `degree` 4 gives five weights.
std::array<double, 6> spline_weights(double u, int degree) {
  std::array<double, 6> w{1};
  for (int d = 1; d <= degree; ++d) {
    double carried = 0;
    for (int i = d; i >= 0; --i) {
      const auto at = static_cast<std::size_t>(i);
      const double left = i > 0 ? w[at - 1] * (u + d - i) : 0;
      const double right = i < d ? w[at] * (i + 1 - u) : 0;
      carried = (left + right) / d;
      w[at] = carried;
    }
  }
  return w;
}

}  // namespace

double noise(double x, double seed, int derivative) {
  constexpr double kLargest = 1e15;  // beyond, whole numbers are no longer apart
  if (!(std::abs(x) < kLargest && std::abs(seed) < kLargest)) return std::numeric_limits<double>::quiet_NaN();
  const double floor = std::floor(x);
  const auto first = static_cast<std::int64_t>(floor);
  const std::int64_t chosen = std::llround(seed);
  const std::array<double, 6> w = spline_weights(x - floor, derivative == 0 ? 5 : 4);
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    // The derivative of a B-spline is the difference of two of one degree less.
    const double weight = derivative == 0 ? w[i] : (i > 0 ? w[i - 1] : 0) - (i < 5 ? w[i] : 0);
    sum += weight * gaussian(first + static_cast<std::int64_t>(i), chosen);
  }
  return sum / std::sqrt(kMeanSquare);
}

}  // namespace oblique::text
